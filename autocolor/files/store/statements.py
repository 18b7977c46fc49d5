"""Statements of SQL on the tables of a store: what they may do, answer, and what is wrong with them."""

from __future__ import annotations

import re
import sqlite3
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import Final, NamedTuple

from autocolor.checks import nearest, shown
from autocolor.errors import InputError, UsageError, WriteError
from autocolor.files.meshes.repair import different
from autocolor.files.store.connections import LONGEST_COMPUTED, LONGEST_TEXT, OF_THE_DISK, Clock, reason
from autocolor.files.store.sql_columns import quoted

# -------------------- permissions
# What a statement may do to a store: read and compute, and change rows where that is asked for.

FUNCTIONS: Final = frozenset(
    (
        "abs", "acos", "acosh", "asin", "asinh", "atan", "atan2", "atanh", "avg", "cast", "ceil", "ceiling",
        "changes", "char", "coalesce", "concat", "concat_ws", "cos", "cosh", "count", "cume_dist",
        "current_date", "current_time", "current_timestamp", "date", "datetime", "degrees", "dense_rank",
        "exp", "first_value", "floor", "format", "glob", "group_concat", "hex", "ieee754", "ifnull", "iif",
        "instr", "json", "json_array", "json_array_length", "json_each", "json_extract", "json_group_array",
        "json_group_object", "json_object", "json_quote", "json_remove", "json_replace", "json_set",
        "json_tree", "json_type", "json_valid", "julianday", "lag", "last_insert_rowid", "last_value",
        "lead", "length", "like", "likelihood", "likely", "ln", "log", "log10", "log2", "lower", "ltrim",
        "max", "min", "mod", "nth_value", "ntile", "nullif", "percent_rank", "pi", "pow", "power", "printf",
        "quote", "radians", "random", "rank", "replace", "round", "row_number", "rtrim", "sign", "sin",
        "sinh", "sqlite_version", "sqrt", "strftime", "string_agg", "substr", "substring", "sum", "tan",
        "tanh", "time", "timediff", "total", "total_changes", "trim", "trunc", "typeof", "unicode", "unistr",
        "unixepoch", "unlikely", "upper", "->", "->>",
    )
)  # fmt: skip
"""The functions that statements may call: those that compute with their arguments and nothing else."""

READING_PRAGMAS: Final = frozenset(
    (
        "application_id", "data_version", "foreign_key_check", "foreign_key_list", "index_info", "index_list",
        "integrity_check", "page_count", "page_size", "quick_check", "schema_version", "table_info",
        "table_list", "table_xinfo", "user_version",
    )
)  # fmt: skip
"""The pragmas that only tell something; as most take an argument, it must not be a new value."""

SETTABLE: Final = ("application_id", "schema_version", "user_version")

RESTORES: Final = (
    sqlite3.SQLITE_CREATE_TRIGGER,
    sqlite3.SQLITE_CREATE_INDEX,
    sqlite3.SQLITE_REINDEX,
    sqlite3.SQLITE_SELECT,
    sqlite3.SQLITE_READ,
)
"""What it takes to make a trigger or an index again, but for its row in the table of all tables."""

MASTER: Final = "sqlite_master"

READS: Final = (
    sqlite3.SQLITE_SELECT,
    sqlite3.SQLITE_READ,
    sqlite3.SQLITE_RECURSIVE,
    sqlite3.SQLITE_TRANSACTION,
    sqlite3.SQLITE_SAVEPOINT,
)
CHANGES: Final = (sqlite3.SQLITE_INSERT, sqlite3.SQLITE_UPDATE, sqlite3.SQLITE_DELETE)

Authorizer = Callable[[int, str | None, str | None, str | None, str | None], int]


def authorizer(may_change: bool) -> Authorizer:
    """What a statement may do: read, call FUNCTIONS, and, if it `may_change`, change rows of tables."""

    def allowed(
        action: int, first: str | None, second: str | None, database: str | None, inner: str | None
    ) -> int:
        if action == sqlite3.SQLITE_FUNCTION:
            is_allowed = (second or "").lower() in FUNCTIONS
        elif action == sqlite3.SQLITE_PRAGMA:
            name = (first or "").lower()
            is_allowed = name in READING_PRAGMAS and not (second is not None and name in SETTABLE)
        elif action in CHANGES:
            is_allowed = may_change and not (first or "").lower().startswith("sqlite_")
        else:
            is_allowed = action in READS
        return sqlite3.SQLITE_OK if is_allowed else sqlite3.SQLITE_DENY

    return allowed


def restoring(
    action: int, first: str | None, second: str | None, database: str | None, inner: str | None
) -> int:
    """What the text may do that a file keeps of a trigger or an index: make that, and nothing else."""
    if action == sqlite3.SQLITE_FUNCTION:
        is_allowed = (second or "").lower() in FUNCTIONS
    else:
        is_allowed = action in RESTORES or (action in CHANGES[:2] and first == MASTER)
    return sqlite3.SQLITE_OK if is_allowed else sqlite3.SQLITE_DENY


