"""Columns: the description of each field of a table, given once, at the field of its row class.

    @table_row
    class Light(Row):
        noun: ClassVar[str] = "light"

        concentration: float = number(
            default=0.0, at_least=0, tier=Tier.LIGHT, help="How narrow the light is."
        )

The checks at construction, scene files, `--set`, `--json`, the table store, the journal, menus and documents
are made from it. A row of a table is a frozen dataclass that derives from `Row`; `row_kinds.table_row` makes
it. `replaced`, `from_plain`, `to_plain`, `difference` and `cost` work for any row. The `Kind` of a column
says which values it may have: see `kinds` for values without fields and `row_kinds` for rows inside rows.

A key is the name of a column in a file, and usually the name of its field. The field of an `inline` row has
no key: the file writes the keys of that row among the keys of the containing row.
"""

from __future__ import annotations

import dataclasses
import math
import re
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from enum import IntEnum
from functools import cache
from typing import Any, ClassVar, Final, Generic, NamedTuple, Required, Self, TypedDict, TypeVar, Unpack, cast

from autocolor.arrays import half_up
from autocolor.checks import closest, listed, nearest, shown
from autocolor.errors import InputError
from autocolor.immutable import Immutable

WORLD_UNITS: Final = "world units"
"""The unit of coordinates and lengths. Their usual range is the object's; they have no bar."""

MISSING: Final[Any] = dataclasses.MISSING
"""The default of a column that must be given."""

Value = TypeVar("Value")
Default = TypeVar("Default")


@dataclasses.dataclass(frozen=True)
class Column:
    """A column: its kind, the cost of an edit, a line of help, its unit and its default.

    `bar` is the usual range and the step, None for a column without a usual range. `start` is the first value
    of an absent number that is switched on.
    """

    kind: Kind[Any]
    tier: Tier
    help: str
    unit: str = ""
    bar: BarRange | None = None
    start: float | None = None
    default: Any = dataclasses.field(default_factory=lambda: MISSING)

    @property
    def is_optional(self) -> bool:
        """Whether the value may be None."""
        return self.default is None


class About(TypedDict, Generic[Default], total=False):
    """The keywords of any field: those of `Column` besides the kind."""

    tier: Required[Tier]
    help: Required[str]
    unit: str
    bar: BarRange
    start: float
    default: Default


def column_of(kind: Kind[Value], **about: Unpack[About[Default]]) -> Value | Default:
    """A field of a row class whose values are of a kind.

    Type checkers see the type of its values, with that of its default.
    """
    made = Column(kind, **about)
    return cast("Value | Default", dataclasses.field(default=made.default, metadata={"column": made}))


class Tier(IntEnum):
    """What an edit of a column costs, in increasing order; each computes again all that a lower one does."""

    NOTHING = 0
    ENTRIES = 1
    LEVELS = 2
    MIX = 3
    LIGHT = 4
    FRAME = 5


Path = tuple[str | int, ...]
"""The keys and row numbers that lead from a row to a value inside it."""


