"""The view: eye position, view direction, rotation of the picture plane, and field of view; named views.

Paper: "Light Direction and Concentration", Figure 5 (eye, view direction, RESCALE, ANGLE).
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Annotated, ClassVar, Final, Unpack

import numpy as np

from autocolor.arrays import Floats
from autocolor.checks import Vector
from autocolor.immutable import read_only
from autocolor.scene.changes import NamedViewChanges, ViewChanges
from autocolor.scene.columns import WORLD_UNITS, BarRange, Column, Problem, Row, Tier, replaced
from autocolor.scene.kinds import Number, Text, VectorKind
from autocolor.scene.row_kinds import Nested

MOST_VIEWS: Final = 64
"""Limit: named views of a scene."""

ASPECT: Final = 640 / 480
"""Assumed: the width over the height of the paper's display."""


@dataclass(frozen=True, repr=False)
class View(Row):
    """An eye position, and a view direction or a target. The world's z axis points up."""

    noun: ClassVar[str] = "view"
    alternatives: ClassVar[tuple[tuple[str, ...], ...]] = (("direction",), ("target",))

    eye: Annotated[Vector, Column(VectorKind(), Tier.FRAME, "The position of the eye.", WORLD_UNITS)]
    direction: Annotated[
        Vector | None,
        Column(
            VectorKind(has_length=True), Tier.FRAME, "The view direction, of any length; excludes a target."
        ),
    ] = None
    target: Annotated[
        Vector | None,
        Column(
            VectorKind(), Tier.FRAME, "The point that the eye looks at; excludes a direction.", WORLD_UNITS
        ),
    ] = None
    angle: Annotated[
        float,
        Column(
            Number(),
            Tier.FRAME,
            "The rotation of the horizontal axis of the picture plane.",
            "degrees",
            bar=BarRange(-180, 180, 1),
        ),
    ] = 0.0
    field_of_view: Annotated[
        float,
        Column(
            Number(at_least=0.01, at_most=179),
            Tier.FRAME,
            "The vertical field of view of a picture of 4:3 or wider; a narrower picture has the horizontal"
            " field of view of 4:3.",
            "degrees",
            bar=BarRange(5, 120, 1),
        ),
    ] = 30.0

    def rules(self) -> Iterator[Problem]:
        """Exactly one of direction and target is given, and the target is not the eye."""
        if (self.direction is None) == (self.target is None):
            yield Problem((), "it must have either a direction or a target; give one of them")
        elif self.target is not None and self.target == self.eye:
            yield Problem((), f"the target must differ from the eye, {self.eye}; move one of them")

    @cached_property
    def axes(self) -> Floats:
        """The axes of camera space, right, down and forward, as the rows of a (3, 3) rotation matrix.

        The camera coordinates of a point are axes @ (point - eye): x to the right, like elements; y down,
        like lines; and the depth along the view direction.
        Assumed: if the view direction is vertical, the top of the picture is +y.
        """
        if self.direction is not None:
            toward = np.array(self.direction)
        else:
            assert self.target is not None
            toward = np.array(self.target) - np.array(self.eye)
        x, y, z = (toward / np.abs(toward).max()).tolist()
        length = math.hypot(x, y, z)
        x, y, z = x / length, y / length, z / length
        # Right is forward x up, and down is forward x right. Measured: np.cross takes ten times as long.
        right, flat = (y, -x, 0.0), math.hypot(x, y)
        # Closer to the vertical than this, rounding errors would determine the rotation of the picture.
        if flat < 1e-9:
            right, flat = (-z, 0.0, x), math.hypot(z, x)
        u, v, w = right[0] / flat, right[1] / flat, right[2] / flat
        forward, right, down = (x, y, z), (u, v, w), (y * w - z * v, z * u - x * w, x * v - y * u)
        turn = math.radians(self.angle)
        cosine, sine = math.cos(turn), math.sin(turn)
        axes = np.array(
            [
                [cosine * a - sine * b for a, b in zip(right, down, strict=True)],
                [sine * a + cosine * b for a, b in zip(right, down, strict=True)],
                forward,
            ]
        )
        return read_only(axes)

    def half_height(self, aspect: float) -> float:
        """Half the height of a picture at a depth of 1; `aspect` is its width over its height.

        Assumed: a picture that is narrower than 4:3 shows more above and below. With the same height it would
        cut off the sides of the object.
        """
        return math.tan(math.radians(self.field_of_view) / 2) * max(1.0, ASPECT / aspect)

    def replace(self, /, **changes: Unpack[ViewChanges]) -> View:
        """The view with some fields changed; a new direction removes the target, and vice versa."""
        return replaced(self, changes)


@dataclass(frozen=True, repr=False)
class NamedView(Row):
    """A view with a name, to come back to."""

    noun: ClassVar[str] = "named view"

    name: Annotated[str, Column(Text(), Tier.NOTHING, "The name, unique among the named views.")]
    view: Annotated[View, Column(Nested(View, inline=True), Tier.NOTHING, "The view.")]

    def replace(self, /, **changes: Unpack[NamedViewChanges]) -> NamedView:
        """The named view with some fields changed, also fields of its view."""
        return replaced(self, changes)
