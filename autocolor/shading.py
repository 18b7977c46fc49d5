"""One light on what is seen: its diffuse and its specular plane, without D, S and the light's intensity.

Paper: "The Lighting Model" and "Light Controls". The sum over the lights with their strengths is made in
`lighting`; here is what takes the time, and what stays when only strengths change.

Measured and rejected: one surface after another (a tenth longer on the coupe, whose smaller surfaces are
hardly worth the calls); fewer pixels at once than 131,072 (a tenth more at a quarter of that); two threads,
each on half of the pixels (as long as one: what they compute they must fetch from memory, and between any two
calls they wait for the interpreter); two processes (two thirds of the time of one, for a second copy of
everything); the cosines of all lights as one matrix product (a twentieth less).
"""

from __future__ import annotations

from collections.abc import Mapping
from itertools import pairwise
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from autocolor.light_controls import Controls, concentrated, controls, inside_cone, inside_flaps
from autocolor.light_planes import DIFFUSE, SPECULAR
from autocolor.lights import Light
from autocolor.reflection import phong_diffuse, phong_specular
from autocolor.seen import (
    MIRROR,
    NORMAL,
    POINT,
    POINT_SQUARED,
    Seen,
    Share,
    keep_products,
)

CLOSE = 0.02
"""Below this squared distance, as a fraction of the squares it is the difference of, subtract the points."""

LEAST_SQUARE = 1e-37
"""Of a ray, in units; what is nearer to the light is taken to be as far, so that no length is 0."""

FARTHEST = 1e15
"""In units; the rays of a light that is farther are parallel, and float32 can hold the square of this."""

FEW = 0.3
"""Below this fraction of lit pixels it takes less time to pick them than to compute them all."""

Singles = npt.NDArray[np.float32]
Floats = npt.NDArray[np.float64]
Numbers = npt.NDArray[np.intp]


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


def shade(planes: Singles, light: Placed, seen: Seen, share: Share, exponents: Mapping[int, float]) -> None:
    """Fill the diffuse and the specular plane of a light where the pixels of a share are.

    `planes` is (2, n) float32, in the order of `Seen.pixels`; they become 0 where the light has no effect.
    `exponents` has N for each surface number that is seen.
    """
    out, rows = planes[:, share.pixels], seen.rows[:, share.pixels]
    lit = inside_flaps(light.controls, rows)
    if lit is not None and not lit.any():
        out[:] = 0
        return
    rays = _rays(rows, light)
    # Divide by the length each time: that takes as long as a product, and an inverse twice as long.
    length = np.sqrt(rays.squares, out=rays.squares)

    # Find what faces the light and is within its controls.
    cos_incidence = rays.along(NORMAL)
    cos_incidence /= length
    facing = cos_incidence > 0
    lit = facing if lit is None else np.logical_and(lit, facing, out=lit)
    cos_light = None
    if rays.ahead is not None:
        cos_light = np.divide(rays.ahead, length, out=rays.ahead)
        lit &= inside_cone(light.controls, cos_light)
    lit_count = np.count_nonzero(lit)
    if not lit_count:
        out[:] = 0
        return

    # Of few pixels take those alone.
    chosen = np.flatnonzero(lit) if lit_count < FEW * len(lit) else None
    ends = [each.stop for each in share.slices]
    lit_out = out
    if chosen is not None:
        ends = np.searchsorted(chosen, ends).tolist()
        cos_incidence = cos_incidence.take(chosen)
        cos_light = None if cos_light is None else cos_light.take(chosen)
        lit_out = np.empty((2, lit_count), np.float32)

    # Reflect it to the eye, and take of both terms what the controls leave.
    if cos_light is not None and light.controls.concentration > 0:
        multiplier = concentrated(cos_light, light.controls.concentration)
    else:
        multiplier = np.ones(len(cos_incidence), np.float32)
    if chosen is None and lit_count < len(lit):
        multiplier *= lit.astype(np.float32)
    np.multiply(phong_diffuse(cos_incidence), multiplier, out=lit_out[DIFFUSE])
    cos_eye = rays.along(MIRROR)
    cos_eye /= length
    if chosen is not None:
        cos_eye = cos_eye.take(chosen)
    for each, (start, end) in zip(share.slices, pairwise([0, *ends]), strict=True):
        specular = phong_specular(cos_eye[start:end], exponents[each.surface_number])
        np.multiply(specular, multiplier[start:end], out=lit_out[SPECULAR, start:end])
    if chosen is not None:
        out[:] = 0
        for plane, values in zip(out, lit_out, strict=True):
            plane[chosen] = values


class _Rays(NamedTuple):
    """The rays p - P from points to a light, of any length.

    `squares` are those of the rays, never 0; `ahead` is how far each point is ahead in the light's direction,
    None where the light has none. `rows` are those of the points; `close` are the places of points so near
    to the light that differences would cancel, and `close_rows` their rows with the light in the middle.
    """

    squares: Singles
    ahead: Singles | None
    rows: Singles
    position: Floats
    close: Numbers
    close_rows: Singles

    def along(self, vector: slice) -> Singles:
        """The product of each ray with the vector in three of the rows, after which its product with P is."""
        factors = np.array([*self.position, -1], np.float32)
        products: Singles = factors @ self.rows[vector.start : vector.stop + 1]
        if len(self.close):
            products[self.close] = -self.close_rows[vector.stop]
        return products


def _rays(rows: Singles, light: Placed) -> _Rays:
    """The rays from the points in some rows to a light."""
    toward = light.controls.toward
    squares, ahead = _squares_and_ahead(rows, light.position, toward)
    close, close_rows = np.empty(0, np.intp), rows[:, :0]
    if squares.min() <= light.close:
        close = np.flatnonzero(squares <= light.close)
        close_rows = rows.take(close, axis=1)
        close_rows[POINT] -= light.position.astype(np.float32)[:, None]
        keep_products(close_rows)
        close_squares, close_ahead = _squares_and_ahead(close_rows, np.zeros(3), toward)
        squares[close] = np.maximum(close_squares, np.float32(LEAST_SQUARE))
        if ahead is not None:
            ahead[close] = close_ahead
    return _Rays(squares, ahead, rows, light.position, close, close_rows)


def _squares_and_ahead(
    rows: Singles, position: Floats, toward: Floats | None
) -> tuple[Singles, Singles | None]:
    """The square of each ray, and how far its point is ahead in the light's direction.

    (p - P)^2 is P.P - 2 p.P + p.p, and both are linear in P and P.P. Measured: a product of two rows with
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
