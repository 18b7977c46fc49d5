"""The tables that a file really has: plain tables with plain columns are read, and nothing else.

A view, a virtual table or a computed column of a name that a store needs would run what a stranger wrote when
it is read; it is refused by that name. Of other names they are nobody's business, and stay.
"""

from __future__ import annotations

import sqlite3
from collections.abc import Iterable, Mapping
from typing import Final, NamedTuple

from autocolor.checks import listed, nearest, shown
from autocolor.errors import InputError
from autocolor.files.store.schema import APPLICATION, DEFINITIONS, NODES, POLYGONS, VERSION
from autocolor.files.store.sql_columns import SqlValue, quoted

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
