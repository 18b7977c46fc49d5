"""The rays from the visible points to a light: lengths, and cosines with normal and reflected view.

Paper: Figures 1 and 3. Lengths and cosines are products with `VisiblePoints.rows`, in camera space. The last
functions are for light and eye far away, as words that stand for normals assume them: then a direction is the
same at every point.
"""

from __future__ import annotations

import math
from typing import Final, NamedTuple

import numpy as np

from autocolor.arrays import ROUNDING, Floats, Indices, Singles, columns, dot, half_logarithms, unit_vector
from autocolor.checks import Vector
from autocolor.scene.lights import Light, middle_between
from autocolor.scene.scene import Scene
from autocolor.visibility.visible_points import POINT, POINT_SQUARED, VisiblePoints, fill_point_products

CLOSE: Final = 0.02
"""A point is close to a light if its squared distance is at most this fraction of the squares of the two
positions. At close points the positions are subtracted before they are squared."""

LEAST_ROUNDING: Final = 2.2
CANCELLATION: Final = 0.33
"""Measured on balls and walls, from near and far: cos(L) is off by at most the larger of the two, in units in
the last place of 1. The second is multiplied by the square of the lengths that are subtracted, which are the
light's and the point's distances from the origin, over the square of the ray."""

LEAST_SQUARE: Final = 1e-37
"""The least squared distance of a point from a light, so that no distance is 0."""

FARTHEST: Final = 1e15
"""The largest distance of a light, in units: its rays are parallel, and float32 can hold its square."""

GRAZING: Final = np.float32(5e-7)
"""A cosine above its rounding. Parallel rays often run along a flat surface, which they do not light."""


class CameraLight(NamedTuple):
    """A light in camera space, ready for the visible points of one view.

    `position` is relative to the origin of the points. Points at a squared distance of at most `close` are
    close to the light. `direction` is a unit vector, or None if no light control uses cos(L). A light at
    infinity is at FARTHEST against its direction. `distance` is that of the light from the origin, and no
    point is farther from the origin than `radius`.
    """

    position: Floats
    close: float
    direction: Floats | None
    is_at_infinity: bool = False
    distance: float = FARTHEST
    radius: float = 0.0


def camera_light(light: Light, points: VisiblePoints, directed: bool) -> CameraLight:
    """A light in the camera space of some visible points, with its direction if it is `directed`."""
    if light.at_infinity:
        assert light.axis is not None
        direction = points.camera_direction(light.axis)
        return CameraLight(-FARTHEST * direction, 0.0, direction if directed else None, True)
    position = points.camera_point(light.position)
    position *= min(FARTHEST / max(float(np.abs(position).max()), 1.0), 1.0)
    square = float(position @ position)
    close = CLOSE * max(square, points.radius**2)
    ahead = points.camera_direction(light.axis) if directed and light.axis is not None else None
    return CameraLight(position, close, ahead, False, math.sqrt(square), points.radius)


class Rays(NamedTuple):
    """The rays p - P from points to a light.

    `length` is never 0. `cos_light` is the cosine of L, between the light's direction and the ray from the
    light to the point, or None for a light without a direction. `rows` are the rows of the points. `close`
    are the places of the points close to the light, and `close_rows` their rows around the light. Cosines of
    L are off by at most `rounding`.
    """

    length: Singles
    cos_light: Singles | None
    rows: Singles
    position: Floats
    close: Indices
    close_rows: Singles
    direction: Floats | None
    rounding: float
    are_parallel: bool = False

    def from_light(self, places: Indices) -> Singles:
        """The vectors from the light to some points, (3, places) float32, as exact as the points."""
        position = self.position.astype(np.float32)
        # Near the light the difference is exact: both numbers are close to each other.
        vectors: Singles = columns(self.rows[POINT], places)
        vectors -= position[:, None]
        vectors -= (self.position - position).astype(np.float32)[:, None]
        return vectors

    def cos_light_logarithms(self, places: Indices) -> Singles:
        """log(cos(L)) of some points near the light's direction, (places,) float32.

        Measured and rejected: two more rows of the matrix product, for the distances of all points from the
        light's axis. Every light takes a third longer.
        """
        assert self.direction is not None
        direction, across = self.direction.astype(np.float32), self.from_light(places)
        across -= direction[:, None] * (direction @ across)
        squares = dot(across, across)
        length = self.length.take(places)
        squares /= length
        squares /= length
        return half_logarithms(squares)

    def exact_cos_light(self, places: Indices) -> Floats:
        """cos(L) of some points, (places,) float64."""
        assert self.direction is not None
        from_light = columns(self.rows[POINT], places) - self.position[:, None]
        cosines: Floats = self.direction @ from_light
        cosines /= np.sqrt(np.maximum(dot(from_light, from_light), LEAST_SQUARE))
        return cosines

    def cosines_with(self, vector: slice) -> Singles:
        """The cosine between each ray and the unit vector v in three of the rows; the next row has P.v."""
        factors = np.array([*self.position, -1], np.float32)
        # p.v - P.v is the component of the ray along v.
        products: Singles = factors @ self.rows[vector.start : vector.stop + 1]
        if len(self.close):
            products[self.close] = -self.close_rows[vector.stop]
        # Measured: a quotient takes as long as a product, and an inverse twice as long.
        products /= self.length
        if self.are_parallel:
            products[np.abs(products) <= GRAZING] = 0
        return products


