"""Writing that leaves the old file or the new one, whole, whatever happens in between."""

from __future__ import annotations

import errno
import os
import secrets
from contextlib import suppress
from pathlib import Path

from autocolor.errors import AutocolorError, OutputError, WriteError

NO_PLACE = (
    errno.ENOENT,
    errno.ENOTDIR,
    errno.EACCES,
    errno.EPERM,
    errno.EROFS,
    errno.ENAMETOOLONG,
    errno.EISDIR,
)
"""What says that there is no place for an output, rather than that writing failed midway."""

NO_LINKS = (errno.EPERM, errno.ENOSYS, errno.EOPNOTSUPP, errno.ENOTSUP, errno.EMLINK)
"""What a file system without hard links answers."""


def write_atomically(path: str | os.PathLike[str], data: bytes, *, overwrite: bool) -> None:
    """Write the bytes beside the path, sync them, and give them its name.

    Raises OutputError where the path exists and may not be overwritten, or where nothing can be put;
    WriteError where writing failed. Nothing but a whole old or new file is left in either case.
    """
    target = Path(path)
    try:
        if target.is_dir():
            raise OutputError(f"{target}: an output must be a file, not a folder; add a file name")
        if not overwrite and os.path.lexists(target):
            raise _exists(target)
        # Through a link, so that the link stays and what it names is replaced.
        target = Path(os.path.realpath(target))
        beside = target.with_name(f".{target.name[:100]}.{secrets.token_hex(6)}.part")
        try:
            _write_synced(beside, data)
            _name(beside, target, overwrite)
        finally:
            with suppress(OSError):
                os.unlink(beside)
        _sync_folder(target.parent)
    except OSError as error:
        raise _refusal(target, error) from None
    except ValueError:
        raise OutputError(
            f"a file name must be one that the system can hold, not {str(path)!r}; choose another name"
        ) from None


def _write_synced(path: Path, data: bytes) -> None:
    number = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL | getattr(os, "O_BINARY", 0), 0o666)
    with open(number, "wb") as file:
        file.write(data)
        file.flush()
        os.fsync(number)


def _name(beside: Path, target: Path, overwrite: bool) -> None:
    """Give the finished file its name; a link refuses one that came to exist meanwhile."""
    if overwrite:
        with suppress(OSError):
            os.chmod(beside, os.stat(target).st_mode & 0o777)
        os.replace(beside, target)
        return
    try:
        os.link(beside, target)
    except FileExistsError:
        raise _exists(target) from None
    except OSError as error:
        if error.errno not in NO_LINKS:
            raise
        os.rename(beside, target)


def _exists(path: Path) -> OutputError:
    return OutputError(f"{path} exists; choose another name or add --force")


def _refusal(path: Path, error: OSError) -> AutocolorError:
    reason = (error.strerror or str(error)).lower()
    if error.errno in NO_PLACE:
        return OutputError(f"{path}: it cannot be made there ({reason}); choose another place")
    return WriteError(f"{path}: it could not be written ({reason}); make room or choose another place")


def _sync_folder(folder: Path) -> None:
    # Not every system opens folders; the file itself is synced already.
    with suppress(OSError):
        number = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(number)
        finally:
            os.close(number)
