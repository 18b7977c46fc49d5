"""The mesh formats, and how the format of a file or a folder is recognized.

A file's format is recognized by its suffix, or by its first bytes where only another format begins so. To add
a mesh format, write its reader beside the others in `meshes`, and a row of MESH_FORMATS below. The formats of
whole scenes are in `scene_sources`.
"""

from __future__ import annotations

import dataclasses
import difflib
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Final, TypeVar

from autocolor.errors import InputError
from autocolor.files.meshes.byu import read_byu
from autocolor.files.meshes.csv_tables import CSV_FILES, read_csv_tables, write_csv_tables
from autocolor.files.meshes.foreign import FOREIGN, read_foreign
from autocolor.files.meshes.npy_tables import MAGIC, NODES, POLYGONS, read_npy_tables, write_npy_tables
from autocolor.files.meshes.obj import begins_as_obj, obj_text, read_obj
from autocolor.files.meshes.off import begins_as_off, read_off
from autocolor.files.meshes.ply import ply_bytes, read_ply
from autocolor.files.meshes.ply_elements import begins_as_ply
from autocolor.files.meshes.repair import PLAIN, MeshReport, Placement
from autocolor.files.meshes.stl import begins_as_stl, read_stl, stl_bytes
from autocolor.files.meshes.table_file import SUFFIX, read_table_file, table_file_bytes
from autocolor.files.reading import read_head, refuse_irregular, status_of, table_exists
from autocolor.logs import logger_of, timed
from autocolor.scene.mesh import Mesh

LOG: Final = logger_of(__name__)


@dataclass(frozen=True)
class Format:
    """A file format: its name in messages, and the suffixes of its files, in lower case.

    `begins` is whether a file with these first bytes may have this format; None if first bytes tell nothing.
    A folder that has all the files `in_folder` has this format.
    """

    name: str
    suffixes: tuple[str, ...]
    begins: Callable[[bytes], bool] | None = field(default=None, kw_only=True)
    in_folder: tuple[str, ...] = field(default=(), kw_only=True)


SomeFormat = TypeVar("SomeFormat", bound=Format)


def suffixes_of(formats: Iterable[Format]) -> tuple[str, ...]:
    """The different suffixes of some formats, sorted."""
    return tuple(sorted({suffix for each in formats for suffix in each.suffixes}))


def format_named(path: Path, formats: Iterable[SomeFormat]) -> SomeFormat | None:
    """The format with the suffix of the path; None if there is none."""
    suffix = path.suffix.lower()
    return next((each for each in formats if suffix in each.suffixes), None)


def recognized(path: Path, formats: Sequence[SomeFormat]) -> SomeFormat | None:
    """The format of a file: by its suffix, unless the file begins as another format does.

    None if no format has the suffix or begins so.
    """
    named = format_named(path, formats)
    if named is not None and named.begins is None:
        return named
    head = read_head(path)
    if named is not None and (not head or (named.begins is not None and named.begins(head))):
        return named
    return next((each for each in formats if each.begins is not None and each.begins(head)), named)


def suffix_rule(path: Path, suffixes: Sequence[str]) -> str:
    """The rule for the suffix of a path as part of a message, with the nearest of the allowed suffixes.

    >>> suffix_rule(Path("car.obk"), (".npz", ".obj", ".toml"))
    "end in .npz, .obj or .toml, not in '.obk'; did you mean '.obj'?"
    """
    *others, last = suffixes
    listed = f"{', '.join(others)} or {last}" if others else last
    given = f"not in {path.suffix!r}" if path.suffix else "and this one has no ending"
    near = difflib.get_close_matches(path.suffix.lower(), suffixes, 1, 0.75) if path.suffix else []
    return f"end in {listed}, {given}{f'; did you mean {near[0]!r}?' if near else ''}"


FILE: Final = ("file",)
"""The key of a mesh in a single file."""

NODES_AND_POLYGONS: Final = ("nodes", "polygons")
"""The keys of a mesh in a node table and a polygon table."""

PARTS: Final = "parts"
NODE_SCALARS: Final = "node scalars"
POLYGON_SCALARS: Final = "polygon scalars"
QUADS: Final = "quads"
DOUBLES: Final = "double precision"
MESH_EXTRAS: Final = (PARTS, NODE_SCALARS, POLYGON_SCALARS, QUADS, DOUBLES)
"""Contents of a mesh, beside nodes and triangles in single precision, that some formats cannot hold."""

MeshReader = Callable[..., MeshReport]
"""A function that reads a mesh. Its positional arguments are the paths of the files, in the order of the
format's keys, and a Placement. It raises InputError."""

MeshWriter = Callable[..., list[Path]]
"""A function that writes the files of a mesh to a folder, and returns them. Its arguments are the folder, the
mesh, and the keyword `overwrite`. It raises OutputError and WriteError."""


@dataclass(frozen=True)
class MeshFormat(Format):
    """A mesh file format.

    `keys` are the keys of a `[[mesh]]` table that name its files; suffixes and first bytes are those of the
    first file. In a folder of this format, the first files `in_folder` are the files of the keys. If the only
    key is "file", the folder itself is the file.

    `written` returns the content of a single file; `write` writes several files into a folder, and returns
    them. `holds` are the MESH_EXTRAS that a written mesh keeps. Files that are `mapped` into memory are read
    page by page, so their size has no limit. `prior_of_y` is how often y is up in the files of others, from
    -1 to 1 (see `meshes.up_axis`); None if the format says which axis is up.
    """

    read: MeshReader
    keys: tuple[str, ...] = FILE
    written: Callable[[Mesh], bytes] | None = None
    write: MeshWriter | None = None
    holds: frozenset[str] = frozenset(MESH_EXTRAS)
    mapped: bool = False
    prior_of_y: float | None = None


