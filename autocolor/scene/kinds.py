"""The kinds of columns whose values have no fields: numbers, strings, vectors, curves, colors and others.

The methods are described in `columns.Kind`.
"""

from __future__ import annotations

import json
import math
import re
from collections.abc import Mapping, Set
from dataclasses import dataclass
from itertools import islice, pairwise
from numbers import Integral, Real
from typing import Any, Final

import numpy as np

from autocolor.arrays import half_up, unit_vector
from autocolor.checks import Color, Vector, closest, either, shown
from autocolor.scene.columns import REFUSED, BarRange, Kind, Path, Problem, Tier, bar_within

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
class Number(Kind):
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

    def accepts(self) -> str:
        return "float"

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

    def bar(self) -> BarRange | None:
        is_limited = -math.inf < self.at_least < self.at_most < math.inf and not self.above
        return bar_within(self.at_least, self.at_most) if is_limited else None

    def between(self, one: float, other: float, share: float) -> float:
        value: float = super().between(one, other, share)
        return one + share * short_turn(one, other) if self.turns else value

    def to_plain(self, name: str, value: float) -> Mapping[str, object]:
        return {name: None if value == self.endless else value}

    def difference(self, name: str, one: float, other: float) -> Mapping[str, object]:
        # Write an infinite value, too: a change without the key would not change the value.
        return {} if repr(one) == repr(other) else {name: other}


def short_turn(one: float, other: float) -> float:
    """The turn from one angle to another, in degrees, above -180 to 180; opposite angles turn by 180.

    >>> short_turn(350, 20), short_turn(20, 350), short_turn(0, 180)
    (30, -30, 180)
    """
    return 180 - (180 - (other - one)) % 360


@dataclass(frozen=True)
class Whole(Kind):
    """A whole number within bounds."""

    at_least: int
    at_most: int

    def accepts(self) -> str:
        return "int"

    def bar(self) -> BarRange:
        return BarRange(self.at_least, self.at_most, 1)

    def rule(self) -> str:
        return f"must be a whole number from {self.at_least} to {self.at_most}"

    def accepted(self, value: Any) -> int:
        require(isinstance(value, (int, np.integer)) and not isinstance(value, bool))
        number = int(value)
        require(self.at_least <= number <= self.at_most)
        return number

    def between(self, one: int, other: int, share: float) -> int:
        return _whole_between(one, other, share)


def _whole_between(one: int, other: int, share: float) -> int:
    """The whole number at a share of the way from one to another, rounded half up."""
    return half_up(one + (other - one) * share)


@dataclass(frozen=True)
class Boolean(Kind):
    """A boolean."""

    def rule(self) -> str:
        return "must be true or false"

    def accepts(self) -> str:
        return "bool"

    def accepted(self, value: Any) -> bool:
        require(isinstance(value, (bool, np.bool_)))
        return bool(value)


@dataclass(frozen=True)
class Text(Kind):
    """A string, not empty unless `may_be_empty`."""

    may_be_empty: bool = False

    def rule(self) -> str:
        return "must be a string" + ("" if self.may_be_empty else " of at least one character")

    def accepts(self) -> str:
        return "str"

    def accepted(self, value: Any) -> str:
        require(isinstance(value, str) and (value != "" or self.may_be_empty))
        text: str = value
        return text


@dataclass(frozen=True)
class VectorKind(Kind):
    """A point or a direction: three finite numbers; with `has_length`, not all zero."""

    has_length: bool = False

    def rule(self) -> str:
        return "must be three finite numbers of at most 1e36"

    def accepts(self) -> str:
        return "Sequence[float]"

    def accepted(self, value: Any) -> tuple[float, float, float]:
        require(not isinstance(value, UNORDERED))
        given = list(value)
        require(len(given) == 3 and not any(isinstance(component, NO_NUMBERS) for component in given))
        x, y, z = (float(component) for component in given)
        require(all(abs(component) <= LARGEST_PLACE for component in (x, y, z)))
        return x, y, z

    def advice(self, value: object) -> str:
        return "; write them as in [1, 2, 3]" if isinstance(value, str) else ""

    def validated(self, value: object, path: Path, problems: list[Problem]) -> object:
        vector = super().validated(value, path, problems)
        if self.has_length and vector == (0.0, 0.0, 0.0):
            problems.append(Problem(path, f"must have a length above 0, not {shown(value)}; change it"))
            return REFUSED
        return vector

    def between(self, one: Vector, other: Vector, share: float) -> Vector:
        """A point moves along a line. A direction turns along a great circle, and its length is linear."""
        if not self.has_length:
            point: Vector = super().between(one, other, share)
            return point
        length = super().between(math.hypot(*one), math.hypot(*other), share)
        x, y, z = (length * component for component in _direction_between(one, other, share))
        return x, y, z


