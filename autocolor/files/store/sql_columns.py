"""The columns of an SQL table for a row class, made from the descriptions of its columns.

A number, a switch, a name, a choice or a color is one column of the key's name. A point or a direction is
three: `position_x`, `position_y`, `position_z`. A row in a row is the columns of that row with the key before
them: `flaps_z_minimum`. All else that a key may hold is one column: text as it is, and lists and tables as
JSON. An absent value is NULL, and so is a limit that is infinite.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final

from autocolor.scene.columns import Field, Kind, Row, fields_of, to_plain
from autocolor.scene.kinds import (
    LARGEST_PLACE,
    Boolean,
    ColorKind,
    Instance,
    Number,
    OneOf,
    Text,
    VectorKind,
    Whole,
)
from autocolor.scene.row_kinds import NamedRows, Nested, OneRowOf, Reference, RowList

NUMBER: Final = "number"
"""The column of every small table that counts its rows from 1; it keeps their order."""

AXES: Final = ("x", "y", "z")
LARGEST_FLOAT: Final = 1.7976931348623157e308

OF_TEXT: Final = (Text, OneOf, ColorKind, Reference, OneRowOf)
"""The kinds whose values are text."""

OF_JSON: Final = ("[", "{", '"')
"""What the text of a value begins with that is JSON."""

SqlValue = None | int | float | str
"""A value of a table; there are no bytes in a store."""


@dataclass(frozen=True)
class SqlColumn:
    """A column of an SQL table: the value at `path` in a row's keys and plain values.

    `component` is the component of a vector that it holds, if it does. `references` is the table
    whose `name` it is.
    """

    name: str
    path: tuple[str, ...]
    kind: Kind
    help: str
    component: int | None = None
    may_be_null: bool = False
    default: SqlValue = None
    references: str = ""

    @property
    def type(self) -> str:
        """Its type in SQL."""
        if isinstance(self.kind, (Number, VectorKind)):
            return "REAL"
        if isinstance(self.kind, (Whole, Boolean)):
            return "INTEGER"
        return "TEXT" if isinstance(self.kind, OF_TEXT) else "ANY"

    @property
    def checks(self) -> Iterator[str]:
        """The conditions for its values, as SQL; a condition that is NULL holds."""
        name, kind = quoted(self.name), self.kind
        if isinstance(kind, VectorKind):
            yield f"abs({name}) <= {LARGEST_PLACE!r}"
        elif isinstance(kind, Number):
            yield f"abs({name}) <= {LARGEST_FLOAT!r}"
            if kind.at_least > -math.inf:
                yield f"{name} {'>' if kind.above else '>='} {kind.at_least!r}"
            if kind.at_most < math.inf:
                yield f"{name} <= {kind.at_most!r}"
        elif isinstance(kind, Whole):
            yield f"{name} BETWEEN {kind.at_least} AND {kind.at_most}"
        elif isinstance(kind, Boolean):
            yield f"{name} IN (0, 1)"
        elif isinstance(kind, (OneOf, OneRowOf)):
            names = kind.names if isinstance(kind, OneOf) else kind.classes
            yield f"{name} IN ({', '.join(map(literal, names))})"
        elif isinstance(kind, Reference) or (isinstance(kind, Text) and not kind.may_be_empty):
            yield f"{name} <> ''"

    @property
    def declaration(self) -> str:
        """The column as `CREATE TABLE` has it."""
        parts = [quoted(self.name), self.type]
        if not self.may_be_null:
            parts.append("NOT NULL")
        if self.path == ("name",) and isinstance(self.kind, Text) and not self.kind.may_be_empty:
            parts.append("UNIQUE")
        if self.default is not None:
            parts.append(f"DEFAULT {literal(self.default)}")
        if self.references:
            parts.append(f"REFERENCES {quoted(self.references)} (name) ON UPDATE CASCADE")
        checks = list(self.checks)
        if checks:
            # The name of a check is what any tool says when it fails.
            parts.append(checked(f"{'.'.join(self.path)} {self.kind.rule()}", " AND ".join(checks)))
        return " ".join(parts)


def quoted(name: str) -> str:
    """A name as SQL writes it.

    >>> quoted("on")
    '"on"'
    """
    return '"' + name.replace('"', '""') + '"'


def checked(rule: str, condition: str) -> str:
    """A check of a table, whose name is the rule in words."""
    return f"CONSTRAINT {quoted(rule)} CHECK ({condition})"


def literal(value: SqlValue) -> str:
    """A value as SQL writes it.

    >>> literal("it's"), literal(0.5), literal(None)
    ("'it''s'", '0.5', 'NULL')
    """
    if value is None:
        return "NULL"
    return "'" + value.replace("'", "''") + "'" if isinstance(value, str) else repr(value)


def columns_of(row_class: type[Row]) -> tuple[SqlColumn, ...]:
    """The columns for the fields of a row class; a mesh and whole tables have none."""
    found = _COLUMNS.get(row_class)
    if found is None:
        found = _COLUMNS[row_class] = tuple(
            column
            for name, field in fields_of(row_class).items()
            for column in _columns(name, field, (), is_given=True)
        )
    return found


_COLUMNS: Final[dict[type[Row], tuple[SqlColumn, ...]]] = {}


def _columns(name: str, field: Field, prefix: tuple[str, ...], is_given: bool) -> Iterator[SqlColumn]:
    """The columns of a field; unless the row around it `is_given`, all of them may be NULL."""
    column, is_optional, default = field
    kind, path = column.kind, (*prefix, name)
    if isinstance(kind, (Instance, RowList)):
        return
    if isinstance(kind, Nested) and (not is_optional or _tells_itself(kind.row_class)):
        inner_prefix = prefix if kind.inline else path
        for inner_name, inner in fields_of(kind.row_class).items():
            yield from _columns(inner_name, inner, inner_prefix, is_given and not is_optional)
        return
    may_be_null = is_optional or not is_given or getattr(kind, "endless", None) is not None
    may_be_null |= isinstance(kind, NamedRows)
    start: Any = default() if default is not None and is_given and not may_be_null else None
    begun = {} if start is None else dict(kind.to_plain(name, start))
    keys = kind.keys(name, column)
    for key, inner_column in keys.items():
        # The other keys of a variant are those of its classes: each has only some of them.
        is_own = key == name
        inner_kind, text = inner_column.kind, inner_column.help
        nullable = may_be_null or not is_own
        value = begun.get(key) if is_own else None
        if isinstance(inner_kind, VectorKind):
            for number, axis in enumerate(AXES):
                component = None if value is None else float(value[number])  # type: ignore[index]
                yield SqlColumn(
                    "_".join((*prefix, key, axis)),
                    (*prefix, key),
                    inner_kind,
                    text,
                    number,
                    nullable,
                    component,
                )
        else:
            references = inner_kind.table if isinstance(inner_kind, Reference) and not inner_kind.word else ""
            yield SqlColumn(
                "_".join((*prefix, key)),
                (*prefix, key),
                inner_kind,
                text,
                None,
                nullable,
                in_sql(value),
                references,
            )


def _tells_itself(row_class: type[Row]) -> bool:
    """Whether a row of the class always has a column that is not NULL, so that its presence is seen."""
    return any(
        not field.is_optional
        and getattr(field.column.kind, "endless", None) is None
        and (not isinstance(field.column.kind, Nested) or _tells_itself(field.column.kind.row_class))
        for field in fields_of(row_class).values()
    )


def in_sql(value: object) -> SqlValue:
    """A plain value as a store holds it."""
    if value is None or isinstance(value, (bool, int)):
        return None if value is None else int(value)
    if isinstance(value, float):
        return value
    if isinstance(value, str) and not value.startswith(OF_JSON):
        return value
    return json.dumps(value, ensure_ascii=False)


def row_values(row: Row) -> dict[str, SqlValue]:
    """The values of a row by the names of the columns of its class."""
    table = to_plain(row)
    return {column.name: in_sql(_within(table, column)) for column in columns_of(type(row))}


def _within(table: Mapping[str, Any], column: SqlColumn) -> object:
    value: Any = table
    for key in column.path:
        value = value.get(key) if isinstance(value, Mapping) else None
    return value if column.component is None or value is None else value[column.component]


def row_table(row_class: type[Row], values: Mapping[str, SqlValue]) -> dict[str, Any]:
    """The keys and plain values of a row, for `made`, of its values by the names of columns.

    What is NULL is left out, except for limits that are infinite. Nothing is checked here.
    """
    table: dict[str, Any] = {}
    columns = columns_of(row_class)
    vectors: dict[tuple[str, ...], list[SqlValue]] = {}
    for column in columns:
        value = values.get(column.name)
        if column.component is not None:
            vectors.setdefault(column.path, []).append(value)
        elif value is not None:
            _put(table, column.path, _out_of_sql(column.kind, value))
    for path, components in vectors.items():
        if components != [None] * len(AXES):
            _put(table, path, components)
    for column in columns:
        endless = getattr(column.kind, "endless", None)
        if endless is not None and column.name in values and values[column.name] is None:
            inner = _inside(table, column.path[:-1])
            if inner is not None:
                inner[column.path[-1]] = endless
    return table


def _out_of_sql(kind: Kind, value: SqlValue) -> object:
    """A value of a store as a plain value; one that its kind will refuse stays as it is."""
    if isinstance(kind, Boolean) and value in (0, 1):
        return bool(value)
    if isinstance(value, str) and value.startswith(OF_JSON):
        try:
            found: object = json.loads(value)
        except (ValueError, RecursionError):
            return value
        return found
    return value


def _put(table: dict[str, Any], path: Sequence[str], value: object) -> None:
    for key in path[:-1]:
        table = table.setdefault(key, {})
    table[path[-1]] = value


def _inside(table: dict[str, Any], path: Sequence[str]) -> dict[str, Any] | None:
    for key in path:
        inner = table.get(key)
        if not isinstance(inner, dict):
            return None
        table = inner
    return table
