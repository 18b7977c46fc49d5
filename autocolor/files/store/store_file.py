"""Reading a scene from a store, and writing a scene to a store.

A store that exists is replaced as a whole. What other programs added to it stays: tables, views, indexes and
triggers. None of them is run.
"""

from __future__ import annotations

import os
import sqlite3
from contextlib import closing
from pathlib import Path
from typing import Final

from autocolor.checks import printable
from autocolor.errors import InputError, WriteError
from autocolor.files.scene_report import SceneReport
from autocolor.files.store.connections import (
    LONGEST_TEXT,
    files_to_play,
    in_memory,
    limited,
    refusals,
    replacing,
    store_content,
)
from autocolor.files.store.rows import insert_rows, report_of
from autocolor.files.store.schema import DEFINITIONS, INDEXES, stored_tables
from autocolor.files.writing import Guard, no_guard, refuse_output, write_atomically
from autocolor.logs import logger_of, timed
from autocolor.scene.creation import MATERIALS, SurfaceSource
from autocolor.scene.scene import Scene

LOG: Final = logger_of(__name__)

VERSION: Final = 1
"""The version of the tables, `PRAGMA user_version`."""

READING_SECONDS: Final = 120.0
"""Limit: how long a store may be read; the largest takes half of that."""


def read_store(path: str | os.PathLike[str], *, surfaces: SurfaceSource = MATERIALS) -> SceneReport:
    """The scene of a store, and messages about rows that were created for it.

    A store needs only nodes and polygons. Nothing is repaired. Tables of other programs are ignored, and no
    view or trigger is run. Raises InputError with every problem, MissingInputError if there is no such file.
    """
    path = Path(path)
    with timed(LOG, f"read {path.name}"), closing(in_memory(store_content(path))) as connection:
        return report_in(connection, path.name, surfaces)


def report_in(connection: sqlite3.Connection, file: str, surfaces: SurfaceSource = MATERIALS) -> SceneReport:
    """The scene in the tables of a connection. Raises InputError; messages begin with `file`."""
    late = InputError(f"a store must be read within {READING_SECONDS:g} seconds, not longer; leave rows out")
    with refusals(file):
        (version,) = connection.execute("PRAGMA user_version").fetchone()
        try:
            if version > VERSION:
                raise InputError(
                    f"the version of a store must be at most {VERSION}, not {version}; use a newer autocolor"
                )
            with limited(connection, READING_SECONDS, late):
                return report_of(connection, stored_tables(connection), Path(file).stem or "scene", surfaces)
        except InputError as error:
            raise InputError(f"{file}: {problem}" for problem in error.problems) from None


def store_bytes(scene: Scene) -> bytes:
    """The bytes of a store with a scene; equal scenes give equal bytes. Raises InputError."""
    with closing(in_memory()) as connection:
        for statement in ("PRAGMA journal_mode = OFF", "PRAGMA page_size = 8192", "BEGIN"):
            connection.execute(statement)
        _fill(connection, scene)
        connection.execute("COMMIT")
        return connection.serialize()


def write_store(
    path: str | os.PathLike[str], scene: Scene, *, overwrite: bool = False, guard: Guard = no_guard
) -> None:
    """Write a scene to a store, so that `read_store` gives it back.

    With `overwrite`, a store that exists is replaced, and the tables, views, indexes and triggers of other
    programs stay in it. `guard` checks the file before. Raises OutputError or WriteError if the file cannot
    be written, and InputError if it is no store of ours. Nothing is changed then.
    """
    path = Path(path)
    refuse_output(path, overwrite=overwrite)
    check = guard(path)
    with timed(LOG, f"wrote {path.name}"):
        if path.exists():
            with replacing(path, check) as (data, save), closing(in_memory(data)) as old:
                save(_with_additions(old, scene, path.name))
            return
        for ending in files_to_play(path):
            raise WriteError(
                f"{path.name}: a new store must have no {path.name}{ending} beside it, because SQLite would"
                " play it into the store; move it away"
            )
        check()
        write_atomically(path, store_bytes(scene), overwrite=overwrite)


def _with_additions(old: sqlite3.Connection, scene: Scene, name: str) -> bytes:
    """The bytes of a store with a scene, and with what other programs added to the old store.

    The tables of the scene are made anew, and after them the indexes and triggers that others gave them. So
    none of these is run. Raises WriteError if an addition does not fit the scene's rows.
    """
    try:
        query = "SELECT name, lower(tbl_name), sql FROM sqlite_master WHERE typeof(sql) = 'text'"
        added = [row for row in old.execute(query) if row[0] not in {**DEFINITIONS, **INDEXES}]
        if not added:
            return store_bytes(scene)
        old.execute("BEGIN")
        for table in DEFINITIONS:
            old.execute(f"DROP TABLE IF EXISTS {table}")
        _fill(old, scene)
        for _, table, sql in added:
            # SQLite writes the text so. Another statement that hides there is not run.
            if table in DEFINITIONS and sql.startswith(
                ("CREATE INDEX ", "CREATE UNIQUE INDEX ", "CREATE TRIGGER ")
            ):
                old.execute(sql)
        old.execute("COMMIT")
        return old.serialize()
    except sqlite3.Error as error:
        raise WriteError(
            f"{name}: what other programs added must fit the tables of the scene, and does not"
            f" ({printable(str(error))}); drop it, or write to another file"
        ) from None


def _fill(connection: sqlite3.Connection, scene: Scene) -> None:
    """Create the tables, insert the rows of a scene, and create the indexes.

    Inserting the rows into tables that already have indexes takes longer.
    """
    connection.execute(f"PRAGMA user_version = {VERSION}")
    for definition in DEFINITIONS.values():
        connection.execute(definition)
    try:
        insert_rows(connection, scene)
    except (UnicodeEncodeError, sqlite3.DataError) as error:
        rule = f"a text in a store must be UTF-8 of at most {LONGEST_TEXT:,} bytes, and one is not"
        raise InputError(f"{rule} ({printable(str(error))}); rename or shorten it") from None
    for definition in INDEXES.values():
        connection.execute(definition)
