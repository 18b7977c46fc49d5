"""The `[[mesh]]` tables of a scene file: reading their files, remembering them, and writing a mesh for them.

A mesh has no file names. A table beside the meshes remembers the files of each mesh while the mesh exists, so
that a scene file can name these files again. A file may have been changed since, so it is read and compared
before a scene file names it.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, ClassVar, Final, NamedTuple
from weakref import WeakKeyDictionary

from autocolor.budget import memory_problem
from autocolor.errors import InputError, OutputError
from autocolor.files.formats import format_of_files, read_mesh
from autocolor.files.meshes.obj import obj_text
from autocolor.files.meshes.repair import COMPUTED, FILE, NORMALS, SCALES, UPS, MeshReport, Placement
from autocolor.files.meshes.table_file import SUFFIX, table_file_bytes
from autocolor.files.paths import free_path, path_within
from autocolor.files.scene_toml.toml_text import KeyPath, SceneProblems, parsed_toml
from autocolor.files.writing import write_atomically
from autocolor.scene.columns import BarRange, Column, Problem, Row, RowError, Tier, from_plain
from autocolor.scene.kinds import OneOf, Text
from autocolor.scene.mesh import CREASE_ANGLES, Mesh, has_same_tables

MOST_MESHES: Final = 1000
MESH_STEM: Final = "mesh"
"""The name, without its ending, of a mesh file that is written beside a scene file."""

SCALE_BAR: Final = BarRange(0.01, 10, 0.01)

FILE_KEYS: Final = (("file",), ("nodes", "polygons"))
"""The keys that name the files of a mesh: one file, or a node table and a polygon table."""

MESH_FILE_KEYS: Final = frozenset(key for keys in FILE_KEYS for key in keys)
"""The keys of a `[[mesh]]` table whose values are paths; the others tell how the files are read."""


@dataclass(frozen=True)
class MeshEntry(Row):
    """One `[[mesh]]` table of a scene file: its files, their up axis, scale and normals, the crease angle."""

    noun: ClassVar[str] = "mesh"

    file: Annotated[str | None, Column(Text(), Tier.FRAME, "A mesh file in the scene's folder.")] = None
    nodes: Annotated[str | None, Column(Text(), Tier.FRAME, "A node table, with a polygon table.")] = None
    polygons: Annotated[str | None, Column(Text(), Tier.FRAME, "The polygon table.")] = None
    up: Annotated[str, Column(OneOf(UPS), Tier.FRAME, "The file's up axis; the world's is z.")] = "z"
    scale: Annotated[
        float, Column(SCALES, Tier.FRAME, "A factor for the coordinates of the file.", bar=SCALE_BAR)
    ] = 1.0
    normals: Annotated[
        str, Column(OneOf(NORMALS), Tier.FRAME, "Whose normals are used: computed, or the file's own.")
    ] = COMPUTED
    crease_angle: Annotated[
        float | None,
        Column(
            CREASE_ANGLES,
            Tier.FRAME,
            "Polygons that meet at a larger angle keep a sharp edge; the same for all meshes.",
            "degrees",
        ),
    ] = None

    def placement(self, crease_angle: float | None) -> Placement:
        """The placement of the mesh; all meshes of a scene have the same crease angle."""
        return Placement(self.up, self.scale, crease_angle, self.normals)

    def rules(self) -> Iterator[Problem]:
        """The keys must name either one file or two tables."""
        given = tuple(key for keys in FILE_KEYS for key in keys if vars(self)[key] is not None)
        if given not in FILE_KEYS:
            listed = " and ".join(given) or "none of them"
            yield Problem((), f"it must have a file, or nodes and polygons, not {listed}; correct it")


GROWTH: Final = 6
"""Measured: how many times their size mesh files of most formats take while they are read."""

Entries = tuple[Mapping[str, Any], ...]
"""`[[mesh]]` tables."""


@dataclass(frozen=True)
class MeshFiles:
    """A mesh to read: the path of its `[[mesh]]` table, its files by key, and the table itself."""

    path: KeyPath
    files: Mapping[str, Path]
    entry: MeshEntry


def meshes_of(problems: SceneProblems, rows: list[Any], folder: Path, *, outside: bool) -> list[MeshReport]:
    """The meshes of a scene that could be read, all with the same crease angle; problems are collected."""
    if len(rows) > MOST_MESHES:
        problems.note(("mesh",), f"must have at most {MOST_MESHES:,} tables, not {len(rows):,}; join some")
        return []
    sources = [
        source
        for row, table in enumerate(rows)
        if not problems.full
        and (source := _files(problems, ("mesh", row), table, folder, outside)) is not None
    ]
    crease_angle = _crease_angle(problems, sources)
    size = sum(_size(file) for source in sources for file in _read_whole(source.files))
    if problem := memory_problem(GROWTH * size, "thin out the mesh files"):
        problems.note(("mesh",), f"the mesh files together {problem}")
        return []
    reports = []
    for source in sources:
        try:
            reports.append(read_mesh(source.files, source.entry.placement(crease_angle)))
        except InputError as error:
            problems.note_file((*source.path, next(iter(source.files))), error)
    return reports


def _files(
    problems: SceneProblems, path: KeyPath, table: object, folder: Path, outside: bool
) -> MeshFiles | None:
    """The files of one `[[mesh]]` table; None, with its problems added, if they are invalid."""
    entry = _entry(problems, path, table)
    if entry is None:
        return None
    files = {}
    for key in [key for keys in FILE_KEYS for key in keys if vars(entry)[key] is not None]:
        reasons: list[str] = []
        file = path_within(reasons, folder, vars(entry)[key], outside=outside)
        problems.note_all([Problem((key,), reason) for reason in reasons], path)
        if file is not None:
            files[key] = file
    return MeshFiles(path, files, entry) if tuple(files) in FILE_KEYS else None


def _entry(problems: SceneProblems, path: KeyPath, table: object) -> MeshEntry | None:
    """One `[[mesh]]` table without its invalid keys, which are added to the problems.

    Its files are still read, so that their problems are reported too.
    """
    try:
        return from_plain(MeshEntry, table)
    except RowError as error:
        problems.note_all(error.row_problems, path)
        wrong = {problem.path[0] for problem in error.row_problems if problem.path}
    if not wrong or not isinstance(table, Mapping):
        return None
    try:
        return from_plain(MeshEntry, {key: value for key, value in table.items() if key not in wrong})
    except RowError:
        return None


def _crease_angle(problems: SceneProblems, sources: list[MeshFiles]) -> float | None:
    """The crease angle that the tables give; None if no table gives an angle."""
    given = [
        (source.entry.crease_angle, source) for source in sources if source.entry.crease_angle is not None
    ]
    for angle, source in given[1:]:
        if angle != given[0][0]:
            problems.note(
                (*source.path, "crease_angle"),
                f"must be the same in all meshes, {given[0][0]:g} as before, not {angle:g}; give one of them",
            )
    return given[0][0] if given else None


def _read_whole(files: Mapping[str, Path]) -> Iterable[Path]:
    """The files of a mesh that are read whole; mapped files are not."""
    mesh_format = format_of_files(files)
    return () if mesh_format is not None and mesh_format.mapped else files.values()


def _size(path: Path) -> int:
    try:
        return os.stat(path).st_size
    except OSError:
        return 0


def mesh_file(table: Mapping[str, Any]) -> dict[str, str]:
    """The keys of a `[[mesh]]` table that are needed to read the mesh again."""
    return {
        key: table[key] for key in ("file", "nodes", "polygons", "up", "scale", "normals") if key in table
    }


@dataclass(frozen=True)
class MeshSource:
    """The `[[mesh]]` tables that a mesh was read with, and the absolute folder that their files are in.

    `scene_file` is the scene file that has these tables, None if the mesh was read without one.
    """

    folder: Path
    entries: Entries
    scene_file: Path | None = None


_SOURCES: Final[WeakKeyDictionary[Mesh, MeshSource]] = WeakKeyDictionary()


def keep_source(mesh: Mesh, source: MeshSource) -> None:
    """Remember the files that a mesh was read from."""
    _SOURCES[mesh] = source


def source_of(mesh: Mesh) -> MeshSource | None:
    """The files that a mesh was read from; None for a mesh of a picture, a store or a program."""
    return _SOURCES.get(mesh)


class Meshes(NamedTuple):
    """The `[[mesh]]` tables for the mesh of a scene, and the reports of reading their files."""

    entries: Entries
    reports: list[MeshReport]


def meshes_there(folder: Path, mesh: Mesh, old: bytes | None) -> Meshes | None:
    """The files in a folder that hold a mesh; None if no files do.

    Candidates are the files that the old scene file names, and the files that the mesh was read from.
    """
    candidates = [] if old is None else [entries_of(old)]
    source = source_of(mesh)
    if source is not None:
        candidates.append(_relative(source.entries, source.folder, folder.resolve()))
    for entries in candidates:
        reports = reports_of(folder, entries)
        if reports and has_same_tables(Mesh.joined([report.mesh for report in reports]), mesh):
            return Meshes(entries, reports)
    return None


def entries_of(data: bytes) -> Entries:
    """The `[[mesh]]` tables of the text of a scene file; empty if it has something else instead."""
    entries = parsed_toml(data, "scene.toml").get("mesh")
    return tuple(entries) if isinstance(entries, list) else ()


def _relative(entries: Entries, source: Path, folder: Path) -> Entries:
    """Tables with the paths of their files from another folder; empty if a file is not within it."""
    tables = []
    for entry in entries:
        keys = dict(entry)
        for key in keys.keys() & MESH_FILE_KEYS:
            try:
                keys[key] = Path(os.path.normpath(source / keys[key])).relative_to(folder).as_posix()
            except ValueError:
                return ()
        tables.append(keys)
    return tuple(tables)


def reports_of(folder: Path, entries: Entries) -> list[MeshReport]:
    """The reports of reading the files that tables name; empty if a file or a table has a problem."""
    problems = SceneProblems("scene.toml", b"", {})
    reports = meshes_of(problems, list(entries), folder, outside=False)
    return [] if problems.messages else reports


def written_mesh(folder: Path, mesh: Mesh, written: list[Path]) -> Meshes:
    """Write a mesh to a new file: as OBJ, or as arrays if OBJ does not give the same mesh with its scalars.

    The file is added to `written`. Raises OutputError or WriteError.
    """
    normals = COMPUTED if mesh.own_normals is None else FILE
    as_obj = () if mesh.scalars else ((".obj", obj_text),)
    for suffix, content in (*as_obj, (SUFFIX, table_file_bytes)):
        path = free_path(folder / f"{MESH_STEM}{suffix}")
        write_atomically(path, content(mesh), overwrite=False)
        written.append(path)
        try:
            report = read_mesh({"file": path}, Placement(normals=normals))
            if has_same_tables(report.mesh, mesh) and not report.repairs:
                entry = {"file": path.name, **({} if normals == COMPUTED else {"normals": normals})}
                return Meshes((entry,), [report])
        except InputError:
            pass
        os.unlink(written.pop())
    raise OutputError(
        f"{folder}: a mesh must read back the same from a file, and one of {len(mesh.node_numbers):,}"
        " polygons is too large; leave parts out"
    )
