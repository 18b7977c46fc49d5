"""A light that is added to a scene without its place being given."""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from autocolor.scene.defaults import object_bounds, sphere_around, studio_axes
from autocolor.scene.lights.light import Light
from autocolor.scene.lights.light_copies import free_name
from autocolor.scene.scene import Scene

DISTANCE: Final = 4.0
"""Assumed: from the middle of the object, in radii of the sphere around it, as far as the studio lights."""

ELEVATION: Final = 40.0
"""Assumed: degrees above the level of the middle, so that the light is seen to fall from above."""

TURNS: Final = (0, 35, -35, 70, -70, 105, -105, 140, -140, 180)
"""Assumed: degrees around the object, from the side of the eye; the first place without a light is taken."""

NAME: Final = "light"


def new_light_of(scene: Scene) -> Light:
    """A light to add to a scene: above the side of the eye, and aimed at the middle of the object.

    Its name is free, and so is its place: no other light is closer to it than the radius of the object,
    unless there are lights all around.
    """
    center, radius = sphere_around(*object_bounds(scene.mesh, scene.parts))
    right, up, away = studio_axes(scene.view)
    elevation = math.radians(ELEVATION)
    places = []
    for turn in map(math.radians, TURNS):
        outward = math.sin(turn) * right - math.cos(turn) * away
        toward = math.cos(elevation) * outward + math.sin(elevation) * up
        places.append(center + DISTANCE * radius * toward)
    taken = [np.array(light.position) for light in scene.lights_in_world]
    free = [place for place in places if all(math.dist(place, other) >= radius for other in taken)]
    return Light(
        free_name(NAME, [light.name for light in scene.lights]),
        tuple((free or places)[0].tolist()),
        aim=tuple(center.tolist()),
    )
