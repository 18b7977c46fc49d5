"""Opening and replacing stores. A store is data: the file of a stranger can be read, and can do nothing else.

- A store is a file of one scene. It is copied into memory, read and changed there, and replaced as a whole.
  So a program of ours that is killed leaves the old store or the new one, and nothing beside it.
- SQLite itself opens the file for the copy: it knows its locks, and what a `-journal` or a `-wal` beside the
  store holds. A `-journal` may name any file as its super-journal, which SQLite deletes. It is refused.
- The schema of a file may call only functions that compute (`trusted_schema`). Nothing can be attached or
  loaded, no statement can set a pragma, and a statement that takes too long is ended (see `limited`).
"""

from __future__ import annotations

import os
import sqlite3
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager, suppress
from pathlib import Path
from typing import Final

from autocolor.checks import printable
from autocolor.errors import (
    AutocolorError,
    InputError,
    MissingInputError,
    OutputError,
    UnavailableError,
    WriteError,
    reason_of,
)
from autocolor.files.reading import opened, require_size, status_of
from autocolor.files.writing import status_numbers, write_atomically

BEGINS: Final = b"SQLite format 3\0"

GROWTH: Final = 3.5
"""Measured: how many times its size the store of a scene takes while it is read."""

LONGEST_TEXT: Final = 1 << 17
"""Limit: in bytes, of a value and of a row. SQLite cannot interrupt a function: searching a text of this
length for one of half its length takes 0.2 s."""

SECONDS_OF_WAITING: Final = 5.0
"""Limit: how long to wait for another program that is writing."""


def in_memory(data: bytes | None = None) -> sqlite3.Connection:
    """A store in memory, with the content of a file or empty.

    Raises UnavailableError if this Python's SQLite lacks what a store needs.
    """
    # The first version with STRICT tables.
    if sqlite3.sqlite_version_info < (3, 37) or not hasattr(sqlite3.Connection, "serialize"):
        raise UnavailableError(
            "a store must have SQLite 3.37 or later with sqlite3_serialize, and this Python has"
            f" {sqlite3.sqlite_version}; use another Python"
        )
    connection = _connected("file:?mode=memory")
    if data is not None:
        connection.deserialize(data)
    return connection


def _connected(uri: str) -> sqlite3.Connection:
    """A connection that begins no transaction by itself, with limits; nothing of its file is run."""
    connection = sqlite3.connect(uri, uri=True, isolation_level=None, timeout=SECONDS_OF_WAITING)
    connection.setlimit(sqlite3.SQLITE_LIMIT_LENGTH, LONGEST_TEXT)
    # No function that compares with a pattern can be interrupted.
    connection.setlimit(sqlite3.SQLITE_LIMIT_LIKE_PATTERN_LENGTH, 1000)
    for pragma in ("trusted_schema=OFF", "cell_size_check=ON", "foreign_keys=OFF"):
        connection.execute(f"PRAGMA {pragma}")
    return connection


def _content(connection: sqlite3.Connection) -> bytes:
    """The bytes of a store. Raises sqlite3.Error."""
    data = connection.serialize()
    # Two bytes of the header say whether the store is in WAL mode. Nothing in memory is.
    return b"\1\1".join((data[:18], data[20:]))


def store_content(path: Path) -> bytes:
    """The content of the store at a path, with what its `-wal` holds.

    If a program was killed while it changed the store, SQLite first takes that change back, by the `-journal`
    beside it. Raises InputError, MissingInputError.
    """
    with refusals(path.name), closing(_opened(path)) as file:
        file.execute("BEGIN")
        file.execute("SELECT count(*) FROM sqlite_master").fetchone()
        return _content(file)


def _opened(path: Path, is_written: bool = False) -> sqlite3.Connection:
    """A connection to the store at a path, which lets it be written if SQLite must.

    Raises InputError if the file is not regular, too large, or no store, or if SQLite would delete another
    file (see `files_to_play`); MissingInputError.
    """
    with opened(path) as (file, status):
        require_size(path.name, status.st_size, GROWTH)
        if file.read(len(BEGINS)) != BEGINS:
            raise InputError(
                f"{path.name}: a store must be an SQLite file, and this one does not begin as such; remove"
                " it, or choose another file"
            )
    # A connection that could write would move a log into the store when it is closed.
    mode = "ro" if "-wal" in files_to_play(path) and not is_written else "rw"
    return _connected(f"{Path(os.path.realpath(path)).as_uri()}?mode={mode}")


@contextmanager
def replacing(path: Path, check: Callable[[], None]) -> Iterator[tuple[bytes, Callable[[bytes], None]]]:
    """The content of the store at a path, and a function that replaces it.

    Until the end SQLite's own lock keeps other programs from changing the store. `check` is called first
    under this lock. What a log beside the store holds is moved into the store, because SQLite would play it
    into the next file of this name; the store then is no longer in WAL mode. Raises InputError,
    MissingInputError; OutputError if the place is write-protected, and WriteError if another program goes on
    writing, or replaces the store meanwhile.
    """
    before = status_of(path)
    if not os.access(path, os.W_OK):
        raise OutputError(
            f"{path.name}: a store must not be write-protected to be changed; change its permissions, or"
            " write to another file"
        )
    with refusals(path.name, WriteError), closing(_opened(path, is_written=True)) as file:
        file.execute("BEGIN IMMEDIATE")
        check()
        if file.execute("PRAGMA journal_mode").fetchone() == ("wal",):
            for statement in ("COMMIT", "PRAGMA journal_mode = DELETE", "BEGIN IMMEDIATE"):
                file.execute(statement)
        if not os.path.samestat(before, status_of(path)):
            # Another program of ours replaced the store while this one waited for the lock of the old file.
            file.close()
            with replacing(path, check) as pair:
                yield pair
            return

        present = status_numbers(path)

        def save(data: bytes) -> None:
            if status_numbers(path) != present:
                raise WriteError(
                    f"{path.name}: a store must stay as it is while it is changed, and another program"
                    " replaced it; nothing was saved, so try again"
                )
            if sys.platform == "win32":
                # An open file cannot be replaced there.
                file.close()
            write_atomically(path, data, overwrite=True)

        yield _content(file), save


