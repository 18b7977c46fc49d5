"""Atomic writing: whatever happens, a path names either the whole old file or the whole new one.

The bytes go into a temporary file in the same folder, which is synced and then renamed. Both packages write
their files with this module.
"""

from __future__ import annotations

import errno
import os
import secrets
from contextlib import suppress
from pathlib import Path
from typing import Final

from ramtek_emu.errors import OutputError, OutputExistsError, WriteError, reason_of

NO_PLACE: Final = (
    errno.ENOENT,
    errno.ENOTDIR,
    errno.EACCES,
    errno.EPERM,
    errno.EROFS,
    errno.ENAMETOOLONG,
    errno.EISDIR,
)
"""Errors of a place where no file can be created; any other error means that writing failed midway."""

NO_LINKS: Final = (errno.EPERM, errno.ENOSYS, errno.EOPNOTSUPP, errno.ENOTSUP, errno.EMLINK)
"""The errors of file systems without hard links."""


class Output:
    """A file that is written piece by piece under a temporary name; `keep` gives it its own name."""

    def __init__(self, path: str | os.PathLike[str], *, overwrite: bool) -> None:
        """Create the temporary file; OutputExistsError or OutputError if the path cannot be written."""
        self.overwrite = overwrite
        refuse_output(path, overwrite)
        # Follow links: the file that a link names is replaced, and the link is kept.
        self.path = Path(os.path.realpath(path))
        self._beside = self.path.with_name(f".{self.path.name[:100]}.{secrets.token_hex(6)}.part")
        flags = os.O_WRONLY | os.O_CREAT | os.O_EXCL | getattr(os, "O_BINARY", 0)
        try:
            # `keep` or the end of the with statement closes it.
            self._file = open(os.open(self._beside, flags, 0o666), "wb")  # noqa: SIM115
        except OSError as error:
            raise _refusal(self.path, error) from None

    def write(self, data: bytes) -> None:
        """Add bytes; WriteError when they cannot be written."""
        try:
            self._file.write(data)
        except OSError as error:
            raise _refusal(self.path, error) from None

    def keep(self) -> None:
        """Sync the file and give it its name; WriteError or OutputExistsError when that fails."""
        try:
            with self._file:
                self._file.flush()
                os.fsync(self._file.fileno())
            _name(self._beside, self.path, self.overwrite)
            _sync_folder(self.path.parent)
        except OutputError:
            raise
        except OSError as error:
            raise _refusal(self.path, error) from None

    def __enter__(self) -> Output:
        return self

    def __exit__(self, *_: object) -> None:
        """Remove the temporary file if it was not kept."""
        with suppress(OSError):
            self._file.close()
        with suppress(OSError):
            os.unlink(self._beside)


def write_atomically(path: str | os.PathLike[str], data: bytes, *, overwrite: bool) -> None:
    """Write the bytes to the path, whole or not at all.

    Raises OutputExistsError if the path exists and may not be overwritten, OutputError if no file can be
    created there, and WriteError if writing fails.
    """
    with Output(path, overwrite=overwrite) as output:
        output.write(data)
        output.keep()


def refuse_output(path: str | os.PathLike[str], overwrite: bool) -> None:
    """Refuse a path that cannot be written; call it before computing anything for the file."""
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
            f"a file name must be valid on this system, not {str(path)!r}; choose another name"
        ) from None


def _name(beside: Path, target: Path, overwrite: bool) -> None:
    """Give the finished file its name. A hard link fails if someone created a file of that name meanwhile."""
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
        f"an output must be a new file, not {path}, which exists; choose another name, or overwrite it"
        " with --force (overwrite=True in Python)"
    )


def _refusal(path: Path, error: OSError) -> OutputError | WriteError:
    reason = reason_of(error)
    if error.errno in NO_PLACE:
        other = "name" if error.errno == errno.ENAMETOOLONG else "place"
        return OutputError(
            f"an output must have a place, and at {path} it cannot be made ({reason}); choose another {other}"
        )
    return WriteError(
        f"an output must be written whole, and {path} could not be ({reason}); "
        "make room or choose another place"
    )


def _sync_folder(folder: Path) -> None:
    # Not every system can open folders; the file itself is already synced.
    with suppress(OSError):
        number = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(number)
        finally:
            os.close(number)