SECONDS: Final = 30.0
"""Assumed: how long a statement may take unless more is allowed."""

AT_ONCE: Final = 1000
"""Rows that are fetched at once, unless they are long."""

STEPS: Final = 1000
"""Steps of SQLite's machine between two looks at the clock: a function may take long for one step."""

KEYWORDS: Final = ("on", "of", "all", "order", "group", "from", "to")
"""Keywords of SQL that are, or may be, the names of columns."""

Parameters = Sequence[object] | Mapping[str, object]
Value = None | int | float | str | bytes


class Answer(NamedTuple):
    """The names of the columns of an answer, which differ, and its rows, fetched as they are asked for."""

    columns: tuple[str, ...]
    rows: Iterator[tuple[Value, ...]]


def answer_of(
    connection: sqlite3.Connection, statement: str, parameters: Parameters = (), seconds: float = SECONDS
) -> Answer:
    """The answer to one statement that changes nothing. Raises UsageError, also while rows are fetched."""
    changed = changes_of(connection, statement, parameters)
    if changed:
        raise UsageError(
            f"a statement must only read the tables, and this one changes {', '.join(sorted(changed))}; allow"
            " changes with --write (tables.change in Python), or write a SELECT"
        )
    clock = Clock(connection, seconds, STEPS)
    with told(connection, clock), allowed(connection, may_change=False):
        cursor = connection.execute(statement, parameters)
    columns = different([each[0] for each in cursor.description or ()])

    def rows() -> Iterator[tuple[Value, ...]]:
        while True:
            # What is done with the rows in between takes no time of the statement.
            clock.begin()
            with told(connection, clock), allowed(connection, may_change=False):
                found = _some_of(cursor)
            if not found:
                return
            yield from found

    return Answer(columns, rows())


def _some_of(cursor: sqlite3.Cursor) -> list[tuple[Value, ...]]:
    """The next AT_ONCE rows; fewer if their texts are LONGEST_TEXT letters together."""
    rows: list[tuple[Value, ...]] = []
    letters = 0
    while len(rows) < AT_ONCE and letters < LONGEST_TEXT:
        row = cursor.fetchone()
        if row is None:
            break
        rows.append(row)
        letters += sum(len(value) for value in row if isinstance(value, (str, bytes)))
    return rows


def change(
    connection: sqlite3.Connection, statement: str, parameters: Parameters = (), seconds: float = SECONDS
) -> int:
    """Run one statement that changes rows, within a transaction; returns how many. Raises UsageError."""
    clock = Clock(connection, seconds, STEPS)
    with told(connection, clock), allowed(connection, may_change=True):
        cursor = connection.execute(statement, parameters)
        # Rows that a RETURNING clause gives are left aside, but only then are all of them changed.
        for _ in cursor:
            pass
    return max(cursor.rowcount, 0)


def changes_of(
    connection: sqlite3.Connection, statement: str, parameters: Parameters = ()
) -> Mapping[str, set[int]]:
    """The tables that a statement would change, and how; it is not run. Raises UsageError for a wrong one."""
    found: dict[str, set[int]] = {}
    check = authorizer(may_change=True)

    def note(action: int, first: str | None, *rest: str | None) -> int:
        if action in CHANGES and first is not None:
            found.setdefault(first.lower(), set()).add(action)
        return check(action, first, *rest)

    if not statement.strip().rstrip(";").strip():
        raise UsageError("a statement must not be empty; write one, as in SELECT * FROM lights")
    connection.set_authorizer(note)
    try:
        with told(connection, Clock(connection, SECONDS, STEPS)):
            is_pragma = statement.lstrip().lower().startswith(("pragma", "explain"))
            connection.execute(statement if is_pragma else f"EXPLAIN {statement}", parameters).fetchall()
    finally:
        connection.set_authorizer(None)
    return found


@contextmanager
def allowed(connection: sqlite3.Connection, may_change: bool) -> Iterator[None]:
    """What statements may do meanwhile, and how long the values may be that they compute."""
    connection.set_authorizer(authorizer(may_change))
    longest = connection.setlimit(sqlite3.SQLITE_LIMIT_LENGTH, LONGEST_COMPUTED)
    try:
        yield
    finally:
        connection.setlimit(sqlite3.SQLITE_LIMIT_LENGTH, longest)
        connection.set_authorizer(None)


