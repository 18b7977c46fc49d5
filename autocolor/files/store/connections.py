"""Connections to stores: what a stranger's file may do in ours is nothing but be read.

A store is data. The schema of a file cannot call functions that do anything but compute (`trusted_schema`),
nothing can be attached or loaded, no pragma can be set by a statement (see `permissions`), sizes are limited,
and a statement that takes too long is ended. Python 3.11 cannot set SQLite's defensive mode; later ones do.
"""

from __future__ import annotations

import os
import sqlite3
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any, Final
from urllib.request import pathname2url

from autocolor.checks import printable
from autocolor.errors import InputError, UnavailableError, WriteError, reason_of
from autocolor.files.reading import read_head, refuse_irregular, status_of

LEAST_SQLITE: Final = (3, 37, 0)
"""The first version with STRICT tables."""

BEGINS: Final = b"SQLite format 3\0"
LARGEST_STORE: Final = 1 << 31
"""Assumed: in bytes; thirty million polygons."""

LONGEST_TEXT: Final = 1 << 20
"""Assumed: in bytes, of a value and of a row."""

LONGEST_COMPUTED: Final = 1 << 17
"""Assumed: in bytes, of a value that a statement reads or computes. A function is not ended while it runs:
to search half of this in all of it takes a fifth of a second, and of LONGEST_TEXT nine."""

READING_SECONDS: Final = 120.0
"""Assumed: how long a store may be read; the largest takes half of that."""

SECONDS_OF_WAITING: Final = 5.0
"""Assumed: how long to wait for another program that is writing."""

STEPS: Final = 100_000
"""Steps of SQLite's machine between two looks at the clock: about a millisecond."""

BESIDE: Final = ("-journal", "-wal", "-shm")
"""The endings of the files that SQLite opens beside a store."""

LIMITS: Final = {
    sqlite3.SQLITE_LIMIT_LENGTH: LONGEST_TEXT,
    sqlite3.SQLITE_LIMIT_SQL_LENGTH: LONGEST_TEXT,
    sqlite3.SQLITE_LIMIT_COLUMN: 2000,
    sqlite3.SQLITE_LIMIT_EXPR_DEPTH: 200,
    sqlite3.SQLITE_LIMIT_COMPOUND_SELECT: 50,
    sqlite3.SQLITE_LIMIT_VDBE_OP: 250_000,
    sqlite3.SQLITE_LIMIT_FUNCTION_ARG: 100,
    sqlite3.SQLITE_LIMIT_ATTACHED: 0,
    sqlite3.SQLITE_LIMIT_LIKE_PATTERN_LENGTH: 1000,
    sqlite3.SQLITE_LIMIT_VARIABLE_NUMBER: 1000,
    sqlite3.SQLITE_LIMIT_TRIGGER_DEPTH: 1,
    sqlite3.SQLITE_LIMIT_WORKER_THREADS: 0,
}
"""What a statement, and a value in a file, may be at most."""


class Clock:
    """Ends statements of a connection that take longer than some seconds; `ended` tells that it did."""

    def __init__(
        self, connection: sqlite3.Connection, seconds: float = READING_SECONDS, steps: int = STEPS
    ) -> None:
        self.seconds = seconds
        self.ended = False
        self.begin()
        connection.set_progress_handler(self._look, steps)

    def begin(self, seconds: float | None = None) -> None:
        """Count from now."""
        self.seconds = self.seconds if seconds is None else seconds
        self.ended = False
        self._until = time.monotonic() + self.seconds

    def _look(self) -> int:
        self.ended = time.monotonic() > self._until
        return int(self.ended)


OF_WRITING: Final = (
    sqlite3.SQLITE_BUSY,
    sqlite3.SQLITE_LOCKED,
    sqlite3.SQLITE_FULL,
    sqlite3.SQLITE_IOERR,
    sqlite3.SQLITE_READONLY,
    sqlite3.SQLITE_CANTOPEN,
)
"""The errors of a store that is not itself at fault when it cannot be written."""

OF_THE_DISK: Final = (sqlite3.SQLITE_FULL, sqlite3.SQLITE_IOERR)
"""The errors of a disk that is full or fails."""


def guarded(connection: sqlite3.Connection) -> sqlite3.Connection:
    """The connection, with its limits and settings; nothing of its file is run."""
    for limit, most in LIMITS.items():
        connection.setlimit(limit, min(most, connection.getlimit(limit)))
    for pragma in ("trusted_schema=OFF", "cell_size_check=ON", "mmap_size=0", "foreign_keys=OFF"):
        connection.execute(f"PRAGMA {pragma}")
    if hasattr(connection, "setconfig"):
        # From Python 3.12 on.
        connection.setconfig(getattr(sqlite3, "SQLITE_DBCONFIG_DEFENSIVE"), True)  # noqa: B009
    return connection


def in_memory() -> sqlite3.Connection:
    """A new store in memory. Raises UnavailableError."""
    refuse_old_sqlite()
    return guarded(sqlite3.connect(":memory:", isolation_level=None))


def refuse_old_sqlite() -> None:
    """Raise UnavailableError if the SQLite of this Python has no STRICT tables."""
    if sqlite3.sqlite_version_info < LEAST_SQLITE:
        raise UnavailableError(
            f"a store must have SQLite 3.37 or later, not {sqlite3.sqlite_version}; use a newer Python"
        )


