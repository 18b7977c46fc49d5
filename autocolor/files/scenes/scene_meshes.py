"""The meshes that a scene file names, with every problem noted."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from autocolor.errors import InputError
from autocolor.files.meshes.formats import read_entry
from autocolor.files.paths import path_within
from autocolor.files.reading import LARGEST_MESH_FILE
from autocolor.files.repair.polygons import MeshReport
from autocolor.files.scenes.problems import SceneProblems
from autocolor.files.scenes.scene_models import MeshKeys
from autocolor.files.scenes.toml_text import KeyPath

MOST_MESHES: Final = 1000


@dataclass(frozen=True)
class MeshEntry:
    """One `[[mesh]]` whose keys are right: its files by their keys, and the up axis."""

    path: KeyPath
    files: Mapping[str, Path]
    up: str
    crease_angle: float | None


def meshes_of(problems: SceneProblems, rows: list[Any], folder: Path, *, outside: bool) -> list[MeshReport]:
    """The meshes of a scene, as many as could be read, all with the same crease angle."""
    if len(rows) > MOST_MESHES:
        problems.note(
            ("mesh",), f"mesh must be there at most {MOST_MESHES:,} times, not {len(rows):,}; join some"
        )
        return []
    entries = [
        entry
        for row, table in enumerate(rows)
        if not problems.full
        and (entry := _entry(problems, ("mesh", row), table, folder, outside)) is not None
    ]
    crease_angle = _crease_angle(problems, entries)
    size = sum(_size(file) for entry in entries for file in entry.files.values())
    if size > LARGEST_MESH_FILE:
        problems.note(
            ("mesh",), f"the mesh files must have at most {LARGEST_MESH_FILE:,} bytes together, not {size:,}"
        )
        return []
    reports = []
    for entry in entries:
        try:
            reports.append(read_entry(entry.files, up=entry.up, crease_angle=crease_angle))
        except InputError as error:
            problems.note_file((*entry.path, next(iter(entry.files))), error)
    return reports


def _entry(
    problems: SceneProblems, path: KeyPath, table: object, folder: Path, outside: bool
) -> MeshEntry | None:
    keys, wrong = problems.checked(path, MeshKeys, table)
    if not isinstance(table, dict):
        return None
    names = [key for key in ("file", "nodes", "polygons") if key in table]
    if names not in (["file"], ["nodes", "polygons"]):
        listed = " and ".join(names) or "none of them"
        problems.note(path, f"it must have a file, or nodes and polygons, not {listed}; mend it")
        return None
    files = {}
    for key in names:
        reasons: list[str] = []
        file = path_within(reasons, folder, keys[key], outside=outside) if key in keys else None
        for reason in reasons:
            problems.note((*path, key), f"{key} {reason}")
        if file is not None:
            files[key] = file
    if len(files) < len(names) or "up" in wrong:
        return None
    return MeshEntry(path, files, keys.get("up", "z"), keys.get("crease_angle"))


def _crease_angle(problems: SceneProblems, entries: list[MeshEntry]) -> float | None:
    """The crease angle that the entries give, None where none does."""
    given = [(entry.crease_angle, entry) for entry in entries if entry.crease_angle is not None]
    for angle, entry in given[1:]:
        if angle != given[0][0]:
            problems.note(
                (*entry.path, "crease_angle"),
                f"crease_angle must be the same in all meshes, {given[0][0]:g} as before, not {angle:g};"
                " give one of them",
            )
    return given[0][0] if given else None


def _size(path: Path) -> int:
    try:
        return os.stat(path).st_size
    except OSError:
        return 0


def mesh_file(table: Mapping[str, Any]) -> dict[str, str]:
    """The keys of a `[[mesh]]` that lead to its mesh."""
    return {key: table[key] for key in ("file", "nodes", "polygons", "up") if key in table}
