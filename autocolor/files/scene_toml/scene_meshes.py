"""The `[[mesh]]` tables of a scene file: reading their files, remembering them, and writing a mesh for them.

A mesh has no file names. A table beside the meshes remembers the files of each mesh while the mesh exists, so
that a scene file can name these files again. A file may have been changed since, so it is read and compared
before a scene file names it.
"""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any, ClassVar, Final, NamedTuple
from weakref import WeakKeyDictionary

from autocolor.errors import InputError, OutputError
from autocolor.files.formats import read_mesh
from autocolor.files.meshes.obj import obj_text
from autocolor.files.meshes.repair import COMPUTED, FILE, NORMALS, SCALES, UPS, MeshReport, Placement
from autocolor.files.meshes.table_file import SUFFIX, table_file_bytes
from autocolor.files.paths import free_path, path_within
from autocolor.files.scene_toml.toml_text import KeyPath, SceneProblems, parsed_toml
from autocolor.files.writing import write_atomically
from autocolor.scene.columns import BarRange, Problem, Row, RowError, Tier, column_of, from_plain
from autocolor.scene.kinds import one_of, text
from autocolor.scene.mesh import CREASE_ANGLES, Mesh, has_same_tables
from autocolor.scene.row_kinds import table_row

MOST_MESHES: Final = 1000

MESH_FILE_KEYS: Final = ("file", "nodes", "polygons")
"""The keys of a `[[mesh]]` table whose values are paths; the others tell how the files are read."""


@table_row
class MeshEntry(Row):
    """One `[[mesh]]` table of a scene file: its files, their up axis, scale and normals, the crease angle."""

    noun: ClassVar[str] = "mesh"

    file: str | None = text(default=None, tier=Tier.FRAME, help="A mesh file in the scene's folder.")
    nodes: str | None = text(default=None, tier=Tier.FRAME, help="A node table, with a polygon table.")
    polygons: str | None = text(default=None, tier=Tier.FRAME, help="The polygon table.")
    up: str = one_of(UPS, default="z", tier=Tier.FRAME, help="The file's up axis; the world's is z.")
    scale: float = column_of(
        SCALES,
        default=1.0,
        bar=BarRange(0.01, 10, 0.01),
        tier=Tier.FRAME,
        help="A factor for the coordinates of the file.",
    )
    normals: str = one_of(
        NORMALS,
        default=COMPUTED,
        tier=Tier.FRAME,
        help="Whose normals are used: computed, or the file's own.",
    )
    crease_angle: float | None = column_of(
        CREASE_ANGLES,
        default=None,
        unit="degrees",
        bar=BarRange(0, 180, 1),
        tier=Tier.FRAME,
        help="Polygons that meet at a larger angle keep a sharp edge; the same for all meshes.",
    )

    @property
    def file_keys(self) -> tuple[str, ...]:
        """The keys of the files that are given."""
        return tuple(key for key in MESH_FILE_KEYS if vars(self)[key] is not None)

    def rules(self) -> Iterator[Problem]:
        """The keys must name either one file or two tables."""
        if self.file_keys not in (("file",), ("nodes", "polygons")):
            listed = " and ".join(self.file_keys) or "none of them"
            yield Problem((), f"it must have a file, or nodes and polygons, not {listed}; correct it")


Entries = tuple[Mapping[str, Any], ...]
"""`[[mesh]]` tables."""


def meshes_of(problems: SceneProblems, rows: list[Any], folder: Path, *, outside: bool) -> list[MeshReport]:
    """The meshes of a scene that could be read, all with the same crease angle; problems are collected."""
    if len(rows) > MOST_MESHES:
        problems.note(("mesh",), f"must have at most {MOST_MESHES:,} tables, not {len(rows):,}; join some")
        return []
    entries: dict[KeyPath, MeshEntry] = {}
    for row, table in enumerate(rows):
        try:
            entries["mesh", row] = from_plain(MeshEntry, table)
        except RowError as error:
            problems.note_all(error.row_problems, ("mesh", row))
    angles = {path: entry.crease_angle for path, entry in entries.items() if entry.crease_angle is not None}
    angle = next(iter(angles.values()), None)
    for path, other in angles.items():
        if other != angle:
            rule = f"must be the same in all meshes, {angle:g} as before, not {other:g}; give one of them"
            problems.note((*path, "crease_angle"), rule)
    reports = []
    for path, entry in entries.items():
        if problems.full:
            break
        files = {}
        for key in entry.file_keys:
            reasons: list[str] = []
            file = path_within(reasons, folder, vars(entry)[key], outside=outside)
            problems.note_all((Problem((key,), reason) for reason in reasons), path)
            if file is not None:
                files[key] = file
        try:
            if len(files) == len(entry.file_keys):
                placement = Placement(entry.up, entry.scale, angle, entry.normals)
                reports.append(read_mesh(files, placement))
        except InputError as error:
            problems.note_file((*path, next(iter(files))), error)
    return reports


