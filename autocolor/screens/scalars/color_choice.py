"""A choice of a color by its name, for those beyond the limits and of missing values."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Final

from autocolor.checks import Color
from autocolor.scene.columns.color_kinds import in_digits
from autocolor.widgets.widget import Choice

NAMED: Final[Mapping[str, Color]] = {
    "black": (0, 0, 0),
    "gray": (128, 128, 128),
    "white": (255, 255, 255),
    "magenta": (255, 0, 255),
    "red": (255, 0, 0),
    "yellow": (255, 255, 0),
    "green": (0, 160, 0),
    "cyan": (0, 255, 255),
    "blue": (0, 0, 255),
}
"""Assumed: colors enough to differ from any color scale."""

NO_COLOR: Final = "none"


def color_choice(
    label: str, told: str, color: Color | None, put: Callable[[Color | None], object], has_none: bool
) -> Choice:
    """A row that chooses one of the colors, or none if there can be none; any other is told in digits."""
    names = (*([NO_COLOR] if has_none else []), *NAMED)
    name_of = {each: name for name, each in NAMED.items()}
    present = NO_COLOR if color is None else name_of.get(color, in_digits(color))
    return Choice(label, told, names=names, present=present, choose=lambda name: put(NAMED.get(name)))
