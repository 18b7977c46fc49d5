"""The tables of a store: the SQL columns of row classes, the definitions of tables, and their inspection.

Each table of a scene is one SQL table, made from the descriptions of its columns; the nodes, the polygons and
the scalars of the mesh have tables of their own. All are STRICT: any tool checks types. Ranges, choices and
references are checked when a store is read. Columns that refer to other tables have indexes.

A number, a switch, a name, a choice or a color is one SQL column of the key's name. A point or a direction is
three: `position_x`, `position_y`, `position_z`. A row in a row is the columns of that row with the key before
them: `flaps_z_minimum`. Any other value is one column: text as it is, and lists and tables as JSON. An absent
value is NULL, and so is a limit that is infinite. A surface has a ramp, or two colors and their blend: the
columns of the other are NULL. NULL in a column that the surface uses stands for the default.
"""

from __future__ import annotations

import json
import sqlite3
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Any, Final, NamedTuple

from autocolor.checks import listed, nearest
from autocolor.errors import InputError
from autocolor.scene.columns import MISSING, Column, Kind, Row, fields_of, to_plain
from autocolor.scene.kinds import Boolean, ColorKind, Instance, Number, OneOf, Text, VectorKind, Whole
from autocolor.scene.row_kinds import Nested, OneRowOf, Reference, RowList
from autocolor.scene.scalar import NODE, POLYGON
from autocolor.scene.scene import Scene

NUMBER: Final = "number"
"""The column that counts the rows of a table from 1, in their order; the tables of the mesh apart."""

AXES: Final = ("x", "y", "z")
TYPES: Final[Mapping[str, tuple[type[Kind[Any]], ...]]] = {
    "REAL": (Number, VectorKind),
    "INTEGER": (Whole, Boolean),
    "TEXT": (Text, OneOf, ColorKind, Reference, OneRowOf),
}
"""The types in SQL of kinds of values; those of others are ANY."""

JSON_BEGINS: Final = ("[", "{", '"')
"""A text with such a beginning is JSON."""

SqlValue = None | int | float | str
"""A value of a table; a store has no bytes."""


class SqlColumn(NamedTuple):
    """A column of an SQL table, for the value at `path` in a row's plain values.

    A path has keys; that of a component of a vector ends with 0, 1 or 2.
    """

    name: str
    path: tuple[str | int, ...]
    column: Column
    may_be_null: bool
    default: SqlValue

    @property
    def type(self) -> str:
        """The type in SQL."""
        return next((name for name, kinds in TYPES.items() if isinstance(self.column.kind, kinds)), "ANY")

    @property
    def declaration(self) -> str:
        """The column as a line of `CREATE TABLE`."""
        kind, parts = self.column.kind, [quoted(self.name), self.type]
        if not self.may_be_null:
            parts.append("NOT NULL")
        if self.path == ("name",) and isinstance(kind, Text) and not kind.may_be_empty:
            parts.append("UNIQUE")
        if self.default is not None:
            parts.append(f"DEFAULT {literal(self.default)}")
        if isinstance(kind, Reference) and not kind.word:
            parts.append(f"REFERENCES {quoted(kind.table)} (name) ON UPDATE CASCADE")
        return " ".join(parts)


def quoted(name: str) -> str:
    """A name as SQL writes it.

    >>> quoted("on")
    '"on"'
    """
    return '"' + name.replace('"', '""') + '"'


def literal(value: SqlValue) -> str:
    """A value, not None, as SQL writes it.

    >>> literal("it's"), literal(0.5)
    ("'it''s'", '0.5')
    """
    return "'" + value.replace("'", "''") + "'" if isinstance(value, str) else repr(value)


