"""Reading input files safely: regular files only, and never more than a given number of bytes.

A mesh of several tables in a folder is saved by one rename (see `writing.write_together`): the new tables
are in the hidden folder COMMITTED until each has its own name. `TableFiles` finds them there.
"""

from __future__ import annotations

import errno
import json
import os
import re
import stat
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, BinaryIO, Final, NamedTuple, NoReturn, TypeVar

from autocolor import checks
from autocolor.budget import allowed_memory, require_memory
from autocolor.errors import InputError, MissingInputError, reason_of

LEAST_READ: Final = 1 << 20
"""Bytes to request even if the file system reports a smaller file."""

HEAD: Final = 4096
"""Bytes that are enough to recognize a file format."""

UTF_8_MARK: Final = b"\xef\xbb\xbf"

Result = TypeVar("Result")


def read_bytes(path: Path, largest: int) -> bytes:
    """The content of a regular file of at most `largest` bytes, without a UTF-8 byte order mark.

    Never waits for a pipe or a device. Raises MissingInputError if the file does not exist, InputError if it
    is not a regular file, too large, or unreadable.
    """
    with opened(path) as (file, status):
        # read() allocates the requested size at once, even for a small file.
        data = file.read(min(largest, max(status.st_size, LEAST_READ)) + 1)
    if len(data) > largest:
        raise InputError(
            f"{path.name}: a file must have at most {largest:,} bytes, not more; split or simplify it"
        )
    return data.removeprefix(UTF_8_MARK)


def read_whole(path: Path, growth: float) -> bytes:
    """The content of a regular file like `read_bytes`, as large as the memory budget allows.

    To read the file takes `growth` times its size in memory, as measured. Raises InputError if this is more
    than the budget allows, before anything is read.
    """
    with opened(path) as (_, status):
        require_size(path.name, status.st_size, growth)
    return read_bytes(path, int(allowed_memory() / growth))


def require_size(name: str, size: int, growth: float) -> None:
    """Raise InputError if the memory to read `size` bytes, `growth` times as much, is more than allowed."""
    require_memory(growth * size, f"{name}: to read {size:,} bytes", "split or simplify it")


@contextmanager
def opened(path: Path) -> Iterator[tuple[BinaryIO, os.stat_result]]:
    """A regular file opened for reading, and its status; it never waits for a pipe or a device.

    Raises MissingInputError if the file does not exist, InputError if it is not a regular file, or if it
    cannot be opened or read.
    """
    refuse_irregular(path, status_of(path))
    try:
        # The file may have been replaced since: O_NONBLOCK keeps a pipe from blocking; fstat checks again.
        number = os.open(path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0))
        with open(number, "rb") as file:
            status = os.fstat(number)
            refuse_irregular(path, status)
            yield file, status
    except OSError as error:
        raise unreadable(path, error) from None


def status_of(path: Path) -> os.stat_result:
    """The status of a file or folder. Raises MissingInputError, InputError for a name that cannot be one."""
    try:
        return os.stat(path)
    except OSError as error:
        raise unreadable(path, error) from None
    except ValueError:
        raise unnameable(path) from None


def read_head(path: Path) -> bytes:
    """The first HEAD bytes of a regular file; empty if it cannot be read."""
    try:
        refuse_irregular(path, os.stat(path))
        with open(path, "rb") as file:
            return file.read(HEAD)
    except (OSError, ValueError, InputError):
        return b""


# Tables in a folder. The folder COMMITTED has the tables of the last save that have no name of their own yet,
# and NAMES, the names of all tables of that save. It exists for a moment, or after a program was killed.

COMMITTED: Final = ".autocolor-tables"

NAMES: Final = "names.json"
"""It is the locked file of the temporary folder that the folder COMMITTED was (see `ramtek_emu.writing`)."""

SET_KEYS: Final = frozenset(("files", "absent"))

LARGEST_SET: Final = 1 << 17
MOST_NAMES: Final = 4000
"""Limit: more than the names of 1000 scalars, twice."""

TABLE_NAME: Final = re.compile(r"(?:scalars/)?[a-z0-9_]{1,40}\.(?:csv|npy)|tables\.json")
"""The names that a set may have, so that a set of a stranger moves and removes nothing else."""

