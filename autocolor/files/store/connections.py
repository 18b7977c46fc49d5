"""Connections to stores. A store is data: the file of a stranger can be read, and can do nothing else.

- The schema of a file may call only functions that compute (`trusted_schema`). Nothing can be attached or
  loaded, no statement can set a pragma (see `authorizer`), sizes are limited, and a statement that takes too
  long is ended. Python 3.11 cannot set SQLite's defensive mode; later versions do.
- A `-journal` beside a store may name any file as its super-journal. SQLite deletes that file after it
  rolled the journal back. So a store is always opened read-only first, and no journal is ever rolled back.
"""

from __future__ import annotations

import os
import sqlite3
import stat
import time
from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager
from pathlib import Path
from typing import Final

from autocolor.checks import printable
from autocolor.errors import InputError, MissingInputError, UnavailableError, WriteError, reason_of
from autocolor.files.reading import opened, read_head, refuse_irregular, require_size, status_of

LEAST_SQLITE: Final = (3, 37, 0)
"""The first version with STRICT tables."""

BEGINS: Final = b"SQLite format 3\0"
GROWTH: Final = 2
"""Measured: how many times its size the store of a scene takes while it is read."""

LONGEST_TEXT: Final = 1 << 20
"""Limit: in bytes, of a value and of a row."""

READING_SECONDS: Final = 120.0
"""Limit: how long a store may be read; the largest takes half of that."""

SECONDS_OF_WAITING: Final = 5.0
"""Limit: how long to wait for another program that is writing."""

SECONDS_BETWEEN_TRIES: Final = 0.02
"""Limit: seconds between two tries to begin a change while another program is writing."""

STEPS: Final = 100_000
"""Steps of SQLite's machine between two looks at the clock: about a millisecond."""

FIRST_LOOK: Final = "SELECT count(*) FROM sqlite_master"

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
"""Upper limits of statements, and of the values in a file."""


def in_memory() -> sqlite3.Connection:
    """A new store in memory. Raises UnavailableError."""
    refuse_old_sqlite()
    return _guarded(sqlite3.connect(":memory:", isolation_level=None))


def connected(path: Path) -> sqlite3.Connection:
    """A read-only connection to the store at a path.

    It also reads changes of another program that are still in the store's `-wal`. It rolls no journal back,
    and creates no file. Raises InputError, MissingInputError.
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
    with refusals(path.name), write_refusals(path.name):
        while (connection := _begun(path, checks_references)) is None:
            if time.monotonic() > until:
                refuse_journal(path)
                raise WriteError(f"{path.name}: {BUSY}")
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
                connection.close()
                raise
    except sqlite3.OperationalError as error:
        if primary_code(error) in BUSY_ERRORS:
            return None
        raise
    connection.execute(f"PRAGMA busy_timeout = {SECONDS_OF_WAITING * 1000:.0f}")
    return connection


@contextmanager
def transaction(connection: sqlite3.Connection, name: str) -> Iterator[None]:
    """A transaction, which begins here unless the connection has begun it. After any error it is rolled back.

    Raises WriteError if another program is writing to the store, if writing fails, or if a table of another
    program then refers to a missing row.
    """
    with write_refusals(name):
        try:
            if not connection.in_transaction:
                connection.execute("BEGIN IMMEDIATE")
            yield
            try:
                connection.execute("COMMIT")
            except sqlite3.IntegrityError as error:
                raise WriteError(
                    f"{name}: tables of other programs must not refer to rows that a change removes or"
                    f" renames ({error}); change their rows first"
                ) from None
        except BaseException:
            if connection.in_transaction:
                connection.execute("ROLLBACK")
            raise


def journal_mode(connection: sqlite3.Connection) -> str:
    """The journal mode of a store; "delete" if a store in WAL mode was opened as an immutable file."""
    (mode,) = connection.execute("PRAGMA journal_mode").fetchone()
    return str(mode)


def refuse_old_sqlite() -> None:
    """Raise UnavailableError if the SQLite of this Python has no STRICT tables."""
    if sqlite3.sqlite_version_info < LEAST_SQLITE:
        raise UnavailableError(
            f"a store must have SQLite 3.37 or later, not {sqlite3.sqlite_version}; use a newer Python"
        )


def _opened(path: Path, mode: str, seconds_of_waiting: float) -> sqlite3.Connection:
    """A connection that begins no transaction by itself."""
    uri = f"{Path(os.path.abspath(path)).as_uri()}?mode={mode}"
    connection = sqlite3.connect(uri, uri=True, isolation_level=None, timeout=seconds_of_waiting)
    try:
        _guarded(connection)
        # SQLite reads the file, and looks for its journal, only now.
        connection.execute(FIRST_LOOK).fetchone()
    except BaseException:
        connection.close()
        raise
    return connection


def _guarded(connection: sqlite3.Connection) -> sqlite3.Connection:
    """The connection, with its limits and settings; nothing of its file is run."""
    for limit, most in LIMITS.items():
        connection.setlimit(limit, min(most, connection.getlimit(limit)))
    for pragma in ("trusted_schema=OFF", "cell_size_check=ON", "mmap_size=0", "foreign_keys=OFF"):
        connection.execute(f"PRAGMA {pragma}")
    if hasattr(connection, "setconfig"):
        # From Python 3.12 on.
        connection.setconfig(getattr(sqlite3, "SQLITE_DBCONFIG_DEFENSIVE"), True)  # noqa: B009
    return connection


# Permissions of statements.

READING_PRAGMAS: Final = frozenset(
    (
        "application_id", "data_version", "foreign_key_check", "foreign_key_list", "index_info", "index_list",
        "integrity_check", "page_count", "page_size", "quick_check", "schema_version", "table_info",
        "table_list", "table_xinfo", "user_version",
    )
)  # fmt: skip
"""The pragmas that only read. Most take an argument; for those in SETTABLE an argument is a new value."""

SETTABLE: Final = ("application_id", "schema_version", "user_version")

UNSAFE_FUNCTIONS: Final = frozenset(
    (
        "load_extension", "fts3_tokenizer", "readfile", "writefile", "edit", "match", "matchinfo", "snippet",
        "offsets", "optimize", "highlight", "bm25", "fts5", "rtreecheck", "rtreedepth", "rtreenode",
    )
)  # fmt: skip
"""The functions that do more than compute with their arguments.

