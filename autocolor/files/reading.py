"""Reading input files safely: regular files only, and never more than a given number of bytes."""

from __future__ import annotations

import errno
import json
import os
import re
import stat
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from io import BufferedReader
from pathlib import Path
from typing import Any, Final, NoReturn

import numpy as np

from autocolor import checks
from autocolor.budget import require_memory
from autocolor.errors import InputError, MissingInputError, reason_of

HEAD: Final = 4096
"""Bytes that are enough to recognize a file format."""

UTF_8_MARK: Final = b"\xef\xbb\xbf"


def read_bytes(path: Path, largest: int) -> bytes:
    """The content of a regular file of at most `largest` bytes, without a UTF-8 byte order mark.

    Never waits for a pipe or a device. Raises MissingInputError if the file does not exist, InputError if it
    is not a regular file, too large, or unreadable.
    """
    with opened(path) as (file, _):
        data = file.read(largest + 1)
    if len(data) > largest:
        raise InputError(
            f"{path.name}: a file must have at most {largest:,} bytes, not more; split or simplify it"
        )
    return data.removeprefix(UTF_8_MARK)


def read_whole(path: Path, growth: float) -> bytes:
    """The content of a regular file like `read_bytes`, as large as the memory budget allows.

    To read the file takes `growth` times its size in memory, as measured. Raises InputError if this is more
    than the budget allows, before anything is read, and for a file that begins with a page of zeros.
    """
    with opened(path) as (file, status):
        require_size(path.name, status.st_size, growth)
        # Such a file was made, and never filled.
        if status.st_size > HEAD and not file.read(HEAD).strip(b"\0"):
            raise InputError(
                f"{path.name}: a file must not begin with {HEAD:,} zero bytes; copy or export it again"
            )
        file.seek(0)
        return file.read(status.st_size).removeprefix(UTF_8_MARK)


def require_size(name: str, size: int, growth: float) -> None:
    """Raise InputError if the memory to read `size` bytes, `growth` times as much, is more than allowed."""
    require_memory(growth * size, f"{name}: to read {size:,} bytes", "split or simplify it")


@contextmanager
def opened(path: Path) -> Iterator[tuple[BufferedReader, os.stat_result]]:
    """A regular file opened for reading, and its status; it never waits for a pipe or a device.

    Raises MissingInputError if the file does not exist, InputError if it is not a regular file, or if it
    cannot be opened or read.
    """
    refuse_irregular(path, status_of(path))
    try:
        with open(path, "rb") as file:
            yield file, os.fstat(file.fileno())
    except OSError as error:
        raise unreadable(path, error) from None


def status_of(path: Path) -> os.stat_result:
    """The status of a file or folder. Raises MissingInputError, InputError for a name that cannot be one."""
    try:
        return os.stat(path)
    except OSError as error:
        raise unreadable(path, error) from None
    except ValueError:
        raise InputError(
            f"a file name must be valid on this system, not {shown(str(path))}; correct it"
        ) from None


def read_head(path: Path) -> bytes:
    """The first HEAD bytes of a regular file; empty if it cannot be read."""
    with suppress(InputError), opened(path) as (file, _):
        return file.read(HEAD)
    return b""


def refuse_irregular(path: Path, status: os.stat_result) -> None:
    """Raise InputError unless the status is of a regular file."""
    if not stat.S_ISREG(status.st_mode):
        kind = "a folder" if stat.S_ISDIR(status.st_mode) else "a pipe or a device"
        raise InputError(f"{path}: it must be a regular file, not {kind}; name a file")


def unreadable(path: Path, error: OSError) -> InputError:
    """The error that says why a file could not be read."""
    if error.errno in (errno.ENOENT, errno.ENOTDIR):
        return MissingInputError(f"{path}: there is no such file or folder; check the name")
    return InputError(f"{path}: it cannot be read ({reason_of(error)}); check the name and its permissions")


MOST_NESTED: Final = 100
"""Limit: lists and tables around a value in JSON; files of ours need eight."""

JSON_TEXT: Final = re.compile(rb'"(?:[^"\\]+|\\.)*"?', re.DOTALL)


def bounded_json(data: bytes, most_values: int) -> Any:
    """The value that JSON text describes. Raises ValueError if it is wrong or has too many values."""

    def refuse(constant: str) -> NoReturn:
        raise ValueError(f"the number {constant}")

    if sum(map(data.count, (b",", b"[", b"{"))) > most_values:
        raise ValueError(f"more than {most_values:,} values")
    marks = np.frombuffer(JSON_TEXT.sub(b"", data), np.uint8)
    opening, closing = np.isin(marks, [*b"[{"]), np.isin(marks, [*b"]}"])
    if np.max(np.cumsum(opening.astype(int) - closing), initial=0) > MOST_NESTED:
        raise ValueError(f"values in more than {MOST_NESTED} lists and tables")
    try:
        return json.loads(data.decode("utf-8"), parse_constant=refuse)
    except json.JSONDecodeError as error:
        reason = error.msg.removesuffix(" at")
        raise ValueError(f"{reason} at line {error.lineno}, column {error.colno}") from None


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


def shown(value: str | bytes, most: int = 40) -> str:
    """The text in quotes for a message, cut to `most` characters."""
    if isinstance(value, bytes):
        value = value[: 4 * most + 4].decode("utf-8", "backslashreplace")
    return checks.shown(value, most)
