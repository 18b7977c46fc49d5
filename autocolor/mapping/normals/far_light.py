"""The light at normals alone: every light and the eye are far away, so that places do not matter.

Paper: reference 2, D. H. Bass, 1981, "Using the video lookup table for reflectivity calculations": the light
that is reflected is a function of the normal where light and eye are far from the object. Assumed: the
direction to a light, and to the eye, is that from the middle of the object; that of a light at infinity is
its axis. What depends on the place of a point cannot be told from its normal: concentration, cones, flaps,
half-spaces, falloff and the links to parts are left out. All else is as in the picture: strengths, links to
surfaces, reflection models, the ambient light.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from autocolor.arrays import Indices, Singles, dot
from autocolor.checks import Vector
from autocolor.lighting.far_away import ORIGIN, direction_to_eye, direction_to_light, middle_of
from autocolor.lighting.illumination import illuminate
from autocolor.lighting.picture import Picture
from autocolor.scene.columns.rows import with_values
from autocolor.scene.lights.light import Light
from autocolor.scene.scene import Scene
from autocolor.visibility.visible_parts import VisibleParts
from autocolor.visibility.visible_points import (
    NORMAL,
    REFLECTED_VIEW,
    ROW_COUNT,
    SurfaceSlice,
    VisiblePoints,
)

NOTHING: Final[Indices] = np.empty(0, np.intp)


def light_at_normals(
    scene: Scene, normals: Singles, slices: tuple[SurfaceSlice, ...], numbers: Indices, count: int
) -> Picture:
    """A picture of one line of `count` elements, in which the light of a scene falls on some normals.

    `normals` are unit vectors in camera space, (3, n) float32, by surface as `slices` tells, and `numbers`,
    (n,), their elements. All of them are at one point, the middle of the object, and each light is in its
    direction at a distance of 1: so `illuminate` computes what is reflected. A light at the middle itself
    gives nothing. Raises InputError for intensities that float32 can't hold.
    """
    middle = middle_of(scene)
    view = scene.view.replace(eye=ORIGIN, direction=tuple(scene.view.axes[2].tolist()))
    to_eye = direction_to_eye(scene).astype(np.float32)[:, None]
    rows = np.zeros((ROW_COUNT, normals.shape[1]), np.float32)
    rows[NORMAL] = normals
    rows[REFLECTED_VIEW] = 2 * dot(normals, to_eye) * normals - to_eye
    points = VisiblePoints(
        view=view,
        lines=1,
        elements=count,
        unit=1.0,
        middle=np.zeros(3),
        pixels=numbers,
        slices=slices,
        span_polygons=NOTHING,
        span_lengths=NOTHING,
        parts=VisibleParts((), NOTHING, NOTHING, NOTHING),
        rows=rows,
    )
    lights = tuple(far_light(light, middle) for light in scene.lights_in_world)
    return illuminate(with_values(scene, {"view": view, "lights": lights}), points)


def far_light(light: Light, middle: Vector) -> Light:
    """A light of the world as a point at a distance of 1 from the origin, in its direction from the middle.

    It has no controls; its strength and its links to surfaces stay.
    """
    links = with_values(light.links, {"only_parts": None, "except_parts": None})
    plain = Light(light.name, direction_to_light(light, middle))
    return with_values(plain, {"intensity": light.intensity, "on": light.on, "links": links})
