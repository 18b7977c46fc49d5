"""Columns: the description of each field of a table, given once, at the field of its dataclass.

    concentration: Annotated[float, Column(Number(at_least=0), Tier.LIGHT, "how narrow the light is")] = 0.0

A row of a table is a frozen dataclass that derives from `Row`, whose fields are checked at construction. What
else the columns determine is in `rows`; the kinds of columns are in `value_kinds`, `reference_kinds` and
`row_kinds`.

A key is the name of a column in a file. It is the name of the field, except that a nested row that is
`inline` has no key of its own: its keys are among those of the row that contains it.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Iterator, Mapping
from enum import IntEnum
from functools import partial
from typing import Any, ClassVar, Final, NamedTuple, TypeVar, get_type_hints

from autocolor.checks import shown
from autocolor.immutable import Immutable
from autocolor.scene.columns.bars import Bar
from autocolor.scene.columns.problems import REFUSED, Path, Problem, RowError

WORLD_UNITS: Final = "world units"
"""The unit of coordinates and lengths, whose usual range is that of the object; they have no bar."""


class Tier(IntEnum):
    """The cost of an edit of a column: what must be recomputed, in increasing order."""

    NOTHING = 0
    """Nothing."""
    ENTRIES = 1
    """Entries of the lookup table, but no words."""
    LEVELS = 2
    """The levels, and so the words."""
    MIX = 3
    """The weighted sum of the light planes."""
    LIGHT = 4
    """The planes of one light, or of all lights on one surface."""
    FRAME = 5
    """Everything."""


class Kind:
    """The kind of values in a column: how they are checked, changed, written and compared."""

    is_whole: ClassVar[bool] = False
    """Whether the values are whole numbers."""

    def rule(self) -> str:
        """The rule for a value, as part of a message: "must be true or false"."""
        raise NotImplementedError

    def accepts(self) -> str:
        """The type annotation of accepted values, as written in `changes.py`."""
        raise NotImplementedError

    def has_keys_inside(self) -> bool:
        """Whether keys of the containing row can refer to fields inside the value."""
        return False

    def keys(self, name: str, column: Column) -> Mapping[str, Column]:
        """The keys that a field of this name has in a file."""
        return {name: column}

    def held(self, value: object, path: Path, problems: list[Problem]) -> object:
        """The value converted for the row; REFUSED, with its problems appended, if it is invalid."""
        raise NotImplementedError

    def changed(self, present: object, table: Mapping[str, Any], path: Path, problems: list[Problem]) -> Any:
        """The value with some keys inside it changed; the table itself if the kind has no keys inside."""
        return table

    def written(self, name: str, value: Any) -> Mapping[str, object]:
        """The keys and plain values to write for a field of this name; None values are not written."""
        return {name: value}

    def difference(self, name: str, one: Any, other: Any) -> Mapping[str, object]:
        """The keys and values that change a field of this name from one value to another, neither None."""
        return {} if repr(one) == repr(other) else self.written(name, other)

    def bar(self) -> Bar | None:
        """The bar of the kind's own limits; None where it has no numbers, or not both limits."""
        return None

    def cost(self, one: Any, other: Any, own: Tier) -> Tier | None:
        """The cost of a change from one value to another, None for no change; `own` is the column's tier."""
        return None if one == other else own


@dataclasses.dataclass(frozen=True)
class Column:
    """One column: its kind, the cost of an edit, one line of help, and its unit.

    `bar` is its usual range and step, where the kind's own limits do not give them (see `bar_of`). `start` is
    what an absent number begins with when it is switched on.
    """

    kind: Kind
    tier: Tier
    help: str
    unit: str = ""
    bar: Bar | None = None
    start: float | None = None


def bar_of(column: Column) -> Bar | None:
    """The bar of a column: its usual range and its step; None if it has no numbers, or WORLD_UNITS.

    Whole numbers have whole steps.
    """
    return column.bar if column.bar is not None else column.kind.bar()


