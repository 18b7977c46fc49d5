"""Flaps: the sides of ranges of object coordinates.

Paper: "Light Flaps and Cones".
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final, Literal

import numpy as np

from autocolor.arrays import Booleans, Floats, Singles
from autocolor.lighting.light_controls.control import ROUNDING, LightControl, registered
from autocolor.scene.lights.flaps import Flap
from autocolor.scene.lights.light import Light
from autocolor.visibility.visible_points import POINT, VisiblePoints

Axis = Literal["x", "y", "z"]
"""The object coordinate that a flap restricts."""

FlapEnd = Literal["minimum", "maximum"]
"""The fields of a flap that are coordinates."""

FAR_FLAP: Final = 1e30
"""In units; farther than any point, and float32 can hold it."""


@registered
@dataclass(frozen=True, eq=False)
class FlapSides(LightControl):
    """The sides of all flaps that are on.

    Paper: "Light Flaps and Cones": a flap is a range of an object coordinate, a box and no shadow. A point on
    a side is inside. `sides` is (sides, 4); see `is_inside`.
    """

    sides: Singles

    @classmethod
    def of(cls, light: Light, points: VisiblePoints) -> FlapSides | None:
        """The sides that are not at infinity."""
        sides = flap_sides(light, points)
        return cls(np.array(list(sides.values()), np.float32)) if sides else None

    def lit_points(self, rows: Singles, pixels: slice) -> Booleans:
        """Whether each point is inside all flaps."""
        lit = is_inside(self.sides[0], rows)
        for side in self.sides[1:]:
            np.logical_and(lit, is_inside(side, rows), out=lit)
        return lit


def flaps_of(light: Light) -> dict[Axis, Flap | None]:
    """The flap of a light along each axis, on or off; None where there is none."""
    return {"x": light.flaps.x, "y": light.flaps.y, "z": light.flaps.z}


def flap_sides(light: Light, points: VisiblePoints) -> dict[tuple[Axis, FlapEnd], Floats]:
    """The sides, (4,) each, of the flaps that are on, but for those at infinity; see `is_inside`."""
    sides: dict[tuple[Axis, FlapEnd], Floats] = {}
    # A surface that lies on a side is lit: allow for the rounding of its points to float32.
    slack = 4 * ROUNDING * points.radius
    for row, (axis, flap) in enumerate(flaps_of(light).items()):
        if flap is None or not flap.on:
            continue
        coordinate = points.world_coordinate(row)
        ends: dict[FlapEnd, tuple[float, float]] = {
            "minimum": (1.0, flap.minimum),
            "maximum": (-1.0, flap.maximum),
        }
        for end, (sign, limit) in ends.items():
            if math.isfinite(limit):
                in_units = min(max(sign * limit / points.unit, -FAR_FLAP), FAR_FLAP)
                sides[axis, end] = sign * coordinate - np.array([0, 0, 0, in_units - slack])
    return sides


def is_inside(side: Singles, rows: Singles) -> Booleans:
    """Whether each point is on the inner side of a plane: where its product with (P, 1) is at least 0."""
    inside: Booleans = side[:3] @ rows[POINT] >= -side[3]
    return inside
