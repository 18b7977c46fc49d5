"""The tables of a scene, to select from, to join and to change: in Python, and for `autocolor sql`."""

from __future__ import annotations

import os
import sqlite3
from collections.abc import Mapping
from pathlib import Path
from typing import Final

from autocolor.errors import UsageError
from autocolor.files.formats import recognized
from autocolor.files.scene_sources import SCENE_FORMATS, PathLike, read_scene_with_report
from autocolor.files.store.connections import closed, connected, connected_to_change, journal_mode
from autocolor.files.store.schema import MESH_TABLES, NODES, POLYGONS, VALUES
from autocolor.files.store.sql_columns import quoted
from autocolor.files.store.statements import (
    SECONDS,
    Answer,
    Parameters,
    Value,
    answer_of,
    change,
    changes_of,
    columns_in,
    names_of_tables,
    require_name,
)
from autocolor.files.store.store_file import report_in, store_of, transaction, without_triggers
from autocolor.scene.scalar import NODE, POLYGON
from autocolor.scene.scene import Scene

DEPENDENT: Final = {POLYGONS: (VALUES[POLYGON], POLYGON), NODES: (VALUES[NODE], NODE)}
"""The tables whose rows go with those of others, and by which column."""


def open_tables(path: PathLike, *, up: str = "z", scale: float = 1.0) -> Tables:
    """The tables of a store, or of any other scene, which is read into memory for it.

        with autocolor.open_tables("car.sqlite") as tables:
            tables.select("SELECT name, surface FROM parts WHERE stage = ?", [False])
            tables.update("lights", "key", intensity=2.0)

    Raises InputError, MissingInputError, and UsageError as `read_scene`.
    """
    path = Path(path)
    if is_store(path) and (up, scale) == ("z", 1):
        return Tables(connected(path), path.name, path)
    return tables_of(read_scene_with_report(path, up=up, scale=scale).scene)


def is_store(path: Path) -> bool:
    """Whether a path is that of a store, by its name or its first bytes."""
    if os.path.isdir(path):
        return False
    found = recognized(path, SCENE_FORMATS)
    return found is not None and found.name == "store"


def tables_of(scene: Scene) -> Tables:
    """The tables of a scene, in memory."""
    return Tables(store_of(scene), scene.name)


