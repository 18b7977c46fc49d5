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
from dataclasses import dataclass
from functools import cached_property
from itertools import groupby
from typing import Any, Final

from autocolor.checks import listed, nearest
from autocolor.errors import InputError
from autocolor.scene.columns import MISSING, Column, Kind, Row, fields_of, to_plain
from autocolor.scene.kinds import Boolean, ColorKind, Instance, Number, OneOf, Text, VectorKind, Whole
from autocolor.scene.row_kinds import NamedRows, Nested, OneRowOf, Reference, RowList
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


@dataclass(frozen=True)
class SqlColumn:
    """A column of an SQL table, for the value at `path` in a row's keys and plain values.

    A vector has three columns; `component` is 0, 1 or 2.
    """

    name: str
    path: tuple[str, ...]
    kind: Kind[Any]
    help: str
    component: int | None = None
    may_be_null: bool = False
    default: SqlValue = None

    @property
    def type(self) -> str:
        """The type in SQL."""
        return next((name for name, kinds in TYPES.items() if isinstance(self.kind, kinds)), "ANY")

    @property
    def references(self) -> str:
        """The table whose column `name` has the values of the column; empty for none."""
        return self.kind.table if isinstance(self.kind, Reference) and not self.kind.word else ""

    @property
    def declaration(self) -> str:
        """The column as a line of `CREATE TABLE`."""
        parts = [quoted(self.name), self.type]
        if not self.may_be_null:
            parts.append("NOT NULL")
        if self.path == ("name",) and isinstance(self.kind, Text) and not self.kind.may_be_empty:
            parts.append("UNIQUE")
        if self.default is not None:
            parts.append(f"DEFAULT {literal(self.default)}")
        if self.references:
            parts.append(f"REFERENCES {quoted(self.references)} (name) ON UPDATE CASCADE")
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


def columns_of(row_class: type[Row]) -> tuple[SqlColumn, ...]:
    """The columns for the fields of a row class, except fields with meshes and lists of rows."""
    fields = fields_of(row_class).items()
    return tuple(column for name, field in fields for column in _columns(name, field, (), is_given=True))


def _columns(name: str, column: Column, prefix: tuple[str, ...], is_given: bool) -> Iterator[SqlColumn]:
    """The columns of a field.

    All of them may be NULL if the row around the field may be absent, or if the field may be reset because
    the row uses an alternative. A row that may be absent must have a column that is never NULL.
    """
    kind, is_optional = column.kind, column.is_optional
    if isinstance(kind, (Instance, RowList)):
        return
    if isinstance(kind, Nested):
        alternatives = {name for group in kind.row_class.alternatives for name in group}
        for inner_name, inner in fields_of(kind.row_class).items():
            inner_is_given = is_given and not is_optional and inner_name not in alternatives
            inner_prefix = prefix if kind.inline else (*prefix, name)
            yield from _columns(inner_name, inner, inner_prefix, inner_is_given)
        return
    may_be_null = is_optional or not is_given or endless(kind) is not None or isinstance(kind, NamedRows)
    has_start = column.default is not MISSING and not may_be_null
    start: Any = kind.to_plain(name, column.default).get(name) if has_start else None
    for key, inner_column in kind.keys(name, column).items():
        # The other keys belong to the classes of a variant; a class has only some of the keys.
        may_be_absent, value = (may_be_null, start) if key == name else (True, None)
        path, inner_kind = (*prefix, key), inner_column.kind
        for number, axis in enumerate(AXES) if isinstance(inner_kind, VectorKind) else [(None, "")]:
            yield SqlColumn(
                "_".join((*path, axis) if axis else path),
                path,
                inner_kind,
                inner_column.help,
                number,
                may_be_absent,
                in_sql(value if number is None or value is None else value[number]),
            )


def endless(kind: Kind[Any]) -> float | None:
    """The infinite value that a kind may have, which a table has as NULL."""
    return getattr(kind, "endless", None)


def in_sql(value: object) -> SqlValue:
    """A plain value as a value of a table."""
    if value is None or isinstance(value, float):
        return value
    if isinstance(value, int):
        return int(value)
    if isinstance(value, str) and not value.startswith(JSON_BEGINS):
        return value
    return json.dumps(value, ensure_ascii=False)


