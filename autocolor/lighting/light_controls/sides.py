"""Sides of planes, which flaps and half-spaces share."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final, NamedTuple, Self

import numpy as np

from autocolor.arrays import Booleans, Floats, Singles
from autocolor.checks import Vector
from autocolor.lighting.light_controls.control import ROUNDING, LightControl
from autocolor.visibility.visible_points import POINT, VisiblePoints

FARTHEST_PLANE: Final = 1e30
"""In units; farther than any point, and float32 can hold it."""


class Side(NamedTuple):
    """The side of a plane that is lit: where the product of `row`, (4,), with (P, 1) is at least 0.

    The product is the distance from the plane, and the light is whole at the distance `edge_width`; both are
    in `VisiblePoints.unit`. An edge of the width 0 is sharp.
    """

    row: Floats
    edge_width: float


def side_of(points: VisiblePoints, direction: Vector, least: float, edge_width: float) -> Side:
    """The points of the world whose product with a unit vector, their `direction`, is at least `least`.

    `edge_width` is in units of the world.
    """
    coordinates = np.array([points.world_coordinate(axis) for axis in range(3)])
    in_units = min(max(least / points.unit, -FARTHEST_PLANE), FARTHEST_PLANE)
    # A surface that lies on a sharp side is lit: allow for the rounding of its points to float32.
    slack = 0.0 if edge_width > 0 else 4 * ROUNDING * points.radius
    row = np.array(direction) @ coordinates - np.array([0, 0, 0, in_units - slack])
    return Side(row, edge_width / points.unit)


def is_inside(side: Side, rows: Singles) -> Booleans:
    """Whether each point is on the inner side of a plane, or on the plane itself."""
    return _is_inside(side.row.astype(np.float32), rows)


@dataclass(frozen=True, eq=False)
class Sides(LightControl):
    """A control that leaves nothing beyond some planes; `sides` is (sides, 4), see `Side.row`."""

    sides: Singles

    @classmethod
    def made_of(cls, sides: Sequence[Side]) -> Self:
        """The control of one or several sides."""
        return cls(np.array([side.row for side in sides], np.float32))

    def lit_points(self, rows: Singles, pixels: slice) -> Booleans:
        """Whether each point is inside all planes."""
        lit = _is_inside(self.sides[0], rows)
        for side in self.sides[1:]:
            np.logical_and(lit, _is_inside(side, rows), out=lit)
        return lit


def _is_inside(row: Singles, rows: Singles) -> Booleans:
    inside: Booleans = row[:3] @ rows[POINT] >= -row[3]
    return inside
