"""Columns: the description of each field of a table, given once, at the field of its dataclass.

    @dataclass(frozen=True, repr=False)
    class Light(Row):
        noun: ClassVar[str] = "light"

        concentration: Annotated[
            float, Column(Number(at_least=0), Tier.LIGHT, "How narrow the light is.")
        ] = 0.0

The checks at construction, scene files, `--set`, `--json`, the table store, the journal, menus and documents
are made from it. A row of a table is a frozen dataclass that derives from `Row`. `replaced`, `from_plain`,
`to_plain`, `difference` and `cost` work for any row. The `Kind` of a column says which values it may have:
see `kinds` for values without fields and `row_kinds` for rows inside rows.

A key is the name of a column in a file, and usually the name of its field. The field of an `inline` row has
no key: the file writes the keys of that row among the keys of the containing row.
"""

from __future__ import annotations

import dataclasses
import math
import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from enum import IntEnum
from functools import cache, partial
from typing import Any, ClassVar, Final, NamedTuple, Self, TypeVar, cast, get_type_hints

from autocolor.checks import listed, nearest, shown
from autocolor.errors import InputError
from autocolor.immutable import Immutable

WORLD_UNITS: Final = "world units"
"""The unit of coordinates and lengths. Their usual range is the object's; they have no bar."""


@dataclasses.dataclass(frozen=True)
class Column:
    """A column: its kind, the cost of an edit, a line of help, and its unit.

    `bar` is the usual range and the step, unless the limits of the kind give them (see `bar_of`). `start` is
    the first value of an absent number that is switched on.
    """

    kind: Kind
    tier: Tier
    help: str
    unit: str = ""
    bar: BarRange | None = None
    start: float | None = None


class Tier(IntEnum):
    """What an edit of a column costs, in increasing order.

    `computed` names what the edit computes again; every lower tier follows. `sent` names what it sends to the
    display.
    """

    NOTHING = 0, "nothing", "nothing"
    ENTRIES = 1, "entries of the lookup table", "those entries, no word"
    LEVELS = 2, "the levels", "all words, the entries that differ"
    MIX = 3, "the weighted sum of the lights", "all words, the entries that differ"
    LIGHT = 4, "one light, or all lights on one surface", "all words, the entries that differ"
    FRAME = 5, "everything", "all words, the entries that differ"

    computed: str
    sent: str

    def __new__(cls, value: int, computed: str, sent: str) -> Tier:
        """A member: a number with two phrases."""
        tier = int.__new__(cls, value)
        tier._value_ = value
        tier.computed, tier.sent = computed, sent
        return tier


Path = tuple[str | int, ...]
"""The keys and row numbers that lead from a row to a value inside it."""


class Kind:
    """The kind of values in a column: how they are checked, replaced, written and compared.

    A kind of values without fields defines `rule`, `accepts` and `accepted`, and may define `advice`. A kind
    of rows defines `validated` instead of `accepted`.
    """

    @property
    def has_keys_inside(self) -> bool:
        """Whether keys of the containing row can refer to fields inside the value."""
        return False

    def rule(self) -> str:
        """The rule for a value, as part of a message: "must be true or false"."""
        raise NotImplementedError

    def accepts(self) -> str:
        """The type annotation of accepted values, as written in `changes.py`."""
        raise NotImplementedError

    def accepted(self, value: Any) -> Any:
        """The converted value. Raises TypeError, ValueError or OverflowError if it breaks the rule."""
        raise NotImplementedError

    def advice(self, value: object) -> str:
        """The end of the message about an invalid value, which says how to correct it."""
        return ""

    def validated(self, value: object, path: Path, problems: list[Problem]) -> object:
        """The value converted for the row; REFUSED, with its problems appended, if it is invalid."""
        try:
            return self.accepted(value)
        except (TypeError, ValueError, OverflowError):
            problems.append(Problem(path, f"{self.rule()}, not {shown(value)}{self.advice(value)}"))
            return REFUSED

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
        """The keys and values that turn a field of this name from one value to another, neither None."""
        return {} if repr(one) == repr(other) else self.to_plain(name, other)

    def bar(self) -> BarRange | None:
        """The bar of the kind's own limits; None unless it has numbers with two limits."""
        return None

    def cost(self, one: Any, other: Any, own: Tier) -> Tier | None:
        """The cost of an edit from one value to another; None if equal. `own` is the tier of the column."""
        return None if one == other else own

    def between(self, one: Any, other: Any, share: float) -> Any:
        """The value at a share of the way from one value to another, neither None; 0 < `share` < 1.

        Floats are interpolated linearly, also inside tuples of equal shape. Assumed: any other value holds
        until the other is reached.
        """
        return _between(one, other, share)


