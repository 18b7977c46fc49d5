"""One light on what is seen: its diffuse and its specular plane, without D, S and the light's intensity.

Paper: "The Lighting Model" and "Light Controls". The sum over the lights with their strengths is made in
`picture`; here is what takes the time, and what stays when only strengths change.

Measured and rejected: two threads, each on half of the pixels (as long as one, for the arrays are read from
memory and the interpreter runs one at a time); two processes (two thirds of the time of one, for a second
copy of everything); fewer pixels at once than 131,072 (a tenth more at a quarter of that); the cosines of all
lights as one matrix product (a sixth less, but it rounds otherwise than that of one light, and an edit must
give what a fresh picture gives).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from autocolor.light_controls import Controls, concentrated, controls, inside_cone, inside_flaps
from autocolor.lights import Light
from autocolor.reflection import phong_diffuse, phong_specular
from autocolor.seen import (
    MIRROR,
    MIRROR_POINT,
    NORMAL,
    NORMAL_POINT,
    POINT,
    POINT_SQUARED,
    Seen,
    keep_products,
)

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


@dataclass(frozen=True, eq=False)
class LightPlanes:
    """The diffuse and the specular plane of a light.

    `values` is (2, n) float32, read-only, in the order of `Seen.pixels`, 0 where the light has no effect;
    `reached` are the numbers of the surfaces where it has any.
    """

    values: Singles
    reached: frozenset[int]


class Placed(NamedTuple):
    """A light made ready for the points of one view.

    `position` is in camera space, around the middle of the object. From points that are nearer than `close`,
    squared, it is subtracted.
    """

    position: Floats
    close: float
    controls: Controls


def placed(light: Light, seen: Seen) -> Placed:
    """A light made ready for what is seen."""
    position = seen.camera_point(light.position)
    position *= min(FARTHEST / max(float(np.abs(position).max()), 1.0), 1.0)
    close = CLOSE * max(float(position @ position), seen.reach**2)
    return Placed(position, close, controls(light, seen))


def light_planes(
    lights: Sequence[Light],
    seen: Seen,
    exponents: Mapping[int, float],
    kept: Sequence[LightPlanes | None],
    changed: frozenset[int] = frozenset(),
) -> list[LightPlanes]:
    """The planes of some lights.

    `exponents` has N for each surface number that is seen. `kept` has for each light None, or planes of the
    same light to take over but for the surfaces with the `changed` numbers.
    """
    ready = [placed(light, seen) for light in lights]
    size = (2, len(seen.pixels))
    values = [np.empty(size, np.float32) if old is None else old.values.copy() for old in kept]
    reached = [set() if old is None else set(old.reached - changed) for old in kept]
    for surface in seen.slices:
        number = surface.surface_number
        renewed = [row for row, old in enumerate(kept) if old is None or number in changed]
        # Take all lights before the next pixels, whose rows are then fetched from memory once.
        for part in surface.parts():
            for row in renewed:
                if _shade(values[row][:, part], seen.rows[:, part], ready[row], exponents[number]):
                    reached[row].add(number)
    for each in values:
        each.flags.writeable = False
    return [LightPlanes(each, frozenset(numbers)) for each, numbers in zip(values, reached, strict=True)]


def _shade(out: Singles, rows: Singles, light: Placed, exponent: float) -> bool:
    """Write the two planes of some pixels of one surface; whether the light has any effect there."""
    position, close, ready = light
    lit = inside_flaps(ready, rows)
    if lit is not None and not lit.any():
        out[:] = 0
        return False
    distance, ahead = _distance_and_ahead(rows, position, ready.toward)
    nearest = float(distance.min())
    if nearest < close:
        rows, position = _around_light(rows, position), np.zeros(3)
        distance, ahead = _distance_and_ahead(rows, position, ready.toward)
        nearest = float(distance.min())
    if nearest < LEAST_DISTANCE:
        np.maximum(distance, np.float32(LEAST_DISTANCE), out=distance)
    inverse = np.sqrt(distance, out=distance)
    np.reciprocal(inverse, out=inverse)

    # Find what faces the light and is within its controls.
    factors = np.array([*position, -1], np.float32)
    cos_incidence = factors @ rows[NORMAL.start : NORMAL_POINT + 1]
    cos_incidence *= inverse
    facing = cos_incidence > 0
    lit = facing if lit is None else np.logical_and(lit, facing, out=lit)
    cos_light = None
    if ahead is not None:
        cos_light = np.multiply(ahead, inverse, out=ahead)
        lit &= inside_cone(ready, cos_light)
    lit_count = np.count_nonzero(lit)
    if not lit_count:
        out[:] = 0
        return False
    cos_eye = factors @ rows[MIRROR.start : MIRROR_POINT + 1]
    cos_eye *= inverse
    few = lit_count < FEW * len(lit)
    if few:
        chosen = np.flatnonzero(lit)
        cos_incidence, cos_eye = cos_incidence.take(chosen), cos_eye.take(chosen)
        cos_light = None if cos_light is None else cos_light.take(chosen)

    # Reflect it to the eye, and take of both terms what the controls leave.
    diffuse = phong_diffuse(cos_incidence)
    specular = phong_specular(cos_eye, exponent)
    multiplier: Singles | np.float32 = np.float32(1)
    if cos_light is not None and ready.concentration > 0:
        multiplier = concentrated(cos_light, ready.concentration)
    if few:
        out[:] = 0
        out[DIFFUSE][chosen] = diffuse * multiplier
        out[SPECULAR][chosen] = specular * multiplier
        return True
    if lit_count < len(lit):
        multiplier = multiplier * lit
    np.multiply(diffuse, multiplier, out=out[DIFFUSE])
    np.multiply(specular, multiplier, out=out[SPECULAR])
    return True


def _distance_and_ahead(
    rows: Singles, position: Floats, toward: Floats | None
) -> tuple[Singles, Singles | None]:
    """The squared distance of each point from the light, and how far it is ahead in the light's direction.

    |P - p|^2 is P.P - 2 p.P + p.p, and both are linear in P and P.P. Measured: a product of two rows with
    these takes as long as that of one.
    """
    factors = np.zeros((1 if toward is None else 2, 4), np.float32)
    factors[0] = *(-2 * position), 1
    if toward is not None:
        factors[1, :3] = toward
    products = factors @ rows[POINT.start : POINT_SQUARED + 1]
    products[0] += np.float32(position @ position)
    if toward is None:
        return products[0], None
    products[1] -= np.float32(toward @ position)
    return products[0], products[1]


def _around_light(rows: Singles, position: Floats) -> Singles:
    """The rows with their points around the light, for a light so near that differences would cancel."""
    moved = rows.copy()
    moved[POINT] -= position.astype(np.float32)[:, None]
    keep_products(moved)
    return moved
