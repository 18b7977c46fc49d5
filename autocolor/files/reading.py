"""Bytes and text of an input file, bounded: regular files only, never more than a stated size."""

from __future__ import annotations

import errno
import os
import stat
from pathlib import Path
from typing import Final

from autocolor.errors import InputError, MissingInputError

LARGEST_MESH_FILE: Final = 256 * 1024 * 1024
"""Assumed: bytes; some three million polygons as OBJ, and a bound on the memory that a reader takes."""

LEAST_READ: Final = 1 << 20
"""Bytes asked for even of a file that says it has less."""

HEAD: Final = 4096
"""Bytes that tell what a file is."""

UTF_8_MARK: Final = b"\xef\xbb\xbf"


def read_bytes(path: Path, largest: int) -> bytes:
    """The content of a regular file of at most `largest` bytes, without a UTF-8 byte order mark.

    Raises MissingInputError where there is none, InputError where it is no regular file, is too large or
    cannot be read. A pipe or a device is never waited for.
    """
    try:
        status = os.stat(path)
    except OSError as error:
        raise unreadable(path, error) from None
    except ValueError:
        raise unnameable(path) from None
    try:
        refuse_irregular(path, status)
        # A pipe put there in between would block without O_NONBLOCK; look again at what was opened.
        number = os.open(path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0))
        with open(number, "rb") as file:
            opened = os.fstat(number)
            refuse_irregular(path, opened)
            # As many bytes as are asked for are allocated at once, however small the file is.
            data = file.read(min(largest, max(opened.st_size, LEAST_READ)) + 1)
    except OSError as error:
        raise unreadable(path, error) from None
    if len(data) > largest:
        raise InputError(
            f"{path.name}: a file must have at most {largest:,} bytes, not more; divide it or thin it out"
        )
    return data.removeprefix(UTF_8_MARK)


def read_head(path: Path) -> bytes:
    """The first bytes of a regular file, to tell what it is; none where it cannot be read."""
    try:
        refuse_irregular(path, os.stat(path))
        with open(path, "rb") as file:
            return file.read(HEAD)
    except (OSError, ValueError, InputError):
        return b""


def refuse_irregular(path: Path, status: os.stat_result) -> None:
    """Raise InputError unless the status is that of a regular file."""
    if stat.S_ISREG(status.st_mode):
        return
    kinds = ((stat.S_ISDIR, "a folder"), (stat.S_ISFIFO, "a pipe"), (stat.S_ISSOCK, "a socket"))
    kind = next((name for is_kind, name in kinds if is_kind(status.st_mode)), "a device")
    raise InputError(f"{path}: it must be a regular file, not {kind}; name a file")


def unnameable(path: Path) -> InputError:
    """The InputError for a name that the system cannot hold: with a NUL byte, or in no encoding."""
    return InputError(f"a file name must be one that the system can hold, not {str(path)!r}; correct it")


def unreadable(path: Path, error: OSError) -> InputError:
    """The InputError that says why a file could not be read."""
    if error.errno in (errno.ENOENT, errno.ENOTDIR):
        return MissingInputError(f"{path}: there is no such file or folder; check the name")
    reason = (error.strerror or str(error)).lower()
    return InputError(f"{path}: it cannot be read ({reason}); check the name and its permissions")


def text_problem(data: bytes) -> str | None:
    """What keeps the bytes from being text, as the end of a sentence, or None."""
    if data[:2] in (b"\xff\xfe", b"\xfe\xff"):
        return "must be text in UTF-8, not UTF-16; save it as UTF-8"
    place = data.find(b"\0")
    if place >= 0:
        line = data.count(b"\n", 0, place) + 1
        return f"must be text, not hold a NUL byte (line {line}); save it as UTF-8 text"
    return None


def shown(value: str | bytes, most: int = 40) -> str:
    """The text in quotes, cut where it is long, for the end of a sentence."""
    if isinstance(value, bytes):
        value = value[: 4 * most + 4].decode("utf-8", "backslashreplace")
    return repr(value) if len(value) <= most else repr(value[:most]) + "..."
