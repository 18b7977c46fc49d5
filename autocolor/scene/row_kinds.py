"""The kinds of columns whose values are rows, and of columns that refer to rows by name; and row classes.

A row inside a row is `Nested`, or `OneRowOf` several classes. A table of rows is a `RowList` or, inside
another row, `NamedRows`. A column refers to rows of other tables by a `Reference`, `References` or
`RangesByName`. `table_row` makes a row class.
"""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import (
    TYPE_CHECKING,
    Any,
    Final,
    NoReturn,
    Self,
    SupportsIndex,
    TypeVar,
    Unpack,
    dataclass_transform,
    get_type_hints,
    overload,
)

from autocolor.arrays import LARGEST_SINGLE
from autocolor.checks import closest, either, listed, nearest, shown
from autocolor.errors import UsageError
from autocolor.scene.columns import (
    REFUSED,
    About,
    Column,
    Default,
    Kind,
    Path,
    Problem,
    Row,
    RowError,
    RowKey,
    SomeRow,
    Value,
    cached_by_class,
    column_of,
    difference,
    from_plain,
    keys_of,
    refused,
    replaced,
    to_plain,
)
from autocolor.scene.kinds import (
    Number,
    Text,
    boolean,
    color,
    coordinates,
    number,
    one_of,
    require,
    text,
    vector,
)

MOST_ROWS: Final = 1_000_000
"""Limit: rows of a table."""


@dataclass(frozen=True)
class Nested(Kind[SomeRow]):
    """A row of another class. With `inline`, files write its keys among the keys of the containing row."""

    row_class: type[SomeRow]
    inline: bool = False

    def rule(self) -> str:
        name, keys = self.row_class.__name__, listed(keys_of(self.row_class))
        return f"must be a {name}" if self.inline else f"must be a table of {keys}"

    def keys(self, name: str, column: Column) -> Mapping[str, Column]:
        if not self.inline:
            return {name: column}
        return {key: inner.column for key, inner in keys_of(self.row_class).items()}

    def validated(self, value: object, path: Path, problems: list[Problem]) -> Any:
        if isinstance(value, self.row_class):
            return value
        if isinstance(value, Mapping):
            return _inside(path[:-1] if self.inline else path, problems, from_plain, self.row_class, value)
        return refused(problems, path, f"{self.rule()}, not {shown(value)}")

    def replaced(self, present: object, table: Mapping[str, Any], path: Path, problems: list[Problem]) -> Any:
        if isinstance(present, self.row_class):
            return _inside(path[:-1] if self.inline else path, problems, replaced, present, table)
        # Make a new row in place of an absent or an invalid row; `validated` refuses any other value later.
        is_new = present is REFUSED or (present is None and not self.inline)
        return self.validated(table, path, problems) if is_new else present

    def to_plain(self, name: str, value: Any) -> Mapping[str, object]:
        return to_plain(value) if self.inline else {name: to_plain(value)}

    def difference(self, name: str, one: Any, other: Any) -> Mapping[str, object]:
        changes = difference(one, other)
        return changes if self.inline or not changes else {name: changes}


def nested(
    row_class: type[SomeRow], *, inline: bool = False, **about: Unpack[About[Default]]
) -> SomeRow | Default:
    """A field of rows of another class; see `Nested`."""
    return column_of(Nested(row_class, inline), **about)


@dataclass(frozen=True, eq=False)
class OneRowOf(Kind[SomeRow]):
    """A row of one of several classes, chosen by name; files write the name and the keys inline."""

    classes: Mapping[str, type[SomeRow]]

    def rule(self) -> str:
        return f"must be {either(self.classes)}"

    def name_of(self, value: Row) -> str:
        """The name of the class of a value."""
        return next(name for name, cls in self.classes.items() if type(value) is cls)

    def keys(self, name: str, column: Column) -> Mapping[str, Column]:
        inner = {key: at.column for cls in self.classes.values() for key, at in keys_of(cls).items()}
        return {name: column, **inner}

    def accepted(self, value: Any) -> Any:
        require(type(value) in self.classes.values() or (isinstance(value, str) and value in self.classes))
        return self.classes[value]() if isinstance(value, str) else value

    def advice(self, value: object) -> str:
        return closest(value, self.classes) if isinstance(value, str) else ""

    def replaced(self, present: object, table: Mapping[str, Any], path: Path, problems: list[Problem]) -> Any:
        name, value = path[-1], self.validated(present, path, problems)
        if value is REFUSED:
            return value
        keys = dict(table)
        for key in table:
            owners = [other for other, cls in self.classes.items() if key in keys_of(cls)]
            if owners and self.name_of(value) not in owners:
                names = " or ".join(map(repr, owners))
                rule = f"must go with {name} = {names}, not with {self.name_of(value)!r}"
                refused(problems, (*path[:-1], key), f"{rule}; leave it out, or change the {name}")
                del keys[key]
        return _inside(path[:-1], problems, replaced, value, keys)

    def to_plain(self, name: str, value: Any) -> Mapping[str, object]:
        return {name: self.name_of(value), **to_plain(value)}

    def difference(self, name: str, one: Any, other: Any) -> Mapping[str, object]:
        return difference(one, other) if type(one) is type(other) else self.to_plain(name, other)


