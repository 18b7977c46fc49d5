"""The kinds of columns that only scalars have: limits, the colors beyond them, and color scales."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Final

from autocolor.arrays import LARGEST_SINGLE
from autocolor.checks import Color, nearest
from autocolor.scene.columns.color_kinds import ColorKind, in_digits
from autocolor.scene.columns.column import Tier
from autocolor.scene.columns.value_kinds import UNORDERED, Leaf, Number, require
from autocolor.scene.scalars.color_scales import COLOR_SCALES, REVERSED

MOST_COLORS: Final = 256


@dataclass(frozen=True)
class Limits(Leaf):
    """Two numbers of float32, the second above the first."""

    def rule(self) -> str:
        return "must be two finite numbers, the second above the first"

    def accepts(self) -> str:
        return "Sequence[float]"

    def accepted(self, value: Any) -> tuple[float, float]:
        require(not isinstance(value, UNORDERED))
        low, high = map(Number(at_least=-LARGEST_SINGLE, at_most=LARGEST_SINGLE).accepted, value)
        require(low < high)
        return low, high

    def written(self, name: str, value: Any) -> Mapping[str, object]:
        return {name: list(value)}


@dataclass(frozen=True)
class EndColor(ColorKind):
    """The color of values beyond a limit: a band of its own, so that its coming and going changes levels."""

    def cost(self, one: Any, other: Any, own: Tier) -> Tier | None:
        return Tier.LEVELS if one is None or other is None else super().cost(one, other, own)


@dataclass(frozen=True)
class ScaleKind(Leaf):
    """The name of a color scale, or a list of at least two colors."""

    def rule(self) -> str:
        return "must be the name of a color scale, or a list of 2 to 256 colors"

    def accepts(self) -> str:
        return "str | Sequence[str | Sequence[int]]"

    def accepted(self, value: Any) -> str | tuple[Color, ...]:
        if isinstance(value, str):
            require(value in COLOR_SCALES)
            return value
        require(not isinstance(value, UNORDERED))
        colors = tuple(ColorKind().accepted(each) for each in value)
        require(2 <= len(colors) <= MOST_COLORS)
        return colors

    def advice(self, value: object) -> str:
        if not isinstance(value, str):
            return ""
        forward = (name for name in COLOR_SCALES if not name.endswith(REVERSED))
        return nearest(value, COLOR_SCALES) or nearest(value, forward)

    def written(self, name: str, value: Any) -> Mapping[str, object]:
        return {name: value if isinstance(value, str) else [in_digits(color) for color in value]}