def _between(one: Any, other: Any, share: float) -> Any:
    if isinstance(one, tuple) and isinstance(other, tuple) and len(one) == len(other):
        return tuple(_between(a, b, share) for a, b in zip(one, other, strict=True))
    if not (isinstance(one, float) and isinstance(other, float)) or one == other:
        return one
    # No bound of a flap is infinitely far away, so the bound holds.
    if math.isinf(one) or math.isinf(other):
        return one
    return min(max(one * (1 - share) + other * share, min(one, other)), max(one, other))


class Row(Immutable):
    """A row of a table: a frozen dataclass whose fields are columns, checked at construction.

    Messages name a row by its `noun` and its name, if it has a name. At most one of the groups of fields in
    `alternatives` is in use: a change that sets a field of one group resets the fields of the other groups.
    The rules of the class refuse a row that uses two groups.
    """

    noun: ClassVar[str] = ""
    alternatives: ClassVar[tuple[tuple[str, ...], ...]] = ()

    def __post_init__(self) -> None:
        check(self, fields_of(type(self)))

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
        for name, field in fields_of(type(self)).items():
            a, b = ones[name], others[name]
            holds = a is b or a is None or b is None or name in held
            vars(copy)[name] = a if holds else field.column.kind.between(a, b, share)
        return copy

    def __repr__(self) -> str:
        # Leave out fields that have their defaults.
        values = vars(self)
        shown_fields = [
            f"{name}={values[name]!r}"
            for name, field in fields_of(type(self)).items()
            if field.default is None or field.default() != values[name]
        ]
        return f"{type(self).__name__}({', '.join(shown_fields)})"


SomeRow = TypeVar("SomeRow", bound=Row)
Result = TypeVar("Result")


def cached_by_class(function: Callable[[type[Row]], Result]) -> Callable[[type[Row]], Result]:
    """The function with its results cached. A type checker does not accept row classes as hashable."""
    return cast(Callable[[type[Row]], Result], cache(function))


class Field(NamedTuple):
    """A field of a row class: its column, whether it may be None, and a function for its default, if any."""

    column: Column
    is_optional: bool
    default: Callable[[], object] | None


@cached_by_class
def fields_of(cls: type[Row]) -> Mapping[str, Field]:
    """The fields of a row class by name, in definition order."""
    hints = get_type_hints(cls, include_extras=True)
    fields = {}
    for field in dataclasses.fields(cls):  # type: ignore[arg-type]
        (column,) = (mark for mark in hints[field.name].__metadata__ if isinstance(mark, Column))
        default: Callable[[], object] | None = None
        if field.default_factory is not dataclasses.MISSING:
            default = field.default_factory
        elif field.default is not dataclasses.MISSING:
            default = partial(getattr, field, "default")
        fields[field.name] = Field(column, field.default is None, default)
    return fields


class RowKey(NamedTuple):
    """A key of a row in a file: its column, its field, and whether it is a key inside the field's value."""

    column: Column
    field: str
    is_inside: bool


@cached_by_class
def keys_of(cls: type[Row]) -> Mapping[str, RowKey]:
    """The keys of a row class in a file, in the order of its fields."""
    return {
        key: RowKey(column, name, field.column.kind.has_keys_inside)
        for name, field in fields_of(cls).items()
        for key, column in field.column.kind.keys(name, field.column).items()
    }


def row_label(row: Row) -> str:
    """The noun and the name of a row, as in "light 'key'"."""
    name = vars(row).get("name")
    return f"{row.noun} {shown(name)}" if row.noun and isinstance(name, str) and name else row.noun


MOST_KEYS: Final = 64
"""Limit: keys of a table."""

PLAIN_TYPES: Final = frozenset((float, int, bool, str, tuple, list))
"""Types of most values, and not of tables. Measured: testing for `Mapping` takes several times as long."""