class Kind(Generic[Value]):
    """The kind of values in a column: how they are checked, replaced, written and compared.

    A kind of values without fields defines `rule` and `accepted`, and may define `advice`. A kind of rows
    defines `validated` instead of `accepted`. `names` are the words that it accepts, if any.
    """

    names: Collection[str] = ()

    def rule(self) -> str:
        """The rule for a value, as part of a message: "must be true or false"."""
        raise NotImplementedError

    def accepted(self, value: Any) -> Value:
        """The converted value. Raises TypeError, ValueError or OverflowError if it breaks the rule."""
        raise NotImplementedError

    def advice(self, value: object) -> str:
        """The end of the message about an invalid value, which says how to correct it."""
        return closest(value, self.names) if isinstance(value, str) else ""

    def validated(self, value: object, path: Path, problems: list[Problem]) -> Any:
        """The value converted for the row; REFUSED, with its problems appended, if it is invalid."""
        try:
            return self.accepted(value)
        except (TypeError, ValueError, OverflowError):
            return refused(problems, path, f"{self.rule()}, not {shown(value)}{self.advice(value)}")

    def keys(self, name: str, column: Column) -> Mapping[str, Column]:
        """The keys in a file, with their columns, for a field of this name."""
        return {name: column}

    def replaced(self, present: object, table: Mapping[str, Any], path: Path, problems: list[Problem]) -> Any:
        """The value with some keys inside it replaced; the table itself if the kind has no keys inside."""
        return table

    def to_plain(self, name: str, value: Any) -> Mapping[str, object]:
        """The keys and plain values to write for a field of this name; None values are not written."""
        return {name: value}

    def difference(self, name: str, one: Any, other: Any) -> Mapping[str, object]:
        """The keys and values that turn a field of this name from one value to another, neither None.

        An infinite value, which is not written, is given too: without the key it would not change.
        """
        plain = {} if repr(one) == repr(other) else self.to_plain(name, other)
        return {key: other if value is None else value for key, value in plain.items()}

    def cost(self, one: Any, other: Any, own: Tier) -> Tier | None:
        """The cost of an edit from one value to another; None if equal. `own` is the tier of the column.

        The cost of an edit of rows is that of their columns, unless the column of the rows costs nothing.
        """
        if own is not Tier.NOTHING and isinstance(one, Row):
            return cost(one, other, own)
        if isinstance(one, tuple) and isinstance(other, tuple) and len(one) == len(other):
            pairs = zip(one, other, strict=True)
            return _largest(self.cost(a, b, own) for a, b in pairs if a is not b)
        return None if one == other else own

    def between(self, one: Any, other: Any, share: float) -> Any:
        """The value at a share of the way from one value to another, neither None; 0 < `share` < 1.

        Numbers are interpolated linearly, whole numbers are rounded half up, and so are rows and the elements
        of tuples, if these have the same names. Assumed: any other value holds until the other is reached.
        """
        if isinstance(one, Row):
            return one.between(other, share)
        if isinstance(one, tuple) and _names_in(one) == _names_in(other):
            return type(one)(self.between(a, b, share) for a, b in zip(one, other, strict=True))
        if type(one) is type(other) is int:
            return half_up(one + (other - one) * share)
        if not (isinstance(one, float) and isinstance(other, float)) or one == other:
            return one
        # No bound of a flap is infinitely far away, so the bound holds.
        if math.isinf(one) or math.isinf(other):
            return one
        return min(max(one * (1 - share) + other * share, min(one, other)), max(one, other))


def _names_in(value: Any) -> Any:
    """The names of the rows in a tuple, and its texts, in place of its elements; None for those without."""
    if isinstance(value, tuple):
        return [_names_in(element) for element in value]
    return value if isinstance(value, str) else vars(value).get("name") if isinstance(value, Row) else None


class Row(Immutable):
    """A row of a table: a frozen dataclass whose fields are columns, checked at construction.

    Messages name a row by its `noun` and its name, if it has a name. At most one of the groups of fields in
    `alternatives` is in use: a change that sets a field of one group resets the fields of the other groups.
    The rules of the class refuse a row that uses two groups.
    """

    noun: ClassVar[str] = ""
    alternatives: ClassVar[tuple[tuple[str, ...], ...]] = ()

    def __post_init__(self) -> None:
        check(self, fields_of(type(self)), [])

    def _meant(self) -> Iterable[str]:
        """The names that may be meant: attributes, and fields of rows inside, such as "paint.blend"."""
        inside = ((key, row.field) for key, row in keys_of(type(self)).items() if row.field != key)
        return [*super()._meant(), *(f"{field}.{key}" for key, field in inside)]

    def complete(self) -> None:
        """Fill in what other columns need, in place, before the rules. A column may be REFUSED."""

    def rules(self) -> Iterator[Problem]:
        """The problems of rules between columns. A column with an invalid value is REFUSED."""
        return iter(())

    def between(self, other: Any, share: float) -> Self:
        """The row at a share of the way to another row, unchecked; 0 < `share` < 1.

        The kind of a column interpolates its values. A column that is absent in one of the rows holds, as do
        alternatives of which the rows use different groups, and a row of another class.
        """
        if self is other or type(self) is not type(other):
            return self
        ones, others = vars(self), vars(other)
        copy = object.__new__(type(self))
        has_same_groups = not self.alternatives or reset_fields(self) == reset_fields(other)
        held = () if has_same_groups else {name for group in self.alternatives for name in group}
        for name, column in fields_of(type(self)).items():
            a, b = ones[name], others[name]
            holds = a is b or a is None or b is None or name in held
            vars(copy)[name] = a if holds else column.kind.between(a, b, share)
        return copy

    def __repr__(self) -> str:
        # Leave out fields that have their defaults.
        columns, values = fields_of(type(self)), vars(self)
        given = [f"{name}={values[name]!r}" for name in columns if columns[name].default != values[name]]
        return f"{type(self).__name__}({', '.join(given)})"