@dataclass(frozen=True)
class MeshSource:
    """The `[[mesh]]` tables that a mesh was read with, and the absolute folder that their files are in.

    `scene_file` is the scene file that has these tables, None if the mesh was read without one.
    """

    folder: Path
    entries: Entries
    scene_file: Path | None = None


SOURCES: Final[WeakKeyDictionary[Mesh, MeshSource]] = WeakKeyDictionary()
"""The files that each mesh was read from; a mesh of a picture, a store or a program has no source."""


class Meshes(NamedTuple):
    """The `[[mesh]]` tables for the mesh of a scene, and the reports of reading their files."""

    entries: Entries
    reports: list[MeshReport]


def meshes_there(folder: Path, mesh: Mesh, old: bytes) -> Meshes | None:
    """The files in a folder that hold a mesh; None if no files do.

    Candidates are the files that the old scene file names, and the files that the mesh was read from.
    """
    candidates = [entries_of(old)]
    if source := SOURCES.get(mesh):
        # On Windows, a file may be on another drive.
        with suppress(ValueError):
            candidates.append(tuple(_from(folder.resolve(), source, entry) for entry in source.entries))
    for entries in candidates:
        reports = reports_of(folder, entries)
        if reports and has_same_tables(Mesh.joined([report.mesh for report in reports]), mesh):
            return Meshes(entries, reports)
    return None


def _from(folder: Path, source: MeshSource, entry: Mapping[str, Any]) -> dict[str, Any]:
    """A table of a source, with the paths of its files from another folder."""
    paths = {
        key: os.path.relpath(source.folder / entry[key], folder) for key in MESH_FILE_KEYS if key in entry
    }
    return {**entry, **{key: Path(path).as_posix() for key, path in paths.items()}}


def entries_of(data: bytes) -> Entries:
    """The `[[mesh]]` tables of the text of a scene file; empty if it has something else instead."""
    entries = parsed_toml(data, "scene.toml").get("mesh")
    return tuple(entries) if isinstance(entries, list) else ()


def reports_of(folder: Path, entries: Entries) -> list[MeshReport]:
    """The reports of reading the files that tables name; empty if a file or a table has a problem."""
    problems = SceneProblems("scene.toml", b"", {"mesh": entries})
    reports = meshes_of(problems, list(entries), folder, outside=False)
    return [] if problems.messages else reports


def written_mesh(folder: Path, mesh: Mesh, written: list[Path]) -> Meshes:
    """Write a mesh to a new file: as OBJ, or as arrays if OBJ does not give the same mesh with its scalars.

    The file is added to `written`. Raises OutputError or WriteError.
    """
    normals = {} if mesh.own_normals is None else {"normals": FILE}
    as_obj = () if mesh.scalars else ((".obj", obj_text),)
    for suffix, content in (*as_obj, (SUFFIX, table_file_bytes)):
        path = free_path(folder / f"mesh{suffix}")
        write_atomically(path, content(mesh), overwrite=False)
        written.append(path)
        entries = ({"file": path.name, **normals},)
        reports = reports_of(folder, entries)
        if reports and has_same_tables(reports[0].mesh, mesh) and not reports[0].repairs:
            return Meshes(entries, reports)
        os.unlink(written.pop())
    raise OutputError(
        f"{folder}: a mesh must read back the same from a file, and one of {len(mesh.node_numbers):,}"
        " polygons is too large; leave parts out"
    )
