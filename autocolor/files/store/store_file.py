"""Reading a scene from a store, and writing one to it.

A new store is made in memory and written as one file, whole or not at all. A store that is there already is
changed in place by one transaction, so that programs which have it open notice, and what else it holds stays:
other tables, views, indices and triggers, none of which are run.
"""

from __future__ import annotations

import os
import sqlite3
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from itertools import islice
from pathlib import Path
from typing import Final

from autocolor.checks import nearest, shown
from autocolor.errors import InputError, OutputError, UsageError, WriteError
from autocolor.files.scenes.scene_report import SceneReport
from autocolor.files.store.connections import (
    Clock,
    closed,
    connected,
    connected_to_change,
    in_memory,
    refusals,
    refusals_of_writing,
    refuse_journal,
    store_head,
)
from autocolor.files.store.mesh_rows import insert_mesh
from autocolor.files.store.scene_rows import insert_rows, report_of
from autocolor.files.store.schema import (
    APPLICATION,
    DEFINITIONS,
    MESH_TABLES,
    ROW_TABLES,
    VALUES,
    VERSION,
    FoundTables,
    found_tables,
)
from autocolor.files.store.sql_columns import quoted
from autocolor.files.store.statements import authorizer, restoring
from autocolor.files.writing import refuse_output, write_atomically
from autocolor.logs import logger_of, timed
from autocolor.scene.creation import MATERIALS, SurfaceSource
from autocolor.scene.scene import Scene, check_scene

# -------------------- foreign_keys
# The rows of a store that refer to rows that are not there, told by their tables and numbers.
#
# Tools that edit a store leave its foreign keys unchecked unless they are asked to check them, and SQLite's
# own error names no row. The polygon table is left to `mesh_rows`, which must find each node and part
# anyway: SQLite would take a quarter of a second for a million polygons.

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


LOG: Final = logger_of(__name__)

STORE_SUFFIXES: Final = (".sqlite", ".db")


def read_store(path: str | os.PathLike[str], *, surfaces: SurfaceSource = MATERIALS) -> SceneReport:
    """The scene of a store, and what was created for it; only nodes and polygons must be there.

    Nothing is repaired. Other tables, views and triggers are left alone, and no view or trigger is run.
    Raises InputError with what is wrong, MissingInputError if there is no such file.
    """
    path = Path(path)
    connection = connected(path)
    try:
        with timed(LOG, f"read {path.name}"):
            return report_in(connection, path.name, path.stem, surfaces)
    finally:
        closed(connection)


def report_in(
    connection: sqlite3.Connection, file: str, name: str, surfaces: SurfaceSource = MATERIALS
) -> SceneReport:
    """The scene in the tables of a connection; `file` is what messages call it. Raises InputError."""
    connection.set_authorizer(authorizer(may_change=False))
    clock = Clock(connection)
    try:
        with refusals(file, clock):
            tables = found_tables(connection)
            _refuse_broken(connection, tables, ROW_TABLES)
            report = report_of(connection, tables, name or "scene", surfaces)
            # Of a node that is missing, the polygons tell first.
            _refuse_broken(connection, tables, VALUES.values())
            return report
    except InputError as error:
        prefix = f"{file}: "
        raise InputError(
            problem if problem.startswith(prefix) else f"{prefix}{problem}" for problem in error.problems
        ) from None
    finally:
        connection.set_authorizer(None)
        connection.set_progress_handler(None, 0)


def _refuse_broken(connection: sqlite3.Connection, tables: FoundTables, names: Iterable[str]) -> None:
    """Raise InputError if a row of one of these tables refers to a row that is not there."""
    problems = broken_references(connection, tables, names)
    if problems:
        raise InputError(problems)


def store_of(scene: Scene) -> sqlite3.Connection:
    """A store in memory that holds a scene. Raises InputError for a text that is not UTF-8."""
    check_scene(scene)
    connection = in_memory()
    connection.execute("PRAGMA journal_mode = OFF")
    connection.execute("PRAGMA page_size = 8192")
    connection.execute(f"PRAGMA application_id = {APPLICATION}")
    connection.execute("BEGIN")
    _fill(connection, scene)
    connection.execute("COMMIT")
    connection.execute("PRAGMA journal_mode = MEMORY")
    return connection


def store_bytes(scene: Scene) -> bytes:
    """The content of a store with a scene; the same for the same scene. Raises InputError."""
    connection = store_of(scene)
    try:
        return connection.serialize()
    finally:
        connection.close()


