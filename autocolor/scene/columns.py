"""Columns: the description of each field of a table, given once, at the field of its dataclass.

    concentration: Annotated[float, Column(Number(at_least=0), Tier.LIGHT, "how narrow the light is")] = 0.0

A row of a table is a frozen dataclass that derives from `Row`. Its columns determine the checks at
construction (`Row`), changes of fields (`changed`), reading a row from plain values, as in a scene file
(`made`), writing one (`plain`), and the cost of an edit (`cost`). The kinds of columns are in `column_kinds`.

A key is the name of a column in a file. It is the name of the field, except that a nested row that is
`inline` has no key of its own: its keys are among those of the row that contains it.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Iterable, Iterator, Mapping
from enum import IntEnum
from functools import partial
from typing import Any, ClassVar, Final, NamedTuple, TypeVar, get_type_hints

from autocolor.checks import listed, nearest, shown
from autocolor.errors import InputError

Path = tuple[str | int, ...]
"""The keys and row numbers that lead from a row to a value inside it."""

MOST_KEYS: Final = 64
"""Assumed: an upper bound on the keys of any table."""


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
        """
        key = ""
        for part in self.path[:-1] if self.names_key else self.path:
            key += f"[{part + 1}]" if isinstance(part, int) else f".{part}" if key else part
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


class Kind:
    """The kind of values in a column: how they are checked, changed, written and compared."""

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

    def cost(self, one: Any, other: Any, own: Tier) -> Tier | None:
        """The cost of a change from one value to another, None for no change; `own` is the column's tier."""
        return None if one == other else own


@dataclasses.dataclass(frozen=True)
class Column:
    """One column: its kind, the cost of an edit, one line of help, and its unit."""

    kind: Kind
    tier: Tier
    help: str
    unit: str = ""


class Row:
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
    """A key of a row in a file: its column, and the field of the row that contains it."""

    column: Column
    field: str


def keys_of(cls: type[Row]) -> Mapping[str, Key]:
    """The keys of a row class in a file, in the order of its fields."""
    found = _KEYS.get(cls)
    if found is None:
        found = _KEYS[cls] = {
            key: Key(column, name)
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


def changed(row: SomeRow, changes: Mapping[str, Any]) -> SomeRow:
    """The row with some fields or keys changed; a table for a row inside it changes that row's keys.

    Raises RowError with every problem.
    """
    problems: list[Problem] = []
    fields = fields_of(type(row))
    values, inner = _values_by_field(row, changes, problems)
    # Copy the columns only: cached properties may depend on them.
    copy = object.__new__(type(row))
    present = vars(row)
    vars(copy).update(present if len(present) == len(fields) else {name: present[name] for name in fields})
    vars(copy).update(values, **inner)
    try:
        check(copy, {name: fields[name] for name in values})
    except RowError as error:
        problems.extend(error.found)
    if problems:
        raise RowError(problems, row_label(row))
    return copy


def _values_by_field(
    row: Row, changes: Mapping[str, Any], problems: list[Problem]
) -> tuple[dict[str, Any], dict[str, Any]]:
    """The new values of the fields that change, and the inner rows that changed, which are checked.

    Problems are appended, and unknown names left out.
    """
    fields, keys = fields_of(type(row)), keys_of(type(row))
    values: dict[str, Any] = {}
    inside: dict[str, dict[str, Any]] = {}
    for name, value in changes.items():
        if name in keys and fields[keys[name].field].column.kind.has_keys_inside():
            inside.setdefault(keys[name].field, {})[name] = value
        elif name not in fields:
            problems.append(unknown(name, {**fields, **keys}))
        elif isinstance(value, Mapping):
            inside.setdefault(name, {}).update(value)
        else:
            values[name] = value
    inner: dict[str, Any] = {}
    for name, table in inside.items():
        present = values.pop(name, vars(row)[name])
        changed_value = fields[name].column.kind.changed(present, table, (name,), problems)
        (inner if isinstance(changed_value, Row) else values)[name] = changed_value
    if row.alternatives and any(values.get(name) is not None for name in row.alternatives):
        values = {**dict.fromkeys(row.alternatives), **values}
    return values, inner


def made(cls: type[SomeRow], table: object) -> SomeRow:
    """The row of a class for a table of keys and plain values; omitted keys have their defaults.

    Raises RowError with every problem.
    """
    if not isinstance(table, Mapping):
        raise RowError([Problem((), f"must be a table of {listed(keys_of(cls))}, not {shown(table)}")])
    if len(table) > MOST_KEYS:
        raise RowError([Problem((), f"it must be a table of at most {MOST_KEYS} keys, not {len(table):,}")])
    fields = fields_of(cls)
    row = object.__new__(cls)
    vars(row).update(
        {name: REFUSED if field.default is None else field.default() for name, field in fields.items()}
    )
    problems: list[Problem] = []
    values, inner = _values_by_field(row, table, problems)
    problems.extend(
        Problem((name,), f"{name} {field.column.kind.rule()}, not missing; add it", names_key=True)
        for name, field in fields.items()
        if field.default is None and name not in values and name not in inner
    )
    vars(row).update(values, **inner)
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


def unknown(name: object, known: Iterable[str]) -> Problem:
    """The problem of an unknown key, with the closest known one."""
    clause = nearest(str(name), list(known))
    return Problem((str(name),), f"there is no {shown(name)}{clause}", names_key=True)
