"""Arrangements of lights, as in a photographer's studio: softbox, rim, overcast and others.

An arrangement replaces the lights and the ambient light of a scene. Its lights are placed by the bounds of
the object, the eye and the world's up, so that it suits any mesh, with a stage or without.

Assumed: all values of this module, chosen by eye on the coupe and on foreign meshes of one color. Few lights
are strong, because highlights stand apart and the light on a floor adds up: with more lights, the floor is
brighter than the highlights, and the colors of the object are pale. Lights behind the object are kept off the
floor by a flap. There a floor would be the brightest thing, and the painted pool of a stage, whose normals
lean away from the eye, a bright ring.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Final, NamedTuple

from autocolor.arrays import Floats
from autocolor.checks import Vector
from autocolor.scene.defaults import object_bounds, sphere_around, studio_axes
from autocolor.scene.lights import Flap, Light
from autocolor.scene.scene import Scene

OFF_FLOOR: Final = 0.02
"""How far above the lowest point of the object the light of a flap begins, in radii of the object."""


class Lamp(NamedTuple):
    """A light aimed at the middle of the object.

    Its place is in radii of the sphere around the object, from its middle to the right, up, and to the eye.
    """

    name: str
    right: float
    up: float
    near: float
    intensity: float
    concentration: float = 0.0
    lights_floor: bool = True
    """Whether it shines on the floor, too."""


class Arrangement(NamedTuple):
    """The ambient light and the lights of an arrangement, and how they look."""

    help: str
    ambient: float
    lamps: Sequence[Lamp]


ARRANGEMENTS: Final[Mapping[str, Arrangement]] = {
    # Four lights side by side give one broad highlight.
    "softbox": Arrangement(
        "One large soft light at the left, and a fill light",
        0.09,
        (
            Lamp("soft 1", -2.75, 2.65, 3.2, 0.27, 6.0),
            Lamp("soft 2", -2.05, 2.65, 3.2, 0.27, 6.0),
            Lamp("soft 3", -2.75, 3.35, 3.2, 0.27, 6.0),
            Lamp("soft 4", -2.05, 3.35, 3.2, 0.27, 6.0),
            Lamp("fill", 3.4, 0.9, 2.2, 0.4, 4.0),
            Lamp("back", 1.0, 1.7, -3.2, 0.6, 10.0, lights_floor=False),
        ),
    ),
    "rim": Arrangement(
        "Two lights behind the object draw its edges",
        0.03,
        (
            Lamp("left", -2.4, 1.5, -3.2, 1.0, 10.0, lights_floor=False),
            Lamp("right", 2.4, 1.5, -3.2, 1.0, 10.0, lights_floor=False),
            Lamp("fill", -1.4, 2.0, 3.8, 0.3, 10.0),
        ),
    ),
    "overcast": Arrangement(
        "Even light from the sky, and a bright horizon",
        0.25,
        (
            Lamp("sky", 0.0, 5.0, 0.6, 0.5),
            Lamp("horizon", -1.2, 1.8, -4.2, 0.6, 3.0, lights_floor=False),
            Lamp("front", 0.8, 2.0, 4.2, 0.3, 1.0),
        ),
    ),
    "showroom": Arrangement(
        "Two rows of lights overhead, and a lit floor",
        0.09,
        (
            Lamp("front left", -1.6, 3.2, 1.4, 0.38, 1.0),
            Lamp("front right", 1.6, 3.2, 1.4, 0.38, 1.0),
            Lamp("back left", -1.6, 2.0, -3.0, 0.55, 6.0, lights_floor=False),
            Lamp("back right", 1.6, 2.0, -3.0, 0.55, 6.0, lights_floor=False),
            Lamp("window", 0.5, 0.8, 4.5, 0.3, 6.0),
        ),
    ),
    "night": Arrangement(
        "One narrow light at the left, and an edge at the right",
        0.015,
        (
            Lamp("street", -2.6, 2.2, 0.4, 1.0, 14.0),
            Lamp("edge", 2.6, 0.9, -2.6, 0.8, 12.0, lights_floor=False),
        ),
    ),
    "three-point": Arrangement(
        "The portrait's key, fill and back light",
        0.06,
        (
            Lamp("key", -2.6, 2.8, 3.0, 0.95, 7.0),
            Lamp("fill", 3.4, 0.8, 2.2, 0.35, 4.0),
            Lamp("back", 1.2, 1.6, -3.2, 0.9, 10.0, lights_floor=False),
        ),
    ),
}
"""Each arrangement by its name."""


def arranged(scene: Scene, name: str) -> Scene:
    """The scene in the light of an arrangement."""
    low, high = object_bounds(scene.mesh, scene.parts)
    center, radius = sphere_around(low, high)
    right, up, away = studio_axes(scene.view)
    digits = 2 - math.floor(math.log10(radius))

    def light(lamp: Lamp) -> Light:
        place = center + radius * (lamp.right * right + lamp.up * up - lamp.near * away)
        row = Light(lamp.name, rounded(place), lamp.intensity, aim=rounded(center))
        flap = None if lamp.lights_floor else Flap(minimum=round(float(low[2]) + OFF_FLOOR * radius, digits))
        return row.replace(concentration=lamp.concentration, flaps={"z": flap})

    def rounded(point: Floats) -> Vector:
        """A point with as many digits as are seen at the size of the object."""
        x, y, z = (round(each, digits) for each in point.tolist())
        return x, y, z

    arrangement = ARRANGEMENTS[name]
    return scene.replace(lights=[light(lamp) for lamp in arrangement.lamps], ambient=arrangement.ambient)
