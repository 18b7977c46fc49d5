"""One light on what is seen: its diffuse and its specular plane, without D, S and the light's intensity.

Paper: "The Lighting Model" and "Light Controls". The sum over the lights with their strengths is made in
`picture`; here is what takes the time, and what stays when only strengths change.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from autocolor.light_controls import Controls, concentrated, controls, inside
from autocolor.lights import Light
from autocolor.reflection import phong_diffuse, phong_specular
from autocolor.seen import MIRROR, MIRROR_POINT, NORMAL, NORMAL_POINT, ONE, POINT, POINT_SQUARED, Seen

PIXELS_AT_ONCE = 1 << 15
CLOSE = 0.02
"""Below this squared distance, as a fraction of the squares it is the difference of, subtract the points."""

LEAST_DISTANCE = 1e-37
"""Squared, in units; what is nearer is taken to be as far, so that its inverse is finite."""

FARTHEST = 1e15
"""In units; the rays of a light that is farther are parallel, and float32 can hold the square of this."""

FEW = 0.3
"""Below this fraction of lit pixels it takes less time to pick them than to compute them all."""

DIFFUSE, SPECULAR = 0, 1

Singles = npt.NDArray[np.float32]
Floats = npt.NDArray[np.float64]


def light_planes(
    light: Light,
    seen: Seen,
    exponents: dict[int, float],
    kept: Singles | None = None,
    changed: frozenset[int] = frozenset(),
) -> Singles:
    """The diffuse and the specular plane of a light, (2, n) float32 in the order of `seen.pixels`.

    `exponents` has N for each surface number that is seen. Both planes are 0 where the light has no effect.
    `kept` are planes of the same light to take over but for the surfaces with the `changed` numbers.
    """
    planes = np.empty((2, len(seen.pixels)), np.float32) if kept is None else kept.copy()
    ready = controls(light, seen)
    position = seen.camera_point(light.position)
    position *= min(FARTHEST / max(float(np.abs(position).max()), 1.0), 1.0)
    for surface in seen.slices:
        if kept is not None and surface.surface_number not in changed:
            continue
        for first in range(surface.start, surface.stop, PIXELS_AT_ONCE):
            part = slice(first, min(first + PIXELS_AT_ONCE, surface.stop))
            _shade(planes[:, part], seen.rows[:, part], position, ready, exponents[surface.surface_number])
    planes.flags.writeable = False
    return planes


def _shade(out: Singles, rows: Singles, position: Floats, ready: Controls, exponent: float) -> None:
    """Write the two planes of some pixels of one surface."""
    flap_rows = rows
    distance = _squared_distance(rows, position)
    nearest = float(distance.min())
    if nearest < CLOSE * max(float(position @ position), float(rows[POINT_SQUARED].max())):
        rows, position = _around_light(rows, position), np.zeros(3)
        distance = rows[POINT_SQUARED].copy()
        nearest = float(distance.min())
    if nearest < LEAST_DISTANCE:
        np.maximum(distance, np.float32(LEAST_DISTANCE), out=distance)
    inverse = np.sqrt(distance, out=distance)
    np.reciprocal(inverse, out=inverse)

    # Find what faces the light and is within its controls.
    light = np.append(position, 1).astype(np.float32)
    cos_incidence = light @ rows[NORMAL.start : NORMAL_POINT + 1]
    cos_incidence *= inverse
    lit = cos_incidence > 0
    cos_light = None
    if ready.toward is not None and ready.least_cosine is not None:
        axis = np.append(ready.toward, -ready.toward @ position).astype(np.float32)
        cos_light = axis @ rows[POINT.start : ONE + 1]
        cos_light *= inverse
    within = inside(ready, cos_light, flap_rows)
    if within is not None:
        lit &= within
    lit_count = np.count_nonzero(lit)
    if not lit_count:
        out[:] = 0
        return
    few = lit_count < FEW * len(lit)
    chosen = np.flatnonzero(lit) if few else slice(None)

    # Reflect it to the eye, and take of both terms what the controls leave.
    cos_eye = light @ rows[MIRROR.start : MIRROR_POINT + 1]
    cos_eye *= inverse
    diffuse = phong_diffuse(cos_incidence[chosen])
    specular = phong_specular(cos_eye[chosen], exponent)
    if cos_light is not None and ready.concentration > 0:
        multiplier = concentrated(cos_light[chosen], ready.concentration)
        diffuse = diffuse * multiplier
        specular *= multiplier
    if few:
        out[:] = 0
        out[DIFFUSE, chosen] = diffuse
        out[SPECULAR, chosen] = specular
    else:
        np.multiply(diffuse, lit, out=out[DIFFUSE])
        np.multiply(specular, lit, out=out[SPECULAR])


def _squared_distance(rows: Singles, position: Floats) -> Singles:
    """|P - p|^2 as one product: P.P - 2 p.P + p.p."""
    factors = np.array([*(-2 * position), position @ position, 1], np.float32)
    squared: Singles = factors @ rows[POINT.start : POINT_SQUARED + 1]
    return squared


def _around_light(rows: Singles, position: Floats) -> Singles:
    """The rows with their points around the light, for a light so near that differences would cancel."""
    moved = rows.copy()
    moved[POINT] -= position.astype(np.float32)[:, None]
    np.einsum("ij,ij->j", moved[POINT], moved[POINT], out=moved[POINT_SQUARED])
    for vector, product in ((NORMAL, NORMAL_POINT), (MIRROR, MIRROR_POINT)):
        np.einsum("ij,ij->j", moved[vector], moved[POINT], out=moved[product])
        np.negative(moved[product], out=moved[product])
    return moved