@contextmanager
def told(connection: sqlite3.Connection, clock: Clock) -> Iterator[None]:
    """Raise what SQLite says of a statement as UsageError, in a sentence that tells what to do.

    Raises WriteError instead for a disk that is full or fails, InputError for a journal that appeared.
    """
    try:
        yield
    except (sqlite3.Error, sqlite3.Warning, OverflowError, UnicodeError) as error:
        if "interrupted" in str(error) and not clock.ended:
            # The user pressed Ctrl+C, which SQLite took.
            raise KeyboardInterrupt from None
        if getattr(error, "sqlite_errorcode", 0) & 0xFF in OF_THE_DISK:
            raise WriteError(reason(error)) from None
        if getattr(error, "sqlite_errorcode", 0) == sqlite3.SQLITE_READONLY_ROLLBACK:
            raise InputError(reason(error)) from None
        raise UsageError(_sentence(connection, error, clock)) from None


def _sentence(connection: sqlite3.Connection, error: Exception, clock: Clock) -> str:
    """What is wrong with a statement, and what to do."""
    text = str(error)
    if clock.ended:
        return (
            f"a statement must end within {clock.seconds:g} seconds, not run on; narrow it with WHERE or"
            " LIMIT, or allow more with --seconds"
        )
    for pattern, told_of in _PATTERNS:
        found = re.search(pattern, text, re.DOTALL)
        if found:
            return told_of.format(*found.groups()) + _advice(connection, pattern, found)
    return f"a statement must be one that SQLite can run, and this one is not ({text}); correct it"


_NO_TABLE: Final = r"no such table: (?:main\.)?(.*)"
_NO_COLUMN: Final = r"(?:no such column: |table \S+ has no column named )(.*)"
_NO_FUNCTION: Final = r"(?:no such function: |not authorized to use function: )(.*)"
_SYNTAX: Final = r'near "(.*)": syntax error'

_PATTERNS: Final = (
    (_NO_TABLE, "there is no table {0!r}"),
    (_NO_COLUMN, "there is no column {0!r}"),
    (_NO_FUNCTION, "a statement may not call the function {0!r}"),
    (_SYNTAX, "a statement cannot be understood near {0!r}"),
    (r"incomplete input", "a statement must be complete, and this one ends too early; complete it"),
    (
        r"one statement at a time",
        "there must be one statement at a time, not several; give them one after the other",
    ),
    (r"CHECK constraint failed: (.*)", "{0}, and a changed row does not hold to that; change it"),
    (r"NOT NULL constraint failed: (\S+)", "{0} must have a value, not NULL; give it one"),
    (r"UNIQUE constraint failed: (\S+)", "{0} must be unique, not that of another row; choose another"),
    (r"cannot store (\w+) value in (\w+) column (\S+)", "{2} must be {1}, not {0}; convert it"),
    (
        r"not authorized|prohibited|readonly",
        "a statement must be a SELECT or, with --write, an INSERT, UPDATE or DELETE of rows, not another;"
        " change the tables themselves with a tool of SQLite",
    ),
    (
        r"too big|too large|too many|too long",
        f"a value must have at most {LONGEST_COMPUTED:,} bytes; shorten it",
    ),
    (
        r"(?:locked|busy)",
        "another program is writing to the store, which must wait for it; let it end, and try again",
    ),
)
"""What SQLite's errors say in a sentence; the groups of the pattern stand for the braces."""


def _advice(connection: sqlite3.Connection, pattern: str, found: re.Match[str]) -> str:
    """What to do, where it depends on the names in the message."""
    if pattern == _NO_TABLE:
        return nearest(found[1], names_of_tables(connection))
    if pattern == _NO_COLUMN:
        name = found[1].rpartition(".")[2].strip('"')
        columns = {each for table in names_of_tables(connection) for each in columns_in(connection, table)}
        return nearest(name, sorted(columns)) or "; see .schema for the columns of each table"
    if pattern == _NO_FUNCTION:
        return nearest(found[1], sorted(FUNCTIONS)) or "; leave it out"
    if pattern == _SYNTAX:
        word = found[1]
        return (
            f'; as a column, write "{word}" with its quotes' if word.lower() in KEYWORDS else "; correct it"
        )
    return ""


def names_of_tables(connection: sqlite3.Connection) -> list[str]:
    """The names of all tables and views of a store, those of others included."""
    query = "SELECT name FROM sqlite_master WHERE type IN ('table', 'view') AND name NOT LIKE 'sqlite_%'"
    return [name for (name,) in connection.execute(f"{query} ORDER BY rowid LIMIT 1000")]


def columns_in(connection: sqlite3.Connection, table: str) -> list[str]:
    """The names of the columns of a table; empty if there is no such table."""
    try:
        return [row[1] for row in connection.execute(f"PRAGMA table_info({quoted(table)})")]
    except sqlite3.Error:
        # A view of others may be broken.
        return []


def require_name(name: str, known: Sequence[str], what: str) -> None:
    """Raise UsageError, with the nearest name, for one that is not known."""
    if name not in known:
        raise UsageError(f"there is no {what} {shown(name)}{nearest(name, known)}")