SomeRow = TypeVar("SomeRow", bound=Row)
Result = TypeVar("Result")


def cached_by_class(function: Callable[[type[Row]], Result]) -> Callable[[type[Row]], Result]:
    """The function with its results cached. A type checker does not accept row classes as hashable."""
    return cast(Callable[[type[Row]], Result], cache(function))


@cached_by_class
def fields_of(cls: type[Row]) -> Mapping[str, Column]:
    """The columns of a row class by the names of their fields, in definition order."""
    return {field.name: field.metadata["column"] for field in dataclasses.fields(cls)}  # type: ignore[arg-type]


class RowKey(NamedTuple):
    """A key of a row in a file: its column and its field, which has another name if the key is inside it."""

    column: Column
    field: str


@cached_by_class
def keys_of(cls: type[Row]) -> Mapping[str, RowKey]:
    """The keys of a row class in a file, in the order of its fields."""
    return {
        key: RowKey(column, name)
        for name, own in fields_of(cls).items()
        for key, column in own.kind.keys(name, own).items()
    }


def row_label(row: Row) -> str:
    """The noun and the name of a row, as in "light 'key'"."""
    name = vars(row).get("name")
    return f"{row.noun} {shown(name)}" if row.noun and isinstance(name, str) and name else row.noun


def replaced(row: SomeRow, changes: Mapping[str, Any]) -> SomeRow:
    """The row with some fields or keys replaced; a table for a row inside it replaces that row's keys.

    Raises RowError with every problem.
    """
    # Copy the columns only: cached properties may depend on them.
    present = vars(row)
    return _made(type(row), {name: present[name] for name in fields_of(type(row))}, changes)


def from_plain(cls: type[SomeRow], table: object) -> SomeRow:
    """The row of a class for a table of keys and plain values; omitted keys have their defaults.

    Raises RowError with every problem.
    """
    if not isinstance(table, Mapping):
        raise RowError([Problem((), f"must be a table of {listed(keys_of(cls))}, not {shown(table)}")])
    return _made(cls, {name: column.default for name, column in fields_of(cls).items()}, table)


def with_values(row: SomeRow, values: Mapping[str, object]) -> SomeRow:
    """The row with other values in some fields, without any check.

    Cached properties are copied: they must not depend on these fields.
    """
    copy = object.__new__(type(row))
    vars(copy).update({**vars(row), **values})
    return copy


MOST_KEYS: Final = 64
"""Limit: keys of a table."""


def _made(cls: type[SomeRow], present: dict[str, Any], changes: Mapping[str, Any]) -> SomeRow:
    """The row of a class with some of its present values, by field, replaced. Raises RowError.

    Measured: with cold caches a function call takes longer than its work, so this function calls few.
    """
    row = object.__new__(cls)
    fresh = vars(row)
    fresh.update(present)
    if len(changes) > MOST_KEYS:
        text = f"it must be a table of at most {MOST_KEYS} keys, not {len(changes):,}"
        raise RowError([Problem((), text)], row_label(row))
    fields, keys = fields_of(cls), keys_of(cls)
    problems: list[Problem] = []
    # Find the new values of fields, and for each field with a row inside, those of that row's keys.
    values: dict[str, Any] = {}
    inside: dict[str, dict[str, Any]] = {}
    for name, value in changes.items():
        key = keys.get(name)
        if key is not None and key.field != name:
            inside.setdefault(key.field, {})[name] = value
        elif name not in fields:
            problems.append(unknown_key(name, {**fields, **keys}, cls.elsewhere))
        elif isinstance(value, Mapping):
            inside.setdefault(name, {}).update(value)
        else:
            values[name] = value
    used = [group for group in cls.alternatives if any(values.get(name) is not None for name in group)]
    if used:
        unused = (name for group in cls.alternatives if group not in used for name in group)
        values = {**{name: fields[name].default for name in unused}, **values}
    fresh.update(values)
    for name, value in fresh.items():
        if value is MISSING:
            fresh[name] = REFUSED
            if name not in inside:
                text = f"{name} {fields[name].kind.rule()}, not missing; add it"
                problems.append(Problem((name,), text, names_key=True))
    for name, table in inside.items():
        fresh[name] = fields[name].kind.replaced(fresh[name], table, (name,), problems)
        if not isinstance(fresh[name], Row):
            values[name] = fresh[name]
    check(row, {name: fields[name] for name in values}, problems)
    return row