RowOfTable = TypeVar("RowOfTable", bound=Row, covariant=True)


class TableRows(tuple[RowOfTable, ...]):
    """The rows of a table: a tuple whose rows have names, so that `scene.lights["key"]` is a row, too.

    A slice is a plain tuple. Raises UsageError, with the closest name, for a name that no row has.
    """

    __slots__ = ()

    if TYPE_CHECKING:
        # A row class with a field of this type accepts any rows for it.
        def __get__(self, row: object, cls: type) -> Self: ...
        def __set__(self, row: object, rows: Sequence[Row]) -> None: ...

    @overload
    def __getitem__(self, key: SupportsIndex | str) -> RowOfTable: ...
    @overload
    def __getitem__(self, key: slice) -> tuple[RowOfTable, ...]: ...
    def __getitem__(self, key: SupportsIndex | slice | str) -> RowOfTable | tuple[RowOfTable, ...]:
        # Protocols are checked slowly, so names and numbers come first.
        if isinstance(key, str) or not isinstance(key, (int, slice, SupportsIndex)):
            key = place_named(self, key)
        return super().__getitem__(key)

    if not TYPE_CHECKING:

        def __getattr__(self, name: str) -> NoReturn:
            advice = f"; write it as [{name!r}]" if name in self else ""
            raise AttributeError(f"a table of rows has no attribute {name!r}{advice}")

    def __contains__(self, key: object) -> bool:
        return (
            any(vars(row)["name"] == key for row in self)
            if isinstance(key, str)
            else super().__contains__(key)
        )


def place_named(rows: Sequence[Row], name: str, noun: str = "row") -> int:
    """The index of the row of that name. Raises UsageError, with the closest name, if no row has it.

    `noun` is that of a table without rows.
    """
    names = [vars(row)["name"] for row in rows]
    if name in names:
        return names.index(name)
    if not rows:
        raise UsageError(f"there is no {noun} {shown(name)}; the table has no rows")
    raise UsageError(f"there is no {rows[0].noun} {shown(name)}{nearest(name, names)}")


@dataclass(frozen=True)
class RowList(Kind[TableRows[SomeRow]]):
    """A table: rows of a class with unique names; scene files write them `by_name` or as an array."""

    row_class: type[SomeRow]
    by_name: bool = False

    def rule(self) -> str:
        return f"must be a list of {self.row_class.__name__} rows"

    def validated(self, value: object, path: Path, problems: list[Problem]) -> Any:
        if not isinstance(value, (list, tuple)) or len(value) > MOST_ROWS:
            return refused(problems, path, f"{self.rule()}, not {shown(value)}")
        nested = Nested(self.row_class)
        rows = TableRows(
            row if type(row) is self.row_class else nested.validated(row, (*path, place), problems)
            for place, row in enumerate(value)
        )
        first: dict[str, int] = {}
        for place, row in enumerate(value):
            name = row.get("name") if isinstance(row, Mapping) else getattr(row, "name", None)
            if isinstance(name, str) and first.setdefault(name, place) != place:
                text = f"must be unique, not the same as {path[-1]}[{first[name] + 1}]; rename it"
                refused(problems, (*path, place, "name"), text)
        return REFUSED if any(row is REFUSED for row in rows) else rows

    def to_plain(self, name: str, value: Any) -> Mapping[str, object]:
        return {name: [to_plain(row) for row in value]}


def _inside(path: Path, problems: list[Problem], make: Callable[..., Row], *arguments: object) -> Any:
    """The row that a function makes; REFUSED, with its problems appended under a path, if it is invalid."""
    try:
        return make(*arguments)
    except RowError as error:
        problems.extend(problem.under(path) for problem in error.row_problems)
        return REFUSED