JOURNAL_MAGIC: Final = bytes.fromhex("d9d505f920a163d7")
"""The bytes that follow the name of a super-journal at the end of a rollback journal."""


def files_to_play(path: Path) -> list[str]:
    """The endings of the files beside a store that SQLite plays into it: "-journal", "-wal".

    SQLite takes a change back by the journal of a program that was killed; a journal that a program keeps for
    its next change has a header of zeros. Raises InputError for a file that is not regular, because SQLite
    would wait for a pipe without end; and for a journal that ends with the name of a super-journal, because
    SQLite deletes the named file when it has rolled the journal back, or a change of its own.
    """
    endings = []
    for ending in ("-journal", "-wal"):
        with suppress(MissingInputError), opened(Path(os.path.realpath(path) + ending)) as (file, status):
            if any(file.read(1)):
                endings.append(ending)
            file.seek(max(0, status.st_size - len(JOURNAL_MAGIC)))
            if ending == "-journal" and file.read() == JOURNAL_MAGIC:
                raise InputError(
                    f"{path.name}: its -journal names another file, which SQLite deletes; if you trust both,"
                    " run `sqlite3 FILE .tables`, otherwise move the journal away"
                )
    return endings


UNSAFE_FUNCTIONS: Final = {
    *("load_extension", "fts3_tokenizer", "match", "matchinfo", "snippet", "offsets", "optimize", "bm25"),
    *("highlight", "fts5", "rtreecheck", "rtreedepth", "rtreenode"),
}
"""The functions that run other code, or read the inner tables of full-text and R-tree indexes, which may be
damaged."""

CHANGES: Final = (sqlite3.SQLITE_INSERT, sqlite3.SQLITE_UPDATE, sqlite3.SQLITE_DELETE)


def authorizer(may_change: bool, changed: set[str]) -> Callable[..., int]:
    """The permissions of a statement: it may read, compute and, with `may_change`, change rows itself.

    A change by a trigger of the file is refused. The tables that the statement changes, or would change, are
    added to `changed`.
    """

    def permission(action: int, first: str | None, second: str | None, _: object, inner: object) -> int:
        name = str(second if action == sqlite3.SQLITE_FUNCTION else first).lower()
        if action in CHANGES:
            changed.add(name)
        is_allowed = (
            action in (sqlite3.SQLITE_SELECT, sqlite3.SQLITE_READ, sqlite3.SQLITE_RECURSIVE)
            or (action == sqlite3.SQLITE_FUNCTION and name not in UNSAFE_FUNCTIONS)
            # These only read, whatever their argument.
            or (
                action == sqlite3.SQLITE_PRAGMA
                and name in ("index_list", "table_info", "table_list", "table_xinfo")
            )
            or (action in CHANGES and may_change and inner is None)
        )
        return sqlite3.SQLITE_OK if is_allowed else sqlite3.SQLITE_DENY

    return permission


@contextmanager
def limited(
    connection: sqlite3.Connection, seconds: float, late: AutocolorError, may_change: bool = False
) -> Iterator[set[str]]:
    """Permissions and time of the statements in the body. Raises `late` if they take longer.

    The set has the tables that they change, or would change.
    """
    changed: set[str] = set()
    until = time.monotonic() + seconds
    connection.set_authorizer(authorizer(may_change, changed))
    # A step of SQLite's machine can be a slow function.
    connection.set_progress_handler(lambda: time.monotonic() > until, 1000)
    try:
        yield changed
    except sqlite3.OperationalError as error:
        if time.monotonic() > until:
            raise late from None
        if "interrupted" in str(error):
            # The user pressed Ctrl+C, which SQLite took.
            raise KeyboardInterrupt from None
        raise
    finally:
        connection.set_authorizer(None)
        connection.set_progress_handler(None, 0)


SQL_ERRORS: Final = (sqlite3.Error, sqlite3.Warning, UnicodeError, OverflowError)

PROTECTED: Final = "the store and its folder must let SQLite open it, and do not ({}); copy all of its files"
SENTENCES: Final = {
    sqlite3.SQLITE_BUSY: "another program is writing to the store, or has it open in WAL mode; close it",
    sqlite3.SQLITE_TOOBIG: f"a value must have at most {LONGEST_TEXT:,} bytes, not more; shorten it",
    sqlite3.SQLITE_READONLY: PROTECTED,
    sqlite3.SQLITE_CANTOPEN: PROTECTED,
}
DAMAGED: Final = (
    "the store cannot be read ({}); if it is damaged, bring a copy back, or rescue it with `sqlite3 FILE"
    " .recover`"
)


def primary_code(error: BaseException) -> int:
    """The error code of SQLite without its details; 0 if the error has none."""
    return getattr(error, "sqlite_errorcode", 0) & 0xFF


@contextmanager
def refusals(name: str, kind: type[AutocolorError] = InputError) -> Iterator[None]:
    """Raise errors of SQLite as another kind, with advice; `name` is the file's name in the message."""
    try:
        yield
    except SQL_ERRORS as error:
        sentence = SENTENCES.get(primary_code(error), DAMAGED).format(printable(reason_of(error)[:300]))
        raise kind(f"{name}: {sentence}") from None