def row_values(columns: Iterable[SqlColumn], row: Row) -> list[SqlValue]:
    """The values of a row for some columns of its class."""
    table = to_plain(row)
    values = ((_within(table, column.path), column.component) for column in columns)
    return [in_sql(value if axis is None or value is None else value[axis]) for value, axis in values]


def plain_row(columns: Iterable[SqlColumn], values: Mapping[str, SqlValue]) -> dict[str, Any]:
    """The keys and plain values of a row, not yet validated; `values` are by the names of columns.

    NULL is left out, or becomes an infinite limit if its row has other values.
    """
    table: dict[str, Any] = {}
    limits = []
    for path, group in groupby(columns, lambda column: column.path):
        first, *others = group
        given = [values.get(column.name) for column in (first, *others)]
        if any(value is not None for value in given):
            value = given if others else _from_sql(first.kind, given[0])
            _within(table, path[:-1], is_made=True)[path[-1]] = value
        elif first.name in values and endless(first.kind) is not None:
            limits.append((path, endless(first.kind)))
    for path, limit in limits:
        inner = _within(table, path[:-1])
        if isinstance(inner, dict):
            inner[path[-1]] = limit
    return table


def _within(table: Any, path: Sequence[str], is_made: bool = False) -> Any:
    """The value at a path of keys in a table, or None. With `is_made`, missing tables are made there."""
    for key in path:
        if is_made:
            table = table.setdefault(key, {})
        else:
            table = table.get(key) if isinstance(table, Mapping) else None
    return table


def _from_sql(kind: Kind[Any], value: SqlValue) -> object:
    """A value of a table as a plain value. An invalid value is returned as it is, and refused later."""
    if isinstance(kind, Boolean) and value in (0, 1):
        return bool(value)
    if isinstance(value, str) and value.startswith(JSON_BEGINS):
        try:
            return json.loads(value)
        except (ValueError, RecursionError):
            return value
    return value


# The definitions of all tables.

APPLICATION: Final = 0x47_4D_41_43
"""The number in the header of our stores: GMAC, for GM AUTOCOLOR."""

VERSION: Final = 1
"""The version of the tables, `PRAGMA user_version`."""

SCENE: Final = "scene"
MESH: Final = "mesh"
NODES: Final = "nodes"
POLYGONS: Final = "polygons"
SCALARS: Final = "mesh_scalars"

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
        return _definition(self.name, NUMBER, [column.declaration for column in self.columns])


def _definition(name: str, key: str, lines: Iterable[str]) -> str:
    return (
        f"CREATE TABLE {quoted(name)} (\n  "
        + ",\n  ".join([f"{key} INTEGER PRIMARY KEY", *lines])
        + "\n) STRICT"
    )


ROW_TABLES: Final[Mapping[str, RowTable]] = {
    SCENE: RowTable(SCENE, Scene, is_single=True),
    **{
        name: RowTable(name, field.kind.row_class, isinstance(field.kind, Nested))
        for name, field in fields_of(Scene).items()
        if isinstance(field.kind, (RowList, Nested))
    },
}
"""The tables of a scene without its mesh: `scene`, `parts`, `surfaces`, `lights`, `view`, `scalar`."""

DEFINITIONS: Final[Mapping[str, str]] = {
    NODES: _definition(NODES, "node", (f"{axis} REAL NOT NULL" for axis in AXES)),
    **{name: table.definition for name, table in ROW_TABLES.items()},
    POLYGONS: _definition(
        POLYGONS,
        "polygon",
        [
            "part TEXT NOT NULL REFERENCES parts (name) ON UPDATE CASCADE",
            *(f"node{corner} INTEGER NOT NULL REFERENCES {NODES} (node)" for corner in (1, 2, 3)),
            f"node4 INTEGER REFERENCES {NODES} (node)",
        ],
    ),
    MESH: _definition(MESH, NUMBER, ["crease_angle REAL NOT NULL"]),
    SCALARS: _definition(
        SCALARS, NUMBER, ["name TEXT NOT NULL UNIQUE", f'"of" TEXT NOT NULL DEFAULT {NODE!r}']
    ),
    **{
        VALUES[of]: (
            f'CREATE TABLE "{VALUES[of]}" (\n'
            f"  scalar TEXT NOT NULL REFERENCES {SCALARS} (name) ON UPDATE CASCADE ON DELETE CASCADE,\n"
            f"  {of} INTEGER NOT NULL REFERENCES {table} ({of}) ON DELETE CASCADE,\n"
            f"  value REAL,\n"
            f"  PRIMARY KEY (scalar, {of})\n) STRICT, WITHOUT ROWID"
        )
        for of, table in ((NODE, NODES), (POLYGON, POLYGONS))
    },
}
"""The statements that create all tables of a store, by name."""