def rays_to(light: CameraLight, rows: Singles) -> Rays:
    """The rays to a light from the points in some rows.

    Departs: the rays to a light at infinity are parallel; the paper has no such light. They have the same
    length, and cos(L) is 1 everywhere, so that concentration and cones leave all of the light.
    """
    direction = light.direction
    close, close_rows = np.empty(0, np.intp), rows[:, :0]
    if light.is_at_infinity:
        length = np.full(rows.shape[1], FARTHEST, np.float32)
        cos_light = None if direction is None else np.ones_like(length)
        rounding = ROUNDING * LEAST_ROUNDING
        return Rays(
            length, cos_light, rows, light.position, close, close_rows, direction, rounding, are_parallel=True
        )
    squares, ahead = _squares_and_ahead(rows, light.position, direction)
    least = float(squares.min())
    if least <= light.close:
        close = np.flatnonzero(squares <= light.close)
        close_rows = rows.take(close, axis=1)
        close_rows[POINT] -= light.position.astype(np.float32)[:, None]
        fill_point_products(close_rows)
        close_squares, close_ahead = _squares_and_ahead(close_rows, np.zeros(3), direction)
        squares[close] = np.maximum(close_squares, np.float32(LEAST_SQUARE))
        if ahead is not None:
            ahead[close] = close_ahead
    length = np.sqrt(squares, out=squares)
    cos_light = None if ahead is None else np.divide(ahead, length, out=ahead)
    # The nearest point is at most as far from the origin as the light and the ray together.
    shortest = math.sqrt(max(least, light.close, LEAST_SQUARE))
    size = light.distance + min(light.radius, light.distance + shortest)
    rounding = ROUNDING * max(LEAST_ROUNDING, CANCELLATION * (size / shortest) ** 2)
    return Rays(length, cos_light, rows, light.position, close, close_rows, direction, rounding)


def _squares_and_ahead(
    rows: Singles, position: Floats, direction: Floats | None
) -> tuple[Singles, Singles | None]:
    """The square of each ray, and how far its point is ahead of the light, along the light's direction.

    (p - P)^2 is P.P - 2 p.P + p.p, and both are linear in P and P.P. Measured: a product of two rows with
    these takes as long as a product of one row.
    """
    factors = np.zeros((1 if direction is None else 2, 4), np.float32)
    factors[0] = *(-2 * position), 1
    if direction is not None:
        factors[1, :3] = direction
    products = factors @ rows[POINT.start : POINT_SQUARED + 1]
    products[0] += np.float32(position @ position)
    if direction is None:
        return products[0], None
    products[1] -= np.float32(direction @ position)
    return products[0], products[1]


def middle_of(scene: Scene) -> Vector:
    """The middle of the object's bounds: directions to lights and eye far away start there."""
    return middle_between(*scene.object_bounds)


def direction_between(start: Vector, end: Vector) -> Vector:
    """The unit vector from one point to another; zero if they are the same.

    >>> direction_between((1, 1, 1), (1, 1, 3))
    (0.0, 0.0, 1.0)
    """
    x, y, z = (b - a for a, b in zip(start, end, strict=True))
    return unit_vector((x, y, z)) if x or y or z else (0.0, 0.0, 0.0)


def direction_to_eye(scene: Scene) -> Floats:
    """The unit vector from the middle of the object to the eye, (3,), in camera space."""
    to_eye: Floats = scene.view.axes @ np.array(direction_between(middle_of(scene), scene.view.eye))
    return to_eye


def direction_to_light(light: Light, middle: Vector) -> Vector:
    """The unit vector to a light of the world; zero for a light in the middle of the object."""
    if light.at_infinity and light.axis is not None:
        x, y, z = light.axis
        return -x, -y, -z
    return direction_between(middle, light.position)
