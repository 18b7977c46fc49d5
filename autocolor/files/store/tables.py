"""The tables of a scene, read and changed with SQL, in Python and by `autocolor sql`."""

from __future__ import annotations

import os
import sqlite3
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, contextmanager, nullcontext
from dataclasses import replace
from pathlib import Path
from typing import Final

from autocolor.budget import allowing, validated_limit
from autocolor.checks import nearest, printable, shown
from autocolor.errors import UsageError, WriteError
from autocolor.files.formats import recognized
from autocolor.files.meshes.repair import different
from autocolor.files.opening import FILES, STORE, PathLike, read_scene_with_report
from autocolor.files.store.connections import (
    SQL_ERRORS,
    in_memory,
    limited,
    primary_code,
    replacing,
    store_content,
)
from autocolor.files.store.schema import quoted
from autocolor.files.store.store_file import report_in, store_bytes
from autocolor.logs import logger_of
from autocolor.scene.mesh import Mesh, has_same_tables
from autocolor.scene.scene import Scene

LOG: Final = logger_of(__name__)

SECONDS: Final = 30.0
"""Limit: how long a statement may take, unless the user allows more."""

Parameters = Sequence[object] | Mapping[str, object]
Value = None | int | float | str | bytes


class ChangeError(UsageError):
    """A statement that would change rows, where it may only read them."""


def open_tables(path: PathLike, *, up: str = "z", scale: float = 1.0, limit: float | None = None) -> Tables:
    """The tables of a store. Any other scene is read, and its tables are made in memory.

        with autocolor.open_tables("car.sqlite") as tables:
            tables.select("SELECT name, surface FROM parts WHERE stage = ?", [False])
            tables.update("lights", "key", intensity=2.0)

    `up`, `scale` and `limit`, and the errors, are those of `read_scene`.
    """
    path = Path(path)
    with allowing(limit):
        if is_store(path) and (up, scale) == ("z", 1):
            return Tables(store_content(path), path.name, path)
        return tables_of(read_scene_with_report(path, up=up, scale=scale).scene)


def is_store(path: Path) -> bool:
    """Whether a file is a store, by its name or its first bytes."""
    return not os.path.isdir(path) and recognized(path, FILES) is STORE


def tables_of(scene: Scene) -> Tables:
    """The tables of a scene, in memory."""
    return Tables(store_bytes(scene), scene.name, mesh=scene.mesh)