INDEXES: Final[Mapping[str, str]] = {
    f"{table}_{column}": f"CREATE INDEX {quoted(f'{table}_{column}')} ON {quoted(table)} ({quoted(column)})"
    for table, columns in {
        **{
            name: [column.name for column in table.columns if column.references]
            for name, table in ROW_TABLES.items()
        },
        POLYGONS: ["part", "node1", "node2", "node3", "node4"],
        VALUES[NODE]: [NODE],
        VALUES[POLYGON]: [POLYGON],
    }.items()
    for column in columns
}
"""The statements that create the indexes, by name. A column that refers to another table has an index, which
makes joins and changes of the other table fast. Indexes are created after the rows are inserted."""


# The tables of a file. Only plain tables with plain columns are read.
#
# Reading a view, a virtual table or a computed column would run code of the file. A view or a virtual table
# with the name of a table of ours is refused; others are ignored.

MOST_ROWS: Final = 100_000
"""Limit: the rows of a table that is not of the mesh."""

NOT_STORED: Final = (1, 2, 3)
"""The numbers that `PRAGMA table_xinfo` has for hidden and computed columns."""

StoredTables = Mapping[str, Sequence[str]]
"""The names of the columns of tables of a file, by the names of the tables, all in lower case."""


def stored_tables(connection: sqlite3.Connection) -> StoredTables:
    """The tables of DEFINITIONS that a store has.

    Raises InputError if the file is of a later version, or something else has the name of a table.
    """
    (application,) = connection.execute("PRAGMA application_id").fetchone()
    (version,) = connection.execute("PRAGMA user_version").fetchone()
    if application == APPLICATION and version > VERSION:
        raise InputError(
            f"the version of a store must be at most {VERSION}, not {version}; read it with a newer autocolor"
        )
    tables, names = {}, []
    for _, name, kind, *_ in connection.execute("PRAGMA main.table_list").fetchall():
        table = name.lower()
        names.append(table)
        if table not in DEFINITIONS:
            continue
        # To ask for the columns of a virtual table would start it.
        query = f"PRAGMA table_xinfo({quoted(name)})"
        columns = connection.execute(query).fetchall() if kind == "table" else []
        if not columns or any(column[6] in NOT_STORED for column in columns):
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
    """The rows of a table, by the names of its columns, ordered by the column NUMBER if the table has it.

    No rows if there is no such table. Raises InputError for more rows than it may have, and for a value that
    is bytes.
    """
    columns = tables.get(table, ())
    if not columns:
        return []
    ordered = f" ORDER BY {quoted(NUMBER)}" if NUMBER in columns else ""
    query = f"SELECT {', '.join(map(quoted, columns))} FROM {quoted(table)}{ordered} LIMIT {MOST_ROWS + 1}"
    rows = [dict(zip(columns, row, strict=True)) for row in connection.execute(query)]
    is_single = table == MESH or (table in ROW_TABLES and ROW_TABLES[table].is_single)
    if len(rows) > (most := 1 if is_single else MOST_ROWS):
        raise InputError(f"the rows of {table} must be at most {most:,}, not more; leave rows out")
    for number, row in enumerate(rows, 1):
        for name in (name for name, value in row.items() if isinstance(value, bytes)):
            raise InputError(f"{table}, row {number}: {name} must be a number or text, not bytes; correct it")
    return rows
