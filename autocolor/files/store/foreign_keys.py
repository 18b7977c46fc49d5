"""The rows of a store that refer to rows that are not there, told by their tables and numbers.

Tools that edit a store leave its foreign keys unchecked unless they are asked to check them, and SQLite's
own error names no row. The polygon table is left to `mesh_rows`, which must find each node and part anyway:
SQLite would take a quarter of a second for a million polygons.
"""

from __future__ import annotations

import sqlite3
from collections.abc import Iterable, Iterator, Mapping
from itertools import islice
from typing import Final

from autocolor.checks import nearest, shown
from autocolor.files.store.schema import DEFINITIONS, MESH_TABLES
from autocolor.files.store.sql_columns import quoted

MOST_PROBLEMS: Final = 20
MOST_NAMES: Final = 1000

NOUNS: Final = {"parts": "part", "surfaces": "surface", "nodes": "node", "polygons": "polygon"}


def broken_references(
    connection: sqlite3.Connection, tables: Mapping[str, object], names: Iterable[str]
) -> list[str]:
    """What is wrong with the references of some tables of a store by name, up to MOST_PROBLEMS.

    `tables` are those that are there: a reference to one that is not there is no problem, as that is created.
    """
    found = (
        problem for table in names if table in tables for problem in _of_table(connection, table, tables)
    )
    # Rows without numbers are told once.
    return list(islice(dict.fromkeys(found), MOST_PROBLEMS))


def _of_table(connection: sqlite3.Connection, table: str, tables: Mapping[str, object]) -> Iterator[str]:
    columns = {
        number: (column, parent)
        for number, _, parent, column, *_ in connection.execute(f"PRAGMA foreign_key_list({quoted(table)})")
        if parent.lower() in tables and parent.lower() in DEFINITIONS
    }
    if not columns:
        return
    try:
        rows = connection.execute(f"PRAGMA foreign_key_check({quoted(table)})")
        broken = [row for row in islice(rows, MOST_PROBLEMS * 10) if row[3] in columns]
    except sqlite3.OperationalError:
        # Keys that fit no table say nothing; what they would have told is checked as the rows are read.
        return
    for _, row, _, number in broken[:MOST_PROBLEMS]:
        column, parent = columns[number]
        parent = parent.lower()
        place = f"{table}, row {row}" if row is not None else table
        noun = NOUNS.get(parent, parent)
        if row is None:
            yield f"{place}: a {column} is not in the {noun} table; remove such rows"
            continue
        value = connection.execute(
            f"SELECT {quoted(column)} FROM {quoted(table)} WHERE rowid = ?", (row,)
        ).fetchone()
        told = shown(value[0]) if value else "a value"
        if parent in MESH_TABLES:
            low, high = connection.execute(f"SELECT min(rowid), max(rowid) FROM {quoted(parent)}").fetchone()
            known = "(which is empty)" if low is None else f"({low} to {high})"
            yield f"{place}: {noun} {told} is not in the {noun} table {known}; correct it"
        else:
            names = connection.execute(f"SELECT name FROM {quoted(parent)} LIMIT {MOST_NAMES}")
            known_names = [name for (name,) in names if isinstance(name, str)]
            clause = nearest(value[0], known_names) if value else ""
            yield f"{place}: {noun} {told} is not in the {noun} table{clause or '; correct it'}"
