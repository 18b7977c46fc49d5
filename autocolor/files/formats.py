"""The formats of files: how each is recognized, read and written. The table MESH_FORMATS has those of a mesh.

A file's format is recognized by its suffix, or by its first bytes where only another format begins so. To add
a mesh format, write its reader beside the others in `meshes`, and a row of MESH_FORMATS below. `opening` adds
the formats of whole scenes, which name meshes.
"""

from __future__ import annotations

import dataclasses
import difflib
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any, Final

from autocolor.errors import InputError
from autocolor.files.foreign.reader import FOREIGN, read_foreign
from autocolor.files.meshes.byu import read_byu
from autocolor.files.meshes.csv_tables import CSV_FILES, read_csv_tables, write_csv_tables
from autocolor.files.meshes.npy_tables import MAGIC, NODES, POLYGONS, read_npy_tables, write_npy_tables
from autocolor.files.meshes.obj import begins_as_obj, read_obj, write_obj
from autocolor.files.meshes.off import begins_as_off, read_off
from autocolor.files.meshes.ply import ply_bytes, read_ply
from autocolor.files.meshes.ply_elements import begins_as_ply
from autocolor.files.meshes.repair import PLAIN, MeshReport, Placement
from autocolor.files.meshes.stl import begins_as_stl, read_stl, stl_bytes
from autocolor.files.meshes.table_file import SUFFIX, read_table_file, table_file_bytes
from autocolor.files.reading import read_head
from autocolor.files.writing import write_atomically
from autocolor.logs import logger_of, timed
from autocolor.scene.mesh import Mesh
from autocolor.scene.scene import Scene

LOG: Final = logger_of(__name__)

PARTS: Final = "parts"
SCALARS: Final = "scalars"
QUADS: Final = "quads"
NORMALS: Final = "own normals"
MESH_EXTRAS: Final = frozenset((PARTS, SCALARS, QUADS, NORMALS))
"""Contents of a mesh, beside nodes and triangles, that some formats cannot hold."""

SURFACES: Final = "surfaces"
SETTINGS: Final = "lights, views and settings"
WHOLE_SCENE: Final = MESH_EXTRAS | {SURFACES, SETTINGS}
"""The parts of a scene, beside nodes and triangles, that some formats cannot hold."""

SceneWriter = Callable[[Path, Scene, bool], list[Path]]
"""A function that writes a scene to a path, and overwrites existing files if that is allowed.

It returns the files that it wrote. It raises OutputError or WriteError, and leaves no file half written."""


@dataclasses.dataclass(frozen=True, kw_only=True)
class Format:
    """A file format: its name in messages, and the suffixes of its files, in lower case.

    `keys` are the keys of a `[[mesh]]` table that name its files; empty for a format of whole scenes, which
    names its meshes itself. `read` reads a mesh from the paths of the files, in the order of the keys, and a
    Placement; or a scene from a path and the options `outside` and `surfaces` of `read_scene`. It raises
    InputError. Suffixes and first bytes are those of the first file: `begins` is whether a file with these
    first bytes may have this format; None if first bytes tell nothing. A folder that has all the files
    `in_folder` has this format.

    `write` writes a file, or a folder, and is None for a format that is only read; `holds` are the parts of
    WHOLE_SCENE that can then be read back. `prior_of_y` is how often y is up in the files of others, from -1
    to 1 (see `meshes.up_axis`); None if the format says which axis is up.
    """

    name: str
    suffixes: tuple[str, ...]
    read: Callable[..., Any]
    keys: tuple[str, ...] = ("file",)
    begins: Callable[[bytes], object] | None = None
    in_folder: tuple[str, ...] = ()
    write: SceneWriter | None = None
    holds: frozenset[str] = MESH_EXTRAS - {NORMALS}
    prior_of_y: float | None = None


def suffixes_of(formats: Iterable[Format]) -> tuple[str, ...]:
    """The different suffixes of some formats, sorted."""
    return tuple(sorted({suffix for each in formats for suffix in each.suffixes}))


def format_named(path: Path, formats: Iterable[Format]) -> Format | None:
    """The format with the suffix of the path; None if there is none."""
    return next((each for each in formats if path.suffix.lower() in each.suffixes), None)


def recognized(path: Path, formats: Sequence[Format]) -> Format | None:
    """The format of a file: by its suffix, unless the file begins as another format does.

    None if no format has the suffix or begins so.
    """
    named = format_named(path, formats)
    if named is not None and named.begins is None:
        return named
    head = read_head(path)
    # The format of the suffix comes before others that begin so, too.
    likely = formats if named is None else [named, *formats]
    return next((each for each in likely if head and each.begins is not None and each.begins(head)), named)