SIMULATION: Final = 0.0
SCANNED: Final = 0.1
MODELED: Final = 0.2
PRINTED: Final = -0.1
"""Assumed: the prior of y by the use of a format. Modelers write OBJ files mostly with y up, as do many
scanners; printers build along z."""

MESH_FORMATS: Final = (
    MeshFormat(
        "CSV", (".csv",), read_csv_tables, NODES_AND_POLYGONS, in_folder=CSV_FILES, write=write_csv_tables
    ),
    MeshFormat("Movie.BYU", (".g", ".byu"), read_byu, prior_of_y=SIMULATION),
    MeshFormat(
        "npy",
        (".npy",),
        read_npy_tables,
        NODES_AND_POLYGONS,
        begins=lambda head: head.startswith(MAGIC),
        in_folder=(NODES, POLYGONS),
        write=write_npy_tables,
        mapped=True,
    ),
    MeshFormat(
        "OBJ",
        (".obj",),
        read_obj,
        begins=begins_as_obj,
        written=obj_text,
        holds=frozenset((PARTS, QUADS, DOUBLES)),
        prior_of_y=MODELED,
    ),
    MeshFormat("OFF", (".off",), read_off, begins=begins_as_off, prior_of_y=SCANNED),
    MeshFormat("PLY", (".ply",), read_ply, begins=begins_as_ply, written=ply_bytes, prior_of_y=SCANNED),
    MeshFormat(
        "STL",
        (".stl",),
        read_stl,
        begins=begins_as_stl,
        written=stl_bytes,
        holds=frozenset(),
        prior_of_y=PRINTED,
    ),
    MeshFormat("tables", (SUFFIX,), read_table_file, written=table_file_bytes),
    *(
        MeshFormat(
            each.name,
            each.suffixes,
            partial(read_foreign, each),
            begins=each.begins,
            prior_of_y=None if each.up else SIMULATION,
        )
        for each in FOREIGN
    ),
)
"""All mesh formats. If several formats accept the first bytes of a file, the first format is used."""


def file_formats() -> tuple[MeshFormat, ...]:
    """The mesh formats that consist of a single file."""
    return tuple(each for each in MESH_FORMATS if each.keys == FILE and each.suffixes)


def mesh_suffixes() -> tuple[str, ...]:
    """The suffixes of all mesh formats that consist of a single file."""
    return suffixes_of(file_formats())


def format_of(path: Path) -> MeshFormat | None:
    """The format of a single file, by its suffix or its first bytes, or of a folder; None if unknown."""
    return (format_of_folder(path) if path.is_dir() else None) or recognized(path, file_formats())


def format_of_folder(folder: Path) -> MeshFormat | None:
    """The format of the mesh in a folder; None if the folder has no mesh."""
    for mesh_format in MESH_FORMATS:
        names = mesh_format.in_folder
        if names and all(table_exists(folder, name) for name in names):
            return mesh_format
    return None


def format_of_files(files: Mapping[str, Path]) -> MeshFormat | None:
    """The format of the files with these keys in `[[mesh]]`; None if it is unknown.

    Several files are recognized by the first: by its suffix, else by its first bytes. If neither is known,
    they are CSV tables, because CSV has no first bytes of its own.
    """
    first = next(iter(files.values()))
    if tuple(files) == FILE:
        return format_of(first)
    several = [each for each in MESH_FORMATS if each.keys == tuple(files)]
    return recognized(first, several) or next((each for each in several if each.begins is None), None)


def files_of_folder(folder: Path, mesh_format: MeshFormat) -> dict[str, Path]:
    """The files of the mesh in a folder, by their keys; the folder itself if the only key is "file"."""
    if mesh_format.keys == FILE:
        return {"file": folder}
    return {key: folder / name for key, name in zip(mesh_format.keys, mesh_format.in_folder, strict=False)}


def read_mesh(files: Mapping[str, Path], placement: Placement = PLAIN) -> MeshReport:
    """The mesh of some files, given by their keys in `[[mesh]]`, and what was repaired. Raises InputError."""
    path = next(iter(files.values()))
    mesh_format = format_of_files(files)
    if mesh_format is None:
        raise InputError(
            f"{path.name}: a mesh file must {suffix_rule(path, mesh_suffixes())}; export it as one of these"
        )
    with timed(LOG, f"read {', '.join(path.name for path in files.values())}"):
        # A folder of tables is no file.
        for file in files.values() if len(files) < len(mesh_format.keys) else ():
            refuse_irregular(file, status_of(file))
        report = mesh_format.read(*files.values(), placement)
    named = format_named(path, MESH_FORMATS)
    if named not in (None, mesh_format) and path.suffix.lower() not in mesh_format.suffixes:
        assert named is not None
        message = (
            f"{path.name}: it begins as {mesh_format.name} and was read as that, not as {named.name};"
            " rename it"
        )
        report = dataclasses.replace(report, repairs=(message, *report.repairs))
    LOG.info("%r", report.mesh)
    for repair in report.repairs:
        LOG.info("%s", repair)
    return report
