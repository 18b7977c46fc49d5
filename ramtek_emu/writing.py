"""Atomic writing: whatever happens, a path names either the whole old file or the whole new one.

The bytes go into a temporary file in the same folder, which is synced, unless the caller declines, and then
renamed. Both packages write their files with this module.

At its exit, Python removes the temporary files of the process. If the process is killed, they stay. They are
locked while their program lives, so the next program that writes a file of the same name knows, and removes
them. Nothing else in the folder is touched.
"""

from __future__ import annotations

import atexit
import errno
import os
import stat
import sys
from collections.abc import Iterable
from contextlib import suppress
from itertools import combinations
from pathlib import Path
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

_PARTS: Final[set[Path]] = set()
"""The temporary files of this process."""


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
            self._beside, descriptor = _new_part(self.path)
            # The end of the with statement closes it.
            self._file = open(descriptor, "wb")  # noqa: SIM115
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
            if sys.platform == "win32":
                # Open files cannot be renamed there. Elsewhere the file is locked until it has its name.
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
        _remove(self._beside)


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
        if path.exists():
            continue
        try:
            write_atomically(path, data, overwrite=False)
        except OutputExistsError:
            continue
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


# Temporary files. A `.part` file that nobody has locked was left by a program that was killed.


def _new_part(path: Path) -> tuple[Path, int]:
    """A new temporary file beside a path, and its locked descriptor. A file that was left is removed first.

    Each of several programs that write the same path at once has a file with another number.
    """
    number = 0
    while True:
        number += 1
        part = path.with_name(f".{path.name[:100]}.{number}.part")
        _remove_left(part)
        # An interrupt may come before the system says that the file is there.
        _PARTS.add(part)
        try:
            flags = os.O_WRONLY | os.O_CREAT | os.O_EXCL | getattr(os, "O_BINARY", 0)
            descriptor = os.open(part, flags, 0o666)
        except OSError as error:
            _PARTS.discard(part)
            if isinstance(error, FileExistsError):
                continue
            raise
        try:
            lock(descriptor)
            is_ours = _is_named(part, descriptor)
        except BlockingIOError:
            # Another program took the file for one that was left, and removes it.
            is_ours = False
        except OSError:
            # Without locks, as on some network drives, no program removes files of others.
            is_ours = True
        if is_ours:
            return part, descriptor
        _PARTS.discard(part)
        os.close(descriptor)


def _remove_left(part: Path) -> None:
    """Remove a temporary file that a killed program left; no link and no other kind of file is removed."""
    with suppress(OSError):
        if not stat.S_ISREG(os.lstat(part).st_mode):
            return
        if sys.platform == "win32":
            # A file that a program has open cannot be removed there.
            os.unlink(part)
            return
        with open(os.open(part, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK), "rb") as file:
            lock(file.fileno())
            if _is_named(part, file.fileno()):
                os.unlink(part)


def _is_named(part: Path, descriptor: int) -> bool:
    """Whether the file of a descriptor still has its name."""
    try:
        return os.path.samestat(os.fstat(descriptor), os.lstat(part))
    except FileNotFoundError:
        return False


if sys.platform == "win32":
    import msvcrt

    def lock(descriptor: int) -> None:
        """Lock an open file until it is closed or its program ends. Raises OSError if it is locked."""
        msvcrt.locking(descriptor, msvcrt.LK_NBLCK, 1)
else:
    import fcntl

    def lock(descriptor: int) -> None:
        """Lock an open file or folder until it is closed or its program ends.

        Raises BlockingIOError if others have the lock, and OSError if the file system has no locks.
        """
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)


def _remove(part: Path) -> None:
    """Remove a temporary file, if it is still there."""
    with suppress(OSError):
        os.unlink(part)
    _PARTS.discard(part)


@atexit.register
def _remove_parts() -> None:
    for part in tuple(_PARTS):
        _remove(part)


if hasattr(os, "register_at_fork"):
    # The files belong to the process that created them.
    os.register_at_fork(after_in_child=_PARTS.clear)
