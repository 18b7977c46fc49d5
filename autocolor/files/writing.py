"""Writing files atomically: after any failure, either the old or the new files are there, complete.

`ramtek_emu.writing` does the work for single files. Its errors become errors of this package.
"""

from __future__ import annotations

import json
import os
import sys
import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Final

import ramtek_emu
from autocolor.errors import OutputError, UsageError, WriteError, reason_of
from autocolor.files.reading import COMMITTED, NAMES, committed_set, name_in_set
from ramtek_emu import writing

SECONDS_OF_WAITING: Final = 10.0
"""Limit: how long to wait for another program that moves tables, which takes milliseconds."""


Guard = Callable[[Path], Callable[[], None]]
"""A check before a file is overwritten, which returns a second check for the moment of overwriting.

Both raise OutputError. The second check opens no file: closing a store would end the locks of a transaction.
"""


def no_guard(_: Path) -> Callable[[], None]:
    """The guard that lets every file be overwritten."""
    return lambda: None


def write_atomically(
    path: str | os.PathLike[str], data: bytes, *, overwrite: bool, sync: bool = True
) -> None:
    """Write the bytes to a temporary file beside the path, sync it, and rename it to the path.

    Without `sync`, a power failure may leave an empty file. Raises OutputError if the path exists and
    `overwrite` is false, or if no file can be created there; WriteError if writing fails. In both cases the
    old file, if any, is intact.
    """
    with refusals_of_this_package():
        writing.write_atomically(path, data, overwrite=overwrite, sync=sync)


def write_together(
    folder: Path, files: Iterable[tuple[str, Iterable[bytes]]], *, others: Iterable[str], overwrite: bool
) -> list[Path]:
    """Write tables to a folder, which is created if it does not exist; returns their paths, sorted.

    The tables are written to a hidden folder in it. One rename commits them, and from then on our readers
    read the new tables; then each is moved to its name. If a program is killed before the rename, the old
    tables are whole. If it is killed later, the next call moves the tables that are left. A table
    that `others` names is removed if it is not written now. Other files in the folder stay.

    Raises OutputError if a table exists and `overwrite` is false, or if the folder cannot be created, and
    WriteError if writing fails. The old or the new tables are whole then.
    """
    parent = folder.resolve().parent
    if not parent.is_dir():
        raise OutputError(f"an output must be in an existing folder, not {folder.parent}; create it")
    if os.path.exists(folder) and not os.path.isdir(folder):
        raise OutputError(f"an output of several files must be a folder, not the file {folder}; name another")
    with (
        new_folder(folder, "a mesh"),
        refusals_of_this_package(),
        _refusals_at(folder),
        writing.temporary_folder(folder.resolve() / "tables") as (part, names_file),
    ):
        names = []
        for name, pieces in files:
            if "/" not in name:
                writing.refuse_output(folder / name, overwrite)
            names.append(name)
            with open(part / name_in_set(name), "xb") as file:
                file.writelines(pieces)
                file.flush()
                os.fsync(file.fileno())
        with _saving_alone(folder):
            _move_tables(folder)
            for name in names:
                _make_folder(folder, name)
                writing.refuse_output(folder / name, overwrite)
            absent = sorted(name for name in {*others} - {*names} if os.path.isfile(folder / name))
            content = {"files": names, "absent": absent}
            names_file.write(json.dumps(content, indent=1).encode())
            names_file.flush()
            os.fsync(names_file.fileno())
            if sys.platform == "win32":
                # A folder of open files cannot be renamed there.
                names_file.close()
            writing.sync_folder(part)
            os.rename(part, folder / COMMITTED)
            writing.sync_folder(folder)
            _move_tables(folder)
    return sorted(folder / name for name in names)


def _move_tables(folder: Path) -> None:
    """Move the tables of a committed save to their names, if there is one. Raises OSError, InputError."""
    committed = committed_set(folder)
    source = folder / COMMITTED
    if committed is not None:
        for name in committed.absent:
            (folder / name).unlink(missing_ok=True)
        for name in committed.files:
            _make_folder(folder, name)
            if os.path.lexists(source / name_in_set(name)):
                with suppress(OSError):
                    os.chmod(source / name_in_set(name), os.stat(folder / name).st_mode & 0o777)
                os.replace(source / name_in_set(name), folder / name)
        for place in {(folder / name).parent for name in committed.files}:
            writing.sync_folder(place)
        os.unlink(source / NAMES)
    with _refusals_at(source), suppress(FileNotFoundError):
        os.rmdir(source)


def _make_folder(folder: Path, name: str) -> None:
    """Make the folder in a folder of tables that a table is in, such as `scalars`. Raises OutputError."""
    if "/" not in name:
        return
    place = (folder / name).parent
    if place.is_symlink():
        raise OutputError(f"{place}: it must be a folder, not a link; choose another place")
    try:
        place.mkdir(exist_ok=True)
    except OSError as error:
        raise OutputError(f"{place}: it cannot be made ({reason_of(error)}); choose another place") from None


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


@contextmanager
def _saving_alone(folder: Path) -> Iterator[None]:
    """Wait until no other program commits or moves tables in a folder. Raises WriteError."""
    try:
        descriptor = os.open(folder, os.O_RDONLY)
    except OSError:
        # Windows opens no folders.
        yield
        return
    try:
        until = time.monotonic() + SECONDS_OF_WAITING
        while True:
            try:
                writing.lock(descriptor, wait=False)
                break
            except BlockingIOError:
                if time.monotonic() > until:
                    raise WriteError(
                        f"tables must be saved by one program at a time, and another one saves to {folder};"
                        " try again"
                    ) from None
                time.sleep(0.01)
            except OSError:
                # The file system has no locks.
                break
        yield
    finally:
        os.close(descriptor)


def refuse_output(path: str | os.PathLike[str], *, overwrite: bool) -> None:
    """Raise OutputError if no file can be written to the path; for use before an expensive computation."""
    with refusals_of_this_package():
        writing.refuse_output(path, overwrite)


def check_suffix(path: str | os.PathLike[str], suffix: str, what: str) -> None:
    """Raise UsageError if the name of a file does not end in a suffix; `what` is written to it."""
    if Path(path).suffix.lower() != suffix:
        raise UsageError(f"{what} must be written to a file that ends in {suffix}, not to {path}; rename it")


@contextmanager
def _refusals_at(path: Path) -> Iterator[None]:
    try:
        yield
    except (ramtek_emu.OutputError, ramtek_emu.WriteError):
        # They are OSErrors, too.
        raise
    except OSError as error:
        raise writing.refusal(path, error) from None


@contextmanager
def refusals_of_this_package() -> Iterator[None]:
    """Raise OutputError and WriteError of this package instead of those of `ramtek_emu`."""
    try:
        yield
    except ramtek_emu.OutputError as refusal:
        raise OutputError(str(refusal)) from None
    except ramtek_emu.WriteError as refusal:
        raise WriteError(str(refusal)) from None
