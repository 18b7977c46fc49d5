"""Connections to stores: what a stranger's file may do in ours is nothing but be read.

A store is data. The schema of a file cannot call functions that do anything but compute (`trusted_schema`),
nothing can be attached or loaded, no pragma can be set by a statement (see `permissions`), sizes are limited,
and a statement that takes too long is ended. Python 3.11 cannot set SQLite's defensive mode; later ones do.

A `-journal` beside a store may name any file as its super-journal, which SQLite deletes after it rolled the
journal back. So a store is always opened read-only first, and no journal is ever rolled back.
"""

from __future__ import annotations

import os
import sqlite3
import stat
import time
from collections.abc import Iterator
from contextlib import closing, contextmanager, suppress
from pathlib import Path
from typing import Any, Final
from urllib.request import pathname2url

from autocolor.checks import printable
from autocolor.errors import InputError, MissingInputError, UnavailableError, WriteError, reason_of
from autocolor.files.reading import opened, read_head, refuse_irregular, status_of

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

SECONDS_BETWEEN_TRIES: Final = 0.02
"""Limit: seconds between two tries to begin a change while another program is writing."""

FIRST_LOOK: Final = "SELECT count(*) FROM sqlite_master"

JOURNAL_HEADER: Final = 28
"""Bytes of the header of a rollback journal; the rest of its first sector is padding."""

JOURNAL_MAGIC: Final = bytes.fromhex("d9d505f920a163d7")
"""The bytes that a rollback journal begins with, and that follow the name of a super-journal at its end."""

JOURNAL_LEFT: Final = (
    "the -journal beside the store is from a change that has not ended, and to roll it back can delete any"
    " file that it names; if you trust both files, open the store once with `sqlite3 FILE .tables`, otherwise"
    " move the journal away"
)

WAL_VERSION: Final = 2
"""The byte in the header of a store in WAL mode; bytes 18 and 19 are for writing and for reading."""

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


def connected(path: Path) -> sqlite3.Connection:
    """A read-only connection to the store at a path.

    Changes of another program that are still in the store's `-wal` are read with it. Nothing is rolled back
    and no file appears beside the store. Raises InputError, MissingInputError.
    """
    _refuse_unsafe(path)
    mode = _reading_mode(path)
    with refusals(path.name):
        return _opened(path, mode, SECONDS_OF_WAITING)


def connected_to_change(path: Path, *, checks_references: bool = False) -> sqlite3.Connection:
    """A connection to the store at a path that has begun a transaction to change it.

    Check the file with `store_head` or `connected` before: an empty file would become a store. With
    `checks_references`, SQLite follows and checks foreign keys in the transaction. Raises InputError,
    MissingInputError, and WriteError if another program is still writing after some seconds.
    """
    _refuse_unsafe(path)
    until = time.monotonic() + SECONDS_OF_WAITING
    with refusals(path.name), refusals_of_writing(path.name):
        while (connection := _begun(path, checks_references)) is None:
            if time.monotonic() > until:
                refuse_journal(path)
                raise WriteError(
                    f"{path.name}: another program is writing to the store; let it end, and try again"
                )
            time.sleep(SECONDS_BETWEEN_TRIES)
    return connection


def _begun(path: Path, checks_references: bool) -> sqlite3.Connection | None:
    """A writable connection in a transaction, or None while another program is writing.

    While the reader has its lock, SQLite cannot roll back a journal that appears after the check.
    """
    try:
        with closing(_opened(path, "ro", 0.0)) as reader:
            reader.execute("BEGIN")
            reader.execute(FIRST_LOOK).fetchone()
            if _has_journal(path):
                return None
            connection = _opened(path, "rw", 0.0)
            try:
                connection.execute(f"PRAGMA foreign_keys = {'ON' if checks_references else 'OFF'}")
                connection.execute("BEGIN IMMEDIATE")
            except BaseException:
                closed(connection)
                raise
    except sqlite3.OperationalError as error:
        if _primary_code(error) in (sqlite3.SQLITE_BUSY, sqlite3.SQLITE_LOCKED):
            return None
        raise
    connection.execute(f"PRAGMA busy_timeout = {SECONDS_OF_WAITING * 1000:.0f}")
    return connection