MOST_TRIES: Final = 20
"""Limit: how often tables are opened while others save them; the pauses between take two seconds together."""

SECONDS_BETWEEN_TRIES: Final = 0.01


class TableSet(NamedTuple):
    """The names of a committed save of tables, and the names that it removes from the folder."""

    files: tuple[str, ...]
    absent: tuple[str, ...]


def committed_set(folder: Path) -> TableSet | None:
    """The last save of tables to a folder, if some of its tables have no name of their own yet; else None.

    Raises InputError if another program wrote it.
    """
    path = folder / COMMITTED / NAMES
    try:
        kind = os.lstat(path.parent).st_mode
    except (OSError, ValueError):
        return None
    try:
        if stat.S_ISLNK(kind) or stat.S_ISLNK(os.lstat(path).st_mode):
            raise ValueError("it is a link")
        content = bounded_json(read_bytes(path, LARGEST_SET), MOST_NAMES)
        if not isinstance(content, dict) or set(content) != SET_KEYS:
            raise ValueError("it has other keys")
        names = [content["files"], content["absent"]]
        if not all(isinstance(listed, list) and all(map(_is_table_name, listed)) for listed in names):
            raise ValueError("it names other files")
    except (FileNotFoundError, NotADirectoryError, MissingInputError):
        return None
    except (OSError, ValueError) as error:
        raise InputError(
            f"{path}: it must be a file that autocolor wrote, and is not ({str(error)[:100]}); delete it"
        ) from None
    return TableSet(*map(tuple, names))


def _is_table_name(name: object) -> bool:
    return isinstance(name, str) and TABLE_NAME.fullmatch(name) is not None


def name_in_set(name: str) -> str:
    """The name of a table in the folder COMMITTED, which has no folders."""
    return name.replace("/", "_")


class TableFiles:
    """Finds the tables of folders, and remembers its answers, to compare them when all tables are open."""

    def __init__(self) -> None:
        self._sets: dict[Path, TableSet | None] = {}
        self._seen: dict[tuple[Path, str], tuple[Path, tuple[int, ...] | None]] = {}

    def path(self, folder: Path, name: str) -> Path:
        """The path of a table of a folder; no file has it if the folder has no such table.

        Raises InputError as `committed_set`.
        """
        committed = None
        if _is_table_name(name):
            if folder not in self._sets:
                self._sets[folder] = committed_set(folder)
            committed = self._sets[folder]
        path = folder / name
        if committed is not None and name in (*committed.files, *committed.absent):
            moved = folder / COMMITTED / name_in_set(name)
            path = moved if name in committed.absent or _is_regular(moved) else path
        self._seen[folder, name] = path, _stamp(path)
        return path

    def has(self, folder: Path, name: str) -> bool:
        """Whether a folder has a table. Raises InputError as `committed_set`."""
        self.path(folder, name)
        return self._seen[folder, name][1] is not None

    def are_unchanged(self) -> bool:
        """Whether all answers would be the same now. Raises InputError as `committed_set`."""
        now = TableFiles()
        for folder, name in self._seen:
            now.path(folder, name)
        return now._seen == self._seen


def _is_regular(path: Path) -> bool:
    try:
        return stat.S_ISREG(os.lstat(path).st_mode)
    except OSError:
        return False


def _stamp(path: Path) -> tuple[int, ...] | None:
    """Numbers that differ for another file, or other content; None for no file."""
    try:
        status = os.stat(path)
    except (OSError, ValueError):
        return None
    return status.st_dev, status.st_ino, status.st_size, status.st_mtime_ns


def read_together(open_files: Callable[[TableFiles], Result]) -> Result:
    """The result of `open_files`, which opens tables; all tables of a folder are of the same save.

    If a save came while it opened them, it is called again. Raises InputError if saves come all the time, and
    the errors of `open_files`.
    """
    for number in range(MOST_TRIES):
        files = TableFiles()
        try:
            result = open_files(files)
        except InputError:
            if files.are_unchanged():
                raise
        else:
            if files.are_unchanged():
                return result
        time.sleep(SECONDS_BETWEEN_TRIES * number)
    raise InputError(
        "tables must stay as they are while they are opened, and these were saved again each of"
        f" {MOST_TRIES} times; try again when the other program has ended"
    )


