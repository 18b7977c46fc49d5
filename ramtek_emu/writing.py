"""Writing that leaves the old file or the new one, whole, whatever happens in between.

The bytes go into a file beside, which is synced and then renamed. Both packages of this distribution write
their files through here.
"""

import errno
import os
import secrets
from contextlib import suppress
from pathlib import Path

from .errors import OutputError, OutputExistsError, WriteError

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

    Raises OutputExistsError where the path exists and may not be overwritten, OutputError where nothing can
    be put, WriteError where writing failed. Nothing but a whole old or new file is left in any case.
    """
    target = Path(path)
    refuse_output(target, overwrite)
    try:
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
    except OutputError:
        raise
    except OSError as error:
        raise _refusal(target, error) from None


def refuse_output(path: str | os.PathLike[str], overwrite: bool) -> None:
    """Refuse a place where no output can be put, before anything is computed for it."""
    target = Path(path)
    try:
        if target.is_dir():
            raise OutputError(f"an output must be a file, not the folder {target}; add a file name")
        if target.exists() and not target.is_file():
            raise OutputError(f"an output must be a file, not the device {target}; choose another name")
        if not overwrite and os.path.lexists(target):
            raise _exists(target)
        if not Path(os.path.realpath(target)).parent.is_dir():
            raise OutputError(
                f"an output must have a folder to be in, and there is no folder {target.parent}; make it, "
                "or choose another place"
            )
    except OutputError:
        raise
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


def _exists(path: Path) -> OutputExistsError:
    return OutputExistsError(
        f"an output must be a new file, not {path}, which exists; choose another name or add --force"
    )


def _refusal(path: Path, error: OSError) -> OutputError | WriteError:
    reason = (error.strerror or str(error)).lower()
    if error.errno in NO_PLACE:
        return OutputError(
            f"an output must have a place, and at {path} it cannot be made ({reason}); choose another place"
        )
    return WriteError(
        f"an output must be written whole, and {path} could not be ({reason}); "
        "make room or choose another place"
    )


def _sync_folder(folder: Path) -> None:
    # Not every system opens folders; the file itself is synced already.
    with suppress(OSError):
        number = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(number)
        finally:
            os.close(number)
