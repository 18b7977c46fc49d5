"""Writing a mesh of several files: all are complete before the first of them has its name."""

from __future__ import annotations

import os
import secrets
import shutil
from collections.abc import Callable
from pathlib import Path

from autocolor.errors import OutputError, WriteError, reason_of
from autocolor.scene.mesh import Mesh


def write_folder(
    path: Path, mesh: Mesh, write: Callable[[Path, Mesh], object], *, overwrite: bool
) -> list[Path]:
    """Write the files of a mesh to a folder, which is made if there is none; returns them.

    `write` writes them into an empty folder; only then do they move to the path. Other files that are there
    stay. Raises OutputError if one of them exists and `overwrite` is false, or if there can be no such
    folder; WriteError if writing fails.
    """
    parent = path.resolve().parent
    if not parent.is_dir():
        raise OutputError(f"an output must be in an existing folder, not {path.parent}; create it")
    if os.path.exists(path) and not os.path.isdir(path):
        raise OutputError(f"an output of several files must be a folder, not the file {path}; name another")
    beside = parent / f".{path.name[:100]}.{secrets.token_hex(6)}.part"
    try:
        os.mkdir(beside)
    except OSError as error:
        raise OutputError(
            f"an output must have a place, and at {path} it cannot be made ({reason_of(error)}); choose"
            " another"
        ) from None
    try:
        write(beside, mesh)
        names = sorted(str(file.relative_to(beside)) for file in beside.rglob("*") if file.is_file())
        there = [name for name in names if os.path.lexists(path / name)]
        if there and not overwrite:
            raise OutputError(
                f"an output must be new files, not {path / there[0]}, which exists; choose another folder, or"
                " overwrite it with --force"
            )
        _synced(beside, names)
        if path.exists():
            # Remove the old files first: if this is cut off, the folder has files of one mesh only.
            for name in there:
                os.unlink(path / name)
            for name in names:
                (path / name).parent.mkdir(parents=True, exist_ok=True)
                os.replace(beside / name, path / name)
        else:
            os.rename(beside, path)
    except OSError as error:
        raise WriteError(
            f"an output must be written whole, and {path} could not be ({reason_of(error)}); make room or"
            " choose another place"
        ) from None
    finally:
        shutil.rmtree(beside, ignore_errors=True)
    return [path / name for name in names]


def _synced(folder: Path, names: list[str]) -> None:
    for name in names:
        with open(folder / name, "rb+") as file:
            os.fsync(file.fileno())
