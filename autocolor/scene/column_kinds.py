"""The kinds of columns: numbers, switches, strings, colors, vectors, choices, curves, references, rows."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any, Final

import numpy as np

from autocolor.checks import listed, nearest, shown
from autocolor.scene.columns import (
    REFUSED,
    Column,
    Kind,
    Path,
    Problem,
    Row,
    RowError,
    Tier,
    changed,
    cost,
    fields_of,
    keys_of,
    made,
    plain,
)

LARGEST_PLACE: Final = 1e36
"""Assumed: leaves room for the eye and the lights around the largest object."""

MOST_ROWS: Final = 1_000_000

NO_NUMBERS: Final = (bool, np.bool_, str, bytes)
"""Types that Python converts to numbers, but that are not accepted as numbers."""


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


def _require(condition: bool) -> None:
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
        if number != self.endless and not (is_within and math.isfinite(number)):
            raise ValueError
        return number

    def written(self, name: str, value: float) -> Mapping[str, object]:
        return {name: None if value == self.endless else value}


@dataclass(frozen=True)
class Whole(Leaf):
    """An integer of at least `at_least`."""

    at_least: int

    def accepts(self) -> str:
        return "int"

    def rule(self) -> str:
        return f"must be a whole number of at least {self.at_least}"

    def accepted(self, value: Any) -> int:
        _require(isinstance(value, (int, np.integer)) and not isinstance(value, bool))
        number = int(value)
        _require(number >= self.at_least)
        return number


@dataclass(frozen=True)
class Switch(Leaf):
    """A boolean."""

    def rule(self) -> str:
        return "must be true or false"

    def accepts(self) -> str:
        return "bool"

    def accepted(self, value: Any) -> bool:
        _require(isinstance(value, (bool, np.bool_)))
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
        _require(isinstance(value, str) and (value != "" or self.may_be_empty))
        text: str = value
        return text


@dataclass(frozen=True)
class ColorKind(Leaf):
    """A color: red, green and blue from 0 to 255, written as "#rrggbb"."""

    def rule(self) -> str:
        return 'must be "#rrggbb" or three whole numbers from 0 to 255'

    def accepts(self) -> str:
        return "str | Sequence[int]"

    def accepted(self, value: Any) -> tuple[int, int, int]:
        if isinstance(value, str):
            _require(len(value) == 7 and value[0] == "#")
            # fromhex skips spaces, but only six digits give three bytes.
            red, green, blue = bytes.fromhex(value[1:])
            return red, green, blue
        given = list(value)
        parts = [int(part) for part in given if not isinstance(part, NO_NUMBERS)]
        _require(parts == given and len(parts) == 3 and min(parts) >= 0 and max(parts) <= 255)
        return parts[0], parts[1], parts[2]

    def written(self, name: str, value: Any) -> Mapping[str, object]:
        return {name: "#{:02x}{:02x}{:02x}".format(*value)}


@dataclass(frozen=True)
class VectorKind(Leaf):
    """A point or a direction: three finite numbers; with `has_length`, not all zero."""

    has_length: bool = False

    def rule(self) -> str:
        return "must be three finite numbers of at most 1e36"

    def accepts(self) -> str:
        return "Sequence[float]"

    def accepted(self, value: Any) -> tuple[float, float, float]:
        given = list(value)
        _require(len(given) == 3 and not any(isinstance(component, NO_NUMBERS) for component in given))
        x, y, z = (float(component) for component in given)
        _require(all(abs(component) <= LARGEST_PLACE for component in (x, y, z)))
        return x, y, z

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
        *others, last = map(repr, self.names)
        return f"must be {', '.join(others)} or {last}" if others else f"must be {last}"

    def accepts(self) -> str:
        return f"Literal[{', '.join(map(json.dumps, self.names))}]"

    def accepted(self, value: Any) -> str:
        _require(isinstance(value, str) and value in self.names)
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
            _require(value in self.names)
            return value
        points = tuple((float(x), float(y)) for x, y in value)
        xs, ys = [x for x, _ in points], [y for _, y in points]
        _require(len(points) >= 2 and xs[0] == 0 and xs[-1] == 1 and all(a < b for a, b in pairwise(xs)))
        _require(ys == sorted(ys) and 0 <= ys[0] <= ys[-1] <= 1)
        return points

    def advice(self, value: object) -> str:
        return nearest(value, self.names) if isinstance(value, str) else ""


@dataclass(frozen=True)
class Referring(Leaf):
    """References to rows of another table by name; the scene checks that these rows exist."""

    table: str

    def names_in(self, value: Any) -> Sequence[str]:
        """The names that a value refers to."""
        raise NotImplementedError


@dataclass(frozen=True)
class Reference(Referring):
    """The name of a row of another table."""

    def rule(self) -> str:
        return Text().rule()

    def accepts(self) -> str:
        return "str"

    def accepted(self, value: Any) -> str:
        return Text().accepted(value)

    def names_in(self, value: Any) -> Sequence[str]:
        return (value,)


@dataclass(frozen=True)
class References(Referring):
    """A list of names of rows of another table."""

    def rule(self) -> str:
        return "must be a list of names"

    def accepts(self) -> str:
        return "Sequence[str]"

    def accepted(self, value: Any) -> tuple[str, ...]:
        _require(isinstance(value, (list, tuple)))
        return tuple(Text().accepted(name) for name in value)

    def names_in(self, value: Any) -> Sequence[str]:
        return tuple(value)


@dataclass(frozen=True)
class PointOrName(Referring):
    """A point, or the name of a row of another table that gives the point."""

    def rule(self) -> str:
        return "must be three finite numbers of at most 1e36, or a name"

    def accepts(self) -> str:
        return "str | Sequence[float]"

    def accepted(self, value: Any) -> str | tuple[float, float, float]:
        return Text().accepted(value) if isinstance(value, str) else VectorKind().accepted(value)

    def names_in(self, value: Any) -> Sequence[str]:
        return (value,) if isinstance(value, str) else ()


def references_of(cls: type[Row]) -> Mapping[str, Referring]:
    """The kinds of the fields of a row class that refer to rows of other tables, by field name."""
    found = _REFERENCES.get(cls)
    if found is None:
        kinds = {name: field.column.kind for name, field in fields_of(cls).items()}
        found = _REFERENCES[cls] = {name: kind for name, kind in kinds.items() if isinstance(kind, Referring)}
    return found


_REFERENCES: Final[dict[type[Row], Mapping[str, Referring]]] = {}


@dataclass(frozen=True, eq=False)
class Instance(Leaf):
    """An instance of a class, such as the mesh; it is compared by identity and not written."""

    value_class: type

    def rule(self) -> str:
        return f"must be a {self.value_class.__name__}"

    def accepts(self) -> str:
        return "object"

    def accepted(self, value: Any) -> object:
        _require(isinstance(value, self.value_class))
        return value

    def written(self, name: str, value: Any) -> Mapping[str, object]:
        return {}

    def cost(self, one: Any, other: Any, own: Tier) -> Tier | None:
        return own


@dataclass(frozen=True)
class Nested(Kind):
    """A row of another class; if it is `inline`, its keys are among those of the containing row."""

    row_class: type[Row]
    inline: bool = False

    def rule(self) -> str:
        return f"must be a table of {listed(keys_of(self.row_class))}"

    def accepts(self) -> str:
        return f"Row | {self.row_class.__name__}Changes"

    def has_keys_inside(self) -> bool:
        return self.inline

    def keys(self, name: str, column: Column) -> Mapping[str, Column]:
        if not self.inline:
            return {name: column}
        return {key: inner.column for key, inner in keys_of(self.row_class).items()}

    def held(self, value: object, path: Path, problems: list[Problem]) -> object:
        if isinstance(value, self.row_class):
            return value
        if isinstance(value, Mapping):
            try:
                return made(self.row_class, value)
            except RowError as error:
                return _refused(error, self._path(path), problems)
        rule = f"must be a {self.row_class.__name__}" if self.inline else self.rule()
        problems.append(Problem(path, f"{rule}, not {shown(value)}"))
        return REFUSED

    def changed(self, present: object, table: Mapping[str, Any], path: Path, problems: list[Problem]) -> Any:
        if isinstance(present, self.row_class):
            try:
                return changed(present, table)
            except RowError as error:
                return _refused(error, self._path(path), problems)
        # Make a new row if there was none or an invalid one; `held` will refuse anything else.
        return self.held(table, path, problems) if present in (None, REFUSED) else present

    def written(self, name: str, value: Any) -> Mapping[str, object]:
        return plain(value) if self.inline else {name: plain(value)}

    def cost(self, one: Any, other: Any, own: Tier) -> Tier | None:
        return own if one is None or other is None else cost(one, other)

    def _path(self, path: Path) -> Path:
        return path[:-1] if self.inline else path


@dataclass(frozen=True, eq=False)
class Variant(Kind):
    """A row of one of several classes, chosen by name; the name and its keys are in the containing row."""

    classes: Mapping[str, type[Row]]

    def has_keys_inside(self) -> bool:
        return True

    def accepts(self) -> str:
        return "str | Row"

    def rule(self) -> str:
        return f"must be {', '.join(map(repr, self.classes))}"

    def name_of(self, value: Row) -> str:
        """The name of the class of a value."""
        return next(name for name, cls in self.classes.items() if type(value) is cls)

    def keys(self, name: str, column: Column) -> Mapping[str, Column]:
        inner = {key: each.column for cls in self.classes.values() for key, each in keys_of(cls).items()}
        return {name: column, **inner}

    def held(self, value: object, path: Path, problems: list[Problem]) -> object:
        if isinstance(value, tuple(self.classes.values())):
            return value
        if isinstance(value, str) and value in self.classes:
            return self.classes[value]()
        clause = nearest(value, self.classes) if isinstance(value, str) else ""
        problems.append(Problem(path, f"{self.rule()}, not {shown(value)}{clause}"))
        return REFUSED

    def changed(self, present: object, table: Mapping[str, Any], path: Path, problems: list[Problem]) -> Any:
        name = path[-1]
        value = self.held(table[str(name)], path, problems) if name in table else present
        if not isinstance(value, Row):
            return value
        own = keys_of(type(value))
        keys = {key: inner for key, inner in table.items() if key != name}
        for key in [key for key in keys if key not in own]:
            having = [repr(other) for other, cls in self.classes.items() if key in keys_of(cls)]
            problems.append(
                Problem(
                    (*path[:-1], key),
                    f"must go with {name} = {' or '.join(having)}, not with {self.name_of(value)!r};"
                    " leave it out, or change the other",
                )
            )
            del keys[key]
        try:
            return changed(value, keys) if keys else value
        except RowError as error:
            return _refused(error, path[:-1], problems)

    def written(self, name: str, value: Any) -> Mapping[str, object]:
        return {name: self.name_of(value), **plain(value)}

    def cost(self, one: Any, other: Any, own: Tier) -> Tier | None:
        return cost(one, other, own)


@dataclass(frozen=True)
class Rows(Kind):
    """A table: rows of a class with unique names; scene files write them `by_name` or as an array."""

    row_class: type[Row]
    by_name: bool = False

    def accepts(self) -> str:
        return "Sequence[Row]"

    def rule(self) -> str:
        return f"must be a list of {self.row_class.__name__} rows"

    def held(self, value: object, path: Path, problems: list[Problem]) -> object:
        if not isinstance(value, (list, tuple)) or len(value) > MOST_ROWS:
            problems.append(Problem(path, f"{self.rule()}, not {shown(value)}"))
            return REFUSED
        nested = Nested(self.row_class)
        rows = tuple(
            row if type(row) is self.row_class else nested.held(row, (*path, number), problems)
            for number, row in enumerate(value)
        )
        first: dict[str, int] = {}
        for number, row in enumerate(value):
            name = row.get("name") if isinstance(row, Mapping) else getattr(row, "name", None)
            if isinstance(name, str) and first.setdefault(name, number) != number:
                text = f"must be unique, not the same as {path[-1]}[{first[name] + 1}]; rename it"
                problems.append(Problem((*path, number, "name"), text))
        return REFUSED if any(row is REFUSED for row in rows) else rows

    def written(self, name: str, value: Any) -> Mapping[str, object]:
        return {name: [plain(row) for row in value]}

    def cost(self, one: Any, other: Any, own: Tier) -> Tier | None:
        if len(one) != len(other):
            return own
        pairs = zip(one, other, strict=True)
        costs = [cost(a, b) for a, b in pairs if a is not b]
        return max((each for each in costs if each is not None), default=None)


def _refused(error: RowError, path: Path, problems: list[Problem]) -> Any:
    """Append the problems of a nested row, with its path before theirs, and return REFUSED."""
    problems.extend(problem.under(path) for problem in error.found)
    return REFUSED
