"""The points of a scene that the three views show when they are scaled to all of it."""

from __future__ import annotations

import numpy as np

from autocolor.arrays import Floats
from autocolor.scene.defaults import object_bounds
from autocolor.scene.scene import Scene
from autocolor.screens.picture.orbit import target_of


def shown_points(scene: Scene) -> Floats:
    """The ends of the object's bounding box, the eye and its target, and the lights and aims, (n, 3).

    Lights that are switched off are among them. A stage, such as a floor, is not: it would make the object
    small, and is drawn as far as it is in the views.
    """
    points = [*object_bounds(scene.mesh, scene.parts), np.array(scene.view.eye), target_of(scene)]
    for light in scene.lights_in_world:
        points.append(np.array(light.position))
        if light.aim is not None:
            points.append(np.array(light.aim))
    return np.array(points)