class Tables:
    """The tables of one scene.

    The tables of a store are those of its file when it was opened, or changed here the last time. The changed
    scene is checked as a scene file is; a change is saved or refused as a whole. Changes of a store are saved
    to its file at once. Changes of another scene stay in memory: `write_scene` writes
    `scene()`. A statement that takes longer than `seconds` is ended.

    Tables have no normals. The own normals of the `mesh` from which they were made stay while its nodes,
    polygons and parts do.
    """

    def __init__(
        self, content: bytes, name: str, store: Path | None = None, mesh: Mesh | None = None
    ) -> None:
        self._connection = in_memory(content)
        self._name = name
        self._store = store
        self._mesh = mesh
        self.seconds = SECONDS
        self._limit = validated_limit(None)

    @property
    def names(self) -> list[str]:
        """The names of all tables and views, also of other programs."""
        query = "SELECT name FROM sqlite_master WHERE type IN ('table', 'view') AND name NOT LIKE 'sqlite_%'"
        return [str(row["name"]) for row in self.select(f"{query} ORDER BY rowid")]

    def columns(self, table: str) -> list[str]:
        """The names of the columns of a table. Raises UsageError for an unknown table."""
        require_name(table, self.names, "table")
        return list(self.answer(f"SELECT * FROM {quoted(table)}")[0])

    def select(self, statement: str, parameters: Parameters = ()) -> list[dict[str, Value]]:
        """The rows that a SELECT gives, as dictionaries by the names of columns.

        `parameters` are the values for ? or :name. Raises UsageError for a statement that is wrong, takes too
        long or would change rows.
        """
        columns, rows = self.answer(statement, parameters)
        return [dict(zip(columns, row, strict=True)) for row in rows]

    def answer(
        self, statement: str, parameters: Parameters = ()
    ) -> tuple[tuple[str, ...], Iterator[tuple[Value, ...]]]:
        """The different names of the columns that a SELECT gives, and its rows.

        They are fetched in chunks, so that an answer may be larger than memory.

        Raises UsageError, also while rows are fetched; ChangeError for a statement that would change rows.
        """
        connection = self._connection
        with _statement(connection, self.seconds):
            cursor = connection.execute(statement, parameters)

        def rows() -> Iterator[tuple[Value, ...]]:
            while True:
                # The time between two fetches is not the statement's.
                with _statement(connection, self.seconds):
                    fetched = cursor.fetchmany(50)
                if not fetched:
                    return
                yield from fetched

        return different([column[0] for column in cursor.description or ()]), rows()

    def update(self, table: str, key: str | int, /, **values: object) -> None:
        """Change columns of the row with this key, which is a name or a number.

        Raises UsageError for an unknown table, key or column, InputError if the scene would be wrong.
        """
        columns = self.columns(table)
        by = "name" if isinstance(key, str) and "name" in columns else columns[0]
        sets = ", ".join(f"{quoted(name)} = ?" for name in values)
        statement = f"UPDATE {quoted(table)} SET {sets} WHERE {quoted(by)} = ?"
        if self.change(statement, [*values.values(), key]) == 0:
            rows = self.select(f"SELECT {quoted(by)} FROM {quoted(table)} LIMIT 1000")
            require_name(str(key), [str(row[by]) for row in rows], f"row of {table} with {by}")

    def change(self, statement: str, parameters: Parameters = ()) -> int:
        """Run one INSERT, UPDATE or DELETE, check the scene, and save it; returns how many rows it changed.

        A new name of a part or a surface replaces the old name everywhere. Removing a node or a polygon
        removes its scalar values. A store is read again first, with the changes of other programs. Raises
        UsageError for a wrong statement, InputError with every problem of the changed scene, WriteError if
        the store has triggers, or cannot be written, OutputError if it is write-protected. After any error,
        nothing is changed.
        """
        saving: AbstractContextManager[tuple[bytes, Callable[[bytes], None]]] = (
            nullcontext((self._connection.serialize(), lambda _: None))
            if self._store is None
            else replacing(self._store, lambda: None)
        )
        with allowing(self._limit), saving as (content, save):
            copy = in_memory(content)
            try:
                for (trigger,) in copy.execute("SELECT name FROM sqlite_master WHERE type = 'trigger'"):
                    raise WriteError(
                        f"{self._name}: a store that is changed must have no triggers, not"
                        f" {shown(trigger)}; drop it, or write the scene to another file"
                    )
                for begin in ("PRAGMA foreign_keys = ON", "BEGIN", "PRAGMA defer_foreign_keys = ON"):
                    copy.execute(begin)
                with _statement(copy, self.seconds, may_change=True):
                    # The last row is changed only after all rows of a RETURNING clause are fetched.
                    for _ in copy.execute(statement, parameters):
                        pass
                # The row count of Python 3.11's cursor is missing after WITH.
                (count,) = copy.execute("SELECT changes()").fetchone()
                report_in(copy, self._name)
                try:
                    copy.execute("COMMIT")
                except sqlite3.IntegrityError as error:
                    raise WriteError(
                        f"{self._name}: tables of other programs must not refer to rows that a change removes"
                        f" or renames ({error}); change their rows first"
                    ) from None
                if count:
                    save(copy.serialize())
                self._connection, copy = copy, self._connection
            finally:
                copy.close()
        return int(count)

    def scene(self) -> Scene:
        """The scene of the tables as they are now. Raises InputError."""
        with allowing(self._limit):
            scene, before = report_in(self._connection, self._name).scene, self._mesh
        if before is None or before.own_normals is None:
            return scene
        if not has_same_tables(scene.mesh, replace(before, own_normals=None)):
            LOG.warning("%s: the normals of the changed mesh will be computed", self._name)
            return scene
        return scene.replace(mesh=replace(before, crease_angle=scene.mesh.crease_angle))

    def close(self) -> None:
        """Free the tables."""
        self._connection.close()

    def __enter__(self) -> Tables:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


@contextmanager
def _statement(connection: sqlite3.Connection, seconds: float, may_change: bool = False) -> Iterator[None]:
    """Limits of permissions and time for a statement, and its errors as UsageError.

    Raises ChangeError if it would change tables and may not.
    """
    late = UsageError(
        f"a statement must end within {seconds:g} seconds, not run on; narrow it with WHERE or LIMIT, or"
        " allow more with --seconds"
    )
    try:
        with limited(connection, seconds, late, may_change) as changed:
            yield
    except SQL_ERRORS as error:
        if primary_code(error) == sqlite3.SQLITE_AUTH and changed and not may_change:
            raise ChangeError(
                f"a statement must only read the tables, and this one changes {', '.join(sorted(changed))};"
                " allow changes with --write (tables.change in Python), or write a SELECT"
            ) from None
        raise UsageError(
            "a statement must be one SELECT or, with --write, one INSERT, UPDATE or DELETE that SQLite can"
            f" run, and this one is not ({printable(str(error))}); correct it"
        ) from None


def require_name(name: str, names: Sequence[str], noun: str) -> None:
    """Raise UsageError, with the nearest name, unless the names include a name."""
    if name not in names:
        raise UsageError(f"there is no {noun} {shown(name)}{nearest(name, names)}")