LEAST_SINE: Final = 1e-9
"""Assumed: directions with a smaller sine of their angle are in a line; rounding would decide how to turn."""


def _direction_between(one: Vector, other: Vector, share: float) -> Vector:
    """The unit vector at a share of the shortest turn from one direction to another.

    Assumed: opposite directions turn through the vertical; from the vertical, through +x.
    """
    start, end = unit_vector(one), unit_vector(other)
    cosine = _dot(start, end)
    aside = _aside(start, end)
    angle = math.atan2(math.hypot(*aside), cosine)
    if math.hypot(*aside) < LEAST_SINE:
        if cosine > 0:
            return start
        aside = _aside(start, (0.0, 0.0, 1.0))
        if math.hypot(*aside) < LEAST_SINE:
            aside = 1.0, 0.0, 0.0
    along, across = math.cos(share * angle), math.sin(share * angle)
    x, y, z = (along * a + across * b for a, b in zip(start, unit_vector(aside), strict=True))
    return x, y, z


def _dot(one: Vector, other: Vector) -> float:
    return sum(a * b for a, b in zip(one, other, strict=True))


def _aside(start: Vector, toward: Vector) -> Vector:
    """The component of a unit vector at right angles to another."""
    cosine = _dot(start, toward)
    x, y, z = (b - cosine * a for a, b in zip(start, toward, strict=True))
    return x, y, z


@dataclass(frozen=True)
class OneOf(Kind):
    """One of several names."""

    names: tuple[str, ...]

    def rule(self) -> str:
        return f"must be {either(self.names)}"

    def accepts(self) -> str:
        return f"Literal[{', '.join(map(json.dumps, self.names))}]"

    def accepted(self, value: Any) -> str:
        require(isinstance(value, str) and value in self.names)
        name: str = value
        return name

    def advice(self, value: object) -> str:
        return closest(value, self.names) if isinstance(value, str) else ""


@dataclass(frozen=True, eq=False)
class CurveKind(Kind):
    """The name of a curve, or points (x, y) of a nondecreasing curve from x = 0 to x = 1."""

    names: Mapping[str, object]

    def accepts(self) -> str:
        return "str | Sequence[Sequence[float]]"

    def rule(self) -> str:
        return f"must be {', '.join(map(repr, self.names))}, or rising points [x, y] from x = 0 to x = 1"

    def accepted(self, value: Any) -> str | tuple[tuple[float, float], ...]:
        if isinstance(value, str):
            require(value in self.names)
            return value
        require(not isinstance(value, UNORDERED))
        pairs = list(value)
        require(not any(isinstance(pair, UNORDERED) for pair in pairs))
        along = Number(at_least=0, at_most=1).accepted
        points = tuple((along(x), along(y)) for x, y in pairs)
        xs, ys = [x for x, _ in points], [y for _, y in points]
        require(len(points) >= 2 and xs[0] == 0 and xs[-1] == 1 and all(a < b for a, b in pairwise(xs)))
        require(all(a <= b for a, b in pairwise(ys)))
        return points

    def advice(self, value: object) -> str:
        return closest(value, self.names) if isinstance(value, str) else ""


@dataclass(frozen=True, eq=False)
class Instance(Kind):
    """An instance of a class, such as the mesh. It is compared by identity, and scene files leave it out."""

    value_class: type

    def rule(self) -> str:
        return f"must be a {self.value_class.__name__}"

    def accepts(self) -> str:
        return "object"

    def accepted(self, value: Any) -> object:
        require(isinstance(value, self.value_class))
        return value

    def to_plain(self, name: str, value: Any) -> Mapping[str, object]:
        return {}

    def difference(self, name: str, one: Any, other: Any) -> Mapping[str, object]:
        return {}

    def cost(self, one: Any, other: Any, own: Tier) -> Tier | None:
        return own


RIGHT_ANGLE: Final = 90.0

MOST_POINTS: Final = 91
"""Limit: points of a curve, one for each degree."""

AngleCurve = tuple[tuple[float, float], ...]
"""Points (angle in degrees, value), with rising angles from 0 to 90, of a piecewise linear curve."""


@dataclass(frozen=True)
class AngleCurveKind(Kind):
    """Points (angle, share) of a curve from 0 to 90 degrees, with shares from 0 to 1.

    `least` is the least share at 0 degrees. `start` is the first value when an absent curve is switched on.
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
        """The kind of a point's share; the number of the point counts from 0."""
        return Number(0 if number else self.least, 1)