class Tables:
    """The tables of one scene.

    Whatever changes them is checked as a scene file is, and saved or refused as a whole. Changes of a store
    are in its file at once; those of another scene are in memory: `write_scene` writes `scene()`. `seconds`
    is how long a statement may take.
    """

    def __init__(self, connection: sqlite3.Connection, name: str, store: Path | None = None) -> None:
        self._connection = connection
        self._name = name
        self._store = store
        self.seconds = SECONDS

    @property
    def names(self) -> list[str]:
        """The names of the tables."""
        return names_of_tables(self._connection)

    def columns(self, table: str) -> list[str]:
        """The names of the columns of a table. Raises UsageError, with the nearest name, if there is none."""
        require_name(table, self.names, "table")
        return columns_in(self._connection, table)

    def select(self, statement: str, parameters: Parameters = ()) -> list[dict[str, Value]]:
        """The rows that a SELECT gives, as dictionaries by the names of columns.

        `parameters` stand for ? or :name in it. Raises UsageError for a statement that is wrong, takes too
        long or would change something.
        """
        columns, rows = self.answer(statement, parameters)
        return [dict(zip(columns, row, strict=True)) for row in rows]

    def answer(self, statement: str, parameters: Parameters = ()) -> Answer:
        """Like `select`, with rows that are fetched as they are asked for."""
        return answer_of(self._connection, statement, parameters, self.seconds)

    def table(self, name: str) -> list[dict[str, Value]]:
        """All rows of a table."""
        require_name(name, self.names, "table")
        return self.select(f"SELECT * FROM {quoted(name)}")

    def update(self, table: str, key: str | int, /, **values: object) -> None:
        """Change columns of the row of a table that has a key: its name, or its number.

        Raises UsageError for an unknown table, key or column, InputError if the scene would be wrong.
        """
        columns = self.columns(table)
        for name in values:
            require_name(name, columns, f"column of {table}")
        if not values:
            raise UsageError("an update must change a column, not none; give one as in intensity=2.0")
        by = "name" if isinstance(key, str) and "name" in columns else columns[0]
        sets = ", ".join(f"{quoted(name)} = ?" for name in values)
        statement = f"UPDATE {quoted(table)} SET {sets} WHERE {quoted(by)} = ?"
        if self.change(statement, [*values.values(), key]) == 0:
            known = [row[by] for row in self.select(f"SELECT {quoted(by)} FROM {quoted(table)} LIMIT 1000")]
            require_name(str(key), [str(each) for each in known], f"row of {table} with {by}")

    @property
    def is_in_a_file(self) -> bool:
        """Whether changes are in the file of a store at once."""
        return self._store is not None

    def would_change(self, statement: str, parameters: Parameters = ()) -> bool:
        """Whether a statement changes rows; it is not run. Raises UsageError for a wrong one."""
        return bool(changes_of(self._connection, statement, parameters))

    def change(self, statement: str, parameters: Parameters = ()) -> int:
        """Run one INSERT, UPDATE or DELETE, check the scene, and save it; returns how many rows it changed.

        A part or a surface that is renamed is renamed where it is referred to. Values of scalars go with
        their node or polygon. Raises UsageError for a wrong statement, InputError with every problem of the
        scene that would be, and WriteError; nothing is changed then.
        """
        tables = changes_of(self._connection, statement, parameters)
        # To look for references to each node that goes would take the square of their number.
        checks_references = not tables.keys() & {*MESH_TABLES}
        if self._store is None:
            self._connection.execute(f"PRAGMA foreign_keys = {'ON' if checks_references else 'OFF'}")
            return self._changed(self._connection, tables, statement, parameters)
        connection = connected_to_change(self._store, checks_references=checks_references)
        try:
            count = self._changed(connection, tables, statement, parameters)
            is_outdated = journal_mode(connection) != journal_mode(self._connection)
        finally:
            closed(connection)
        if is_outdated:
            # The store is in WAL mode, and was opened as a file that does not change.
            closed(self._connection)
            self._connection = connected(self._store)
        return count

    def _changed(
        self,
        connection: sqlite3.Connection,
        tables: Mapping[str, set[int]],
        statement: str,
        parameters: Parameters,
    ) -> int:
        """Run a statement that changes these tables, and check the scene; returns the number of rows."""
        with transaction(connection, self._name), without_triggers(connection):
            connection.execute("PRAGMA defer_foreign_keys = ON")
            count = change(connection, statement, parameters, self.seconds)
            for table, actions in tables.items():
                if table in DEPENDENT and sqlite3.SQLITE_DELETE in actions:
                    self._remove_values(connection, *DEPENDENT[table], table)
            report_in(connection, self._name, self._scene_name)
        return count

    def _remove_values(self, connection: sqlite3.Connection, values: str, column: str, table: str) -> None:
        if column in columns_in(connection, values):
            connection.execute(f"DELETE FROM {values} WHERE {column} NOT IN (SELECT {column} FROM {table})")

    @property
    def _scene_name(self) -> str:
        return self._name if self._store is None else self._store.stem

    def scene(self) -> Scene:
        """The scene that the tables are now. Raises InputError."""
        return report_in(self._connection, self._name, self._scene_name).scene

    def definition(self, table: str) -> str:
        """The statement that makes a table."""
        require_name(table, self.names, "table")
        query = "SELECT sql FROM sqlite_master WHERE name = ?"
        (text,) = self._connection.execute(query, (table,)).fetchone()
        return f"{text};"

    def close(self) -> None:
        """Let go of the file."""
        closed(self._connection)

    def __enter__(self) -> Tables:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __repr__(self) -> str:
        return f"Tables({self._name!r}: {', '.join(self.names)})"
