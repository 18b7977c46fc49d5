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
import math
import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from enum import IntEnum
from functools import partial
from typing import Any, ClassVar, Final, NamedTuple, TypeVar, get_type_hints

from autocolor.checks import listed, nearest, shown
from autocolor.errors import InputError
from autocolor.immutable import Immutable

# -------------------- bars
# Bars: the usual range of a number, and the steps in which it is set by pointing.
#
# A value may lie beyond its bar: the limits of a column are those of its kind.

STEPS: Final = 100
"""Assumed: a bar has at least as many steps, so that a change by one is small."""

DIGITS: Final = 12
"""Digits of a rounded value: enough for any step, and few enough to write 0.3 as 0.3."""


class Bar(NamedTuple):
    """A usual range, `low` to `high`, and a step; values on it are multiples of the step, or its ends."""

    low: float
    high: float
    step: float

    def rounded(self, value: float) -> float:
        """The nearest value on the bar; halves are rounded up, and values beyond an end become that end.

        >>> Bar(0, 2, 0.01).rounded(0.2987), Bar(1, 90, 1).rounded(0)
        (0.3, 1.0)
        """
        within = min(max(value, self.low), self.high)
        on_step = float(f"{math.floor(within / self.step + 0.5) * self.step:.{DIGITS}g}")
        return float(min(max(on_step, self.low), self.high))

    def fraction(self, value: float) -> float:
        """How far along the bar a value is, 0 to 1."""
        return (min(max(value, self.low), self.high) - self.low) / (self.high - self.low)

    def at(self, fraction: float) -> float:
        """The value on the bar at a fraction of its length, 0 to 1; others are beyond the ends.

        >>> Bar(-180, 180, 1).at(0.5)
        0.0
        """
        return self.rounded(self.low + fraction * (self.high - self.low))


def bar_within(low: float, high: float) -> Bar:
    """The bar of a range, low < high, with at least STEPS steps of 1, 2 or 5 times a power of ten.

    >>> bar_within(0, 180)
    Bar(low=0, high=180, step=1.0)
    """
    most = (high - low) / STEPS
    power = 10.0 ** math.floor(math.log10(most))
    # A step may exceed its bound by no more than rounding: 0.01 is a hundredth of 1.
    step = max((each * power for each in (1, 2, 5, 10) if each * power <= most * (1 + 1e-9)), default=power)
    return Bar(low, high, float(f"{step:.{DIGITS}g}"))


# -------------------- problems
# The problems of rows: what is wrong where, as a message, and the placeholder for an invalid value.

Path = tuple[str | int, ...]
"""The keys and row numbers that lead from a row to a value inside it."""

BARE: Final = re.compile(r"[\w-]{1,100}")
"""Names in a path that need no quotes."""


class Problem(NamedTuple):
    """A problem of the value at a path; the path () is the row as a whole.

    `text` is the end of a message. If `names_key`, it already contains the last key of the path.
    """

    path: Path
    text: str
    names_key: bool = False

    @property
    def sentence(self) -> str:
        """The message: the path and the text.

        >>> Problem(("flaps", "z", "on"), "must be true or false, not 3").sentence
        'flaps.z.on must be true or false, not 3'
        >>> Problem(("half_spaces", "left door", "on"), "must be true or false, not 3").sentence
        "half_spaces.'left door'.on must be true or false, not 3"
        """
        key = ""
        for part in self.path[:-1] if self.names_key else self.path:
            name = part if isinstance(part, str) and BARE.fullmatch(part) else shown(part)
            key += f"[{part + 1}]" if isinstance(part, int) else f".{name}" if key else name
        return f"{key}{'' if self.text.startswith('must ') else ':'} {self.text}" if key else self.text

    def under(self, path: Path) -> Problem:
        """The same problem with a path that starts at a row around it."""
        return self._replace(path=(*path, *self.path))


class RowError(InputError):
    """An invalid row.

    `found` are its problems; `row` is its noun and name, as in "light 'key'", or empty.
    """

    def __init__(self, found: Iterable[Problem], row: str = "") -> None:
        self.found = tuple(found)
        self.row = row
        super().__init__(f"{row}: {each.sentence}" if row else each.sentence for each in self.found)

    def __reduce__(self) -> tuple[type[RowError], tuple[object, ...]]:
        return RowError, (self.found, self.row)


class Refused:
    """The placeholder for an invalid value while the rules between columns are checked.

    It is not None, and all its comparisons are false, so that it breaks no further rule.
    """

    def __eq__(self, other: object) -> bool:
        return False

    def __gt__(self, other: object) -> bool:
        return False

    __ge__ = __lt__ = __le__ = __gt__
    __hash__ = object.__hash__


REFUSED: Final[Any] = Refused()


def unknown(name: object, known: Iterable[str]) -> Problem:
    """The problem of an unknown key, with the closest known one."""
    text = name if isinstance(name, str) else shown(name)
    clause = nearest(text, known)
    return Problem((text,), f"there is no {shown(name)}{clause}", names_key=True)


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


# -------------------- rows
# What columns determine for rows: changes of fields, plain values as in files, and the cost of an edit.

MOST_KEYS: Final = 64
"""Assumed: an upper bound on the keys of any table."""

PLAIN_TYPES: Final = frozenset((float, int, bool, str, tuple, list))
"""Types of most values, none of them a table; asking for `Mapping` takes several times as long."""


