"""Rigs: the lights of a scene with the size of its object, to light another one in the same way.

Assumed: lights keep their directions and their places relative to the object. They are moved with the middle
of its box, and are nearer or farther as the diagonal of the box is shorter or longer; those that follow
something, from what they follow. Widths and reaches are scaled with it. Their intensities stay, as the light
at a point does not depend on its distance.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Annotated, ClassVar

from autocolor.checks import Vector
from autocolor.scene.columns import REFUSED, WORLD_UNITS, Column, Problem, Row, Tier
from autocolor.scene.following import AXES
from autocolor.scene.kinds import VectorKind
from autocolor.scene.lights import Flaps, HalfSpace, Light, middle_between
from autocolor.scene.row_kinds import RowList


@dataclass(frozen=True, repr=False)
class Rig(Row):
    """The lights of a scene, and the least and the largest coordinates of the object that they light."""

    noun: ClassVar[str] = "rig"

    minimum: Annotated[
        Vector, Column(VectorKind(), Tier.LIGHT, "The smallest coordinates of the object.", WORLD_UNITS)
    ]
    maximum: Annotated[
        Vector, Column(VectorKind(), Tier.LIGHT, "The largest coordinates of the object.", WORLD_UNITS)
    ]
    lights: Annotated[tuple[Light, ...], Column(RowList(Light), Tier.MIX, "The lights.")] = ()

    def rules(self) -> Iterator[Problem]:
        """No coordinate of the minimum is above that of the maximum."""
        if self.minimum is not REFUSED and self.maximum is not REFUSED:
            for axis, low, high in zip(AXES, self.minimum, self.maximum, strict=True):
                if low > high:
                    ends = f"{low:g} to {high:g}"
                    yield Problem(
                        (), f"the minimum of {axis} must not be above the maximum, not {ends}; exchange them"
                    )

    def fitted(self, minimum: Vector, maximum: Vector) -> tuple[Light, ...]:
        """The lights as they light an object with other least and largest coordinates.

        For the same object they are the same lights, exactly. An object that is a point has no size: then
        distances stay. Raises InputError if a coordinate would be too large, or a light and its aim too close
        to each other.
        """
        if (minimum, maximum) == (self.minimum, self.maximum):
            return self.lights
        before, after = math.dist(self.minimum, self.maximum), math.dist(minimum, maximum)
        scale = after / before if before > 0 and after > 0 else 1.0
        old = middle_between(self.minimum, self.maximum)
        new = middle_between(minimum, maximum)
        return tuple(_moved(light, scale, old, new) for light in self.lights)


def _moved(light: Light, scale: float, old: Vector, new: Vector) -> Light:
    """The light with each coordinate scaled about one point and moved with it to another.

    The places of a light that follows something are scaled from there.
    """

    def point(coordinates: Vector) -> list[float]:
        return [coordinate(number, value) for number, value in enumerate(coordinates)]

    def coordinate(axis: int, value: float) -> float:
        return new[axis] + scale * (value - old[axis])

    def place(coordinates: Vector) -> list[float]:
        return point(coordinates) if light.follows is None else [scale * each for each in coordinates]

    def half_space(row: HalfSpace) -> HalfSpace:
        moved = [scale * value for value in row.point] if row.carried else point(row.point)
        return row.replace(point=moved, edge_width=scale * row.edge_width)

    flaps = {
        axis: flap.replace(
            minimum=coordinate(number, flap.minimum),
            maximum=coordinate(number, flap.maximum),
            edge_width=scale * flap.edge_width,
        )
        for number, axis in enumerate(AXES)
        if (flap := getattr(light.flaps, axis)) is not None
    }
    return light.replace(
        position=place(light.position),
        direction=light.direction,
        aim=None if light.aim is None else place(light.aim),
        flaps=Flaps(**flaps),
        half_spaces=[half_space(row) for row in light.half_spaces],
        reach=None if light.reach is None else scale * light.reach,
    )