def columns_of(
    row_class: type[Row], around: tuple[str, ...] = (), may_be_absent: bool = False
) -> Iterator[SqlColumn]:
    """The columns for the fields of a row class, except fields with meshes and lists of rows.

    `around` are the keys of the rows around. All columns may be NULL if a row around may be absent, and so
    may a field that is reset because its row uses an alternative, or whose default is not written. A row that
    may be absent must have a column that is never NULL.
    """
    alternatives = {name for group in row_class.alternatives for name in group}
    for name, column in fields_of(row_class).items():
        kind, default = column.kind, column.default
        may_be_null = may_be_absent or column.is_optional or name in alternatives
        if isinstance(kind, Nested):
            yield from columns_of(kind.row_class, around if kind.inline else (*around, name), may_be_null)
            continue
        if isinstance(kind, (Instance, RowList)):
            continue
        has_start = default is not MISSING and not may_be_null
        start: Any = kind.to_plain(name, default).get(name) if has_start else None
        may_be_null |= default is not MISSING and start is None
        for key, inner in kind.keys(name, column).items():
            path = (*around, key)
            # The other keys belong to the classes of a variant; a class has only some of the keys.
            is_absent = may_be_null or key != name
            value = None if is_absent else start
            if not isinstance(inner.kind, VectorKind):
                yield SqlColumn("_".join(path), path, inner, is_absent, in_sql(value))
                continue
            for axis, number in zip("xyz", range(3), strict=True):
                component = None if value is None else value[number]
                yield SqlColumn("_".join((*path, axis)), (*path, number), inner, is_absent, component)


def in_sql(value: object) -> SqlValue:
    """A plain value as a value of a table."""
    if value is None or isinstance(value, float):
        return value
    if isinstance(value, int):
        return int(value)
    if isinstance(value, str) and not value.startswith(JSON_BEGINS):
        return value
    return json.dumps(value, ensure_ascii=False)


def row_values(columns: Iterable[SqlColumn], row: Row) -> Iterator[SqlValue]:
    """The values of a row for some columns of its class."""
    table = to_plain(row)
    for column in columns:
        value: Any = table
        for key in column.path:
            if value is not None:
                value = value[key] if isinstance(key, int) else value.get(key)
        yield in_sql(value)


def plain_row(columns: Iterable[SqlColumn], values: Mapping[str, SqlValue]) -> dict[str, Any]:
    """The keys and plain values of a row, not yet validated; `values` are by the names of columns.

    NULL is left out: the key has its default, and a limit is infinite.
    """
    table: dict[str, Any] = {}
    for column in columns:
        if (value := values.get(column.name)) is None:
            continue
        inner: Any = table
        for key, below in pairwise(column.path):
            inner = inner.setdefault(key, [None] * 3 if isinstance(below, int) else {})
        # An invalid value stays as it is, and is refused later.
        if isinstance(column.column.kind, Boolean) and value in (0, 1):
            value = bool(value)
        elif isinstance(value, str) and value.startswith(JSON_BEGINS):
            with suppress(ValueError, RecursionError):
                value = json.loads(value)
        inner[column.path[-1]] = value
    return table


NODES: Final = "nodes"
POLYGONS: Final = "polygons"

VALUES: Final = {NODE: "node_scalars", POLYGON: "polygon_scalars"}
"""The tables of the values of scalars, for nodes and for polygons."""


@dataclass(frozen=True)
class RowTable:
    """A table for the rows of a class, in their order. With `is_single` it has at most one row."""

    name: str
    row_class: type[Row]
    is_single: bool = False

    @cached_property
    def columns(self) -> tuple[SqlColumn, ...]:
        """The columns without NUMBER, and without the inner rows of a scene, which have their own tables."""
        columns = columns_of(self.row_class)
        return tuple(column for column in columns if self.row_class is not Scene or len(column.path) == 1)

    @property
    def definition(self) -> str:
        """The statement that creates the table."""
        lines = [f"{NUMBER} INTEGER PRIMARY KEY", *(column.declaration for column in self.columns)]
        return f"CREATE TABLE {quoted(self.name)} (\n  {f',{chr(10)}  '.join(lines)}\n) STRICT"


ROW_TABLES: Final[Mapping[str, RowTable]] = {
    "scene": RowTable("scene", Scene, is_single=True),
    **{
        name: RowTable(name, field.kind.row_class, isinstance(field.kind, Nested))
        for name, field in fields_of(Scene).items()
        if isinstance(field.kind, (RowList, Nested))
    },
}
"""The tables of a scene without its mesh: `scene`, `parts`, `surfaces`, `lights`, `view`, `scalar`."""

