"""The view: where the eye is, where it looks, how the picture plane is turned, and how much it takes in.

Paper: "Light Direction and Concentration", Figure 5 (eye, view direction, RESCALE, ANGLE).
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Annotated, ClassVar, Unpack

import numpy as np

from autocolor.arrays import Floats
from autocolor.checks import Vector
from autocolor.scene.changes import ViewChanges
from autocolor.scene.column_kinds import Number, VectorKind
from autocolor.scene.columns import Column, Problem, Row, Tier, changed


@dataclass(frozen=True)
class View(Row):
    """An eye, and a view direction or a target that it looks at. The world's z axis points up."""

    noun: ClassVar[str] = "view"
    alternatives: ClassVar[tuple[str, ...]] = ("direction", "target")

    eye: Annotated[Vector, Column(VectorKind(), Tier.FRAME, "Where the eye is.", "world units")]
    direction: Annotated[
        Vector | None,
        Column(
            VectorKind(has_length=True), Tier.FRAME, "Where it looks, a vector of any length; or a target."
        ),
    ] = None
    target: Annotated[
        Vector | None, Column(VectorKind(), Tier.FRAME, "The point that it looks at.", "world units")
    ] = None
    angle: Annotated[
        float, Column(Number(), Tier.FRAME, "Turns the horizontal axis of the picture plane.", "degrees")
    ] = 0.0
    field_of_view: Annotated[
        float,
        Column(
            Number(at_least=0.01, at_most=179),
            Tier.FRAME,
            "How much it takes in, from top to bottom.",
            "degrees",
        ),
    ] = 30.0

    def rules(self) -> Iterator[Problem]:
        """A direction or a target, and a target that is not the eye."""
        if (self.direction is None) == (self.target is None):
            yield Problem((), "it must have a direction or a target, and not both; leave one out")
        elif self.target is not None and self.target == self.eye:
            yield Problem((), f"the target must not be the eye, not both {self.eye}; move one of them")

    @cached_property
    def axes(self) -> Floats:
        """Right, down and forward as the rows of a (3, 3) rotation, the axes of camera space.

        A point's camera coordinates are axes @ (point - eye): elements grow to the right, lines downward,
        and the third is the depth along the view direction.
        Assumed: when the eye looks along the up axis, the top of the picture is +y.
        """
        if self.direction is not None:
            toward = np.array(self.direction)
        else:
            assert self.target is not None
            toward = np.array(self.target) - np.array(self.eye)
        x, y, z = (toward / np.abs(toward).max()).tolist()
        length = math.hypot(x, y, z)
        x, y, z = x / length, y / length, z / length
        # Right is forward x up, and down is forward x right; measured: a tenth of the time of np.cross.
        right, flat = (y, -x, 0.0), math.hypot(x, y)
        # Closer to the up axis than this, rounding would choose the picture's top.
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
        axes.flags.writeable = False
        return axes

    def replace(self, **changes: Unpack[ViewChanges]) -> View:
        """The view with some fields changed; giving a direction drops the target, and the other way round."""
        return changed(self, changes)
