"""The registry of mesh file formats.

To add a format, put a module or package that calls `register` beside this one; nothing else needs to change.
A file's format is recognized by its suffix, or by its first bytes where these tell another one.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from autocolor.errors import InputError
from autocolor.files.meshes.repair import PLAIN, MeshReport, Placement
from autocolor.files.registry import Registry, format_named, recognized, suffix_rule, suffixes_of
from autocolor.logs import logger_of, timed
from autocolor.scene.mesh import Mesh

LOG: Final = logger_of(__name__)

FILE: Final = ("file",)
"""The keys of a mesh that is one file."""

PARTS: Final = "parts"
NODE_SCALARS: Final = "node scalars"
POLYGON_SCALARS: Final = "polygon scalars"
HELD: Final = (PARTS, NODE_SCALARS, POLYGON_SCALARS)
"""What a mesh may have beside nodes and polygons, and not every format holds."""

MeshReader = Callable[..., MeshReport]
"""A function that reads a mesh. Its positional arguments are the paths of the files, in the order of the
format's keys, and a Placement. It raises InputError."""


@dataclass(frozen=True)
class MeshFormat:
    """One mesh file format.

    `keys` are the keys of a `[[mesh]]` table that name its files; `suffixes` are the suffixes of the first
    file, in lower case. A folder that contains all the files `in_folder` is a mesh of this format: the first
    of them are those of the keys, or the folder itself is the file. `begins` tells from the first bytes of
    the first file whether it may have this format.

    `written` makes the content of a single file; `write` writes the files of a format of several into an
    empty folder. `holds` are the things beside nodes and polygons that are read back then, of HELD. Files
    that are `mapped` into memory are read page by page, so that their size has no limit.
    """

    name: str
    read: MeshReader
    suffixes: tuple[str, ...] = ()
    keys: tuple[str, ...] = FILE
    in_folder: tuple[str, ...] = ()
    begins: Callable[[bytes], bool] | None = None
    written: Callable[[Mesh], bytes] | None = None
    write: Callable[[Path, Mesh], object] | None = None
    holds: frozenset[str] = frozenset(HELD)
    mapped: bool = False


REGISTRY: Final = Registry[MeshFormat](__name__.rpartition(".")[0])


def register(mesh_format: MeshFormat) -> MeshFormat:
    """Add a format to the registry; returns it."""
    return REGISTRY.register(mesh_format)


def mesh_formats() -> tuple[MeshFormat, ...]:
    """All registered formats, sorted by name."""
    return REGISTRY.formats()


def file_formats() -> tuple[MeshFormat, ...]:
    """The formats that consist of a single file."""
    return tuple(each for each in mesh_formats() if each.keys == FILE and each.suffixes)


def mesh_suffixes() -> tuple[str, ...]:
    """The suffixes of all formats that consist of a single file."""
    return suffixes_of(file_formats())


def format_of(path: Path) -> MeshFormat | None:
    """The format of a single file, by its suffix or its first bytes, or of a folder; None if unknown."""
    return (format_of_folder(path) if path.is_dir() else None) or recognized(path, file_formats())


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


def format_of_files(files: Mapping[str, Path]) -> MeshFormat | None:
    """The format of some files, given by their keys in `[[mesh]]`; None if it is unknown.

    That of several files is known by the suffix of the first one, or its first bytes; what is left is the one
    of which neither tells anything.
    """
    first = next(iter(files.values()))
    if tuple(files) == FILE:
        return format_of(first)
    several = [each for each in mesh_formats() if each.keys == tuple(files)]
    return recognized(first, several) or next((each for each in several if each.begins is None), None)


def files_of_folder(folder: Path, found: MeshFormat) -> dict[str, Path]:
    """The files of the mesh that a folder is, by their keys; the folder itself if there is one key alone."""
    if found.keys == FILE:
        return {"file": folder}
    return {key: folder / name for key, name in zip(found.keys, found.in_folder, strict=False)}


def read_mesh(files: Mapping[str, Path], placement: Placement = PLAIN) -> MeshReport:
    """The mesh of some files, given by their keys in `[[mesh]]`, and what was repaired. Raises InputError."""
    path = next(iter(files.values()))
    found = format_of_files(files)
    if found is None:
        raise InputError(
            f"{path.name}: a mesh file must {suffix_rule(path, mesh_suffixes())}; export it as one of these"
        )
    with timed(LOG, f"read {', '.join(path.name for path in files.values())}"):
        report = found.read(*files.values(), placement)
    named = format_named(path, mesh_formats())
    if named is not None and named is not found and path.suffix.lower() not in found.suffixes:
        told = f"{path.name}: it begins as {found.name} and was read as that, not as {named.name}; rename it"
        report = dataclasses.replace(report, repairs=(told, *report.repairs))
    LOG.info("%r", report.mesh)
    for repair in report.repairs:
        LOG.info("%s", repair)
    return report