def replaced(row: SomeRow, changes: Mapping[str, Any]) -> SomeRow:
    """The row with some fields or keys replaced; a table for a row inside it replaces that row's keys.

    Raises RowError with every problem.

    Measured: with cold caches a function call takes longer than its work, so this function calls few.
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
        fresh[name] = fields[name].column.kind.replaced(fresh[name], table, (name,), problems)
        if not isinstance(fresh[name], Row):
            values[name] = fresh[name]
    if values or type(row).rules is not Row.rules:
        try:
            check(copy, {name: fields[name] for name in values})
        except RowError as error:
            problems.extend(error.row_problems)
    if problems:
        raise RowError(problems, row_label(row))
    return copy


def with_values(row: SomeRow, values: Mapping[str, object]) -> SomeRow:
    """The row with other values in some fields, without any check.

    Cached properties are copied: they must not depend on these fields.
    """
    copy = object.__new__(type(row))
    fresh = vars(copy)
    fresh.update(vars(row))
    fresh.update(values)
    return copy


def _values_by_field(
    row: Row, changes: Mapping[str, Any], problems: list[Problem]
) -> tuple[dict[str, Any], dict[str, dict[str, Any]]]:
    """The new values of fields, and for each field with a row inside, the new values of that row's keys.

    An unknown name is left out, and a problem appended.
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
            problems.append(unknown_key(name, {**fields, **keys}))
        elif type(value) not in PLAIN_TYPES and isinstance(value, Mapping):
            inside.setdefault(name, {}).update(value)
        else:
            values[name] = value
    used = [group for group in row.alternatives if any(values.get(name) is not None for name in group)]
    if used:
        unused = [name for group in row.alternatives if group not in used for name in group]
        resets = {name: fields[name].default for name in unused}
        values = {**{name: default() for name, default in resets.items() if default}, **values}
    return values, inside


def reset_fields(row: Row) -> tuple[str, ...]:
    """The fields that are reset because the row uses another group of its `alternatives`.

    A group is in use if an optional field of it has a value.
    """
    fields, values = fields_of(type(row)), vars(row)
    for used in row.alternatives:
        if any(fields[name].is_optional and values[name] is not None for name in used):
            return tuple(name for group in row.alternatives if group is not used for name in group)
    return ()


def from_plain(cls: type[SomeRow], table: object) -> SomeRow:
    """The row of a class for a table of keys and plain values; omitted keys have their defaults.

    Raises RowError with every problem.
    """
    if not isinstance(table, Mapping):
        raise RowError([Problem((), f"must be a table of {listed(keys_of(cls))}, not {shown(table)}")])
    fields = fields_of(cls)
    row = object.__new__(cls)
    row_values = vars(row)
    row_values.update(
        {name: REFUSED if field.default is None else field.default() for name, field in fields.items()}
    )
    problems: list[Problem] = []
    values, inside = _values_by_field(row, table, problems)
    problems.extend(
        Problem((name,), f"{name} {field.column.kind.rule()}, not missing; add it", names_key=True)
        for name, field in fields.items()
        if field.default is None and name not in values and name not in inside
    )
    row_values.update(values)
    for name, keys in inside.items():
        row_values[name] = fields[name].column.kind.replaced(row_values[name], keys, (name,), problems)
    try:
        check(row, fields)
    except RowError as error:
        problems.extend(error.row_problems)
    if problems:
        raise RowError(problems, row_label(row))
    return row


def to_plain(row: Row) -> dict[str, object]:
    """The row as keys and plain values, which TOML and JSON can hold; None and reset values are omitted."""
    values, resets = vars(row), reset_fields(row)
    return {
        key: value
        for name, field in fields_of(type(row)).items()
        if values[name] is not None and name not in resets
        for key, value in field.column.kind.to_plain(name, values[name]).items()
        if value is not None
    }


def difference(one: Row, other: Row) -> dict[str, object]:
    """The keys and plain values with which `replaced` makes one row equal to another row of its class.

    None removes a value. An infinite value is written, too. Meshes are left out.
    """
    ones, others, resets = vars(one), vars(other), reset_fields(other)
    changes: dict[str, object] = {}
    for name, field in fields_of(type(one)).items():
        before, after, kind = ones[name], others[name], field.column.kind
        if before is after:
            continue
        if after is None:
            changes[name] = None
        elif name in resets:
            continue
        elif before is None:
            changes.update(kind.to_plain(name, after))
        else:
            changes.update(kind.difference(name, before, after))
    return changes