The functions up to `edit` run other code or open files. Most builds lack them, but Debian's has
`fts3_tokenizer`, which gives and takes addresses of memory. The functions from `match` on read the inner
tables of full-text and R-tree indexes, which may be damaged.
"""

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
    """The permissions of a statement: it may read, compute and, with `may_change`, change rows itself.

    A change by a trigger of the file is refused.
    """

    def permission(
        action: int, first: str | None, second: str | None, database: str | None, inner: str | None
    ) -> int:
        if action == sqlite3.SQLITE_FUNCTION:
            is_allowed = (second or "").lower() not in UNSAFE_FUNCTIONS
        elif action == sqlite3.SQLITE_PRAGMA:
            name = (first or "").lower()
            is_allowed = name in READING_PRAGMAS and not (second is not None and name in SETTABLE)
        elif action in CHANGES:
            is_allowed = may_change and inner is None and not (first or "").lower().startswith("sqlite_")
        else:
            is_allowed = action in READS
        return sqlite3.SQLITE_OK if is_allowed else sqlite3.SQLITE_DENY

    return permission


class Clock:
    """Ends statements of a connection that take longer than some seconds; `ended` is true afterwards."""

    def __init__(
        self, connection: sqlite3.Connection, seconds: float = READING_SECONDS, steps: int = STEPS
    ) -> None:
        self.seconds = seconds
        self.begin()
        connection.set_progress_handler(self._look, steps)

    def begin(self) -> None:
        """Count from now."""
        self.ended = False
        self._until = time.monotonic() + self.seconds

    def _look(self) -> int:
        self.ended = time.monotonic() > self._until
        return int(self.ended)


# Checks of a file, and of the files beside it, before SQLite opens it.

JOURNAL_MAGIC: Final = bytes.fromhex("d9d505f920a163d7")
"""The bytes that a rollback journal begins with, and that follow the name of a super-journal at its end."""

JOURNAL_LEFT: Final = (
    "the -journal beside the store is from a change that has not ended, and to roll it back can delete any"
    " file that it names; if you trust both files, open the store once with `sqlite3 FILE .tables`, otherwise"
    " move the journal away"
)


def _refuse_unsafe(path: Path) -> None:
    """Raise InputError if a store is no regular file, is too large, or has unsafe files beside it.

    It opens no file that SQLite locks, because closing the file would end the locks of this process on it.
    """
    refuse_old_sqlite()
    status = status_of(path)
    refuse_irregular(path, status)
    require_size(path.name, status.st_size, GROWTH)
    _, wal, shm = (_size_beside(path, ending) for ending in ("-journal", "-wal", "-shm"))
    if os.path.islink(path):
        # SQLite ignores a journal beside the link, but would find it if the folder were copied without links.
        refuse_journal(path)
    if wal and shm is None:
        raise InputError(
            f"{path.name}: the latest changes are in {path.name}-wal, which cannot be read without"
            f" {path.name}-shm; open the store once with `sqlite3 FILE .tables`"
        )


def store_head(path: Path) -> bytes:
    """The first bytes of a store. Raises InputError if a file does not begin as a store.

    Call it before SQLite opens the store: closing the file ends the locks of this process on it.
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

    A program that reuses its journal leaves it with a header of zeros. The header also begins with zeros
    until the journal is synced, before the store is changed. If such a journal ends with the name of a
    super-journal, SQLite deletes the named file as soon as a change of ours is taken back.
    """
    for place in (path, os.path.realpath(path)):
        try:
            with opened(Path(f"{place}-journal")) as (file, status):
                is_hot = any(file.read(1))
                file.seek(max(0, status.st_size - len(JOURNAL_MAGIC)))
                if is_hot or file.read() == JOURNAL_MAGIC:
                    return True
        except MissingInputError:
            continue
    return False


# Errors of SQLite as errors of this package.

BUSY_ERRORS: Final = (sqlite3.SQLITE_BUSY, sqlite3.SQLITE_LOCKED)
DISK_ERRORS: Final = (sqlite3.SQLITE_FULL, sqlite3.SQLITE_IOERR)
PLACE_ERRORS: Final = (sqlite3.SQLITE_READONLY, sqlite3.SQLITE_CANTOPEN)
DAMAGE_ERRORS: Final = (sqlite3.SQLITE_CORRUPT, sqlite3.SQLITE_NOTADB)

BUSY: Final = "another program is writing to the store; let it end, and try again"


def primary_code(error: BaseException) -> int:
    """The error code of SQLite without its details; 0 if the error has none."""
    return getattr(error, "sqlite_errorcode", 0) & 0xFF


@contextmanager
def refusals(name: str = "", clock: Clock | None = None) -> Iterator[None]:
    """Raise errors of SQLite as InputError, with advice; `name` is the file's name in the message."""
    try:
        yield
    except (sqlite3.Error, sqlite3.Warning, UnicodeError, OverflowError) as error:
        if clock is not None and clock.ended:
            reason = f"a store must be read within {clock.seconds:g} seconds, not longer; leave rows out"
        else:
            reason = sentence_of(error)
        raise InputError(f"{name}: {reason}" if name else reason) from None


