"""Lights and the eye as far away, so that a direction is the same at every point.

Assumed: the direction to a light, and to the eye, is that from the middle of the object; that of a light at
infinity is its axis. This is how they are taken where words stand for normals (see `mapping.normals`).
"""

from __future__ import annotations

from typing import Final

import numpy as np

from autocolor.arrays import Floats, Singles
from autocolor.checks import Vector
from autocolor.scene.lights.light import Light
from autocolor.scene.lights.vectors import middle_between, unit_vector
from autocolor.scene.scene import Scene
from autocolor.visibility.sight import Seen
from autocolor.visibility.visible_points import NORMAL, VisiblePoints

ORIGIN: Final = (0.0, 0.0, 0.0)


def middle_of(scene: Scene) -> Vector:
    """The middle of the object's bounds."""
    return middle_between(*scene.object_bounds)


def direction(start: Vector, end: Vector) -> Vector:
    """The unit vector from one point to another; zero where they are the same.

    >>> direction((1, 1, 1), (1, 1, 3))
    (0.0, 0.0, 1.0)
    """
    x, y, z = (b - a for a, b in zip(start, end, strict=True))
    return unit_vector((x, y, z)) if x or y or z else ORIGIN


def direction_to_eye(scene: Scene) -> Floats:
    """The unit vector to the eye, (3,), in camera space."""
    to_eye: Floats = scene.view.axes @ np.array(direction(middle_of(scene), scene.view.eye))
    return to_eye


def direction_to_light(light: Light, middle: Vector) -> Vector:
    """The unit vector to a light of the world; zero for a light in the middle of the object."""
    if light.at_infinity and light.axis is not None:
        x, y, z = light.axis
        return -x, -y, -z
    return direction(middle, light.position)


def seen_from_afar(scene: Scene, seen: Seen) -> Seen:
    """What is seen at a pixel, as if it were in the middle of the object, with the same normal."""
    middle = middle_of(scene)
    to_eye = np.array(direction(middle, scene.view.eye))
    normal = np.array(seen.normal)
    x, y, z = (2 * (normal @ to_eye) * normal - to_eye).tolist()
    return seen._replace(point=middle, reflected_view=(x, y, z))


def cosines_from_afar(scene: Scene, light: Light, points: VisiblePoints, pixels: slice) -> Singles:
    """cos(E) at some visible points, (points,) float32; -1 where the light is behind the surface."""
    to_eye = direction_to_eye(scene)
    to_light = scene.view.axes @ np.array(direction_to_light(light, middle_of(scene)))
    # L . R, for the reflected view R = 2 (N.V) N - V.
    along_eye, along_light = np.stack([to_eye, to_light]).astype(np.float32) @ points.rows[NORMAL, pixels]
    cosines: Singles = 2 * along_eye * along_light - np.float32(to_eye @ to_light)
    cosines[along_light <= 0] = -1
    return cosines