def suffix_rule(path: Path, suffixes: Sequence[str]) -> str:
    """The rule for the suffix of a path as part of a message, with the nearest of the allowed suffixes.

    >>> suffix_rule(Path("car.obk"), (".npz", ".obj", ".toml"))
    "end in .npz, .obj or .toml, not in '.obk'; did you mean '.obj'?"
    """
    *others, last = suffixes
    given = f"not in {path.suffix!r}" if path.suffix else "and this one has no ending"
    near = difflib.get_close_matches(path.suffix.lower(), suffixes, 1, 0.75) if path.suffix else []
    return f"end in {', '.join(others)} or {last}, {given}{f'; did you mean {near[0]!r}?' if near else ''}"


def _file(content: Callable[[Mesh], bytes]) -> SceneWriter:
    """The writer of the mesh of a scene to a file with this content."""

    def write(path: Path, scene: Scene, overwrite: bool) -> list[Path]:
        write_atomically(path, content(scene.mesh), overwrite=overwrite)
        return [path]

    return write


def _tables(write_tables: Callable[..., list[Path]], names: tuple[str, ...]) -> SceneWriter:
    """The writer of the mesh of a scene to tables in a folder; a path may also be that of a table."""

    def write(path: Path, scene: Scene, overwrite: bool) -> list[Path]:
        folder = path.parent if path.name in names else path
        return write_tables(folder, scene.mesh, overwrite=overwrite)

    return write


SIMULATION: Final = 0.0
SCANNED: Final = 0.1
MODELED: Final = 0.2
PRINTED: Final = -0.1
"""Assumed: the prior of y by the use of a format. Modelers write OBJ files mostly with y up, as do many
scanners; printers build along z."""

MESH_FORMATS: Final = (
    Format(
        name="CSV",
        suffixes=(".csv",),
        read=read_csv_tables,
        keys=("nodes", "polygons"),
        in_folder=CSV_FILES,
        write=_tables(write_csv_tables, CSV_FILES),
    ),
    Format(name="Movie.BYU", suffixes=(".g", ".byu"), read=read_byu, prior_of_y=SIMULATION),
    Format(
        name="npy",
        suffixes=(".npy",),
        begins=lambda head: head.startswith(MAGIC),
        read=read_npy_tables,
        keys=("nodes", "polygons"),
        in_folder=(NODES, POLYGONS),
        write=_tables(write_npy_tables, (NODES, POLYGONS)),
        holds=MESH_EXTRAS,
    ),
    Format(
        name="OBJ",
        suffixes=(".obj",),
        begins=begins_as_obj,
        read=read_obj,
        prior_of_y=MODELED,
        write=write_obj,
        holds=frozenset((PARTS, QUADS, NORMALS, SURFACES)),
    ),
    Format(name="OFF", suffixes=(".off",), begins=begins_as_off, read=read_off, prior_of_y=SCANNED),
    Format(
        name="PLY",
        suffixes=(".ply",),
        begins=begins_as_ply,
        read=read_ply,
        prior_of_y=SCANNED,
        write=_file(ply_bytes),
    ),
    Format(
        name="STL",
        suffixes=(".stl",),
        begins=begins_as_stl,
        read=read_stl,
        prior_of_y=PRINTED,
        write=_file(stl_bytes),
        holds=frozenset(),
    ),
    Format(
        name="tables",
        suffixes=(SUFFIX,),
        read=read_table_file,
        write=_file(table_file_bytes),
        holds=MESH_EXTRAS,
    ),
    *(
        Format(
            name=each.name,
            suffixes=each.suffixes,
            begins=each.begins,
            read=partial(read_foreign, each),
            prior_of_y=None if each.up else SIMULATION,
        )
        for each in FOREIGN
    ),
)
"""All mesh formats. If several formats accept the first bytes of a file, the first format is used."""


FILE_FORMATS: Final = tuple(each for each in MESH_FORMATS if len(each.keys) == 1)
"""The mesh formats that consist of a single file."""


def read_mesh(files: Mapping[str, Path], placement: Placement = PLAIN) -> MeshReport:
    """The mesh of some files, given by their keys in `[[mesh]]`, and what was repaired. Raises InputError.

    Several files are recognized by the first. If neither its suffix nor its first bytes are known, they are
    CSV tables, because CSV has no first bytes of its own.
    """
    path = next(iter(files.values()))
    formats = [each for each in MESH_FORMATS if each.keys == tuple(files)]
    mesh_format = recognized(path, formats) or (formats[0] if len(files) > 1 else None)
    if mesh_format is None:
        raise InputError(
            f"{path.name}: a mesh file must {suffix_rule(path, suffixes_of(formats))};"
            " export it as one of these"
        )
    with timed(LOG, f"read {', '.join(path.name for path in files.values())}"):
        report: MeshReport = mesh_format.read(*files.values(), placement)
    named = format_named(path, MESH_FORMATS)
    if named is not None and named is not mesh_format:
        message = (
            f"{path.name}: it begins as {mesh_format.name} and was read as that, not as {named.name};"
            " rename it"
        )
        report = dataclasses.replace(report, repairs=(message, *report.repairs))
    LOG.info("%r", report.mesh)
    return report