def on_bar(column: Column, value: float) -> float:
    """The nearest value on the bar of a column, an int if it holds whole numbers; itself without a bar."""
    bar = bar_of(column)
    if bar is None:
        return value
    return int(bar.rounded(value)) if column.kind.is_whole else bar.rounded(value)


class Row(Immutable):
    """A row of a table: a frozen dataclass whose fields are columns, checked at construction.

    `noun` is what messages call it, before its name if it has one. At most one of the fields in
    `alternatives` has a value; a change that sets one resets the others.
    """

    noun: ClassVar[str] = ""
    alternatives: ClassVar[tuple[str, ...]] = ()

    def __post_init__(self) -> None:
        check(self, fields_of(type(self)))

    def rules(self) -> Iterator[Problem]:
        """The rules between columns that the row breaks; invalid values are REFUSED."""
        return iter(())

    def __repr__(self) -> str:
        # What has its default goes without saying.
        values = vars(self)
        told = [
            f"{name}={values[name]!r}"
            for name, field in fields_of(type(self)).items()
            if field.default is None or field.default() != values[name]
        ]
        return f"{type(self).__name__}({', '.join(told)})"


SomeRow = TypeVar("SomeRow", bound=Row)


class Field(NamedTuple):
    """A field of a row class: its column, whether it may be None, and a function for its default, if any."""

    column: Column
    is_optional: bool
    default: Callable[[], object] | None


def fields_of(cls: type[Row]) -> Mapping[str, Field]:
    """The fields of a row class by name, in definition order."""
    found = _FIELDS.get(cls)
    if found is None:
        found = _FIELDS[cls] = _fields_of(cls)
    return found


_FIELDS: Final[dict[type[Row], Mapping[str, Field]]] = {}


def _fields_of(cls: type[Row]) -> Mapping[str, Field]:
    hints = get_type_hints(cls, include_extras=True)
    fields = {}
    for field in dataclasses.fields(cls):  # type: ignore[arg-type]
        (column,) = (each for each in hints[field.name].__metadata__ if isinstance(each, Column))
        default: Callable[[], object] | None = partial(_itself, field.default)
        if field.default_factory is not dataclasses.MISSING:
            default = field.default_factory
        elif field.default is dataclasses.MISSING:
            default = None
        fields[field.name] = Field(column, field.default is None, default)
    return fields


def _itself(value: object) -> object:
    return value


class Key(NamedTuple):
    """A key of a row in a file: its column, the field that contains it, whether it is inside the value."""

    column: Column
    field: str
    is_inside: bool


def keys_of(cls: type[Row]) -> Mapping[str, Key]:
    """The keys of a row class in a file, in the order of its fields."""
    found = _KEYS.get(cls)
    if found is None:
        found = _KEYS[cls] = {
            key: Key(column, name, field.column.kind.has_keys_inside())
            for name, field in fields_of(cls).items()
            for key, column in field.column.kind.keys(name, field.column).items()
        }
    return found


_KEYS: Final[dict[type[Row], Mapping[str, Key]]] = {}


def row_label(row: Row) -> str:
    """The noun and the name of a row, as in "light 'key'"."""
    name = vars(row).get("name")
    return f"{row.noun} {shown(name)}" if row.noun and isinstance(name, str) and name else row.noun


def check(row: Row, fields: Mapping[str, Field]) -> None:
    """Check and convert some fields of a row in place, then check the rules between its columns.

    Raises RowError with every problem.
    """
    problems: list[Problem] = []
    values = vars(row)
    is_refused = False
    for name, (column, is_optional, _) in fields.items():
        value = values[name]
        if value is not REFUSED and not (is_optional and value is None):
            values[name] = value = column.kind.held(value, (name,), problems)
        is_refused |= value is REFUSED
    if type(row).rules is not Row.rules:
        problems.extend(row.rules())
    if problems or is_refused:
        raise RowError(problems, row_label(row))
