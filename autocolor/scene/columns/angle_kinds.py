"""The kind of columns that hold a curve over the angles from 0 to 90 degrees."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import Any, Final

from autocolor.scene.columns.value_kinds import UNORDERED, Leaf, Number, require

RIGHT_ANGLE: Final = 90.0

MOST_POINTS: Final = 91
"""Assumed: a point for each degree is enough of a curve."""

AngleCurve = tuple[tuple[float, float], ...]
"""Points (angle in degrees, value), with rising angles from 0 to 90; between them the curve is linear."""


@dataclass(frozen=True)
class AngleCurveKind(Leaf):
    """Points (angle, share) of a curve from 0 to 90 degrees, with shares from 0 to 1.

    `least` is the least share at 0 degrees. `start` is what an absent curve begins with when it is switched
    on.
    """

    least: float
    start: AngleCurve

    def accepts(self) -> str:
        return "Sequence[Sequence[float]]"

    def rule(self) -> str:
        return (
            f"must be 2 to {MOST_POINTS} points [angle, share], with angles that rise from 0 to 90 and shares"
            f" from 0 to 1, the first at least {self.least:g}"
        )

    def advice(self, value: object) -> str:
        return f"; write them as in {[list(point) for point in self.start]}"

    def accepted(self, value: Any) -> AngleCurve:
        require(not isinstance(value, UNORDERED))
        pairs = list(value)
        require(2 <= len(pairs) <= MOST_POINTS)
        require(not any(isinstance(pair, UNORDERED) for pair in pairs))
        angle, share = Number(0, RIGHT_ANGLE).accepted, self.share_kind(1).accepted
        points = tuple((angle(x), share(y)) for x, y in pairs)
        require(points[0][0] == 0 and points[-1][0] == RIGHT_ANGLE)
        require(all(one[0] < other[0] for one, other in pairwise(points)))
        self.share_kind(0).accepted(points[0][1])
        return points

    def share_kind(self, number: int) -> Number:
        """The kind of the share of a point, by its number from 0."""
        return Number(0 if number else self.least, 1)
