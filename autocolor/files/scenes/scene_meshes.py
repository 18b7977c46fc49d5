"""Reading the meshes that a scene file names, and collecting their problems."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, ClassVar, Final
from weakref import WeakKeyDictionary

from autocolor.errors import InputError
from autocolor.files.formats import format_of_files, read_mesh
from autocolor.files.meshes.repair import SCALES, UPS, MeshReport, Placement
from autocolor.files.paths import path_within
from autocolor.files.reading import LARGEST_MESH_FILE
from autocolor.files.scenes.scene_report import SceneProblems
from autocolor.files.scenes.toml_text import KeyPath
from autocolor.scene.columns import BarRange, Column, Problem, Row, RowError, Tier, from_plain
from autocolor.scene.kinds import OneOf, Text
from autocolor.scene.mesh import CREASE_ANGLES, Mesh

MOST_MESHES: Final = 1000

SCALE_BAR: Final = BarRange(0.01, 10, 0.01)

FILE_KEYS: Final = (("file",), ("nodes", "polygons"))
"""The keys that name the files of a mesh: one file, or a node table and a polygon table."""


MESH_FILE_KEYS: Final = frozenset(key for keys in FILE_KEYS for key in keys)
"""The keys of a `[[mesh]]` table whose values are paths; the others tell how the files are read."""


@dataclass(frozen=True)
class MeshEntry(Row):
    """One `[[mesh]]` table of a scene file: its files, their up axis and scale, and the crease angle."""

    noun: ClassVar[str] = "mesh"

    file: Annotated[str | None, Column(Text(), Tier.FRAME, "A mesh file in the scene's folder.")] = None
    nodes: Annotated[str | None, Column(Text(), Tier.FRAME, "A node table, with a polygon table.")] = None
    polygons: Annotated[str | None, Column(Text(), Tier.FRAME, "The polygon table.")] = None
    up: Annotated[str, Column(OneOf(UPS), Tier.FRAME, "The file's up axis; the world's is z.")] = "z"
    scale: Annotated[
        float, Column(SCALES, Tier.FRAME, "A factor for the coordinates of the file.", bar=SCALE_BAR)
    ] = 1.0
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
        """How the mesh is placed; the crease angle is that of all meshes of the scene."""
        return Placement(self.up, self.scale, crease_angle)

    def rules(self) -> Iterator[Problem]:
        """The given keys name either one file or two tables."""
        given = tuple(key for keys in FILE_KEYS for key in keys if vars(self)[key] is not None)
        if given not in FILE_KEYS:
            listed = " and ".join(given) or "none of them"
            yield Problem((), f"it must have a file, or nodes and polygons, not {listed}; correct it")


@dataclass(frozen=True)
class Source:
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
        and (source := _source(problems, ("mesh", row), table, folder, outside)) is not None
    ]
    crease_angle = _crease_angle(problems, sources)
    size = sum(_size(file) for source in sources for file in _read_whole(source.files))
    if size > LARGEST_MESH_FILE:
        problems.note(
            ("mesh",),
            f"the mesh files must have at most {LARGEST_MESH_FILE:,} bytes together, not {size:,};"
            " thin them out",
        )
        return []
    reports = []
    for source in sources:
        try:
            reports.append(read_mesh(source.files, source.entry.placement(crease_angle)))
        except InputError as error:
            problems.note_file((*source.path, next(iter(source.files))), error)
    return reports


def _source(
    problems: SceneProblems, path: KeyPath, table: object, folder: Path, outside: bool
) -> Source | None:
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
    return Source(path, files, entry) if tuple(files) in FILE_KEYS else None


def _entry(problems: SceneProblems, path: KeyPath, table: object) -> MeshEntry | None:
    """One `[[mesh]]` table without its invalid keys, which are added to the problems.

    So its files are still read, and their problems reported too.
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


def _crease_angle(problems: SceneProblems, sources: list[Source]) -> float | None:
    """The crease angle that the tables give; None if none does."""
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
    """Those of the files of a mesh that are read whole, and not mapped into memory."""
    found = format_of_files(files)
    return () if found is not None and found.mapped else files.values()


def _size(path: Path) -> int:
    try:
        return os.stat(path).st_size
    except OSError:
        return 0


def mesh_file(table: Mapping[str, Any]) -> dict[str, str]:
    """The keys of a `[[mesh]]` table that are needed to read the mesh again."""
    return {key: table[key] for key in ("file", "nodes", "polygons", "up", "scale") if key in table}


# -------------------- mesh_sources
# Where meshes were read from, so that a scene that is written can name the same files.
#
# What was read from where is kept beside the meshes, which know nothing of files, and forgotten with them.
# Whoever names a file again must compare what it holds: it may have been changed since.


@dataclass(frozen=True)
class MeshSource:
    """The `[[mesh]]` tables that a mesh was read with, and the absolute folder that their files are in.

    `scene_file` is the scene file that has these tables, None if the mesh was read without one.
    """

    folder: Path
    entries: tuple[Mapping[str, Any], ...]
    scene_file: Path | None = None


_SOURCES: Final[WeakKeyDictionary[Mesh, MeshSource]] = WeakKeyDictionary()


def keep_source(mesh: Mesh, source: MeshSource) -> None:
    """Keep where a mesh was read from."""
    _SOURCES[mesh] = source


def source_of(mesh: Mesh) -> MeshSource | None:
    """Where a mesh was read from; None if it was made in memory or is that of a picture file."""
    return _SOURCES.get(mesh)
