"""Columns: what each field of a table is, told once, at the field of its dataclass.

    concentration: Annotated[float, Column(Number(at_least=0), Tier.LIGHT, "how narrow the light is")] = 0.0

A row of a table is a frozen dataclass that derives from `Row`. From its columns derive the checks at
construction (`Row`), changes of some fields (`changed`), reading a row from plain values such as a scene file
has (`made`), writing one (`plain`), and what an edit costs (`cost`). The kinds of columns are in
`column_kinds`.

A key is the name that a column has in a file: that of the field. The columns of a row that is `inline` stand
among the keys of the row around it.
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
"""Keys and row numbers that lead from a row to a value in it."""

MOST_KEYS: Final = 64
"""Assumed: more keys than any table has."""


class Tier(IntEnum):
    """What an edit of a column costs: what is computed again, from the least to the most."""

    NOTHING = 0
    """Nothing."""
    ENTRIES = 1
    """Entries of the lookup table; no word."""
    LEVELS = 2
    """The levels, and so the words."""
    MIX = 3
    """The weighted sum of the light planes."""
    LIGHT = 4
    """The planes of one light, or of all lights on one surface."""
    FRAME = 5
    """Everything."""


class Problem(NamedTuple):
    """What is wrong with the value at a path, as the end of a sentence; () is the row as a whole.

    Where the text `names_key`, the sentence does not name the last key of the path again.
    """

    path: Path
    text: str
    names_key: bool = False

    @property
    def sentence(self) -> str:
        """The problem with the keys before it.

        >>> Problem(("flaps", "z", "on"), "must be true or false, not 3").sentence
        'flaps.z.on must be true or false, not 3'
        """
        key = ""
        for part in self.path[:-1] if self.names_key else self.path:
            key += f"[{part + 1}]" if isinstance(part, int) else f".{part}" if key else part
        return f"{key}{'' if self.text.startswith('must ') else ':'} {self.text}" if key else self.text

    def under(self, path: Path) -> Problem:
        """The same problem, seen from a row around it."""
        return self._replace(path=(*path, *self.path))


class RowError(InputError):
    """A row that breaks rules.

    `found` says where in the row; `row` is its noun and name, as in "light 'key'", or nothing.
    """

    def __init__(self, found: Iterable[Problem], row: str = "") -> None:
        self.found = tuple(found)
        self.row = row
        super().__init__(f"{row}: {each.sentence}" if row else each.sentence for each in self.found)


class Refused:
    """What stands for a value that was refused while the rules between columns are checked.

    It is neither None nor equal to, above or below anything, so that it breaks no rule again.
    """

    def __eq__(self, other: object) -> bool:
        return False

    def __gt__(self, other: object) -> bool:
        return False

    __ge__ = __lt__ = __le__ = __gt__
    __hash__ = object.__hash__


REFUSED: Final[Any] = Refused()


class Kind:
    """What a column holds: how it is checked, changed, written and compared."""

    def rule(self) -> str:
        """What a value must be, as the middle of a sentence: "must be true or false"."""
        raise NotImplementedError

    def accepts(self) -> str:
        """The type of what is accepted, as it stands in `changes.py`."""
        raise NotImplementedError

    def has_keys_inside(self) -> bool:
        """Whether keys of the row around it lead into the value."""
        return False

    def keys(self, name: str, column: Column) -> Mapping[str, Column]:
        """The keys that a field of this name has in a file."""
        return {name: column}

    def held(self, value: object, path: Path, problems: list[Problem]) -> object:
        """The value as a row holds it, or REFUSED after its problems were noted."""
        raise NotImplementedError

    def changed(self, present: object, table: Mapping[str, Any], path: Path, problems: list[Problem]) -> Any:
        """The value with some keys inside it changed; the table itself where there are none inside."""
        return table

    def written(self, name: str, value: Any) -> Mapping[str, object]:
        """The keys and plain values of a field of this name; a key whose value is None is not written."""
        return {name: value}

    def cost(self, one: Any, other: Any, own: Tier) -> Tier | None:
        """What a change from one value to another costs, None for no change; `own` is the column's tier."""
        return None if one == other else own


@dataclasses.dataclass(frozen=True)
class Column:
    """One column: its kind, what an edit of it costs, one line of help, and its unit."""

    kind: Kind
    tier: Tier
    help: str
    unit: str = ""


class Row:
    """A row of a table: a frozen dataclass whose fields are columns, checked when it is made.

    `noun` names it in sentences, before its name if it has one. Of the fields in `alternatives` one at most
    is given; a change that gives one drops the others.
    """

    noun: ClassVar[str] = ""
    alternatives: ClassVar[tuple[str, ...]] = ()

    def __post_init__(self) -> None:
        check(self, fields_of(type(self)))

    def rules(self) -> Iterator[Problem]:
        """The rules between columns that the row breaks; a value that was refused is REFUSED."""
        return iter(())


SomeRow = TypeVar("SomeRow", bound=Row)


class Field(NamedTuple):
    """A field of a row class: its column, whether it may be None, and what makes its default, if any."""

    column: Column
    is_optional: bool
    default: Callable[[], object] | None


def fields_of(cls: type[Row]) -> Mapping[str, Field]:
    """The fields of a row class by name, in their order."""
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
    """A key of a row in a file: its column, and the field of the row that it leads to."""

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
    """The noun of a row and its name, as in "light 'key'"."""
    name = vars(row).get("name")
    return f"{row.noun} {shown(name)}" if row.noun and isinstance(name, str) and name else row.noun


def check(row: Row, fields: Mapping[str, Field]) -> None:
    """Check some fields of a row and hold them as their kinds do; then check the rules between columns.

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
    # Only the columns are copied: what a row computed of itself and keeps may depend on them.
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
    """The new values of the fields that change, and the inner rows that changed, checked already."""
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
    """The row of a table of keys and plain values; what is left out has its default.

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
    """The row as keys and plain values, which TOML and JSON can hold; what is None is left out."""
    values = vars(row)
    return {
        key: value
        for name, field in fields_of(type(row)).items()
        if values[name] is not None
        for key, value in field.column.kind.written(name, values[name]).items()
        if value is not None
    }


def cost(one: Row, other: Row, own: Tier = Tier.FRAME) -> Tier | None:
    """What an edit costs that changes one row to another: the most of its columns, None where all are equal.

    Rows of different classes cost `own`.
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
    """The problem of a key that there is not, with the nearest right one."""
    clause = nearest(str(name), list(known))
    return Problem((str(name),), f"there is no {shown(name)}{clause}", names_key=True)