def changed(row: SomeRow, changes: Mapping[str, Any]) -> SomeRow:
    """The row with some fields or keys changed; a table for a row inside it changes that row's keys.

    Raises RowError with every problem.

    Measured: with cold caches each call costs more than what it computes, so this one makes few.
    """
    fields = fields_of(type(row))
    problems: list[Problem] = []
    values, inside = _values_by_field(row, changes, problems)
    # Copy the columns only: cached properties may depend on them.
    copy = object.__new__(type(row))
    present, fresh = vars(row), vars(copy)
    fresh.update(present if len(present) == len(fields) else {name: present[name] for name in fields})
    fresh.update(values)
    for name, table in inside.items():
        fresh[name] = fields[name].column.kind.changed(fresh[name], table, (name,), problems)
        if not isinstance(fresh[name], Row):
            values[name] = fresh[name]
    if values or type(row).rules is not Row.rules:
        try:
            check(copy, {name: fields[name] for name in values})
        except RowError as error:
            problems.extend(error.found)
    if problems:
        raise RowError(problems, row_label(row))
    return copy


def with_values(row: SomeRow, values: Mapping[str, object]) -> SomeRow:
    """The row with other values in some fields, which were checked already.

    Cached properties are copied, too: none may depend on these fields.
    """
    copy = object.__new__(type(row))
    fresh = vars(copy)
    fresh.update(vars(row))
    fresh.update(values)
    return copy


def _values_by_field(
    row: Row, changes: Mapping[str, Any], problems: list[Problem]
) -> tuple[dict[str, Any], dict[str, dict[str, Any]]]:
    """The new values of fields, and the tables of keys for the rows inside others.

    Problems are appended, and unknown names left out.
    """
    if len(changes) > MOST_KEYS:
        text = f"it must be a table of at most {MOST_KEYS} keys, not {len(changes):,}"
        raise RowError([Problem((), text)], row_label(row))
    fields, keys = fields_of(type(row)), keys_of(type(row))
    values: dict[str, Any] = {}
    inside: dict[str, dict[str, Any]] = {}
    for name, value in changes.items():
        key = keys.get(name)
        if key is not None and key.is_inside:
            inside.setdefault(key.field, {})[name] = value
        elif name not in fields:
            problems.append(unknown(name, {**fields, **keys}))
        elif type(value) not in PLAIN_TYPES and isinstance(value, Mapping):
            inside.setdefault(name, {}).update(value)
        else:
            values[name] = value
    if row.alternatives and any(values.get(name) is not None for name in row.alternatives):
        values = {**dict.fromkeys(row.alternatives), **values}
    return values, inside


def made(cls: type[SomeRow], table: object) -> SomeRow:
    """The row of a class for a table of keys and plain values; omitted keys have their defaults.

    Raises RowError with every problem.
    """
    if not isinstance(table, Mapping):
        raise RowError([Problem((), f"must be a table of {listed(keys_of(cls))}, not {shown(table)}")])
    fields = fields_of(cls)
    row = object.__new__(cls)
    vars(row).update(
        {name: REFUSED if field.default is None else field.default() for name, field in fields.items()}
    )
    problems: list[Problem] = []
    values, inside = _values_by_field(row, table, problems)
    problems.extend(
        Problem((name,), f"{name} {field.column.kind.rule()}, not missing; add it", names_key=True)
        for name, field in fields.items()
        if field.default is None and name not in values and name not in inside
    )
    made_row = vars(row)
    made_row.update(values)
    for name, keys in inside.items():
        made_row[name] = fields[name].column.kind.changed(made_row[name], keys, (name,), problems)
    try:
        check(row, fields)
    except RowError as error:
        problems.extend(error.found)
    if problems:
        raise RowError(problems, row_label(row))
    return row


def plain(row: Row) -> dict[str, object]:
    """The row as keys and plain values, which TOML and JSON can hold; None values are omitted."""
    values = vars(row)
    return {
        key: value
        for name, field in fields_of(type(row)).items()
        if values[name] is not None
        for key, value in field.column.kind.written(name, values[name]).items()
        if value is not None
    }


def difference(one: Row, other: Row) -> dict[str, object]:
    """The keys and plain values by which `changed` makes one row equal to another of its class.

    A value that is taken away is None; an infinite one is written as it is. Meshes are left out.
    """
    ones, others = vars(one), vars(other)
    told: dict[str, object] = {}
    for name, field in fields_of(type(one)).items():
        before, after, kind = ones[name], others[name], field.column.kind
        if before is after:
            continue
        if after is None:
            told[name] = None
        elif before is None:
            told.update(kind.written(name, after))
        else:
            told.update(kind.difference(name, before, after))
    return told


def cost(one: Row, other: Row, own: Tier = Tier.FRAME) -> Tier | None:
    """The cost of an edit from one row to another: the largest of its columns; None if all are equal.

    For rows of different classes it is `own`.
    """
    if type(one) is not type(other):
        return own
    ones, others = vars(one), vars(other)
    most: Tier | None = None
    for name, (column, _, _) in fields_of(type(one)).items():
        if ones[name] is not others[name]:
            costs = column.kind.cost(ones[name], others[name], column.tier)
            if costs is not None and (most is None or costs > most):
                most = costs
    return most