# References to rows of other tables, by name.


@dataclass(frozen=True)
class Referring(Kind[Value]):
    """References to rows of another table, by name, or by a `word`. The scene checks that the rows exist."""

    table: str
    word: str = ""

    @property
    def words(self) -> tuple[str, ...]:
        """The words that are valid instead of a name."""
        return (self.word,) if self.word else ()

    def names_in(self, value: Any) -> Sequence[str]:
        """The names that a value refers to."""
        names = (value,) if isinstance(value, str) else value
        return [name for name in names if name != self.word]


@dataclass(frozen=True)
class Reference(Referring[str]):
    """The name of a row of another table, or `word`, if that is not empty."""

    def rule(self) -> str:
        noun = self.table.removesuffix("s")
        return f"must be {self.word!r} or the name of a {noun}" if self.word else Text().rule()

    def accepted(self, value: Any) -> str:
        return Text().accepted(value)


@dataclass(frozen=True)
class References(Referring[tuple[str, ...]]):
    """A list of names of rows of another table."""

    def rule(self) -> str:
        return "must be a list of names"

    def accepted(self, value: Any) -> tuple[str, ...]:
        require(isinstance(value, (list, tuple)))
        return tuple(Text().accepted(name) for name in value)


PERCENTAGE: Final = re.compile(r"([0-9]{2,3}(?:\.[0-9]{1,2})?) ?%")
LEAST_PERCENT: Final = 50
"""Limit: the lowest percentage. A lower percentage would show most of a picture at one level."""

RangesOrWord = str | tuple[tuple[str, tuple[float, float]], ...]


@dataclass(frozen=True)
class RangesByName(Referring[RangesOrWord]):
    """The word `none`, a percentage, or ranges [minimum, maximum] by the names of rows.

    The value is the word, the percentage as text such as "99.5 %", or pairs (name, range). The name `word`
    stands for all further rows. 0 <= minimum < maximum.
    """

    none: str = "none"

    def rule(self) -> str:
        return (
            f"must be {self.none!r}, a percentage such as '99.5 %' from {LEAST_PERCENT} to 100, or a table of"
            f" ranges [minimum, maximum] from 0 to 3.4e38 by the names of {self.table} and {self.word!r}"
        )

    def accepted(self, value: Any) -> RangesOrWord:
        if isinstance(value, str):
            percent = PERCENTAGE.fullmatch(value)
            if percent is None:
                require(value == self.none)
                return value
            require(LEAST_PERCENT <= float(percent[1]) <= 100)
            return f"{float(percent[1]):g} %"
        pairs = list(value.items()) if isinstance(value, Mapping) else list(value)
        intensity = Number(at_least=0, at_most=LARGEST_SINGLE).accepted
        ranges = tuple(
            (Text().accepted(name), (intensity(minimum), intensity(maximum)))
            for name, (minimum, maximum) in pairs
        )
        require(len(ranges) > 0 and len(dict(ranges)) == len(ranges))
        require(all(low < high for _, (low, high) in ranges))
        return ranges

    def names_in(self, value: Any) -> Sequence[str]:
        return () if isinstance(value, str) else super().names_in(name for name, _ in value)

    def to_plain(self, name: str, value: Any) -> Mapping[str, object]:
        return {name: value if isinstance(value, str) else {key: list(limits) for key, limits in value}}


@cached_by_class
def references_of(cls: type[Row]) -> Mapping[str, RowKey]:
    """The keys of a row class whose columns refer to rows of other tables."""
    return {key: at for key, at in keys_of(cls).items() if isinstance(at.column.kind, Referring)}


# Rows by name inside another row.

MOST_NAMED_ROWS: Final = 64
"""Limit: rows inside another row. A screen hardly has room for more."""

FEW: Final = f"must be at most {MOST_NAMED_ROWS}, not {{:,}}; leave some out"


