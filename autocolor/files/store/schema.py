"""The tables of a store: their names, their columns and how they are made.

Every table of a scene has one, and so have the node table, the polygon table and the scalars of the mesh. All
are STRICT, and tell what a value must be and which rows it refers to.
"""

from __future__ import annotations

import sqlite3
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Final, NamedTuple

from autocolor.checks import LARGEST_COORDINATE, listed, nearest, shown
from autocolor.errors import InputError
from autocolor.files.store.sql_columns import NUMBER, SqlColumn, SqlValue, checked, columns_of, quoted
from autocolor.scene.columns import Row, fields_of
from autocolor.scene.row_kinds import Nested, RowList
from autocolor.scene.scalar import NODE, POLYGON
from autocolor.scene.scene import Scene

APPLICATION: Final = 0x47_4D_41_43
"""The number in the header of our stores: GMAC, for GM AUTOCOLOR."""

VERSION: Final = 1
"""The version of the tables, `PRAGMA user_version`."""

SCENE: Final = "scene"
MESH: Final = "mesh"
NODES: Final = "nodes"
POLYGONS: Final = "polygons"
SCALARS: Final = "mesh_scalars"
IN_DEGREES: Final = "crease_angle BETWEEN 0 AND 180"

VALUES: Final = {NODE: "node_scalars", POLYGON: "polygon_scalars"}
"""The tables of the values of scalars, by what they are of."""


@dataclass(frozen=True)
class RowTable:
    """A table with a row for each row of a class, in their order; at most one if it `is_single`.

    `columns` are those for the class, without the one that counts the rows.
    """

    name: str
    row_class: type[Row]
    columns: tuple[SqlColumn, ...]
    is_single: bool

    @property
    def definition(self) -> str:
        """The statement that makes the table."""
        key = f"{quoted(NUMBER)} INTEGER PRIMARY KEY"
        if self.is_single:
            key += f" DEFAULT 1 CHECK ({quoted(NUMBER)} = 1)"
        lines = [key, *(column.declaration for column in self.columns), *_vector_checks(self.columns)]
        return _definition(self.name, lines)


def _vector_checks(columns: tuple[SqlColumn, ...]) -> list[str]:
    """That a vector that may be absent has all of its components or none, and that some are not all 0."""
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
    """The table for a row class; of a scene, without what has tables of its own."""
    columns = columns_of(row_class)
    if row_class is Scene:
        columns = tuple(column for column in columns if len(column.path) == 1)
    return RowTable(name, row_class, columns, is_single)


def _row_tables() -> dict[str, RowTable]:
    """The tables for the rows of a scene by name; a table comes after those that it refers to."""
    found = {SCENE: row_table(SCENE, Scene, is_single=True)}
    for name, field in fields_of(Scene).items():
        kind = field.column.kind
        if isinstance(kind, (RowList, Nested)):
            found[name] = row_table(name, kind.row_class, is_single=isinstance(kind, Nested))
    return found


ROW_TABLES: Final[Mapping[str, RowTable]] = _row_tables()
"""The tables of a scene but those of its mesh: `scene`, `parts`, `surfaces`, `lights`, `view`, `scalar`."""


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
            f"{NUMBER} INTEGER PRIMARY KEY DEFAULT 1 CHECK ({NUMBER} = 1)",
            f"crease_angle REAL NOT NULL {checked('crease_angle must be from 0 to 180', IN_DEGREES)}",
        ],
    ),
    SCALARS: _definition(
        SCALARS,
        [
            f"{NUMBER} INTEGER PRIMARY KEY",
            "name TEXT NOT NULL UNIQUE CHECK (name <> '')",
            f'"of" TEXT NOT NULL DEFAULT {NODE!r} CHECK ("of" IN ({NODE!r}, {POLYGON!r}))',
        ],
    ),
    VALUES[NODE]: _values(NODE, NODES),
    VALUES[POLYGON]: _values(POLYGON, POLYGONS),
}
"""The statements that make the tables, by name: all tables of a store."""

MESH_TABLES: Final = (NODES, POLYGONS, MESH, SCALARS, *VALUES.values())


# -------------------- found_tables
# The tables that a file really has: plain tables with plain columns are read, and nothing else.
#
# A view, a virtual table or a computed column of a name that a store needs would run what a stranger wrote
# when it is read; it is refused by that name. Of other names they are nobody's business, and stay.

