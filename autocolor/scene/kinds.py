"""The kinds of columns whose values have no fields: numbers, strings, vectors, curves, colors and others.

The methods are described in `columns.Kind`. A function such as `number` makes the field of a row class; the
keywords of any field are those of `columns.About`.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Set
from dataclasses import dataclass
from itertools import islice, pairwise
from numbers import Integral
from typing import Any, Final, Unpack

import numpy as np

from autocolor.arrays import Floats, unit_vector
from autocolor.checks import Color, Vector, closest, either
from autocolor.scene.columns import (
    MISSING,
    REFUSED,
    WORLD_UNITS,
    About,
    Default,
    Kind,
    Path,
    Problem,
    Tier,
    column_of,
)

LARGEST_PLACE: Final = 1e36
"""Limit: a coordinate. It leaves room for the eye and the lights around the largest object."""

NO_NUMBERS: Final = (bool, np.bool_, str, bytes, bytearray)
"""Types that Python converts to numbers, but that a column of numbers refuses."""

UNORDERED: Final = (str, bytes, bytearray, Mapping, Set)
"""Types that a column of components refuses although they have elements: text, and types without an order."""


def require(condition: bool) -> None:
    """Raise ValueError unless the condition holds."""
    if not condition:
        raise ValueError


@dataclass(frozen=True)
class Number(Kind[float]):
    """A finite number within bounds, converted to float.

    With `above`, the lower bound is excluded. The infinite value `endless` is accepted, too: it means "no
    limit", and files leave it out. If it `turns`, it is an angle in degrees, and between two angles it goes
    the short way.
    """

    at_least: float = -math.inf
    at_most: float = math.inf
    above: bool = False
    endless: float | None = None
    turns: bool = False

    def rule(self) -> str:
        if self.above:
            end = f" and at most {self.at_most:g}" if self.at_most < math.inf else ""
            return f"must be a number above {self.at_least:g}{end}"
        if self.at_least > -math.inf and self.at_most < math.inf:
            return f"must be a number from {self.at_least:g} to {self.at_most:g}"
        least = f" of at least {self.at_least:g}" if self.at_least > -math.inf else ""
        return f"must be a finite number{least}"

    def accepted(self, value: Any) -> float:
        require(not isinstance(value, NO_NUMBERS))
        number = float(value)
        is_within = self.at_least <= number <= self.at_most and not (self.above and number == self.at_least)
        require(number == self.endless or (is_within and -math.inf < number < math.inf))
        return number

    def between(self, one: Any, other: Any, share: float) -> Any:
        value = super().between(one, other, share)
        return one + share * short_turn(one, other) if self.turns else value

    def to_plain(self, name: str, value: float) -> Mapping[str, object]:
        return {name: None if value == self.endless else value}


def number(
    *,
    at_least: float = -math.inf,
    at_most: float = math.inf,
    above: bool = False,
    endless: float | None = None,
    turns: bool = False,
    **about: Unpack[About[Default]],
) -> float | Default:
    """A field of numbers within bounds; see `Number`."""
    return column_of(Number(at_least, at_most, above, endless, turns), **about)


def short_turn(one: float, other: float) -> float:
    """The turn from one angle to another, in degrees, above -180 to 180; opposite angles turn by 180.

    >>> short_turn(350, 20), short_turn(20, 350), short_turn(0, 180)
    (30, -30, 180)
    """
    return 180 - (180 - (other - one)) % 360


@dataclass(frozen=True)
class Whole(Kind[int]):
    """A whole number within bounds."""

    at_least: int
    at_most: int

    def rule(self) -> str:
        return f"must be a whole number from {self.at_least} to {self.at_most}"

    def accepted(self, value: Any) -> int:
        require(isinstance(value, (int, np.integer)) and not isinstance(value, bool))
        number = int(value)
        require(self.at_least <= number <= self.at_most)
        return number


@dataclass(frozen=True)
class Boolean(Kind[bool]):
    """A boolean."""

    def rule(self) -> str:
        return "must be true or false"

    def accepted(self, value: Any) -> bool:
        require(isinstance(value, (bool, np.bool_)))
        return bool(value)


def boolean(**about: Unpack[About[Default]]) -> bool | Default:
    """A field of booleans."""
    return column_of(Boolean(), **about)


@dataclass(frozen=True)
class Text(Kind[str]):
    """A string, not empty unless `may_be_empty`."""

    may_be_empty: bool = False

    def rule(self) -> str:
        return "must be a string" + ("" if self.may_be_empty else " of at least one character")

    def accepted(self, value: Any) -> str:
        require(isinstance(value, str) and (value != "" or self.may_be_empty))
        return str(value)


def text(*, may_be_empty: bool = False, **about: Unpack[About[Default]]) -> str | Default:
    """A field of strings, not empty unless `may_be_empty`."""
    return column_of(Text(may_be_empty), **about)


COORDINATE: Final = Number(-LARGEST_PLACE, LARGEST_PLACE)


@dataclass(frozen=True)
class VectorKind(Kind[Vector]):
    """A point or a direction: three finite numbers; with `has_length`, not all zero."""

    has_length: bool = False

    def rule(self) -> str:
        return "must be three finite numbers of at most 1e36"

    def accepted(self, value: Any) -> Vector:
        require(not isinstance(value, UNORDERED))
        x, y, z = map(COORDINATE.accepted, value)
        require(not self.has_length or (x, y, z) != (0, 0, 0))
        return x, y, z

    def advice(self, value: object) -> str:
        if isinstance(value, str):
            return "; write them as in [1, 2, 3]"
        return "; one of them must not be 0" if self.has_length else ""

    def between(self, one: Any, other: Any, share: float) -> Any:
        """A point moves along a line. A direction turns along a great circle, and its length is linear."""
        if not self.has_length or isinstance(one, float):
            return super().between(one, other, share)
        length = super().between(math.hypot(*one), math.hypot(*other), share)
        return tuple((length * _direction_between(one, other, share)).tolist())


def coordinates(*, tier: Tier, help: str, default: Default = MISSING) -> Vector | Default:
    """A field of points, in world units."""
    return column_of(VectorKind(), unit=WORLD_UNITS, tier=tier, help=help, default=default)


def vector(**about: Unpack[About[Default]]) -> Vector | Default:
    """A field of directions, of any length."""
    return column_of(VectorKind(has_length=True), **about)


LEAST_SINE: Final = 1e-9
"""Assumed: directions with a smaller sine of their angle are in a line; rounding would decide how to turn."""


def _direction_between(one: Vector, other: Vector, share: float) -> Floats:
    """The unit vector at a share of the shortest turn from one direction to another.

    Assumed: opposite directions turn through the vertical; from the vertical, through +x.
    """
    start, end = np.array(unit_vector(one)), np.array(unit_vector(other))
    cosine = float((start * end).sum())
    # The component at right angles to the start.
    aside = end - cosine * start
    angle = math.atan2(math.hypot(*aside), cosine)
    for other_way in ([0.0, 0.0, 1.0], [1.0, 0.0, 0.0]):
        if math.hypot(*aside) < LEAST_SINE:
            if cosine > 0:
                return start
            aside = other_way - (start * other_way).sum() * start
    x, y, z = aside.tolist()
    return math.cos(share * angle) * start + math.sin(share * angle) * np.array(unit_vector((x, y, z)))


@dataclass(frozen=True)
class OneOf(Kind[str]):
    """One of several names."""

    names: tuple[str, ...]

    def rule(self) -> str:
        return f"must be {either(self.names)}"

    def accepted(self, value: Any) -> str:
        require(isinstance(value, str) and value in self.names)
        return str(value)


def one_of(names: tuple[str, ...], **about: Unpack[About[Default]]) -> str | Default:
    """A field of several names."""
    return column_of(OneOf(names), **about)


AngleCurve = tuple[tuple[float, float], ...]
"""Points (x, y) of a piecewise linear curve, with rising x."""


def _points(value: Any, end: float, most: float = math.inf) -> tuple[tuple[float, float], ...]:
    """The 2 to `most` points of a curve from x = 0 to x = end, y from 0 to 1. Raises ValueError."""
    require(not isinstance(value, UNORDERED))
    pairs = list(value)
    require(2 <= len(pairs) <= most and not any(isinstance(pair, UNORDERED) for pair in pairs))
    along, share = Number(0, end).accepted, Number(0, 1).accepted
    points = tuple((along(x), share(y)) for x, y in pairs)
    require(points[0][0] == 0 and points[-1][0] == end)
    require(all(one[0] < other[0] for one, other in pairwise(points)))
    return points


@dataclass(frozen=True, eq=False)
class CurveKind(Kind[str | AngleCurve]):
    """The name of a curve, or points (x, y) of a nondecreasing curve from x = 0 to x = 1."""

    names: Mapping[str, object]

    def rule(self) -> str:
        return f"must be {', '.join(map(repr, self.names))}, or rising points [x, y] from x = 0 to x = 1"

    def accepted(self, value: Any) -> str | AngleCurve:
        if isinstance(value, str):
            require(value in self.names)
            return value
        points = _points(value, 1)
        require(all(one[1] <= other[1] for one, other in pairwise(points)))
        return points


@dataclass(frozen=True, eq=False)
class Instance(Kind[Any]):
    """An instance of a class, such as the mesh. Scene files leave it out."""

    value_class: type

    def rule(self) -> str:
        return f"must be a {self.value_class.__name__}"

    def accepted(self, value: Any) -> Any:
        require(isinstance(value, self.value_class))
        return value

    def to_plain(self, name: str, value: Any) -> Mapping[str, object]:
        return {}


MOST_POINTS: Final = 91
"""Limit: points of a curve over angles, one for each degree."""


@dataclass(frozen=True)
class AngleCurveKind(Kind[AngleCurve]):
    """Points (angle, share) of a curve from 0 to 90 degrees, with shares from 0 to 1.

    `least` is the least share at 0 degrees. `start` is the first value when an absent curve is switched on.
    """

    least: float
    start: AngleCurve

    def rule(self) -> str:
        return (
            f"must be 2 to {MOST_POINTS} points [angle, share], with angles that rise from 0 to 90 and shares"
            f" from 0 to 1, the first at least {self.least:g}"
        )

    def advice(self, value: object) -> str:
        return f"; write them as in {[list(point) for point in self.start]}"

    def accepted(self, value: Any) -> AngleCurve:
        points = _points(value, 90, MOST_POINTS)
        require(points[0][1] >= self.least)
        return points


LONGEST_COLOR: Final = 100
"""Limit: letters of a color; Pillow has the same limit."""

SIX_DIGITS: Final = re.compile("#[0-9a-fA-F]{6}")


@dataclass(frozen=True)
class ColorKind(Kind[Color]):
    """A color: red, green and blue from 0 to 255, written as "#rrggbb".

    Three whole numbers are accepted, and every text that Pillow's `ImageColor` knows, unless it has
    transparency: a name of CSS, "#rgb", "rgb(10%, 20%, 30%)", "hsl(0, 100%, 50%)". Pillow is slow to load, so
    "#rrggbb" is read without it.
    """

    def rule(self) -> str:
        return 'must be "#rrggbb", a name such as "red", or three whole numbers from 0 to 255'

    def accepted(self, value: Any) -> Color:
        if isinstance(value, str):
            value = bytes.fromhex(value[1:]) if SIX_DIGITS.fullmatch(value) else _components(value)
        else:
            require(not isinstance(value, UNORDERED))
        given = list(value)
        # Refuse even whole floats: (1.0, 0, 0) is red in other programs, and nearly black here.
        require(all(isinstance(part, Integral) and not isinstance(part, NO_NUMBERS) for part in given))
        require(len(given) == 3 and min(given) >= 0 and max(given) <= 255)
        red, green, blue = map(int, given)
        return red, green, blue

    def advice(self, value: Any) -> str:
        if isinstance(value, str):
            return _advice_on_text(value)
        try:
            # Most programs write fractions.
            return f"; write {list(self.accepted([int(255 * part + 0.5) for part in value]))}"
        except (TypeError, ValueError, OverflowError):
            return ""

    def to_plain(self, name: str, value: Any) -> Mapping[str, object]:
        return {name: in_digits(value)}


def color(**about: Unpack[About[Default]]) -> Color | Default:
    """A field of colors."""
    return column_of(ColorKind(), **about)


@dataclass(frozen=True)
class ColorsKind(Kind[tuple[Color, ...]]):
    """A list of 2 to `most` colors. A text of colors between commas, as in "#200, #f60", is accepted."""

    most: int

    def rule(self) -> str:
        return f"must be a list of 2{f' to {self.most}' if self.most > 2 else ''} colors"

    def accepted(self, value: Any) -> tuple[Color, ...]:
        require(not isinstance(value, UNORDERED))
        colors = tuple(ColorKind().accepted(color) for color in islice(value, self.most + 1))
        require(2 <= len(colors) <= self.most)
        return colors

    def advice(self, value: object) -> str:
        return '; write them as in ["#200", "#fff"]'

    def validated(self, value: object, path: Path, problems: list[Problem]) -> Any:
        given = value
        if isinstance(value, str) and len(value) <= LONGEST_COLOR * self.most:
            given = _between_commas(value.removeprefix("[").removesuffix("]"))
        if isinstance(given, (list, tuple)) and 2 <= len(given) <= self.most:
            # Name the colors that are invalid.
            ramp = [ColorKind().validated(color, (*path, at), problems) for at, color in enumerate(given)]
            return REFUSED if any(color is REFUSED for color in ramp) else tuple(ramp)
        return super().validated(value, path, problems)

    def to_plain(self, name: str, value: Any) -> Mapping[str, object]:
        return {name: [in_digits(color) for color in value]}


def _between_commas(text: str) -> list[str]:
    """The parts of a text between its commas, except those in parentheses, without spaces and quotes.

    >>> _between_commas("red, 'rgb(1, 2, 3)'")
    ['red', 'rgb(1, 2, 3)']
    """
    return [part.strip(" '\"") for part in re.split(rf",(?![^()]{{0,{LONGEST_COLOR}}}\))", text)]


def in_digits(color: Color) -> str:
    """The color as "#rrggbb".

    >>> in_digits((176, 16, 32))
    '#b01020'
    """
    return "#{:02x}{:02x}{:02x}".format(*color)


def color_names() -> tuple[str, ...]:
    """The names of colors, in lower case."""
    from PIL import ImageColor

    return tuple(ImageColor.colormap)


def _components(text: str) -> tuple[int, ...]:
    """The three or four components, of any size, of a text that Pillow knows. Raises ValueError."""
    # Pillow would also accept a line break at the end, and digits of other alphabets.
    require(len(text) <= LONGEST_COLOR and text.isascii() and text.isprintable())
    from PIL import ImageColor

    return ImageColor.getrgb(text)


def _advice_on_text(text: str) -> str:
    """The end of the message about a text that is no color: how to correct it."""
    try:
        components = _components(text)
    except ValueError:
        components = ()
    if len(components) == 4 and max(components) <= 255:
        red, green, blue, _ = components
        return f", which has transparency; write {in_digits((red, green, blue))!r}"
    if components:
        return "; keep its parts from 0 to 255, or from 0% to 100%"
    if re.fullmatch("#[0-9a-fA-F]*", text):
        return "; write three or six hexadecimal digits after the #"
    if re.fullmatch("[A-Za-z]{2,}", text):
        return closest(text.lower(), color_names()) or '; write it as in "#b01020"'
    return '; write it as in "#b01020"'
