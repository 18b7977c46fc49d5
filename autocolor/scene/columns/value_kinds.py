"""The kinds of columns that hold one value: numbers, switches, strings, vectors, choices, curves."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Set
from dataclasses import dataclass
from itertools import pairwise
from typing import Any, ClassVar, Final

import numpy as np

from autocolor.checks import either, nearest, shown
from autocolor.scene.columns.bars import Bar, bar_within
from autocolor.scene.columns.column import Kind, Tier
from autocolor.scene.columns.problems import REFUSED, Path, Problem

LARGEST_PLACE: Final = 1e36
"""Assumed: leaves room for the eye and the lights around the largest object."""

NO_NUMBERS: Final = (bool, np.bool_, str, bytes, bytearray)
"""Types that Python converts to numbers, but that are not accepted as numbers."""

UNORDERED: Final = (str, bytes, bytearray, Mapping, Set)
"""Types with elements that are not accepted as components in their order."""


class Leaf(Kind):
    """A kind of values without fields: a value is accepted or refused as a whole."""

    def accepted(self, value: Any) -> Any:
        """The converted value. Raises TypeError, ValueError or OverflowError if it breaks the rule."""
        raise NotImplementedError

    def advice(self, value: object) -> str:
        """A clause for the message about an invalid value: what to do."""
        return ""

    def held(self, value: object, path: Path, problems: list[Problem]) -> object:
        try:
            return self.accepted(value)
        except (TypeError, ValueError, OverflowError):
            problems.append(Problem(path, f"{self.rule()}, not {shown(value)}{self.advice(value)}"))
            return REFUSED


def require(condition: bool) -> None:
    """Raise ValueError unless the condition holds."""
    if not condition:
        raise ValueError


@dataclass(frozen=True)
class Number(Leaf):
    """A finite number within bounds, converted to float.

    With `above`, the lower bound is excluded. `endless` is an infinite value that is also accepted, for no
    limit, and is not written.
    """

    at_least: float = -math.inf
    at_most: float = math.inf
    above: bool = False
    endless: float | None = None

    def accepts(self) -> str:
        return "float"

    def rule(self) -> str:
        if self.above:
            end = f" and at most {self.at_most:g}" if self.at_most < math.inf else ""
            return f"must be a number above {self.at_least:g}{end}"
        if self.at_least > -math.inf and self.at_most < math.inf:
            return f"must be a number from {self.at_least:g} to {self.at_most:g}"
        return "must be a finite number" + (
            f" of at least {self.at_least:g}" if self.at_least > -math.inf else ""
        )

    def accepted(self, value: Any) -> float:
        if isinstance(value, NO_NUMBERS):
            raise TypeError
        number = float(value)
        is_within = self.at_least <= number <= self.at_most and not (self.above and number == self.at_least)
        if number != self.endless and not (is_within and -math.inf < number < math.inf):
            raise ValueError
        return number

    def bar(self) -> Bar | None:
        is_limited = -math.inf < self.at_least < self.at_most < math.inf and not self.above
        return bar_within(self.at_least, self.at_most) if is_limited else None

    def written(self, name: str, value: float) -> Mapping[str, object]:
        return {name: None if value == self.endless else value}

    def difference(self, name: str, one: float, other: float) -> Mapping[str, object]:
        # A limit that is taken away must be told: the key that is left out keeps its value.
        return {} if repr(one) == repr(other) else {name: other}


@dataclass(frozen=True)
class Whole(Leaf):
    """A whole number within bounds."""

    is_whole: ClassVar[bool] = True

    at_least: int
    at_most: int

    def accepts(self) -> str:
        return "int"

    def bar(self) -> Bar:
        return Bar(self.at_least, self.at_most, 1)

    def rule(self) -> str:
        return f"must be a whole number from {self.at_least} to {self.at_most}"

    def accepted(self, value: Any) -> int:
        require(isinstance(value, (int, np.integer)) and not isinstance(value, bool))
        number = int(value)
        require(self.at_least <= number <= self.at_most)
        return number


@dataclass(frozen=True)
class Switch(Leaf):
    """A boolean."""

    def rule(self) -> str:
        return "must be true or false"

    def accepts(self) -> str:
        return "bool"

    def accepted(self, value: Any) -> bool:
        require(isinstance(value, (bool, np.bool_)))
        return bool(value)


@dataclass(frozen=True)
class Text(Leaf):
    """A string, which must not be empty unless `may_be_empty`."""

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
class VectorKind(Leaf):
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

    def held(self, value: object, path: Path, problems: list[Problem]) -> object:
        vector = super().held(value, path, problems)
        if self.has_length and vector == (0.0, 0.0, 0.0):
            problems.append(Problem(path, f"must not be zero, not {shown(value)}; give it a length"))
            return REFUSED
        return vector


@dataclass(frozen=True)
class Choice(Leaf):
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
        close = nearest(value, self.names) if isinstance(value, str) else ""
        return close if "did you mean" in close else ""


@dataclass(frozen=True, eq=False)
class CurveKind(Leaf):
    """The name of a curve, or points (x, y) of a nondecreasing one from x = 0 to x = 1."""

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
        return nearest(value, self.names) if isinstance(value, str) else ""


@dataclass(frozen=True, eq=False)
class Instance(Leaf):
    """An instance of a class, such as the mesh; it is compared by identity and not written."""

    value_class: type

    def rule(self) -> str:
        return f"must be a {self.value_class.__name__}"

    def accepts(self) -> str:
        return "object"

    def accepted(self, value: Any) -> object:
        require(isinstance(value, self.value_class))
        return value

    def written(self, name: str, value: Any) -> Mapping[str, object]:
        return {}

    def difference(self, name: str, one: Any, other: Any) -> Mapping[str, object]:
        return {}

    def cost(self, one: Any, other: Any, own: Tier) -> Tier | None:
        return own
