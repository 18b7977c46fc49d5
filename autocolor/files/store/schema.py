"""The tables of a store: the SQL columns of row classes, the definitions of tables, and their inspection.

Each table of a scene is one SQL table, made from the descriptions of its columns; the nodes, the polygons and
the scalars of the mesh have tables of their own. All are STRICT. A CHECK is named by its rule, so any tool
shows the rule when a value breaks it. Columns that refer to other tables have indexes.

A number, a switch, a name, a choice or a color is one SQL column of the key's name. A point or a direction is
three: `position_x`, `position_y`, `position_z`. A row in a row is the columns of that row with the key before
them: `flaps_z_minimum`. Any other value is one column: text as it is, and lists and tables as JSON. An absent
value is NULL, and so is a limit that is infinite. A surface has a ramp, or two colors and their blend: the
columns of the other are NULL. NULL in a column that the surface uses stands for the default.
"""

from __future__ import annotations

import json
import math
import sqlite3
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final, NamedTuple

from autocolor.checks import LARGEST_COORDINATE, listed, nearest, shown
from autocolor.errors import InputError
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
from autocolor.scene.scalar import NODE, POLYGON
from autocolor.scene.scene import Scene

NUMBER: Final = "number"
"""The column that counts the rows of a table from 1, in their order; the tables of the mesh apart."""

AXES: Final = ("x", "y", "z")
LARGEST_FLOAT: Final = 1.7976931348623157e308

TEXT_KINDS: Final = (Text, OneOf, ColorKind, Reference, OneRowOf)
JSON_BEGINS: Final = ("[", "{", '"')
"""A text with such a beginning is JSON."""

SqlValue = None | int | float | str
"""A value of a table; a store has no bytes."""