@contextmanager
def write_refusals(name: str) -> Iterator[None]:
    """Raise errors that keep a store from being written as WriteError; other errors stay as they are."""
    try:
        yield
    except sqlite3.Error as error:
        if primary_code(error) in (*BUSY_ERRORS, *DISK_ERRORS, *PLACE_ERRORS):
            raise WriteError(f"{name}: {sentence_of(error)}") from None
        raise


def sentence_of(error: Exception) -> str:
    """A sentence for an error of SQLite: what is wrong with the store, and what to do."""
    code, text = primary_code(error), printable(reason_of(error)[:300])
    if code in BUSY_ERRORS:
        return BUSY
    if getattr(error, "sqlite_errorcode", 0) == sqlite3.SQLITE_READONLY_ROLLBACK:
        return JOURNAL_LEFT
    if code == sqlite3.SQLITE_TOOBIG:
        return f"a value must have at most {LONGEST_TEXT:,} bytes, not more; shorten it"
    if code in PLACE_ERRORS:
        return (
            f"the store cannot be opened or changed where it is ({text}): a change of it was interrupted, or"
            " it is write-protected; open it once with the program that wrote it, or use another file"
        )
    if code in DISK_ERRORS:
        return f"the disk must hold the store, and is full or fails ({text}); make room, and try again"
    return (
        f"the store cannot be read ({text}); if it is damaged, bring a copy back, or rescue it with"
        " `sqlite3 FILE .recover`"
    )
