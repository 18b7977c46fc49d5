"""Atomic writing: whatever happens, a path names either the whole old file or the whole new one.

The bytes go into a temporary file in the same folder, which is synced, unless the caller declines, and then
renamed. Both packages write their files with this module.

If writing fails or is interrupted, the temporary file is removed. If the process is killed, the file stays
with the bytes so far, such as the words of a recording. Its name is `.NAME.XXXXXXXX.part`, with eight random
digits, and no program removes it.
"""

from __future__ import annotations

import errno
import os
from collections.abc import Iterable
from contextlib import suppress
from itertools import combinations
from pathlib import Path
from secrets import token_hex
from typing import Final

from ramtek_emu.errors import OutputError, OutputExistsError, WriteError, reason_of

PNG: Final = ".png"
"""The suffix of pictures and of snapshots."""

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

    def __init__(self, path: str | os.PathLike[str], *, overwrite: bool, sync: bool = True) -> None:
        """Create the temporary file; OutputExistsError or OutputError if the path cannot be written."""
        self.overwrite = overwrite
        self.sync = sync
        refuse_output(path, overwrite)
        # Follow links: the file that a link names is replaced, and the link is kept.
        self.path = Path(os.path.realpath(path))
        try:
            # Programs that write the same path at once have temporary files of their own.
            # A name of so few letters, of up to four bytes, leaves room for the rest.
            self._beside = self.path.with_name(f".{self.path.name[:50]}.{token_hex(4)}.part")
            # The end of the with statement closes it.
            self._file = open(self._beside, "xb")  # noqa: SIM115
        except OSError as error:
            raise refusal(self.path, error) from None

    def write(self, data: bytes) -> None:
        """Add bytes; WriteError when they cannot be written."""
        try:
            self._file.write(data)
        except OSError as error:
            raise refusal(self.path, error) from None

    def write_at(self, place: int, data: bytes) -> None:
        """Replace bytes that were written; WriteError when that fails."""
        try:
            self._file.seek(place)
            self._file.write(data)
            self._file.seek(0, os.SEEK_END)
        except OSError as error:
            raise refusal(self.path, error) from None

    def keep(self) -> None:
        """Sync the file and give it its name; WriteError or OutputExistsError when that fails.

        Without `sync`, the file has its name at once, and the system writes its bytes to the disk later.
        """
        try:
            self._file.flush()
            if self.sync:
                os.fsync(self._file.fileno())
            # Windows cannot rename open files.
            self._file.close()
            _name(self._beside, self.path, self.overwrite)
            if self.sync:
                sync_folder(self.path.parent)
        except OutputError:
            raise
        except OSError as error:
            raise refusal(self.path, error) from None

    def __enter__(self) -> Output:
        return self

    def __exit__(self, *_: object) -> None:
        """Remove the temporary file if it was not kept."""
        with suppress(OSError):
            self._file.close()
        with suppress(OSError):
            os.unlink(self._beside)


def write_atomically(
    path: str | os.PathLike[str], data: bytes, *, overwrite: bool, sync: bool = True
) -> None:
    """Write the bytes to the path, whole or not at all.

    Without `sync`, the system writes the file to the disk later. A program that is killed still leaves whole
    files, but after a power failure a new file may be empty.

    Raises OutputExistsError if the path exists and may not be overwritten, OutputError if no file can be
    created there, and WriteError if writing fails.
    """
    with Output(path, overwrite=overwrite, sync=sync) as output:
        output.write(data)
        output.keep()


def write_numbered(data: bytes, folder: Path, name: str, suffix: str) -> Path:
    """Write the bytes to NAME-0001 with the suffix, or the next free number, never over a file.

    Returns the path, links resolved. Raises OutputError or WriteError.
    """
    number = 1
    while True:
        path = folder / f"{name}-{number:04d}{suffix}"
        number += 1
        if not os.path.lexists(path):
            # Another program may take the number meanwhile.
            with suppress(OutputExistsError):
                write_atomically(path, data, overwrite=False)
                return path.resolve()


def refuse_output(path: str | os.PathLike[str], overwrite: bool) -> None:
    """Refuse a path that cannot be written; call it before computing anything for the file."""
    target = Path(path)
    try:
        # Path.exists hides that a name is too long since Python 3.14; os.stat does not.
        with suppress(FileNotFoundError, NotADirectoryError):
            os.stat(target)
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
        raise refusal(target, error) from None
    except ValueError:
        raise OutputError(
            f"a file name must be valid on this system, not {str(path)!r}; choose another name"
        ) from None


def check_suffix(path: str | os.PathLike[str], suffix: str, what: str) -> None:
    """Raise OutputError if the name of a file does not end in a suffix; `what` is written to it."""
    if Path(path).suffix.lower() != suffix:
        raise OutputError(f"{what} must be written to a file that ends in {suffix}, not to {path}; rename it")


def same_outputs(paths: Iterable[str]) -> tuple[str, str] | None:
    """The first two of the paths that name the same file, also by a link; None if all files differ."""
    for one, other in combinations(paths, 2):
        names = [os.path.normcase(os.path.realpath(path)) for path in (one, other)]
        with suppress(OSError):
            if names[0] == names[1] or os.path.samefile(one, other):
                return one, other
    return None


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


def refusal(path: Path, error: OSError) -> OutputError | WriteError:
    """The error that says why a file could not be written."""
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


def sync_folder(folder: Path) -> None:
    """Sync the names in a folder. Not every system can open folders; then nothing happens."""
    with suppress(OSError):
        number = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(number)
        finally:
            os.close(number)