@dataclass(frozen=True)
class SqlColumn:
    """A column of an SQL table, for the value at `path` in a row's keys and plain values.

    A vector has three columns; `component` is 0, 1 or 2. If `references` is the name of a table, the values
    of the column are values of that table's column `name`.
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
        """The type in SQL."""
        if isinstance(self.kind, (Number, VectorKind)):
            return "REAL"
        if isinstance(self.kind, (Whole, Boolean)):
            return "INTEGER"
        return "TEXT" if isinstance(self.kind, TEXT_KINDS) else "ANY"

    @property
    def checks(self) -> Iterator[str]:
        """The SQL conditions that the values must meet; NULL meets every condition."""
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
        checks = list(self.checks)
        if checks:
            # Any tool shows the name of a check that fails.
            parts.append(checked(f"{'.'.join(self.path)} {self.kind.rule()}", " AND ".join(checks)))
        return " ".join(parts)


def quoted(name: str) -> str:
    """A name as SQL writes it.

    >>> quoted("on")
    '"on"'
    """
    return '"' + name.replace('"', '""') + '"'


def checked(rule: str, condition: str) -> str:
    """A CHECK of a table, named by its rule."""
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
    """The columns for the fields of a row class, except fields with meshes and lists of rows."""
    return tuple(
        column
        for name, field in fields_of(row_class).items()
        for column in _columns(name, field, (), is_given=True)
    )


def _columns(name: str, field: Field, prefix: tuple[str, ...], is_given: bool) -> Iterator[SqlColumn]:
    """The columns of a field.

    All of them may be NULL if the row around the field may be absent, or if the field may be reset because
    the row uses an alternative.
    """
    column, is_optional, default = field
    kind, path = column.kind, (*prefix, name)
    if isinstance(kind, (Instance, RowList)):
        return
    if isinstance(kind, Nested) and (not is_optional or _has_required_column(kind.row_class)):
        inner_prefix = prefix if kind.inline else path
        alternatives = {name for group in kind.row_class.alternatives for name in group}
        for inner_name, inner in fields_of(kind.row_class).items():
            inner_is_given = is_given and not is_optional and inner_name not in alternatives
            yield from _columns(inner_name, inner, inner_prefix, inner_is_given)
        return
    may_be_null = is_optional or not is_given or getattr(kind, "endless", None) is not None
    may_be_null |= isinstance(kind, NamedRows)
    start: Any = default() if default is not None and is_given and not may_be_null else None
    defaults: dict[str, Any] = {} if start is None else dict(kind.to_plain(name, start))
    keys = kind.keys(name, column)
    for key, inner_column in keys.items():
        # The other keys belong to the classes of a variant; a class has only some of the keys.
        is_own = key == name
        inner_kind, text = inner_column.kind, inner_column.help
        nullable = may_be_null or not is_own
        value = defaults.get(key) if is_own else None
        if isinstance(inner_kind, VectorKind):
            for number, axis in enumerate(AXES):
                component = None if value is None else float(value[number])
                name_of_axis = "_".join((*prefix, key, axis))
                yield SqlColumn(name_of_axis, (*prefix, key), inner_kind, text, number, nullable, component)
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


def _has_required_column(row_class: type[Row]) -> bool:
    """Whether a row of the class always has a value that is not NULL, so that an absent row is all NULL."""
    return any(
        not field.is_optional
        and getattr(field.column.kind, "endless", None) is None
        and (not isinstance(field.column.kind, Nested) or _has_required_column(field.column.kind.row_class))
        for field in fields_of(row_class).values()
    )


def in_sql(value: object) -> SqlValue:
    """A plain value as a value of a table."""
    if value is None or isinstance(value, (bool, int)):
        return None if value is None else int(value)
    if isinstance(value, float):
        return value
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
    vectors: dict[tuple[str, ...], list[SqlValue]] = {}
    limits = []
    for column in columns:
        value = values.get(column.name)
        if column.component is not None:
            vectors.setdefault(column.path, []).append(value)
        elif value is not None:
            _within(table, column.path[:-1], True)[column.path[-1]] = _from_sql(column.kind, value)
        elif column.name in values and (endless := getattr(column.kind, "endless", None)) is not None:
            limits.append((column.path, endless))
    for path, components in vectors.items():
        if components != [None] * len(AXES):
            _within(table, path[:-1], True)[path[-1]] = components
    for path, endless in limits:
        inner = _within(table, path[:-1])
        if isinstance(inner, dict):
            inner[path[-1]] = endless
    return table


def _within(table: Any, path: Sequence[str], is_made: bool = False) -> Any:
    """The value at a path of keys in a table, or None. With `is_made`, missing tables are made there."""
    for key in path:
        if is_made:
            table = table.setdefault(key, {})
        else:
            table = table.get(key) if isinstance(table, Mapping) else None
    return table


def _from_sql(kind: Kind, value: SqlValue) -> object:
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


SINGLE_ROW: Final = checked(f"{NUMBER} must be 1", f"{quoted(NUMBER)} = 1")


@dataclass(frozen=True)
class RowTable:
    """A table for the rows of a class, in their order. With `is_single` it has at most one row.

    `columns` lacks the column NUMBER, which every such table has.
    """

    name: str
    row_class: type[Row]
    columns: tuple[SqlColumn, ...]
    is_single: bool

    @property
    def definition(self) -> str:
        """The statement that creates the table."""
        key = f"{quoted(NUMBER)} INTEGER PRIMARY KEY"
        if self.is_single:
            key += f" DEFAULT 1 {SINGLE_ROW}"
        lines = [key, *(column.declaration for column in self.columns), *_vector_checks(self.columns)]
        return _definition(self.name, lines)


def _vector_checks(columns: tuple[SqlColumn, ...]) -> list[str]:
    """CHECKs of vector columns: all components or none are NULL, and directions are not zero."""
    checks = []
    vectors: dict[tuple[str, ...], list[SqlColumn]] = {}
    for column in columns:
        if column.component is not None:
            vectors.setdefault(column.path, []).append(column)
    for x, y, z in vectors.values():
        name = ".".join(x.path)
        a, b, c = (quoted(column.name) for column in (x, y, z))
        if x.may_be_null:
            all_or_none = f"({a} IS NULL) = ({b} IS NULL) AND ({a} IS NULL) = ({c} IS NULL)"
            checks.append(checked(f"{name} must have all of x, y and z, or none of them", all_or_none))
        if getattr(x.kind, "has_length", False):
            checks.append(checked(f"{name} must not be zero", f"{a} <> 0 OR {b} <> 0 OR {c} <> 0"))
    return checks


def row_table(name: str, row_class: type[Row], is_single: bool = False) -> RowTable:
    """The table for a row class. The table of a scene lacks its inner rows, which have their own tables."""
    columns = columns_of(row_class)
    if row_class is Scene:
        columns = tuple(column for column in columns if len(column.path) == 1)
    return RowTable(name, row_class, columns, is_single)


def _row_tables() -> dict[str, RowTable]:
    """The tables for the rows of a scene by name, in the order of its fields."""
    tables = {SCENE: row_table(SCENE, Scene, is_single=True)}
    for name, field in fields_of(Scene).items():
        kind = field.column.kind
        if isinstance(kind, (RowList, Nested)):
            tables[name] = row_table(name, kind.row_class, is_single=isinstance(kind, Nested))
    return tables


ROW_TABLES: Final[Mapping[str, RowTable]] = _row_tables()
"""The tables of a scene without its mesh: `scene`, `parts`, `surfaces`, `lights`, `view`, `scalar`."""


def _definition(name: str, lines: list[str], end: str = "STRICT") -> str:
    return f"CREATE TABLE {quoted(name)} (\n  " + ",\n  ".join(lines) + f"\n) {end}"


def _number(name: str, rest: str = " NOT NULL") -> str:
    rule = f"{name} must be finite and at most {LARGEST_COORDINATE:g} in size"
    return f"{name} REAL{rest} {checked(rule, f'abs({name}) <= {LARGEST_COORDINATE!r}')}"


def _values(of: str, table: str) -> str:
    return _definition(
        VALUES[of],
        [
            f"scalar TEXT NOT NULL REFERENCES {SCALARS} (name) ON UPDATE CASCADE ON DELETE CASCADE",
            f"{of} INTEGER NOT NULL REFERENCES {table} ({of})",
            _number("value", ""),
            f"PRIMARY KEY (scalar, {of})",
        ],
        "STRICT, WITHOUT ROWID",
    )


DEFINITIONS: Final[Mapping[str, str]] = {
    NODES: _definition(NODES, ["node INTEGER PRIMARY KEY", *map(_number, ("x", "y", "z"))]),
    **{name: table.definition for name, table in ROW_TABLES.items()},
    POLYGONS: _definition(
        POLYGONS,
        [
            "polygon INTEGER PRIMARY KEY",
            "part TEXT NOT NULL REFERENCES parts (name) ON UPDATE CASCADE",
            *(f"node{corner} INTEGER NOT NULL REFERENCES {NODES} (node)" for corner in (1, 2, 3)),
            f"node4 INTEGER REFERENCES {NODES} (node)",
        ],
    ),
    MESH: _definition(
        MESH,
        [
            f"{NUMBER} INTEGER PRIMARY KEY DEFAULT 1 {SINGLE_ROW}",
            "crease_angle REAL NOT NULL "
            + checked("crease_angle must be from 0 to 180", "crease_angle BETWEEN 0 AND 180"),
        ],
    ),
    SCALARS: _definition(
        SCALARS,
        [
            f"{NUMBER} INTEGER PRIMARY KEY",
            "name TEXT NOT NULL UNIQUE " + checked("name must not be empty", "name <> ''"),
            f'"of" TEXT NOT NULL DEFAULT {NODE!r} '
            + checked(f"of must be {NODE!r} or {POLYGON!r}", f'"of" IN ({NODE!r}, {POLYGON!r})'),
        ],
    ),
    VALUES[NODE]: _values(NODE, NODES),
    VALUES[POLYGON]: _values(POLYGON, POLYGONS),
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

MESH_TABLES: Final = (NODES, POLYGONS, MESH, SCALARS, *VALUES.values())


# The tables of a file. Only plain tables with plain columns are read.
#
# Reading a view, a virtual table or a computed column would run code of the file. A view or a virtual table
# with the name of a table of ours is refused; others are ignored.

MOST_ROWS: Final = 100_000
"""Limit: the rows of a table that is not of the mesh."""

NOT_STORED: Final = (1, 2, 3)
"""The numbers that `PRAGMA table_xinfo` has for hidden and computed columns."""


class StoredTable(NamedTuple):
    """A table of a file: its columns, and whether it is STRICT."""

    columns: tuple[str, ...]
    is_strict: bool


StoredTables = Mapping[str, StoredTable]


def stored_tables(connection: sqlite3.Connection) -> StoredTables:
    """The tables of DEFINITIONS that a store has, by name.

    Raises InputError if the file is of a later version, or something else has the name of a table.
    """
    (application,) = connection.execute("PRAGMA application_id").fetchone()
    (version,) = connection.execute("PRAGMA user_version").fetchone()
    if application == APPLICATION and version > VERSION:
        raise InputError(
            f"the version of a store must be at most {VERSION}, not {version}; read it with a newer autocolor"
        )
    tables, names = {}, []
    for _, name, kind, _, _, is_strict in connection.execute("PRAGMA main.table_list").fetchall():
        table = name.lower()
        names.append(table)
        if table not in DEFINITIONS:
            continue
        if kind != "table":
            what = "a view" if kind == "view" else f"a {kind} table"
            raise InputError(f"{table} must be a table, not {what}; make it a table, or rename it")
        columns = connection.execute(f"PRAGMA table_xinfo({quoted(name)})").fetchall()
        for column in columns:
            if column[6] in NOT_STORED:
                raise InputError(
                    f"{table}: a column must hold values, not compute them as {shown(column[1])} does; make"
                    " it a plain column"
                )
        tables[table] = StoredTable(tuple(column[1].lower() for column in columns), bool(is_strict))
    _require("a store must have the tables", (NODES, POLYGONS), names)
    return tables


def require_columns(table: str, columns: Iterable[str], needed: Sequence[str]) -> None:
    """Raise InputError if a table lacks a column that it needs."""
    _require(f"{table} must have the columns", needed, columns)


def _require(rule: str, needed: Sequence[str], names: Iterable[str]) -> None:
    """Raise InputError, with the nearest name, if some of the needed names are missing."""
    missing = [name for name in needed if name not in names]
    if missing:
        verb, them = ("is", "it") if len(missing) == 1 else ("are", "them")
        raise InputError(
            f"{rule} {listed(needed)}, and {listed(missing)} {verb} missing; add"
            f" {them}{nearest(missing[0], names)}"
        )


def rows_of_table(
    connection: sqlite3.Connection, table: str, columns: Sequence[str]
) -> list[dict[str, SqlValue]]:
    """The rows of a table, by the names of its columns, ordered by the column NUMBER if the table has it.

    Raises InputError for more than MOST_ROWS rows, and for a value that is bytes.
    """
    ordered = f" ORDER BY {quoted(NUMBER)}" if NUMBER in columns else ""
    query = f"SELECT {', '.join(map(quoted, columns))} FROM {quoted(table)}{ordered} LIMIT {MOST_ROWS + 1}"
    rows = [dict(zip(columns, row, strict=True)) for row in connection.execute(query)]
    if len(rows) > MOST_ROWS:
        raise InputError(f"{table} must have at most {MOST_ROWS:,} rows, not more; leave rows out")
    for number, row in enumerate(rows, 1):
        for name, value in row.items():
            if isinstance(value, bytes):
                raise InputError(
                    f"{table}, row {number}: {name} must be a number or text, not bytes; correct it"
                )
    return rows