def table_exists(folder: Path, name: str) -> bool:
    """Whether a folder has a table, by the names alone."""
    try:
        return TableFiles().has(folder, name)
    except InputError:
        return (folder / name).exists()


def refuse_irregular(path: Path, status: os.stat_result) -> None:
    """Raise InputError unless the status is of a regular file."""
    if stat.S_ISREG(status.st_mode):
        return
    kinds = ((stat.S_ISDIR, "a folder"), (stat.S_ISFIFO, "a pipe"), (stat.S_ISSOCK, "a socket"))
    kind = next((name for is_kind, name in kinds if is_kind(status.st_mode)), "a device")
    raise InputError(f"{path}: it must be a regular file, not {kind}; name a file")


def unnameable(path: Path) -> InputError:
    """The error for a path that the system cannot represent, such as one with a NUL byte."""
    return InputError(f"a file name must be valid on this system, not {str(path)!r}; correct it")


def unreadable(path: Path, error: OSError) -> InputError:
    """The error that says why a file could not be read."""
    if error.errno in (errno.ENOENT, errno.ENOTDIR):
        return MissingInputError(f"{path}: there is no such file or folder; check the name")
    return InputError(f"{path}: it cannot be read ({reason_of(error)}); check the name and its permissions")


MOST_NESTED: Final = 100
"""Limit: lists and tables around a value in JSON; files of ours need eight."""

NESTING: Final = re.compile(rb'"[^"\\]*+(?:\\.[^"\\]*+)*+"?|[\[\]{}]', re.DOTALL)
"""A text, which may lack its end, or a bracket."""


def bounded_json(data: bytes, most_values: int) -> Any:
    """The value that JSON text describes. Raises ValueError if it is wrong or has too many values."""

    def refuse(constant: str) -> NoReturn:
        raise ValueError(f"the number {constant}")

    if sum(map(data.count, (b",", b"[", b"{"))) > most_values:
        raise ValueError(f"more than {most_values:,} values")
    if nesting(data) > MOST_NESTED:
        raise ValueError(f"values in more than {MOST_NESTED} lists and tables")
    try:
        return json.loads(data.decode("utf-8"), parse_constant=refuse)
    except json.JSONDecodeError as error:
        reason = error.msg.removesuffix(" at")
        raise ValueError(f"{reason} at line {error.lineno}, column {error.colno}") from None


def nesting(data: bytes) -> int:
    """The most lists and tables around a value of JSON text, counted before it is parsed.

    >>> nesting(b'{"a": [1, [2]], "b": "[[[[["}')
    3
    """
    depth = most = 0
    # A text is skipped whole: what is in it opens nothing.
    for mark in NESTING.finditer(data):
        if mark[0] in b"[{":
            depth += 1
            most = max(most, depth)
        elif mark[0] in b"]}":
            depth -= 1
    return most


def text_problem(data: bytes) -> str | None:
    """Why the bytes cannot be UTF-8 text (UTF-16, or a NUL byte), as the end of a message; None otherwise."""
    if data[:2] in (b"\xff\xfe", b"\xfe\xff"):
        return "must be text in UTF-8, not UTF-16; save it as UTF-8"
    place = data.find(b"\0")
    if place >= 0:
        line = data.count(b"\n", 0, place) + 1
        return f"must be text, not hold a NUL byte (line {line}); save it as UTF-8 text"
    return None


def text_lines(data: bytes, place: str, thing: str) -> bytes:
    """The text of `thing`, with lines that end with LF. Raises InputError for UTF-16 and NUL bytes."""
    if problem := text_problem(data):
        raise InputError(f"{place}: {thing} {problem}")
    return data.replace(b"\r\n", b"\n").replace(b"\r", b"\n") if b"\r" in data else data


def utf_8_text(data: bytes, place: str, thing: str) -> str:
    """The bytes of `thing` decoded. Raises InputError with the line if they are not UTF-8."""
    try:
        return data.decode("utf-8")
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        raise InputError(f"{place}, line {line}: {thing} must be text in UTF-8; save it as UTF-8") from None


def shown(value: str | bytes, most: int = 40) -> str:
    """The text in quotes for a message, cut to `most` characters."""
    if isinstance(value, bytes):
        value = value[: 4 * most + 4].decode("utf-8", "backslashreplace")
    return checks.shown(value, most)
