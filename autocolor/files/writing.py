"""Writing files atomically: after any failure, either the old or the new files are there, complete.

`ramtek_emu.writing` does the work for single files. Its errors become errors of this package.
"""

from __future__ import annotations

import os
import shutil
import sys
from collections.abc import Callable, Iterable, Iterator
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from typing import Final, TypeVar

import numpy as np

import ramtek_emu
from autocolor.arrays import AnyArray
from autocolor.errors import InputError, MissingInputError, OutputError, UsageError, WriteError, reason_of
from ramtek_emu import writing

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


Guard = Callable[[Path], Callable[[], None]]
"""A check before a file is overwritten, which returns a second check for the moment of overwriting.

Both raise OutputError. The second check opens no file: closing a store would end the locks of a transaction.
"""


def no_guard(_: Path) -> Callable[[], None]:
    """The guard that lets every file be overwritten."""
    return lambda: None


def status_numbers(path: Path) -> tuple[int, ...] | None:
    """Numbers that differ after a file was changed or replaced; None if it is missing. It is not opened."""
    try:
        status = os.stat(path)
    except (OSError, ValueError):
        return None
    # A program may set the time of a change, but not the time when the status changed.
    return status.st_dev, status.st_ino, status.st_mtime_ns, status.st_ctime_ns, status.st_size


def write_atomically(
    path: str | os.PathLike[str], data: bytes, *, overwrite: bool, sync: bool = True
) -> None:
    """Write the bytes to a temporary file beside the path, sync it, and rename it to the path.

    Without `sync`, a power failure may leave an empty file. Raises OutputError if the path exists and
    `overwrite` is false, or if no file can be created there; WriteError if writing fails. In both cases the
    old file, if any, is intact.
    """
    with refusals_of_this_package(path):
        writing.write_atomically(path, data, overwrite=overwrite, sync=sync)


@contextmanager
def new_folder(folder: Path, thing: str) -> Iterator[None]:
    """Create a missing folder for `thing`; remove it again if the body fails. Raises OutputError."""
    try:
        os.mkdir(folder)
    except FileExistsError:
        yield
        return
    except (OSError, ValueError) as error:
        raise OutputError(
            f"{thing} must have a folder to be in, and {str(folder)!r} cannot be made ({reason_of(error)});"
            " choose another place"
        ) from None
    try:
        yield
    except BaseException:
        with suppress(OSError):
            os.rmdir(folder)
        raise


def refuse_output(path: str | os.PathLike[str], *, overwrite: bool) -> None:
    """Raise OutputError if no file can be written to the path; for use before an expensive computation."""
    with refusals_of_this_package(path):
        writing.refuse_output(path, overwrite)


def check_suffix(path: str | os.PathLike[str], suffix: str, what: str) -> None:
    """Raise UsageError if the name of a file does not end in a suffix; `what` is written to it."""
    if Path(path).suffix.lower() != suffix:
        raise UsageError(f"{what} must be written to a file that ends in {suffix}, not to {path}; rename it")


@contextmanager
def refusals_of_this_package(path: str | os.PathLike[str]) -> Iterator[None]:
    """Raise OutputError and WriteError of this package instead of those of `ramtek_emu` and of an OSError."""
    try:
        yield
    except OSError as error:
        ours = isinstance(error, (ramtek_emu.OutputError, ramtek_emu.WriteError))
        refusal = error if ours else writing.refusal(Path(path), error)
        kind = OutputError if isinstance(refusal, ramtek_emu.OutputError) else WriteError
        raise kind(str(refusal)) from None


# Tables of a folder that are saved together. They are written to a hidden folder in it, which gets
# the name SAVED once all tables are whole. Then the tables move out of it. Our readers prefer the tables
# in SAVED. So after a kill they find all the old tables, or all the new.

UNFINISHED: Final = ".tables.part"
SAVED: Final = ".tables-saved"

SCALARS: Final = "scalars"
"""The folder of scalars in a folder of tables."""

Result = TypeVar("Result")


