"""The tables of a scene, read and changed with SQL, in Python and by `autocolor sql`."""

from __future__ import annotations

import os
import sqlite3
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Final, NamedTuple

from autocolor.budget import allowing, validated_limit
from autocolor.checks import nearest, printable, shown
from autocolor.errors import UsageError, WriteError
from autocolor.files.formats import recognized
from autocolor.files.meshes.repair import different
from autocolor.files.opening import FILES, STORE, PathLike, read_scene_with_report
from autocolor.files.store.connections import (
    BUSY_ERRORS,
    CHANGES,
    DAMAGE_ERRORS,
    DISK_ERRORS,
    Clock,
    authorizer,
    closed_on_error,
    copied,
    loaded,
    primary_code,
    replacing,
    sentence_of,
)
from autocolor.files.store.schema import MESH_TABLES, NODES, POLYGONS, VALUES, quoted
from autocolor.files.store.store_file import report_in, store_of
from autocolor.scene.scalar import NODE, POLYGON
from autocolor.scene.scene import Scene

DEPENDENT: Final = {POLYGONS: (VALUES[POLYGON], POLYGON), NODES: (VALUES[NODE], NODE)}
"""For each table: the table of values that are removed with its rows, and the column that refers to it."""

SECONDS: Final = 30.0
"""Limit: how long a statement may take, unless the user allows more."""

Parameters = Sequence[object] | Mapping[str, object]
Value = None | int | float | str | bytes


class Answer(NamedTuple):
    """The different names of the columns of an answer, and its rows, which are fetched in chunks."""

    columns: tuple[str, ...]
    rows: Iterator[tuple[Value, ...]]


def open_tables(path: PathLike, *, up: str = "z", scale: float = 1.0, limit: float | None = None) -> Tables:
    """The tables of a store. Any other scene is read, and its tables are made in memory.

        with autocolor.open_tables("car.sqlite") as tables:
            tables.select("SELECT name, surface FROM parts WHERE stage = ?", [False])
            tables.update("lights", "key", intensity=2.0)

    `limit` is a factor for the memory budget. Raises InputError, MissingInputError, and UsageError as
    `read_scene`.
    """
    path = Path(path)
    with allowing(limit):
        if is_store(path) and (up, scale) == ("z", 1):
            return Tables(loaded(path), path.name, path)
        return tables_of(read_scene_with_report(path, up=up, scale=scale).scene)


def is_store(path: Path) -> bool:
    """Whether a file is a store, by its name or its first bytes."""
    return not os.path.isdir(path) and recognized(path, FILES) is STORE


def tables_of(scene: Scene) -> Tables:
    """The tables of a scene, in memory."""
    return Tables(store_of(scene), scene.name)


