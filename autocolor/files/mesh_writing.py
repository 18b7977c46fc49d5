"""The mesh files of a scene that is written: those that hold its mesh already, or a new one beside it."""

from __future__ import annotations

import os
from collections.abc import Mapping
from itertools import count
from pathlib import Path
from typing import Any, Final, NamedTuple

from autocolor.errors import InputError, OutputError
from autocolor.files.formats import read_mesh
from autocolor.files.meshes.obj import obj_text
from autocolor.files.meshes.repair import MeshReport
from autocolor.files.meshes.table_file import SUFFIX, table_file_bytes
from autocolor.files.scenes.scene_meshes import MESH_FILE_KEYS, meshes_of, source_of
from autocolor.files.scenes.scene_report import SceneProblems
from autocolor.files.scenes.toml_text import parsed_toml
from autocolor.files.writing import write_atomically
from autocolor.scene.mesh import Mesh, has_same_tables

MESH_STEM: Final = "mesh"
"""The name, without its ending, of the mesh file that is written beside a scene file."""

Entries = tuple[Mapping[str, Any], ...]
"""`[[mesh]]` tables."""


class Meshes(NamedTuple):
    """`[[mesh]]` tables that give the mesh of a scene, and what is read with them."""

    entries: Entries
    reports: list[MeshReport]


def meshes_there(folder: Path, mesh: Mesh, old: bytes | None) -> Meshes | None:
    """The files in a folder that hold a mesh: those that the text of a scene file names, or its sources."""
    given = [] if old is None else [entries_of(old)]
    source = source_of(mesh)
    if source is not None:
        given.append(_relative(source.entries, source.folder, folder.resolve()))
    for entries in given:
        reports = reports_of(folder, entries)
        if reports and has_same_tables(Mesh.joined([report.mesh for report in reports]), mesh):
            return Meshes(entries, reports)
    return None


def entries_of(data: bytes) -> Entries:
    """The `[[mesh]]` tables of the text of a scene file; empty if it has something else instead."""
    entries = parsed_toml(data, "scene.toml").get("mesh")
    return tuple(entries) if isinstance(entries, list) else ()


def _relative(entries: Entries, source: Path, folder: Path) -> Entries:
    """Tables with the paths of their files from another folder; empty if one of them is not within it."""
    found = []
    for entry in entries:
        keys = dict(entry)
        for key in keys.keys() & MESH_FILE_KEYS:
            try:
                keys[key] = Path(os.path.normpath(source / keys[key])).relative_to(folder).as_posix()
            except ValueError:
                return ()
        found.append(keys)
    return tuple(found)


def reports_of(folder: Path, entries: Entries) -> list[MeshReport]:
    """What is read of the files that tables name; empty if anything is wrong with them."""
    problems = SceneProblems("scene.toml", b"", {})
    reports = meshes_of(problems, list(entries), folder, outside=False)
    return [] if problems.found else reports


def written_mesh(folder: Path, mesh: Mesh, written: list[Path]) -> Meshes:
    """Write a mesh to a new file, as OBJ or, if that does not give the same mesh, scalars too, as arrays.

    The file is added to `written`. Raises OutputError or WriteError.
    """
    as_obj = () if mesh.scalars else ((".obj", obj_text),)
    for suffix, content in (*as_obj, (SUFFIX, table_file_bytes)):
        path = _written_to_a_free_name(folder, suffix, content(mesh))
        written.append(path)
        try:
            report = read_mesh({"file": path})
            if has_same_tables(report.mesh, mesh) and not report.repairs:
                return Meshes(({"file": path.name},), [report])
        except InputError:
            pass
        os.unlink(written.pop())
    raise OutputError(
        f"{folder}: a mesh must read back the same from a file, and one of {len(mesh.node_numbers):,}"
        " polygons is too large; leave parts out"
    )


def _written_to_a_free_name(folder: Path, suffix: str, data: bytes) -> Path:
    for number in count(1):
        path = folder / f"{MESH_STEM}{f'-{number}' if number > 1 else ''}{suffix}"
        if not os.path.lexists(path):
            break
    write_atomically(path, data, overwrite=False)
    return path