MOST_TABLES: Final = 10_000
MOST_ROWS: Final = 100_000
"""Assumed: the rows of a table that is not of the mesh."""

COMPUTED: Final = (2, 3)
HIDDEN: Final = 1


class FoundTable(NamedTuple):
    """A table as it is: its columns, its key of whole numbers if it has one, and whether it checks types."""

    columns: tuple[str, ...]
    key: str
    is_strict: bool


FoundTables = Mapping[str, FoundTable]


def found_tables(connection: sqlite3.Connection) -> FoundTables:
    """The tables of a store that are there, by name.

    Raises InputError if the file is of a later version, or something else has the name of a table.
    """
    (application,) = connection.execute("PRAGMA application_id").fetchone()
    (version,) = connection.execute("PRAGMA user_version").fetchone()
    if application == APPLICATION and version > VERSION:
        raise InputError(
            f"the version of a store must be at most {VERSION}, not {version}; read it with a newer autocolor"
        )
    rows = connection.execute("SELECT type, name, rootpage FROM sqlite_master LIMIT ?", (MOST_TABLES,))
    kinds = {
        name.lower(): (kind, name, root)
        for kind, name, root in rows.fetchall()
        if kind in ("table", "view") and isinstance(name, str)
    }
    found = {}
    strict = {row[1].lower() for row in connection.execute("PRAGMA table_list").fetchall() if row[5]}
    for table in DEFINITIONS:
        if table not in kinds:
            continue
        kind, name, root = kinds[table]
        if kind != "table" or not root:
            what = "a view" if kind == "view" else "a virtual table"
            raise InputError(f"{table} must be a table, not {what}; make it a table, or rename it")
        columns = connection.execute(f"PRAGMA table_xinfo({quoted(name)})").fetchall()
        for column in columns:
            if column[6] in (*COMPUTED, HIDDEN):
                raise InputError(
                    f"{table}: a column must hold values, not compute them as {shown(column[1])} does; make"
                    " it a plain column"
                )
        keys = [(column[1].lower(), column[2].upper()) for column in columns if column[5]]
        key = keys[0][0] if len(keys) == 1 and keys[0][1] == "INTEGER" else ""
        found[table] = FoundTable(tuple(column[1].lower() for column in columns), key, table in strict)
    missing = [name for name in (NODES, POLYGONS) if name not in found]
    if missing:
        raise InputError(_lacking("a store must have the tables", (NODES, POLYGONS), missing, kinds))
    return found


def require_columns(table: str, columns: Iterable[str], needed: Iterable[str]) -> None:
    """Raise InputError if a table lacks a column that it needs."""
    there = tuple(columns)
    missing = [name for name in needed if name not in there]
    if missing:
        raise InputError(_lacking(f"{table} must have the columns", needed, missing, there))


def _lacking(rule: str, needed: Iterable[str], missing: list[str], there: Iterable[str]) -> str:
    """That some of the needed names are missing, and what is there that may be meant."""
    is_one = len(missing) == 1
    return (
        f"{rule} {listed(needed)}, and {listed(missing)} {'is' if is_one else 'are'} missing; add"
        f" {'it' if is_one else 'them'}{nearest(missing[0], there)}"
    )


def small_table(
    connection: sqlite3.Connection, table: str, columns: tuple[str, ...], order: str
) -> list[dict[str, SqlValue]]:
    """The rows of a table by the names of its columns, in an order; at most MOST_ROWS. Raises InputError."""
    names = ", ".join(map(quoted, columns))
    ordered = f" ORDER BY {quoted(order)}" if order in columns else ""
    query = f"SELECT {names} FROM {quoted(table)}{ordered} LIMIT {MOST_ROWS + 1}"
    rows = connection.execute(query).fetchall()
    if len(rows) > MOST_ROWS:
        raise InputError(f"{table} must have at most {MOST_ROWS:,} rows, not more; leave rows out")
    for number, row in enumerate(rows, 1):
        for name, value in zip(columns, row, strict=True):
            if isinstance(value, bytes):
                raise InputError(
                    f"{table}, row {number}: {name} must be a number or text, not bytes; correct it"
                )
    return [dict(zip(columns, row, strict=True)) for row in rows]
