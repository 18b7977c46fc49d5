"""The rays from the visible points to a light, fast: each cosine of many points is one matrix product.

Paper: Figures 1 and 3. `light.rays_to` has the same by the definitions, in a third to a fifth of the speed.
The last functions are for light and eye far away, as words that stand for normals assume them: then a
direction is the same at every point.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from autocolor.arrays import ROUNDING, Floats, Singles, columns, unit_vector
from autocolor.checks import Vector
from autocolor.lighting.controls import FARTHEST, reach_of, sides_of
from autocolor.lighting.light import GRAZING, LEAST_DISTANCE, CameraLight, Rays, rays_to
from autocolor.scene.lights import Light, middle_between
from autocolor.scene.scene import Scene
from autocolor.visibility.visible_points import NORMAL, POINT, POINT_SQUARED, REFLECTED_VIEW, VisiblePoints

CLOSE: Final = 0.02
"""A point is close to a light if its squared distance is at most this fraction of the squares of the two
positions. The rays of close points are computed by the definitions."""

LEAST_ROUNDING: Final = 2.2
CANCELLATION: Final = 0.33
"""Measured on balls and walls, from near and far: cos(L) is off by at most the larger of the two, in units in
the last place of 1. The second is multiplied by the square of the lengths that are subtracted, which are the
light's and the point's distances from the origin, over the square of the ray."""


def camera_light(light: Light, points: VisiblePoints) -> CameraLight:
    """A light of the world ready for some visible points."""
    axis = None if light.axis is None else points.camera_direction(light.axis)
    if light.at_infinity:
        assert axis is not None
        position = -FARTHEST * axis
    else:
        position = points.camera_point(light.position)
        position *= min(FARTHEST / max(float(np.abs(position).max()), 1.0), 1.0)
    if light.concentration == 0 and light.cone_angle is None:
        axis = None
    return CameraLight(
        light, position, axis, tuple(sides_of(light, points).values()), reach_of(light, points)
    )


def fast_rays(light: CameraLight, rows: Singles, radius: float) -> tuple[Rays, float]:
    """The rays from the points in some rows to a light, float32, and how far cos(L) may be off by rounding.

    No point is farther from the origin than `radius`. With p the light, (p - P)^2 = P.P - 2 p.P + p.p, and
    (p - P).v = p.v - P.v for each vector v with its product in the next row. Measured: a quotient takes as
    long as a product, and an inverse twice as long.
    """
    position, square = light.position, float(light.position @ light.position)
    along = np.array([*position, -1], np.float32)
    incidence, eye = (along @ rows[vector.start : vector.stop + 1] for vector in (NORMAL, REFLECTED_VIEW))
    if light.row.at_infinity:
        for cosines in (incidence, eye):
            cosines /= np.float32(FARTHEST)
            cosines[np.abs(cosines) <= GRAZING] = 0
        length = np.full(rows.shape[1], FARTHEST, np.float32)
        ahead = None if light.axis is None else np.ones_like(length)
        return Rays(length, incidence, eye, ahead, rows), 0.0

    factors = np.zeros((1 if light.axis is None else 2, 4), np.float32)
    factors[0] = *(-2 * position), 1
    if light.axis is not None:
        factors[1, :3] = light.axis
    # Measured: a product of two rows takes as long as a product of one row.
    products = factors @ rows[POINT.start : POINT_SQUARED + 1]
    squares, ahead = products[0], None if light.axis is None else products[1]
    squares += np.float32(square)
    close, least = CLOSE * max(square, radius**2), float(squares.min())
    places = np.flatnonzero(squares <= close) if least <= close else np.empty(0, np.intp)
    squares[places] = 1
    length = np.sqrt(squares, out=squares)
    incidence /= length
    eye /= length
    if ahead is not None and light.axis is not None:
        ahead -= np.float32(light.axis @ position)
        ahead /= length
    rays = Rays(length, incidence, eye, ahead, rows)
    if len(places):
        exact = rays_to(light, columns(rows, places))
        length[places], incidence[places], eye[places] = exact.length, exact.cos_incidence, exact.cos_eye
        if ahead is not None and exact.cos_light is not None:
            ahead[places] = exact.cos_light
    # The nearest point is at most as far from the origin as the light and the ray together.
    distance, shortest = math.sqrt(square), math.sqrt(max(least, close, LEAST_DISTANCE**2))
    size = distance + min(radius, distance + shortest)
    return rays, ROUNDING * max(LEAST_ROUNDING, CANCELLATION * (size / shortest) ** 2)


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