DEFINITIONS: Final[Mapping[str, str]] = {
    NODES: """CREATE TABLE nodes (
  node INTEGER PRIMARY KEY,
  x REAL NOT NULL,
  y REAL NOT NULL,
  z REAL NOT NULL
) STRICT""",
    **{name: table.definition for name, table in ROW_TABLES.items()},
    POLYGONS: """CREATE TABLE polygons (
  polygon INTEGER PRIMARY KEY,
  part TEXT NOT NULL REFERENCES parts (name) ON UPDATE CASCADE,
  node1 INTEGER NOT NULL,
  node2 INTEGER NOT NULL,
  node3 INTEGER NOT NULL,
  node4 INTEGER
) STRICT""",
    "mesh": """CREATE TABLE mesh (
  number INTEGER PRIMARY KEY,
  crease_angle REAL NOT NULL
) STRICT""",
    "mesh_scalars": """CREATE TABLE mesh_scalars (
  number INTEGER PRIMARY KEY,
  name TEXT NOT NULL UNIQUE,
  "of" TEXT NOT NULL DEFAULT 'node'
) STRICT""",
    **{
        table: f"""CREATE TABLE {table} (
  scalar TEXT NOT NULL REFERENCES mesh_scalars (name) ON UPDATE CASCADE ON DELETE CASCADE,
  {of} INTEGER NOT NULL REFERENCES {of}s ({of}) ON DELETE CASCADE,
  value REAL,
  PRIMARY KEY (scalar, {of})
) STRICT, WITHOUT ROWID"""
        for of, table in VALUES.items()
    },
}
"""The statements that create all tables of a store, by name."""

INDEXES: Final[Mapping[str, str]] = {
    f"{table}_{column}": f"CREATE INDEX {table}_{column} ON {table} ({column})"
    for column, table in {"part": POLYGONS, **VALUES}.items()
}
"""The statements that create the indexes, by name. They make it fast to rename parts, and to remove nodes and
polygons with their values. They are created after the rows are inserted."""


# The tables of a file. Only plain tables with plain columns are read.
#
# Reading a view, a virtual table or a computed column would run code of the file. A view or a virtual table
# with the name of a table of ours is refused; others are ignored.

MOST_ROWS: Final = 100_000
"""Limit: the rows of a table that is not of the mesh."""

StoredTables = Mapping[str, Sequence[str]]
"""The names of the columns of tables of a file, by the names of the tables, all in lower case."""


def stored_tables(connection: sqlite3.Connection) -> StoredTables:
    """The tables of DEFINITIONS that a store has. Raises InputError if something else has such a name."""
    tables, names = {}, []
    for _, name, kind, *_ in connection.execute("PRAGMA main.table_list").fetchall():
        table = name.lower()
        names.append(table)
        if table not in DEFINITIONS:
            continue
        # To ask for the columns of a virtual table would start it.
        query = f"PRAGMA table_xinfo({quoted(name)})"
        columns = connection.execute(query).fetchall() if kind == "table" else []
        # The number 0 is that of plain columns.
        if not columns or any(column[6] for column in columns):
            raise InputError(
                f"{table} must be a table of plain columns, and no view, virtual table or computed column;"
                " make it one, or rename it"
            )
        tables[table] = [column[1].lower() for column in columns]
    require_names("a store must have the tables", (NODES, POLYGONS), names)
    return tables


def require_names(rule: str, needed: Sequence[str], names: Iterable[str]) -> None:
    """Raise InputError, with the nearest name, if some of the needed names are missing."""
    if missing := [name for name in needed if name not in names]:
        raise InputError(f"{rule} {listed(needed)}; add {listed(missing)}{nearest(missing[0], names)}")


def rows_of_table(
    connection: sqlite3.Connection, tables: StoredTables, table: str
) -> list[dict[str, SqlValue]]:
    """The rows of a table, by the names of its columns, in the order of NUMBER; no rows without the table.

    Raises InputError for more rows than it may have.
    """
    if not (columns := tables.get(table)):
        return []
    ordered = f" ORDER BY {quoted(NUMBER)}" if NUMBER in columns else ""
    query = f"SELECT {', '.join(map(quoted, columns))} FROM {quoted(table)}{ordered} LIMIT {MOST_ROWS + 1}"
    rows = [dict(zip(columns, row, strict=True)) for row in connection.execute(query)]
    is_single = table == "mesh" or (table in ROW_TABLES and ROW_TABLES[table].is_single)
    if len(rows) > (most := 1 if is_single else MOST_ROWS):
        raise InputError(f"the rows of {table} must be at most {most:,}, not more; leave rows out")
    return rows