def write_store(path: str | os.PathLike[str], scene: Scene, *, overwrite: bool = False) -> None:
    """Write a scene to a store, so that `read_store` gives it back.

    With `overwrite`, a store that is there already is changed in place (see above); a file that is none, or
    is damaged, is replaced. Raises OutputError if the file exists and `overwrite` is false, or if nothing can
    be created there; WriteError if writing fails; InputError for a name that UTF-8 cannot hold. Nothing is
    changed then.
    """
    path = Path(path)
    if path.suffix.lower() not in STORE_SUFFIXES:
        raise UsageError(
            f"a store must be written to a file that ends in {' or '.join(STORE_SUFFIXES)}, not to {path};"
            " rename it"
        )
    check_scene(scene)
    refuse_output(path, overwrite=overwrite)
    with timed(LOG, f"wrote {path.name}"):
        if path.exists() and _is_rewritten(path, scene):
            return
        try:
            # Other programs would roll a journal without a store back into the new one.
            refuse_journal(path)
        except InputError as error:
            raise WriteError(str(error)) from None
        write_atomically(path, store_bytes(scene), overwrite=overwrite)


def _is_rewritten(path: Path, scene: Scene) -> bool:
    """Change a store that is there; False if the file is none that can be changed."""
    if not os.access(path, os.W_OK):
        raise OutputError(f"an output must be a file that can be written, not {path}; change its permissions")
    try:
        store_head(path)
        connection = connected_to_change(path)
    except InputError as error:
        if any(os.path.lexists(f"{os.path.realpath(path)}{end}") for end in ("-wal", "-journal")):
            raise WriteError(str(error)) from None
        LOG.warning("%s: written anew, as it is no store that can be read", path)
        return False
    try:
        with transaction(connection, path.name), without_triggers(connection):
            rewrite(connection, scene)
    except sqlite3.Error as error:
        if getattr(error, "sqlite_errorcode", 0) & 0xFF not in (
            sqlite3.SQLITE_CORRUPT,
            sqlite3.SQLITE_NOTADB,
        ):
            raise WriteError(
                f"{path}: what others keep in the store cannot be kept ({error}); write to another file"
            ) from None
        LOG.warning("%s: written anew, as it is damaged (%s)", path, error)
        return False
    finally:
        closed(connection)
    return True


def rewrite(connection: sqlite3.Connection, scene: Scene) -> None:
    """Make the tables of a store anew, with the rows of a scene, within a transaction.

    Indices of others on them are made again.
    """
    others = [
        (table, sql)
        for table, sql in connection.execute(
            "SELECT lower(tbl_name), sql FROM sqlite_master WHERE type = 'index' AND sql IS NOT NULL"
        )
        if table in DEFINITIONS
    ]
    kinds = dict(
        connection.execute("SELECT lower(name), type FROM sqlite_master WHERE type IN ('table', 'view')")
    )
    for table in DEFINITIONS:
        if table in kinds:
            connection.execute(f"DROP {kinds[table].upper()} {quoted(table)}")
    _fill(connection, scene)
    _restore(connection, [sql for _, sql in others])


def _fill(connection: sqlite3.Connection, scene: Scene) -> None:
    """Make the tables, and insert the rows of a scene."""
    for definition in DEFINITIONS.values():
        connection.execute(definition)
    try:
        for table in ROW_TABLES.values():
            insert_rows(connection, scene, table)
        insert_mesh(connection, scene.mesh)
    except UnicodeEncodeError:
        raise InputError("a name in a store must be text in UTF-8; rename it") from None
    connection.execute(f"PRAGMA user_version = {VERSION}")


@contextmanager
def transaction(connection: sqlite3.Connection, name: str) -> Iterator[None]:
    """A transaction, begun unless the connection is in it, that is rolled back whole if anything in it fails.

    Raises WriteError if another program is writing to the store, or if writing fails.
    """
    with refusals_of_writing(name):
        try:
            if not connection.in_transaction:
                connection.execute("BEGIN IMMEDIATE")
            yield
            connection.execute("COMMIT")
        except BaseException:
            if connection.in_transaction:
                connection.execute("ROLLBACK")
            raise


@contextmanager
def without_triggers(connection: sqlite3.Connection) -> Iterator[None]:
    """Within a transaction, take the triggers of a store away and bring them back: kept, and not run."""
    triggers = connection.execute("SELECT name, sql FROM sqlite_master WHERE type = 'trigger'").fetchall()
    for name, _ in triggers:
        connection.execute(f"DROP TRIGGER {quoted(name)}")
    yield
    _restore(connection, [sql for _, sql in triggers])


def _restore(connection: sqlite3.Connection, definitions: Iterable[str]) -> None:
    """Make triggers and indices again; their text comes from a file, and may do nothing else."""
    connection.set_authorizer(restoring)
    try:
        for sql in definitions:
            connection.execute(sql)
    finally:
        connection.set_authorizer(None)
