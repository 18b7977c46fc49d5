"""Half-spaces: flaps along any planes, of which a light may have any number.

Paper: "Light Flaps and Cones" names flaps that are not parallel to the axes as an addition. Their effect is
computed in `lighting.light_controls.half_spaces`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated, ClassVar, Final, Unpack

import numpy as np

from autocolor.arrays import Floats
from autocolor.checks import Vector
from autocolor.errors import InputError
from autocolor.scene.changes import HalfSpaceChanges
from autocolor.scene.columns.column import WORLD_UNITS, Column, Row, Tier
from autocolor.scene.columns.problems import REFUSED, Problem, RowError
from autocolor.scene.columns.rows import changed
from autocolor.scene.columns.value_kinds import Number, Switch, Text, VectorKind

LEAST_TURN: Final = 1e-9
"""Assumed: the least sine of the angle between two sides of a triangle; below it, rounding would decide."""


@dataclass(frozen=True, repr=False)
class HalfSpace(Row):
    """The points on one side of a plane, outside of which a light has no effect, and a switch.

    A point of the plane is lit. With an edge width, the light goes from nothing at the plane to all of it at
    this distance inside. One that is carried by its light, as barn doors are, is told in the coordinates of
    the light (see `following.light_frame`).
    """

    noun: ClassVar[str] = "half-space"

    name: Annotated[str, Column(Text(), Tier.NOTHING, "The name of the half-space, unique for the light.")]
    point: Annotated[Vector, Column(VectorKind(), Tier.LIGHT, "A point of the plane.", WORLD_UNITS)]
    direction: Annotated[
        Vector,
        Column(
            VectorKind(has_length=True),
            Tier.LIGHT,
            "The direction from the plane to the side that is lit, of any length.",
        ),
    ]
    edge_width: Annotated[
        float,
        Column(
            Number(at_least=0),
            Tier.LIGHT,
            "How far inside the plane the light is whole; 0 for a sharp edge.",
            WORLD_UNITS,
        ),
    ] = 0.0
    carried: Annotated[
        bool, Column(Switch(), Tier.LIGHT, "Whether it moves and turns with the light, as barn doors do.")
    ] = False
    on: Annotated[bool, Column(Switch(), Tier.LIGHT, "Whether it restricts the light.")] = True

    @classmethod
    def through(
        cls,
        name: str,
        a: Sequence[float],
        b: Sequence[float],
        c: Sequence[float],
        /,
        **changes: Unpack[HalfSpaceChanges],
    ) -> HalfSpace:
        """The half-space whose plane goes through three points, (3,) each; `a` becomes its point.

        The lit side is the one from which a, b and c turn counterclockwise. `changes` are further fields.
        Raises InputError for an invalid point, and for three points in one line.

        >>> HalfSpace.through("left", (0, 0, 0), (1, 0, 0), (0, 2, 0)).direction
        (0.0, 0.0, 1.0)
        """
        points = _checked_points(name, a, b, c)
        # Scale the sides of the triangle first, so that no product over- or underflows.
        to_b, to_c = (_scaled(points[number] - points[0]) for number in (1, 2))
        across = np.cross(to_b, to_c)
        length = float(np.linalg.norm(across))
        if length <= LEAST_TURN * float(np.linalg.norm(to_b) * np.linalg.norm(to_c)):
            raise InputError(
                f"half-space {name!r}: its three points must not be in one line, not"
                f" {', '.join(str(tuple(each)) for each in points.tolist())}; move one of them"
            )
        point, direction = tuple(points[0].tolist()), tuple((across / length).tolist())
        return cls(name, point, direction).replace(**changes)

    def replace(self, /, **changes: Unpack[HalfSpaceChanges]) -> HalfSpace:
        """The half-space with some fields changed."""
        return changed(self, changes)


def _checked_points(name: str, *points: Sequence[float]) -> Floats:
    """Three points that are finite, (3, 3)."""
    kind, problems = VectorKind(), list[Problem]()
    held = [kind.held(point, (key,), problems) for key, point in zip("abc", points, strict=True)]
    if any(each is REFUSED for each in held):
        raise RowError(problems, f"half-space {name!r}")
    return np.array(held, np.float64)


def _scaled(vector: Floats) -> Floats:
    """The vector with a largest component of 1; zero stays zero."""
    scaled: Floats = vector / (float(np.abs(vector).max()) or 1.0)
    return scaled