def connected(path: Path, *, may_change: bool = False, wait: float | None = None) -> sqlite3.Connection:
    """A connection to the store at a path, read-only unless it `may_change`; it begins no transaction itself.

    What another program wrote beside the file and not yet into it (`-wal`) is read with it. A change that was
    interrupted (`-journal`) is taken back first, as SQLite does. Raises InputError, MissingInputError, and,
    if it `may_change`, WriteError where another program is writing. It waits some seconds for that one, or
    `wait`.
    """
    refuse_old_sqlite()
    status = status_of(path)
    refuse_irregular(path, status)
    if status.st_size > LARGEST_STORE:
        raise InputError(
            f"{path.name}: a store must have at most {LARGEST_STORE:,} bytes, not more; split it"
        )
    if read_head(path)[: len(BEGINS)] != BEGINS:
        raise InputError(
            f"{path.name}: a store must be an SQLite file, and this one does not begin as such; write it"
            " again with `autocolor convert`"
        )
    for ending in BESIDE:
        with suppress(OSError):
            # SQLite would wait for a pipe without end.
            beside = Path(f"{path}{ending}")
            refuse_irregular(beside, os.stat(beside))
    if may_change:
        with refusals(path.name), refusals_of_writing(path.name):
            return _opened(path, "rw", wait)
    with refusals(path.name):
        try:
            return _opened(path, "ro", wait)
        except sqlite3.OperationalError as error:
            if not _is_unfinished(error):
                raise
        # Take back, or take over, what is beside the file; where nothing can be written, it is read alone.
        try:
            _opened(path, "rw", wait).close()
            return _opened(path, "ro", wait)
        except sqlite3.OperationalError:
            if any(os.path.exists(f"{path}{end}") for end in ("-wal", "-journal")):
                raise
            return _opened(path, "ro&immutable=1", wait)


def _is_unfinished(error: sqlite3.Error) -> bool:
    return getattr(error, "sqlite_errorcode", 0) & 0xFF in (sqlite3.SQLITE_READONLY, sqlite3.SQLITE_CANTOPEN)


def _opened(path: Path, mode: str, wait: float | None) -> sqlite3.Connection:
    uri = f"file:{pathname2url(os.path.abspath(path))}?mode={mode}"
    timeout = SECONDS_OF_WAITING if wait is None else wait
    connection = sqlite3.connect(uri, uri=True, isolation_level=None, timeout=timeout)
    try:
        guarded(connection)
        # The first look at the file: SQLite opens it only now.
        connection.execute("SELECT count(*) FROM sqlite_master").fetchone()
    except BaseException:
        connection.close()
        raise
    return connection


@contextmanager
def refusals(name: str, clock: Clock | None = None) -> Iterator[None]:
    """Raise what SQLite says of a damaged or unreadable store as InputError that tells what to do."""
    try:
        yield
    except (InputError, WriteError):
        raise
    except (sqlite3.Error, sqlite3.Warning, UnicodeError, OverflowError) as error:
        raise InputError(f"{name}: {reason(error, clock)}") from None


@contextmanager
def refusals_of_writing(name: str) -> Iterator[None]:
    """Raise what keeps a store from being written as WriteError; other errors are left as they are."""
    try:
        yield
    except sqlite3.Error as error:
        if getattr(error, "sqlite_errorcode", 0) & 0xFF in OF_WRITING:
            raise WriteError(f"{name}: {reason(error)}") from None
        raise


def reason(error: Exception, clock: Clock | None = None) -> str:
    """What is wrong with a store by an error of SQLite, and what to do."""
    code = getattr(error, "sqlite_errorcode", None)
    text = printable(reason_of(error)[:300])
    primary: Any = None if code is None else code & 0xFF
    if clock is not None and clock.ended:
        return f"a store must be read within {clock.seconds:g} seconds, not longer; leave rows out"
    if primary in (sqlite3.SQLITE_BUSY, sqlite3.SQLITE_LOCKED):
        return "another program is writing to the store; let it end, and try again"
    if primary == sqlite3.SQLITE_TOOBIG:
        return f"a value must have at most {LONGEST_TEXT:,} bytes, not more; shorten it"
    if primary in (sqlite3.SQLITE_READONLY, sqlite3.SQLITE_CANTOPEN):
        return (
            f"the store cannot be opened or changed where it is ({text}): a change of it was interrupted, or"
            " it is not to be written; open it once with the program that wrote it, or use another file"
        )
    if primary in OF_THE_DISK:
        return f"the disk must hold the store, and is full or fails ({text}); make room, and try again"
    if primary == sqlite3.SQLITE_NOMEM:
        return "there is not enough memory to read the store; leave rows out"
    if primary == sqlite3.SQLITE_AUTH:
        return f"the store must hold tables of values, not ask for more ({text}); rebuild it"
    return (
        f"the store cannot be read ({text}); if it is damaged, bring a copy back, or rescue it with"
        " `sqlite3 FILE .recover`"
    )


def closed(connection: sqlite3.Connection) -> None:
    """Close a connection, whatever state it is in."""
    with suppress(sqlite3.Error):
        connection.close()