def table_exists(folder: Path, name: str) -> bool:
    """Whether a folder has a table."""
    return os.path.exists(folder / name) or os.path.exists(folder / SAVED / name)


def read_table(folder: Path, name: str, read: Callable[[Path], Result]) -> Result:
    """The result of `read` for the path where a table of a folder is at present."""
    with suppress(MissingInputError):
        return read(folder / SAVED / name)
    return read(folder / name)


def read_together(folder: Path, first: str, read: Callable[[], Result]) -> Result:
    """The result of `read`, which opens tables of a folder with `read_table`, all of the same save.

    `first` is the table whose name is last in the alphabet; a save moves it first. If it was saved meanwhile,
    `read` is called again. Raises InputError if saves come all the time, and the errors of `read`.
    """

    def numbers() -> list[tuple[int, ...] | None]:
        return [status_numbers(path) for path in (folder / SAVED, folder / first)]

    for _ in range(100):
        before = numbers()
        try:
            result = read()
        except InputError:
            if numbers() == before:
                raise
        else:
            if numbers() == before:
                return result
    raise InputError(f"{folder}: tables must stay while they are opened, but a program saves them; try again")


def write_together(
    folder: Path, files: Iterable[tuple[str, bytes | AnyArray]], *, others: Iterable[str], overwrite: bool
) -> list[Path]:
    """Write tables to a folder, created if it does not exist; returns their paths, sorted.

    A table is the bytes of a file, or an array, which numpy writes by columns.

    Tables in `others` that are not written now are removed. All other files in the folder stay. Raises
    OutputError if a table exists and `overwrite` is false, or if the folder cannot be created, and WriteError
    if writing fails. The old or the new tables are whole then.
    """
    paths: list[Path] = []
    unfinished = folder / UNFINISHED
    with new_folder(folder, "a mesh"), refusals_of_this_package(folder), _saving_alone(folder):
        _finish(folder)
        try:
            os.mkdir(unfinished)
            for name, content in files:
                paths.append(folder / name)
                if os.path.lexists(paths[-1]):
                    writing.refuse_output(paths[-1], overwrite)
                path = unfinished / name
                path.parent.mkdir(exist_ok=True)
                with open(path, "wb") as file:
                    if isinstance(content, bytes):
                        file.write(content)
                    else:
                        np.save(file, np.asfortranarray(content))
                    file.flush()
                    os.fsync(file.fileno())
                writing.sync_folder(path.parent)
            os.rename(unfinished, folder / SAVED)
            writing.sync_folder(folder)
            for path in {folder / name for name in others} - {*paths}:
                if path.is_file():
                    path.unlink()
        finally:
            _finish(folder)
    return sorted(paths)


def _finish(folder: Path) -> None:
    """Move the tables of a save to their places, or remove them if the save was not whole. Raises OSError."""
    shutil.rmtree(folder / UNFINISHED, ignore_errors=True)
    saved = folder / SAVED
    for path in sorted(saved.rglob("*"), reverse=True):
        place = folder / path.relative_to(saved)
        if path.is_dir():
            # Its tables have moved.
            path.rmdir()
            continue
        place.parent.mkdir(exist_ok=True)
        with suppress(OSError):
            os.chmod(path, os.stat(place).st_mode & 0o777)
        os.replace(path, place)
    for place in (folder / SCALARS, folder):
        writing.sync_folder(place)
    # The second may be empty now.
    for place in (saved, folder / SCALARS):
        with suppress(OSError):
            os.rmdir(place)


@contextmanager
def _saving_alone(folder: Path) -> Iterator[None]:
    """Refuse to save tables to a folder while another program does. Raises WriteError."""
    with ExitStack() as stack:
        try:
            descriptor = os.open(folder, os.O_RDONLY)
            stack.callback(os.close, descriptor)
            lock(descriptor)
        except BlockingIOError:
            raise WriteError(
                f"tables must be saved by one program at a time, and another one saves to {folder}; try again"
            ) from None
        except OSError:
            # Windows opens no folders, and some file systems have no locks.
            pass
        yield