LONGEST_COLOR: Final = 100
"""Limit: letters of a color; Pillow has the same limit."""

SIX_DIGITS: Final = re.compile("#[0-9a-fA-F]{6}")


@dataclass(frozen=True)
class ColorKind(Kind):
    """A color: red, green and blue from 0 to 255, written as "#rrggbb".

    Three whole numbers are accepted, and every text that Pillow's `ImageColor` knows, unless it has
    transparency: a name of CSS, "#rgb", "rgb(10%, 20%, 30%)", "hsl(0, 100%, 50%)". Pillow is slow to load, so
    "#rrggbb" is read without it.
    """

    def rule(self) -> str:
        return 'must be "#rrggbb", a name such as "red", or three whole numbers from 0 to 255'

    def accepts(self) -> str:
        return "str | Sequence[int]"

    def accepted(self, value: Any) -> Color:
        if isinstance(value, str):
            return _color_of_text(value)
        require(not isinstance(value, UNORDERED))
        given = list(value)
        # Refuse even whole floats: (1.0, 0, 0) is red in other programs, and nearly black here.
        require(all(isinstance(part, Integral) and not isinstance(part, NO_NUMBERS) for part in given))
        return _within_range(tuple(int(part) for part in given))

    def advice(self, value: object) -> str:
        return _advice_on_text(value) if isinstance(value, str) else _advice_on_floats(value)

    def to_plain(self, name: str, value: Any) -> Mapping[str, object]:
        return {name: in_digits(value)}

    def between(self, one: Color, other: Color, share: float) -> Color:
        red, green, blue = (_whole_between(a, b, share) for a, b in zip(one, other, strict=True))
        return red, green, blue


@dataclass(frozen=True)
class ColorsKind(Kind):
    """A list of 2 to `most` colors. A text of colors between commas, as in "#200, #f60", is accepted."""

    most: int

    def rule(self) -> str:
        return f"must be a list of 2 to {self.most} colors"

    def accepts(self) -> str:
        return "str | Sequence[str | Sequence[int]]"

    def accepted(self, value: Any) -> tuple[Color, ...]:
        require(not isinstance(value, UNORDERED))
        colors = tuple(ColorKind().accepted(color) for color in islice(value, self.most + 1))
        require(2 <= len(colors) <= self.most)
        return colors

    def advice(self, value: object) -> str:
        return '; write them as in ["#200", "#f60", "#fff"]'

    def validated(self, value: object, path: Path, problems: list[Problem]) -> object:
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

    def between(self, one: Any, other: Any, share: float) -> Any:
        """Lists of equally many colors are interpolated, color by color; other lists hold."""
        if len(one) != len(other):
            return one
        return tuple(ColorKind().between(a, b, share) for a, b in zip(one, other, strict=True))


def _between_commas(text: str) -> list[str]:
    """The parts of a text between its commas, without spaces and quotes around them.

    Commas in parentheses do not count.

    >>> _between_commas("red, 'rgb(1, 2, 3)'")
    ['red', 'rgb(1, 2, 3)']
    """
    parts: list[list[str]] = []
    depth = 0
    for part in text.split(","):
        if depth > 0:
            parts[-1].append(part)
        else:
            parts.append([part])
        depth += part.count("(") - part.count(")")
    return [",".join(part).strip(" '\"") for part in parts]


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


def _color_of_text(text: str) -> Color:
    """The color that a text describes. Raises ValueError if it describes none, or has transparency."""
    if SIX_DIGITS.fullmatch(text):
        red, green, blue = bytes.fromhex(text[1:])
        return red, green, blue
    return _within_range(_components(text))


def _components(text: str) -> tuple[int, ...]:
    """The three or four components, of any size, of a text that Pillow knows. Raises ValueError."""
    # Pillow would also accept a line break at the end, and digits of other alphabets.
    require(len(text) <= LONGEST_COLOR and text.isascii() and text.isprintable())
    from PIL import ImageColor

    return ImageColor.getrgb(text)


def _within_range(components: tuple[int, ...]) -> Color:
    require(len(components) == 3 and min(components) >= 0 and max(components) <= 255)
    red, green, blue = components
    return red, green, blue


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


def _advice_on_floats(value: object) -> str:
    """How to write the color if some of three numbers are floats; empty for any other value."""
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
    # Python, scene files and --set all write a color as a list.
    return f"; write {list(color)} or {in_digits(color)!r}"
