"""Reading a scene from a store, and writing a scene to a store.

A new store is created in memory and written as one file, whole or not at all. An existing store is changed in
place by one transaction: programs that have it open notice, and tables of other programs stay. A store with
triggers, views or indexes of other programs is not written over, because these could run, or no longer fit.
"""

from __future__ import annotations

import os
import sqlite3
from collections.abc import Callable, Sequence
from contextlib import closing
from pathlib import Path
from typing import Final

from autocolor.checks import shown
from autocolor.errors import InputError, OutputError, UsageError, WriteError
from autocolor.files.paths import STORE_SUFFIXES
from autocolor.files.scene_report import SceneReport
from autocolor.files.store.connections import (
    DAMAGE_ERRORS,
    Clock,
    authorizer,
    connected,
    connected_to_change,
    in_memory,
    primary_code,
    refusals,
    refuse_journal,
    store_head,
    transaction,
)
from autocolor.files.store.rows import insert_mesh, insert_rows, report_of
from autocolor.files.store.schema import (
    APPLICATION,
    DEFINITIONS,
    INDEXES,
    ROW_TABLES,
    VERSION,
    quoted,
    stored_tables,
)
from autocolor.files.writing import Guard, no_guard, refuse_output, write_atomically
from autocolor.logs import logger_of, timed
from autocolor.scene.creation import MATERIALS, SurfaceSource
from autocolor.scene.scene import Scene, check_scene

LOG: Final = logger_of(__name__)


def read_store(path: str | os.PathLike[str], *, surfaces: SurfaceSource = MATERIALS) -> SceneReport:
    """The scene of a store, and messages about rows that were created for it.

    A store needs only nodes and polygons. Nothing is repaired. Tables of other programs are ignored, and no
    view or trigger is run. Raises InputError with every problem, MissingInputError if there is no such file.
    """
    path = Path(path)
    with closing(connected(path)) as connection, timed(LOG, f"read {path.name}"):
        return report_in(connection, path.name, path.stem, surfaces)


def report_in(
    connection: sqlite3.Connection, file: str, name: str, surfaces: SurfaceSource = MATERIALS
) -> SceneReport:
    """The scene in the tables of a connection. Raises InputError; messages begin with `file`."""
    connection.set_authorizer(authorizer(may_change=False))
    clock = Clock(connection)
    try:
        with refusals(clock=clock):
            return report_of(connection, stored_tables(connection), name or "scene", surfaces)
    except InputError as error:
        raise InputError(f"{file}: {problem}" for problem in error.problems) from None
    finally:
        connection.set_authorizer(None)
        connection.set_progress_handler(None, 0)


# Writing.


def store_of(scene: Scene) -> sqlite3.Connection:
    """A store in memory with the tables of a scene. Raises InputError for a text that is not UTF-8."""
    check_scene(scene)
    connection = in_memory()
    try:
        connection.execute("PRAGMA journal_mode = OFF")
        connection.execute("PRAGMA page_size = 8192")
        connection.execute(f"PRAGMA application_id = {APPLICATION}")
        connection.execute("BEGIN")
        _fill(connection, scene)
        connection.execute("COMMIT")
        connection.execute("PRAGMA journal_mode = MEMORY")
    except BaseException:
        connection.close()
        raise
    return connection


def store_bytes(scene: Scene) -> bytes:
    """The bytes of a store with a scene; equal scenes give equal bytes. Raises InputError."""
    with closing(store_of(scene)) as connection:
        return connection.serialize()


def write_store(
    path: str | os.PathLike[str], scene: Scene, *, overwrite: bool = False, guard: Guard = no_guard
) -> None:
    """Write a scene to a store, so that `read_store` gives it back.

    With `overwrite`, a store that exists is changed in place (see above), and a file that is no store, or is
    damaged, is replaced; `guard` checks the file before. Raises OutputError if the file exists and
    `overwrite` is false, or if nothing can be created there; WriteError if writing fails, or if the store has
    triggers, views or indexes of others; InputError for a name that is not UTF-8. Nothing is changed then.
    """
    path = Path(path)
    if path.suffix.lower() not in STORE_SUFFIXES:
        raise UsageError(
            f"a store must be written to a file that ends in {' or '.join(STORE_SUFFIXES)}, not to {path};"
            " rename it"
        )
    check_scene(scene)
    refuse_output(path, overwrite=overwrite)
    check = guard(path)
    with timed(LOG, f"wrote {path.name}"):
        if path.exists() and _is_rewritten(path, scene, check):
            return
        try:
            # Other programs would roll a journal without a store back into the new one.
            refuse_journal(path)
        except InputError as error:
            raise WriteError(str(error)) from None
        check()
        write_atomically(path, store_bytes(scene), overwrite=overwrite)


def _is_rewritten(path: Path, scene: Scene, check: Callable[[], None]) -> bool:
    """Change a store that exists; returns False, without a change, if the file is no readable store.

    The transaction begins with a `check`, because it may have waited for another program.
    """
    if not os.access(path, os.W_OK):
        raise OutputError(f"an output must be a file that can be written, not {path}; change its permissions")
    try:
        store_head(path)
        connection = connected_to_change(path)
    except InputError as error:
        if any(os.path.lexists(f"{os.path.realpath(path)}{end}") for end in ("-wal", "-journal")):
            raise WriteError(str(error)) from None
        LOG.warning("%s: written anew, because the file is not a readable store", path)
        return False
    try:
        with closing(connection), transaction(connection, path.name):
            check()
            refuse_additions(
                connection,
                ("trigger", "view", "index"),
                f"{path.name}: a store that is written over must have no triggers, views or indexes of other"
                " programs",
                "write to another file",
            )
            query = "SELECT name FROM sqlite_master WHERE type = 'table'"
            names = {name.lower() for (name,) in connection.execute(query)}
            for table in DEFINITIONS:
                if table in names:
                    connection.execute(f"DROP TABLE {quoted(table)}")
            _fill(connection, scene)
    except sqlite3.Error as error:
        if primary_code(error) not in DAMAGE_ERRORS:
            raise WriteError(
                f"{path}: a store must be one that SQLite can change, and this one is not ({error}); write to"
                " another file"
            ) from None
        LOG.warning("%s: written anew, as it is damaged (%s)", path, error)
        return False
    return True


def refuse_additions(connection: sqlite3.Connection, kinds: Sequence[str], rule: str, advice: str) -> None:
    """Raise WriteError if a store has triggers, views or indexes that are not our own."""
    query = "SELECT type, name, sql FROM sqlite_master WHERE sql IS NOT NULL"
    for kind, name, sql in connection.execute(query):
        if kind in kinds and INDEXES.get(name) != sql:
            raise WriteError(f"{rule}, and this one has {kind} {shown(name)}; {advice}")


def _fill(connection: sqlite3.Connection, scene: Scene) -> None:
    """Create the tables, insert the rows of a scene, and create the indexes.

    Measured, for a million nodes and a million quads: 2.4 s without indexes, and 3.9 s with them. Inserting
    the rows into tables that already have indexes takes 5.3 s.
    """
    for definition in DEFINITIONS.values():
        connection.execute(definition)
    try:
        for table in ROW_TABLES.values():
            insert_rows(connection, scene, table)
        insert_mesh(connection, scene.mesh)
    except UnicodeEncodeError:
        raise InputError("a name in a store must be text in UTF-8; rename it") from None
    for definition in INDEXES.values():
        connection.execute(definition)
    connection.execute(f"PRAGMA user_version = {VERSION}")
