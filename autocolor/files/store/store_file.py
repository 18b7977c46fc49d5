"""Reading a scene from a store, and writing a scene to a store.

A store that exists is replaced as a whole. What other programs added to it stays: tables, views, indexes and
triggers. None of them is run.
"""

from __future__ import annotations

import os
import sqlite3
from collections.abc import Iterable
from contextlib import closing
from pathlib import Path
from typing import Final

from autocolor.checks import printable
from autocolor.errors import InputError, UsageError, WriteError
from autocolor.files.paths import STORE_SUFFIXES
from autocolor.files.scene_report import SceneReport
from autocolor.files.store.connections import (
    DAMAGE_ERRORS,
    SQL_ERRORS,
    authorizer,
    closed_on_error,
    in_memory,
    limited,
    loaded,
    primary_code,
    refuse_remains,
    replacing,
    sentence_of,
)
from autocolor.files.store.rows import insert_rows, report_of
from autocolor.files.store.schema import (
    APPLICATION,
    DEFINITIONS,
    INDEXES,
    VERSION,
    quoted,
    stored_tables,
)
from autocolor.files.writing import Guard, no_guard, refuse_output, write_atomically
from autocolor.logs import logger_of, timed
from autocolor.scene.creation import MATERIALS, SurfaceSource
from autocolor.scene.scene import Scene, check_scene

LOG: Final = logger_of(__name__)

READING_SECONDS: Final = 120.0
"""Limit: how long a store may be read; the largest takes half of that."""


def read_store(path: str | os.PathLike[str], *, surfaces: SurfaceSource = MATERIALS) -> SceneReport:
    """The scene of a store, and messages about rows that were created for it.

    A store needs only nodes and polygons. Nothing is repaired. Tables of other programs are ignored, and no
    view or trigger is run. Raises InputError with every problem, MissingInputError if there is no such file.
    """
    path = Path(path)
    with timed(LOG, f"read {path.name}"), closing(loaded(path)) as connection:
        return report_in(connection, path.name, surfaces)


def report_in(connection: sqlite3.Connection, file: str, surfaces: SurfaceSource = MATERIALS) -> SceneReport:
    """The scene in the tables of a connection. Raises InputError; messages begin with `file`."""
    late = InputError(f"a store must be read within {READING_SECONDS:g} seconds, not longer; leave rows out")
    try:
        with limited(connection, authorizer(), READING_SECONDS, late):
            return report_of(connection, stored_tables(connection), Path(file).stem or "scene", surfaces)
    except SQL_ERRORS as error:
        raise InputError(f"{file}: {sentence_of(error)}") from None
    except InputError as error:
        raise InputError(f"{file}: {problem}" for problem in error.problems) from None


# Writing.


def store_of(scene: Scene) -> sqlite3.Connection:
    """A store in memory with the tables of a scene. Raises InputError for a text that is not UTF-8."""
    check_scene(scene)
    with closed_on_error(in_memory()) as connection:
        connection.execute("PRAGMA journal_mode = OFF")
        connection.execute("PRAGMA page_size = 8192")
        connection.execute(f"PRAGMA application_id = {APPLICATION}")
        connection.execute("BEGIN")
        _fill(connection, scene)
        connection.execute("COMMIT")
    return connection


def store_bytes(scene: Scene) -> bytes:
    """The bytes of a store with a scene; equal scenes give equal bytes. Raises InputError."""
    with closing(store_of(scene)) as connection:
        return connection.serialize()


def image_of(path: Path) -> bytes:
    """The bytes of the store at a path, with what its `-wal` holds. Raises InputError, MissingInputError."""
    with closing(loaded(path)) as connection:
        return connection.serialize()


def write_store(
    path: str | os.PathLike[str], scene: Scene, *, overwrite: bool = False, guard: Guard = no_guard
) -> None:
    """Write a scene to a store, so that `read_store` gives it back.

    With `overwrite`, a store that exists is replaced, and the tables, views, indexes and triggers of other
    programs stay in it. A file that is no store, or is damaged, is replaced too. `guard` checks the file
    before. Raises OutputError if the file exists and `overwrite` is false, or if nothing can be created
    there; WriteError if writing fails, or if an addition of others does not fit the new tables; InputError
    for a name that is not UTF-8. Nothing is changed then.
    """
    path = Path(path)
    if path.suffix.lower() not in STORE_SUFFIXES:
        raise UsageError(
            f"a store must be written to a file that ends in {' or '.join(STORE_SUFFIXES)}, not to {path};"
            " rename it"
        )
    refuse_output(path, overwrite=overwrite)
    check = guard(path)
    with timed(LOG, f"wrote {path.name}"):
        if path.exists():
            try:
                with replacing(path, check) as (old, save), closing(old):
                    save(_with_additions(old, scene, path.name))
                return
            except InputError as error:
                LOG.warning("%s: written anew, if nothing is beside it: it cannot be read (%s)", path, error)
        refuse_remains(path)
        check()
        write_atomically(path, store_bytes(scene), overwrite=overwrite)


def _with_additions(old: sqlite3.Connection, scene: Scene, name: str) -> bytes:
    """The bytes of a store with a scene, and with what other programs added to the old store.

    Raises InputError if the old store is damaged, WriteError if an addition does not fit the scene's rows.
    """
    try:
        texts = "typeof(name) = 'text' AND typeof(sql) = 'text'"
        found = dict(old.execute(f"SELECT name, sql FROM sqlite_master WHERE {texts}"))
        if found.items() <= {**DEFINITIONS, **INDEXES}.items():
            return store_bytes(scene)
        triggers = {name: sql for name, sql in found.items() if sql.startswith("CREATE TRIGGER ")}
        others = [table for table in DEFINITIONS if found.get(table) != DEFINITIONS[table]]
        # SQLite asks for each trigger that a statement would run. None is left, unless a file hides one.
        old.set_authorizer(lambda *asked: sqlite3.SQLITE_DENY if asked[4] else sqlite3.SQLITE_OK)
        old.execute("BEGIN")
        for kind, names in (("TRIGGER", triggers), ("INDEX", INDEXES), ("TABLE", others)):
            for each in names:
                old.execute(f"DROP {kind} IF EXISTS {quoted(each)}")
        for table in DEFINITIONS:
            if table not in others:
                old.execute(f"DELETE FROM {quoted(table)}")
        _fill(old, scene, others)
        for statement in triggers.values():
            old.execute(statement)
        old.execute("COMMIT")
        return old.serialize()
    except sqlite3.Error as error:
        if primary_code(error) in DAMAGE_ERRORS:
            raise InputError(sentence_of(error)) from None
        raise WriteError(
            f"{name}: what other programs added to a store must fit the tables of the scene, and does not"
            f" ({printable(str(error))}); drop it, or write to another file"
        ) from None


def _fill(connection: sqlite3.Connection, scene: Scene, missing: Iterable[str] = tuple(DEFINITIONS)) -> None:
    """Create the missing tables, insert the rows of a scene, and create the indexes.

    Measured, for a million nodes and a million quads: 2.4 s without indexes, and 3.9 s with them. Inserting
    the rows into tables that already have indexes takes 5.3 s.
    """
    for table in missing:
        connection.execute(DEFINITIONS[table])
    try:
        insert_rows(connection, scene)
    except UnicodeEncodeError:
        raise InputError("a name in a store must be text in UTF-8; rename it") from None
    for definition in INDEXES.values():
        connection.execute(definition)
    connection.execute(f"PRAGMA user_version = {VERSION}")
