"""The registry of mesh file formats.

To add a format, put a module or package that calls `register` beside this one; nothing else needs to change.
A file's format is recognized by its suffix, or by its first bytes if the suffix is unknown.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Final

from autocolor.errors import InputError
from autocolor.files.modules import import_modules_of
from autocolor.files.reading import read_head
from autocolor.files.repair.placement import PLAIN, Placement
from autocolor.files.repair.polygons import MeshReport
from autocolor.logs import logger_of, timed
from autocolor.scene.mesh import Mesh

LOG: Final = logger_of(__name__)

MeshReader = Callable[..., MeshReport]
"""A function that reads a mesh. Its positional arguments are the paths of the files, in the order of the
format's keys, and a Placement. It raises InputError."""


@dataclass(frozen=True)
class MeshFormat:
    """One mesh file format.

    `keys` are the keys of a `[[mesh]]` table that name its files; `suffixes` are the suffixes of the first
    file, in lower case. A folder that contains all the files `in_folder` is a mesh of this format. `begins`
    tells from the first bytes of a file whether it may have this format. `written` is the content of a file
    of this format that holds a mesh, where it can be written.
    """

    name: str
    read: MeshReader
    suffixes: tuple[str, ...] = ()
    keys: tuple[str, ...] = ("file",)
    in_folder: tuple[str, ...] = ()
    begins: Callable[[bytes], bool] | None = None
    written: Callable[[Mesh], bytes] | None = None


_REGISTERED: Final[list[MeshFormat]] = []


def register(mesh_format: MeshFormat) -> MeshFormat:
    """Add a format to the registry; returns it."""
    _REGISTERED.append(mesh_format)
    return mesh_format


@cache
def mesh_formats() -> tuple[MeshFormat, ...]:
    """All registered formats, sorted by name."""
    import_modules_of(__name__.rpartition(".")[0])
    return tuple(sorted(_REGISTERED, key=lambda each: each.name))


def mesh_suffixes() -> tuple[str, ...]:
    """The suffixes of all formats that consist of a single file."""
    return tuple(suffix for each in mesh_formats() if each.keys == ("file",) for suffix in each.suffixes)


def format_of(path: Path) -> MeshFormat | None:
    """The format of a single file, by its suffix or else by its first bytes; None if it is unknown."""
    single = [each for each in mesh_formats() if each.keys == ("file",)]
    suffix = path.suffix.lower()
    named = next((each for each in single if suffix in each.suffixes), None)
    if named is not None or not any(each.begins for each in single):
        return named
    head = read_head(path)
    return next((each for each in single if each.begins is not None and each.begins(head)), None)


def format_of_folder(folder: Path) -> MeshFormat | None:
    """The format of the mesh that a folder is; None if it is none."""
    return next(
        (
            each
            for each in mesh_formats()
            if each.in_folder and all((folder / name).exists() for name in each.in_folder)
        ),
        None,
    )


def read_mesh(files: Mapping[str, Path], placement: Placement = PLAIN) -> MeshReport:
    """The mesh of some files, given by their keys in `[[mesh]]`, and what was repaired. Raises InputError."""
    if tuple(files) == ("file",):
        found = format_of(files["file"])
    else:
        found = next((each for each in mesh_formats() if each.keys == tuple(files)), None)
    if found is None:
        path = next(iter(files.values()))
        raise InputError(
            f"{path.name}: a mesh file must end in {' or '.join(mesh_suffixes())}, not in {path.suffix!r};"
            " export it as one of these"
        )
    with timed(LOG, f"read {', '.join(path.name for path in files.values())}"):
        report = found.read(*files.values(), placement)
    LOG.info("%r", report.mesh)
    for repair in report.repairs:
        LOG.info("%s", repair)
    return report