def cost(one: Row, other: Row, own: Tier = Tier.FRAME) -> Tier | None:
    """The cost of an edit from one row to another: the largest cost of a column; None if the rows are equal.

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


def unknown_key(name: object, keys: Iterable[str]) -> Problem:
    """The problem of an unknown key, with the closest of `keys`."""
    text = name if isinstance(name, str) else shown(name)
    return Problem((text,), f"there is no field {shown(name)}{nearest(text, keys)}", names_key=True)


class RowError(InputError):
    """An invalid row: its problems with their paths, and its label, as in "light 'key'", or ""."""

    def __init__(self, row_problems: Iterable[Problem], row: str = "") -> None:
        self.row_problems = tuple(row_problems)
        self.row = row
        sentences = [problem.sentence for problem in self.row_problems]
        super().__init__(f"{row}: {sentence}" if row else sentence for sentence in sentences)

    def __reduce__(self) -> tuple[type[RowError], tuple[object, ...]]:
        return RowError, (self.row_problems, self.row)


class Refused:
    """The placeholder for an invalid value while the rules between columns are checked.

    All its comparisons are false, so that these rules report no further problem of the value.
    """

    def __eq__(self, other: object) -> bool:
        return False

    def __gt__(self, other: object) -> bool:
        return False

    __ge__ = __lt__ = __le__ = __gt__
    __hash__ = object.__hash__


REFUSED: Final[Any] = Refused()


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
            values[name] = value = column.kind.validated(value, (name,), problems)
        is_refused |= value is REFUSED
    if type(row).rules is not Row.rules:
        problems.extend(row.rules())
    if problems or is_refused:
        raise RowError(problems, row_label(row))


STEPS: Final = 100
"""Assumed: the least number of steps of a bar, so that a step is a small change."""

DIGITS: Final = 12
"""Digits of a rounded value: enough for any step, and few enough to write 0.3 as 0.3."""


class BarRange(NamedTuple):
    """The usual range of a number that is set by pointing: multiples of `step` between `low` and `high`.

    Typed numbers may be any that the kind of the column accepts.
    """

    low: float
    high: float
    step: float

    def rounded(self, value: float) -> float:
        """The nearest value on the bar, with halves rounded up; a value beyond an end becomes the end.

        >>> BarRange(0, 2, 0.01).rounded(0.2987), BarRange(1, 90, 1).rounded(0)
        (0.3, 1.0)
        """
        within = min(max(value, self.low), self.high)
        on_step = float(f"{math.floor(within / self.step + 0.5) * self.step:.{DIGITS}g}")
        return float(min(max(on_step, self.low), self.high))

    def fraction(self, value: float) -> float:
        """The place of a value along the bar, 0 to 1."""
        return (min(max(value, self.low), self.high) - self.low) / (self.high - self.low)

    def at(self, fraction: float) -> float:
        """The value on the bar at a fraction of its length; fractions beyond 0 and 1 give the ends.

        >>> BarRange(-180, 180, 1).at(0.5)
        0.0
        """
        return self.rounded(self.low + fraction * (self.high - self.low))


def bar_within(low: float, high: float) -> BarRange:
    """The bar from `low` to a larger `high`, with at least STEPS steps of 1, 2 or 5 times a power of ten.

    >>> bar_within(0, 180)
    BarRange(low=0, high=180, step=1.0)
    """
    most = (high - low) / STEPS
    power = 10.0 ** math.floor(math.log10(most))
    # A step may exceed its bound by no more than rounding: 0.01 is a hundredth of 1.
    steps = [factor * power for factor in (1, 2, 5, 10)]
    step = max((step for step in steps if step <= most * (1 + 1e-9)), default=power)
    return BarRange(low, high, float(f"{step:.{DIGITS}g}"))


def bar_of(column: Column) -> BarRange | None:
    """The bar of a column; None unless it has numbers with a usual range. Whole numbers have whole steps."""
    return column.bar if column.bar is not None else column.kind.bar()