def _refuse_unsafe(path: Path) -> None:
    """Raise InputError if a store is no regular file, too large, or beside files that are not to be opened.

    It opens no file that SQLite locks: to close one would end the locks of this process on it.
    """
    refuse_old_sqlite()
    status = status_of(path)
    refuse_irregular(path, status)
    if status.st_size > LARGEST_STORE:
        raise InputError(
            f"{path.name}: a store must have at most {LARGEST_STORE:,} bytes, not more; split it"
        )
    _, wal, shm = (_size_beside(path, ending) for ending in ("-journal", "-wal", "-shm"))
    if os.path.islink(path):
        # SQLite looks beside the file that the link leads to only; a copy of the link's folder changes that.
        refuse_journal(path)
    if wal and shm is None:
        raise InputError(
            f"{path.name}: the latest changes are in {path.name}-wal, which cannot be read without"
            f" {path.name}-shm; open the store once with `sqlite3 FILE .tables`"
        )


def store_head(path: Path) -> bytes:
    """The first bytes of a store. Raises InputError if a file does not begin as a store.

    To close the file ends the locks of SQLite in this process on it: call this before a store is opened.
    """
    head = read_head(path)
    if head[: len(BEGINS)] != BEGINS:
        raise InputError(
            f"{path.name}: a store must be an SQLite file, and this one does not begin as such; write it"
            " again with `autocolor convert`"
        )
    return head


def _reading_mode(path: Path) -> str:
    """The mode to read a store in. Raises InputError if it cannot be read without rolling a journal back.

    In WAL mode SQLite makes the files that are missing beside a store even to read it. A store without a
    `-wal` is complete by itself, so it is read as a file that does not change.
    """
    head = store_head(path)
    wal, shm = (_size_beside(path, ending) for ending in ("-wal", "-shm"))
    if wal is not None and shm is not None:
        return "ro"
    if wal is None and WAL_VERSION not in head[18:20]:
        return "ro"
    # An immutable file is read without a look at its journal.
    refuse_journal(path)
    return "ro&immutable=1"


def _size_beside(path: Path, ending: str) -> int | None:
    """The size of a file beside a store; None if there is none. Raises InputError if it is not regular.

    SQLite would wait for a pipe without end.
    """
    beside = Path(os.path.realpath(path) + ending)
    try:
        status = os.lstat(beside)
    except OSError:
        return None
    if stat.S_ISLNK(status.st_mode):
        raise InputError(f"{beside}: it must be a regular file, not a link; move the link away")
    refuse_irregular(beside, status)
    return status.st_size


def refuse_journal(path: Path) -> None:
    """Raise InputError if a rollback journal is beside a store, or beside the file that its link leads to."""
    if _has_journal(path):
        raise InputError(f"{path.name}: {JOURNAL_LEFT}")


def _has_journal(path: Path) -> bool:
    """Whether a journal beside a store may be rolled back, or may end with the name of a file to delete.

    A program that reuses its journal leaves it with a header of zeros. If such a journal ends with the name
    of a super-journal, SQLite deletes the named file as soon as a change of ours is taken back.
    """
    for place in (path, os.path.realpath(path)):
        try:
            with opened(Path(f"{place}-journal")) as (file, status):
                head = file.read(JOURNAL_HEADER)
                file.seek(max(0, status.st_size - len(JOURNAL_MAGIC)))
                if any(head) or file.read() == JOURNAL_MAGIC:
                    return True
        except MissingInputError:
            continue
    return False


def _primary_code(error: Exception) -> int:
    """The error code of SQLite without its details; 0 if the error has none."""
    return getattr(error, "sqlite_errorcode", 0) & 0xFF


def _opened(path: Path, mode: str, seconds_of_waiting: float) -> sqlite3.Connection:
    """A connection that begins no transaction by itself."""
    uri = f"file:{pathname2url(os.path.abspath(path))}?mode={mode}"
    connection = sqlite3.connect(uri, uri=True, isolation_level=None, timeout=seconds_of_waiting)
    try:
        guarded(connection)
        # SQLite reads the file, and looks for its journal, only now.
        connection.execute(FIRST_LOOK).fetchone()
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
        if _primary_code(error) in OF_WRITING:
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
    if code == sqlite3.SQLITE_READONLY_ROLLBACK:
        return JOURNAL_LEFT
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


def journal_mode(connection: sqlite3.Connection) -> str:
    """The journal mode of a store; "delete" if a store in WAL mode was opened as an immutable file."""
    (mode,) = connection.execute("PRAGMA journal_mode").fetchone()
    return str(mode)
