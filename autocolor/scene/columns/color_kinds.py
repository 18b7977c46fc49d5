"""The kind of columns that hold a color, and the ways to write one.

A color is "#rrggbb", three whole numbers, or anything without transparency that Pillow's `ImageColor` knows:
a name of CSS, "#rgb", "rgb(10%, 20%, 30%)", "hsl(0, 100%, 50%)". Pillow is loaded for those alone, so that
scenes that are written in "#rrggbb" need no time for it.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from numbers import Integral, Real
from typing import Any, Final

from autocolor.checks import Color, nearest
from autocolor.scene.columns.value_kinds import NO_NUMBERS, UNORDERED, Leaf, require

LONGEST_COLOR: Final = 100
"""Letters of a color; Pillow takes no more either."""

IN_FULL: Final = re.compile("#[0-9a-fA-F]{6}")
OF_DIGITS: Final = re.compile("#[0-9a-fA-F]*")
A_NAME: Final = re.compile("[A-Za-z]{2,}")


@dataclass(frozen=True)
class ColorKind(Leaf):
    """A color: red, green and blue from 0 to 255, written as "#rrggbb"."""

    def rule(self) -> str:
        return 'must be "#rrggbb", a name such as "red", or three whole numbers from 0 to 255'

    def accepts(self) -> str:
        return "str | Sequence[int]"

    def accepted(self, value: Any) -> Color:
        if isinstance(value, str):
            return _color_of_text(value)
        require(not isinstance(value, UNORDERED))
        given = list(value)
        # A float is refused even if it is whole: (1.0, 0, 0) is red elsewhere, and nearly black here.
        require(all(isinstance(part, Integral) and not isinstance(part, NO_NUMBERS) for part in given))
        return _within_range(tuple(int(part) for part in given))

    def advice(self, value: object) -> str:
        return _advice_on_text(value) if isinstance(value, str) else _advice_on_floats(value)

    def written(self, name: str, value: Any) -> Mapping[str, object]:
        return {name: in_digits(value)}


def in_digits(color: Color) -> str:
    """The color as "#rrggbb".

    >>> in_digits((176, 16, 32))
    '#b01020'
    """
    return "#{:02x}{:02x}{:02x}".format(*color)


def color_names() -> tuple[str, ...]:
    """The names of colors, in small letters."""
    from PIL import ImageColor

    return tuple(ImageColor.colormap)


def _color_of_text(text: str) -> Color:
    """The color that a text means. Raises ValueError if it means none, or one with transparency."""
    if IN_FULL.fullmatch(text):
        red, green, blue = bytes.fromhex(text[1:])
        return red, green, blue
    return _within_range(_components(text))


def _components(text: str) -> tuple[int, ...]:
    """The three or four components of a text that Pillow knows, of any size. Raises ValueError."""
    # Pillow also takes a line break at the end, and digits of other alphabets.
    require(len(text) <= LONGEST_COLOR and text.isascii() and text.isprintable())
    from PIL import ImageColor

    return ImageColor.getrgb(text)


def _within_range(components: tuple[int, ...]) -> Color:
    require(len(components) == 3 and min(components) >= 0 and max(components) <= 255)
    red, green, blue = components
    return red, green, blue


def _advice_on_text(text: str) -> str:
    """What to do about a text that means no color."""
    try:
        components = _components(text)
    except ValueError:
        components = ()
    if len(components) == 4 and max(components) <= 255:
        red, green, blue, _ = components
        return f", which has transparency; write {in_digits((red, green, blue))!r}"
    if components:
        return "; keep its parts from 0 to 255, or from 0% to 100%"
    if OF_DIGITS.fullmatch(text):
        return "; write three or six hexadecimal digits after the #"
    if A_NAME.fullmatch(text):
        return nearest(text.lower(), color_names()) or '; write it as in "#b01020"'
    return '; write it as in "#b01020"'


def _advice_on_floats(value: object) -> str:
    """What to write instead of three numbers that are not all whole; nothing for anything else."""
    try:
        parts = list(value)  # type: ignore[call-overload]
        if len(parts) != 3 or all(isinstance(part, (Integral, *NO_NUMBERS)) for part in parts):
            return ""
        require(all(isinstance(part, Real) for part in parts))
        # Numbers up to 1 are fractions, as most programs write colors with floats.
        scale = 255 if max(parts) <= 1 else 1
        red, green, blue = (int(float(part) * scale + 0.5) for part in parts)
        color = _within_range((red, green, blue))
    except (TypeError, ValueError, OverflowError):
        return ""
    # A list is one in Python, in scene files and after --set.
    return f"; write {list(color)} or {in_digits(color)!r}"
