"""Flaps: the sides of ranges of object coordinates.

Paper: "Light Flaps and Cones".
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

from autocolor.lighting.light_controls.control import registered
from autocolor.lighting.light_controls.sides import Side, Sides, side_of
from autocolor.scene.lights.flaps import Flap
from autocolor.scene.lights.light import Light
from autocolor.visibility.visible_points import VisiblePoints

Axis = Literal["x", "y", "z"]
"""The object coordinate that a flap restricts."""

FlapEnd = Literal["minimum", "maximum"]
"""The fields of a flap that are coordinates."""


@registered
@dataclass(frozen=True, eq=False)
class FlapSides(Sides):
    """The sides of all flaps that are on.

    Paper: "Light Flaps and Cones": a flap is a range of an object coordinate, a box and no shadow. A point on
    a side is inside. What is left near soft ends is computed in `soft_sides`.
    """

    @classmethod
    def of(cls, light: Light, points: VisiblePoints) -> FlapSides | None:
        """The sides that are not at infinity."""
        sides = flap_sides(light, points)
        return cls.made_of(list(sides.values())) if sides else None


def flaps_of(light: Light) -> dict[Axis, Flap | None]:
    """The flap of a light along each axis, on or off; None where there is none."""
    return {"x": light.flaps.x, "y": light.flaps.y, "z": light.flaps.z}


def flap_sides(light: Light, points: VisiblePoints) -> dict[tuple[Axis, FlapEnd], Side]:
    """The sides of the flaps that are on, but for those at infinity."""
    sides: dict[tuple[Axis, FlapEnd], Side] = {}
    for row, (axis, flap) in enumerate(flaps_of(light).items()):
        if flap is None or not flap.on:
            continue
        ends: dict[FlapEnd, tuple[float, float]] = {
            "minimum": (1.0, flap.minimum),
            "maximum": (-1.0, flap.maximum),
        }
        for end, (sign, limit) in ends.items():
            if math.isfinite(limit):
                x, y, z = (sign if number == row else 0.0 for number in range(3))
                sides[axis, end] = side_of(points, (x, y, z), sign * limit, flap.edge_width)
    return sides
