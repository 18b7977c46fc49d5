"""The rays from what is seen to a light: how long they are, and the cosines between them and what is there.

Paper: Figures 1 and 3. All are products with rows of `Seen.rows`, in camera space.
"""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np

from autocolor.arrays import Floats, Numbers, Singles
from autocolor.lighting.light_controls import Controls, controls
from autocolor.scene.lights import Light
from autocolor.visibility.visible_points import POINT, POINT_SQUARED, Seen, keep_products

CLOSE: Final = 0.02
"""A point is close to a light where the square of its distance is at most this fraction of the squares that
it is the difference of: there the two are subtracted before they are squared."""

LEAST_SQUARE: Final = 1e-37
"""The least square of a distance; what is nearer to the light is taken to be as far, so that none is 0."""

FARTHEST: Final = 1e15
"""In units; the rays of a light that is farther are parallel, and float32 can hold the square of this."""


class Placed(NamedTuple):
    """A light made ready for the points of one view.

    `position` is in camera space, around the middle of the object. Points at a squared distance of at most
    `close` are close to it.
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


class Rays(NamedTuple):
    """The rays p - P from points to a light.

    `length` is that of each ray, never 0, and `cos_light` the cosine L between it and the light's direction,
    None where the light has none. `rows` are those of the points; `close` are the places of the points that
    are close to the light, and `close_rows` their rows with the light in the middle.
    """

    length: Singles
    cos_light: Singles | None
    rows: Singles
    position: Floats
    close: Numbers
    close_rows: Singles

    def cosines_with(self, vector: slice) -> Singles:
        """The cosine between each ray and the unit vector v in three of the rows, after which P.v stands."""
        factors = np.array([*self.position, -1], np.float32)
        # p.v - P.v is how far the ray goes along v.
        products: Singles = factors @ self.rows[vector.start : vector.stop + 1]
        if len(self.close):
            products[self.close] = -self.close_rows[vector.stop]
        # Measured: a quotient takes as long as a product, and an inverse twice as long.
        products /= self.length
        return products


def rays_to(light: Placed, rows: Singles) -> Rays:
    """The rays from the points in some rows of what is seen to a light."""
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
    length = np.sqrt(squares, out=squares)
    cos_light = None if ahead is None else np.divide(ahead, length, out=ahead)
    return Rays(length, cos_light, rows, light.position, close, close_rows)


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