@dataclass(frozen=True)
class NamedRows(Kind[tuple[SomeRow, ...]]):
    """Rows of a class with unique names, inside another row, sorted by name.

    Files and changes write a table of tables by name. A change replaces keys of an existing row, which the
    key `name` renames; an unknown name adds a row; None removes a row.
    """

    row_class: type[SomeRow]

    def rule(self) -> str:
        return f"must be a table of {self.row_class.noun}s by name"

    def validated(self, value: object, path: Path, problems: list[Problem]) -> Any:
        if isinstance(value, Mapping):
            return self.replaced((), value, path, problems)
        if not isinstance(value, (list, tuple)) or not all(type(row) is self.row_class for row in value):
            return refused(problems, path, f"{self.rule()}, not {shown(value)}")
        if len(value) > MOST_NAMED_ROWS:
            return refused(problems, path, FEW.format(len(value)))
        rows: list[Any] = sorted(value, key=lambda row: row.name)
        repeated = dict.fromkeys(one.name for one, other in pairwise(rows) if one.name == other.name)
        for name in repeated:
            refused(problems, (*path, name), "must be unique, not repeated; rename one of them")
        return REFUSED if repeated else tuple(rows)

    def replaced(self, present: object, table: Mapping[str, Any], path: Path, problems: list[Problem]) -> Any:
        rows = {row.name: row for row in present} if isinstance(present, tuple) else {}
        # A change may replace every row: remove MOST_NAMED_ROWS, and add as many.
        if len(table) > 2 * MOST_NAMED_ROWS:
            return refused(problems, path, FEW.format(len(table)))
        for name, given in table.items():
            rows[name] = self._changed(rows, name, given, path, problems)
        if any(row is REFUSED for row in rows.values()):
            return REFUSED
        return self.validated([row for row in rows.values() if row is not None], path, problems)

    def _changed(
        self, rows: Mapping[str, Any], name: object, given: object, path: Path, problems: list[Problem]
    ) -> Any:
        """The row of a name after a change, which gives some of its keys, another row, or None."""
        if not isinstance(name, str) or not name:
            text = f"{self.rule()}, not by {shown(name)}; name it by at least one character"
            return refused(problems, path, text)
        path, nested = (*path, name), Nested(self.row_class)
        if given is None and rows.get(name) is None:
            advice = nearest(name, rows) or "; leave it out"
            return refused(problems, path, f"there is no {self.row_class.noun} of this name{advice}")
        if given is None:
            return None
        if name in rows and isinstance(given, Mapping):
            return nested.replaced(rows[name], given, path, problems)
        if not isinstance(given, (Mapping, self.row_class)):
            keys = [key for key in keys_of(self.row_class) if key != "name"]
            return refused(problems, path, f"must be a table of {listed(keys)}, not {shown(given)}")
        new = {"name": name, **(given if isinstance(given, Mapping) else vars(given))}
        if new["name"] != name:
            text = f"must be the name of its table, {shown(name)}, not {shown(new['name'])}; leave it out"
            return refused(problems, (*path, "name"), text)
        return nested.validated(new, path, problems)

    def to_plain(self, name: str, value: Any) -> Mapping[str, object]:
        return {name: {row.name: without_name(to_plain(row)) for row in value} or None}

    def difference(self, name: str, one: Any, other: Any) -> Mapping[str, object]:
        before, after = ({row.name: row for row in rows} for rows in (one, other))
        changes: dict[str, object] = {key: None for key in before if key not in after}
        for key, row in after.items():
            if key not in before:
                changes[key] = without_name(to_plain(row))
            elif inner := difference(before[key], row):
                changes[key] = inner
        return {name: changes} if changes else {}


def without_name(keys: Mapping[str, object]) -> dict[str, object]:
    """The keys of a row without `name`, which is the key of the row's table."""
    return {key: value for key, value in keys.items() if key != "name"}


def _refuse_assignment(row: Row, name: str, value: object) -> NoReturn:
    thing = type(row).__name__
    raise dataclasses.FrozenInstanceError(
        f"a {thing} cannot be changed; use replace({name}=...), which returns another {thing}"
    )


@dataclass_transform(
    frozen_default=True,
    field_specifiers=(column_of, number, boolean, text, coordinates, vector, one_of, color, nested),
)
def table_row(cls: type[SomeRow]) -> type[SomeRow]:
    """The class as a frozen dataclass of columns, whose signature shows the types of their values.

    The fields are made by `column_of`, or by a function for one kind, such as `number`.
    """
    made = dataclasses.dataclass(frozen=True, repr=False)(cls)
    if hasattr(made, "replace"):
        made.__setattr__ = _refuse_assignment  # type: ignore[method-assign,assignment]
    made.__init__.__annotations__ = {**get_type_hints(made.__init__), "return": None}
    return made