class Tables:
    """The tables of one scene.

    The tables of a store are those of its file when it was opened, or changed here the last time. The changed
    scene is checked as a scene file is; a change is saved or refused as a whole. Changes of a store are saved
    to its file at once. Changes of another scene stay in memory: `write_scene` writes
    `scene()`. A statement that takes longer than `seconds` is ended.
    """

    def __init__(self, connection: sqlite3.Connection, name: str, store: Path | None = None) -> None:
        self._connection = connection
        self._name = name
        self._store = store
        self.seconds = SECONDS
        self._limit = validated_limit(None)

    @property
    def names(self) -> list[str]:
        """The names of all tables and views, also of other programs."""
        query = "SELECT name FROM sqlite_master WHERE type IN ('table', 'view') AND name NOT LIKE 'sqlite_%'"
        return [name for (name,) in self._connection.execute(f"{query} ORDER BY rowid LIMIT 1000")]

    def columns(self, table: str) -> list[str]:
        """The names of the columns of a table. Raises UsageError for an unknown table."""
        require_name(table, self.names, "table")
        return columns_in(self._connection, table)

    def select(self, statement: str, parameters: Parameters = ()) -> list[dict[str, Value]]:
        """The rows that a SELECT gives, as dictionaries by the names of columns.

        `parameters` are the values for ? or :name. Raises UsageError for a statement that is wrong, takes too
        long or would change rows.
        """
        columns, rows = self.answer(statement, parameters)
        return [dict(zip(columns, row, strict=True)) for row in rows]

    def answer(self, statement: str, parameters: Parameters = ()) -> Answer:
        """Like `select`, but rows are fetched in chunks, so that an answer may be larger than memory."""
        return answer_of(self._connection, statement, parameters, self.seconds)

    def table(self, name: str) -> list[dict[str, Value]]:
        """All rows of a table."""
        require_name(name, self.names, "table")
        return self.select(f"SELECT * FROM {quoted(name)}")

    def update(self, table: str, key: str | int, /, **values: object) -> None:
        """Change columns of the row with this key, which is a name or a number.

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
            rows = self.select(f"SELECT {quoted(by)} FROM {quoted(table)} LIMIT 1000")
            require_name(str(key), [str(row[by]) for row in rows], f"row of {table} with {by}")

    @property
    def is_in_a_file(self) -> bool:
        """Whether a change is saved to the file of a store at once."""
        return self._store is not None

    def would_change(self, statement: str, parameters: Parameters = ()) -> bool:
        """Whether a statement changes rows; it is not run. Raises UsageError for a wrong statement."""
        return bool(changes_of(self._connection, statement, parameters))

    def change(self, statement: str, parameters: Parameters = ()) -> int:
        """Run one INSERT, UPDATE or DELETE, check the scene, and save it; returns how many rows it changed.

        A new name of a part or a surface replaces the old name everywhere. Removing a node or a polygon
        removes its scalar values. A store is read again first, with the changes of other programs. Raises
        UsageError for a wrong statement, InputError with every problem of the changed scene, WriteError if
        the store has triggers, or cannot be written, OutputError if it is write-protected. After any error,
        nothing is changed.
        """
        with allowing(self._limit), self._copy() as (copy, save):
            tables = changes_of(copy, statement, parameters)
            for (trigger,) in copy.execute("SELECT name FROM sqlite_master WHERE type = 'trigger'"):
                raise WriteError(
                    f"{self._name}: a store that is changed must have no triggers, and this one has trigger"
                    f" {shown(trigger)}; drop it, or write the scene to another file"
                )
            # Without indexes, checking references to removed nodes takes the square of their number.
            if not tables.keys() & {*MESH_TABLES}:
                copy.execute("PRAGMA foreign_keys = ON")
            copy.execute("BEGIN")
            copy.execute("PRAGMA defer_foreign_keys = ON")
            count = change(copy, statement, parameters, self.seconds)
            for table, actions in tables.items():
                values, column = DEPENDENT.get(table, ("", ""))
                if sqlite3.SQLITE_DELETE in actions and column in columns_in(copy, values):
                    copy.execute(f"DELETE FROM {values} WHERE {column} NOT IN (SELECT {column} FROM {table})")
            report_in(copy, self._name, self._scene_name)
            try:
                copy.execute("COMMIT")
            except sqlite3.IntegrityError as error:
                raise WriteError(
                    f"{self._name}: tables of other programs must not refer to rows that a change removes or"
                    f" renames ({error}); change their rows first"
                ) from None
            if count:
                save(copy.serialize())
        self._connection.close()
        self._connection = copy
        return count

    @contextmanager
    def _copy(self) -> Iterator[tuple[sqlite3.Connection, Callable[[bytes], None]]]:
        """A copy of the tables, and a function that saves its bytes to the store's file, if there is one."""
        if self._store is not None:
            with replacing(self._store, lambda: None) as pair:
                yield pair
        else:
            with closed_on_error(copied(self._connection)) as copy:
                yield copy, lambda _: None

    @property
    def _scene_name(self) -> str:
        return self._name if self._store is None else self._store.stem

    def scene(self) -> Scene:
        """The scene of the tables as they are now. Raises InputError."""
        with allowing(self._limit):
            return report_in(self._connection, self._name, self._scene_name).scene

    def definition(self, table: str) -> str:
        """The statement that creates a table."""
        require_name(table, self.names, "table")
        query = "SELECT sql FROM sqlite_master WHERE name = ?"
        (text,) = self._connection.execute(query, (table,)).fetchone()
        return f"{text};"

    def close(self) -> None:
        """Close the file."""
        self._connection.close()

    def __enter__(self) -> Tables:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __repr__(self) -> str:
        return f"Tables({self._name!r}: {', '.join(self.names)})"


# Statements.

LONGEST_COMPUTED: Final = 1 << 17
"""Limit: in bytes, of a value that a statement reads or computes. SQLite cannot interrupt a function:
searching a text of this length for one of half its length takes 0.2 s; at LONGEST_TEXT it would take 9 s."""

ROWS_AT_ONCE: Final = 50
"""Rows that are fetched at once. The rows of tables have at most LONGEST_COMPUTED bytes each."""

STATEMENT_STEPS: Final = 1000
"""Steps of SQLite's machine between two looks at the clock; one step can be a slow function."""


def answer_of(
    connection: sqlite3.Connection, statement: str, parameters: Parameters = (), seconds: float = SECONDS
) -> Answer:
    """The answer to one statement that changes nothing. Raises UsageError, also while rows are fetched."""
    changes = changes_of(connection, statement, parameters)
    if changes:
        raise UsageError(
            f"a statement must only read the tables, and this one changes {', '.join(sorted(changes))}; allow"
            " changes with --write (tables.change in Python), or write a SELECT"
        )
    clock = Clock(connection, seconds, STATEMENT_STEPS)
    with _limited(connection, clock):
        cursor = connection.execute(statement, parameters)
    columns = different([column[0] for column in cursor.description or ()])

    def rows() -> Iterator[tuple[Value, ...]]:
        while True:
            # The time between two fetches is not the statement's.
            clock.begin()
            with _limited(connection, clock):
                fetched = cursor.fetchmany(ROWS_AT_ONCE)
            if not fetched:
                return
            yield from fetched

    return Answer(columns, rows())