def reset_fields(row: Row) -> tuple[str, ...]:
    """The fields that are reset because the row uses another group of its `alternatives`.

    A group is in use if an optional field of it has a value.
    """
    fields, values = fields_of(type(row)), vars(row)
    for used in row.alternatives:
        if any(fields[name].is_optional and values[name] is not None for name in used):
            return tuple(name for group in row.alternatives if group is not used for name in group)
    return ()


def to_plain(row: Row) -> dict[str, object]:
    """The row as keys and plain values, which TOML and JSON can hold; None and reset values are omitted."""
    values, resets = vars(row), reset_fields(row)
    return {
        key: value
        for name, column in fields_of(type(row)).items()
        if values[name] is not None and name not in resets
        for key, value in column.kind.to_plain(name, values[name]).items()
        if value is not None
    }


def difference(one: Row, other: Row) -> dict[str, object]:
    """The keys and plain values with which `replaced` makes one row equal to another row of its class.

    None removes a value. An infinite value is written, too. Meshes are left out.
    """
    ones, others, resets = vars(one), vars(other), reset_fields(other)
    changes: dict[str, object] = {}
    for name, column in fields_of(type(one)).items():
        before, after = ones[name], others[name]
        if before is after or (name in resets and after is not None):
            continue
        if after is None:
            changes[name] = None
        elif before is None:
            changes |= column.kind.to_plain(name, after)
        else:
            changes |= column.kind.difference(name, before, after)
    return changes


def cost(one: Row, other: Row, own: Tier = Tier.FRAME) -> Tier | None:
    """The cost of an edit from one row to another: the largest cost of a column; None if the rows are equal.

    For rows of different classes it is `own`.
    """
    if type(one) is not type(other):
        return own
    ones, others = vars(one), vars(other)
    return _largest(
        column.kind.cost(ones[name], others[name], column.tier)
        for name, column in fields_of(type(one)).items()
        if ones[name] is not others[name]
    )


def _largest(costs: Iterable[Tier | None]) -> Tier | None:
    return max((tier for tier in costs if tier is not None), default=None)


BARE: Final = re.compile(r"[\w-]{1,100}")
"""Names in a path that need no quotes."""


class Problem(NamedTuple):
    """A problem of the value at a path; the path () means the whole row.

    `text` is the end of a message. With `names_key=True` it contains the last key of the path already.
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
        """The problem with a longer path, from a row that contains this row at `path`."""
        return self._replace(path=(*path, *self.path))


def unknown_key(name: object, keys: Iterable[str], elsewhere: Mapping[str, str] = Row.elsewhere) -> Problem:
    """The problem of an unknown key, with the closest of `keys`, or the advice of `Row.elsewhere`."""
    text = name if isinstance(name, str) else shown(name)
    advice = elsewhere.get(text) or nearest(text, keys)
    return Problem((text,), f"there is no field {shown(name)}{advice}", names_key=True)


class RowError(InputError):
    """An invalid row: its problems with their paths, and its label, as in "light 'key'", or ""."""

    def __init__(self, row_problems: Iterable[Problem], row: str = "") -> None:
        self.row_problems = tuple(row_problems)
        self.row = row
        sentences = [problem.sentence for problem in self.row_problems]
        super().__init__(f"{row}: {sentence}" if row else sentence for sentence in sentences)

    def __reduce__(self) -> tuple[type[RowError], tuple[object, ...]]:
        return RowError, (self.row_problems, self.row)


REFUSED: Final[Any] = float("nan")
"""The placeholder for an invalid value while the rules between columns are checked.

It is not a number, so that all its comparisons are false, and these rules report no further problem of it.
"""


def refused(problems: list[Problem], path: Path, text: str) -> Any:
    """Append a problem and return REFUSED."""
    problems.append(Problem(path, text))
    return REFUSED


def check(row: Row, fields: Mapping[str, Column], problems: list[Problem]) -> None:
    """Check and convert some fields of a row in place, then check the rules between its columns.

    Raises RowError with every problem, after those that are there already.
    """
    values = vars(row)
    for name, column in fields.items():
        value = values[name]
        if value is not REFUSED and not (value is None and column.default is None):
            values[name] = column.kind.validated(value, (name,), problems)
    if type(row).rules is not Row.rules:
        row.complete()
        problems.extend(row.rules())
    if problems:
        raise RowError(problems, row_label(row))


class BarRange(NamedTuple):
    """The usual range of a number that is set by pointing: multiples of `step` between `low` and `high`.

    Typed numbers may be any that the kind of the column accepts.
    """

    low: float
    high: float
    step: float
