"""Writing files atomically: after any failure, either the old or the new files are there, complete.

`ramtek_emu.writing` does the work for single files. Its errors become errors of this package.
"""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Final

import ramtek_emu
from autocolor.errors import OutputError, UsageError, WriteError, reason_of
from autocolor.files.reading import DECIDING, SCALARS, hidden_path, save_in, save_of
from ramtek_emu import writing

lock = writing.lock

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

    One of the files decides (see `reading.DECIDING`). Its content must differ from save to save, unless there
    is only one other file. The others are written under hidden names. When the deciding file is replaced, our
    readers read the new tables, and then the tables get their own names. If a program is killed before, the
    old tables are whole. If it is killed later, the next call gives the tables their names. Tables in
    `others` that are not written now are removed. All other files in the folder stay.

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
        _saving_alone(folder),
    ):
        _name_hidden_tables(folder)
        try:
            return _written(folder, files, others, overwrite)
        finally:
            _name_hidden_tables(folder)


UNFINISHED: Final = "0" * 12
"""Stands for the checksum in the hidden name of a table that is not whole yet."""

HIDDEN: Final = re.compile(r"\.([a-z0-9_]+(\.npy|\.csv))\.([0-9a-f]{12})\.part")
"""The hidden name of a table: its own name, its suffix, and the checksum of the deciding file."""


def _written(
    folder: Path, files: Iterable[tuple[str, Iterable[bytes]]], others: Iterable[str], overwrite: bool
) -> list[Path]:
    """Write tables under hidden names, and replace the deciding file. Raises OSError and OutputError."""
    paths: list[Path] = []
    deciding, data = folder, b""
    for name, content in files:
        path = folder / name
        path.parent.mkdir(exist_ok=True)
        writing.refuse_output(path, overwrite)
        if name in DECIDING.values():
            deciding, data = path, b"".join(content)
            continue
        with open(hidden_path(path, UNFINISHED), "wb") as file:
            file.writelines(content)
            file.flush()
            os.fsync(file.fileno())
        paths.append(path)
    save = save_of(data)
    for path in paths:
        writing.refuse_output(path, overwrite)
        os.replace(hidden_path(path, UNFINISHED), hidden_path(path, save))
    for place in {path.parent for path in paths}:
        writing.sync_folder(place)
    writing.write_atomically(deciding, data, overwrite=overwrite)
    for path in {folder / name for name in others} - {*paths}:
        if path.is_file():
            path.unlink()
    return sorted([*paths, deciding])


def _name_hidden_tables(folder: Path) -> None:
    """Give the tables of the present save their names; remove hidden ones of other saves. Raises OSError."""
    for place in (folder, folder / SCALARS):
        for hidden in list(place.iterdir()) if place.is_dir() else ():
            name = HIDDEN.fullmatch(hidden.name)
            if name is None or hidden.is_symlink() or not hidden.is_file():
                continue
            if name[3] == save_in(folder / DECIDING[name[2]]):
                with suppress(OSError):
                    os.chmod(hidden, os.stat(place / name[1]).st_mode & 0o777)
                os.replace(hidden, place / name[1])
            else:
                hidden.unlink()
        writing.sync_folder(place)
    with suppress(OSError):
        os.rmdir(folder / SCALARS)


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
    """Refuse to save tables to a folder while another program does. Raises WriteError."""
    try:
        descriptor = os.open(folder, os.O_RDONLY)
    except OSError:
        # Windows opens no folders.
        yield
        return
    try:
        try:
            lock(descriptor)
        except BlockingIOError:
            raise WriteError(
                f"tables must be saved by one program at a time, and another one saves to {folder}; try again"
            ) from None
        except OSError:
            # The file system has no locks.
            pass
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