def change(
    connection: sqlite3.Connection, statement: str, parameters: Parameters = (), seconds: float = SECONDS
) -> int:
    """Run one statement that changes rows, within a transaction; returns how many. Raises UsageError."""
    clock = Clock(connection, seconds, STATEMENT_STEPS)
    with _limited(connection, clock, may_change=True):
        cursor = connection.execute(statement, parameters)
        # The last row is changed only after all rows of a RETURNING clause are fetched.
        for _ in cursor:
            pass
        # The row count of Python 3.11's cursor is missing after WITH.
        (count,) = connection.execute("SELECT changes()").fetchone()
    return int(count)


def changes_of(
    connection: sqlite3.Connection, statement: str, parameters: Parameters = ()
) -> Mapping[str, set[int]]:
    """The tables that a statement would change, and how. It is not run.

    Raises UsageError for a wrong statement.
    """
    changes: dict[str, set[int]] = {}
    permission = authorizer(may_change=True)

    def note_change(
        action: int, first: str | None, second: str | None, database: str | None, inner: str | None
    ) -> int:
        if action in CHANGES and first is not None and inner is None:
            changes.setdefault(first.lower(), set()).add(action)
        # The changes of triggers are refused by name when the statement is run.
        return permission(action, first, second, database, None)

    if not statement.strip().rstrip(";").strip():
        raise UsageError("a statement must not be empty; write one, as in SELECT * FROM lights")
    is_pragma = statement.lstrip().lower().startswith(("pragma", "explain"))
    with _limited(connection, Clock(connection, SECONDS, STATEMENT_STEPS), may_change=True):
        connection.set_authorizer(note_change)
        connection.execute(statement if is_pragma else f"EXPLAIN {statement}", parameters).fetchall()
    return changes


@contextmanager
def _limited(connection: sqlite3.Connection, clock: Clock, may_change: bool = False) -> Iterator[None]:
    """Limits of permissions, time and the size of values for a statement.

    Raises UsageError for an error of SQLite; WriteError if the disk, which holds large sorted answers, is
    full or fails.
    """
    connection.set_authorizer(authorizer(may_change))
    longest = connection.setlimit(sqlite3.SQLITE_LIMIT_LENGTH, LONGEST_COMPUTED)
    try:
        yield
    except (sqlite3.Error, sqlite3.Warning, OverflowError, UnicodeError) as error:
        if "interrupted" in str(error) and not clock.ended:
            # The user pressed Ctrl+C, which SQLite took.
            raise KeyboardInterrupt from None
        if primary_code(error) in DISK_ERRORS:
            raise WriteError(sentence_of(error)) from None
        raise UsageError(_sentence(error, clock)) from None
    finally:
        connection.setlimit(sqlite3.SQLITE_LIMIT_LENGTH, longest)
        connection.set_authorizer(None)


CHECK_FAILED: Final = "CHECK constraint failed: "


def _sentence(error: Exception, clock: Clock) -> str:
    """A sentence for a statement that failed: what is wrong, and what to do."""
    text, code = printable(str(error)), primary_code(error)
    if clock.ended:
        return (
            f"a statement must end within {clock.seconds:g} seconds, not run on; narrow it with WHERE or"
            " LIMIT, or allow more with --seconds"
        )
    if code in (*BUSY_ERRORS, *DAMAGE_ERRORS):
        return sentence_of(error)
    if code == sqlite3.SQLITE_AUTH:
        return (
            "a statement must be a SELECT or, with --write, an INSERT, UPDATE or DELETE of rows, not another"
            f" ({text}); change the tables themselves with a tool of SQLite"
        )
    if text.startswith(CHECK_FAILED):
        # The name of the CHECK is its rule.
        return f"{text.removeprefix(CHECK_FAILED)}, and a changed row breaks this rule; correct its value"
    return f"a statement must be one that SQLite can run, and this one is not ({text}); correct it"


def columns_in(connection: sqlite3.Connection, table: str) -> list[str]:
    """The names of the columns of a table; empty if there is no such table."""
    try:
        return [row[1] for row in connection.execute(f"PRAGMA table_info({quoted(table)})")]
    except sqlite3.Error:
        # A view of another program may be broken.
        return []


def require_name(name: str, names: Sequence[str], noun: str) -> None:
    """Raise UsageError, with the nearest name, unless the names include a name."""
    if name not in names:
        raise UsageError(f"there is no {noun} {shown(name)}{nearest(name, names)}")
