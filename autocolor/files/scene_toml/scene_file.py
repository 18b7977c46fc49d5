"""Reading a scene from a `scene.toml` and the mesh files beside it.

The keys are the columns of the tables, which docs/COLUMNS.md lists; `[[mesh]]` names the mesh files.
Everything but a mesh is optional and created with defaults when omitted; `lights = []` means no lights. Parts
of the same name in several meshes become one part. All problems of the file are reported together; messages
count the rows of `lights`, `views` and `mesh` from 1.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, Final

from autocolor.checks import nearest, shown
from autocolor.errors import InputError
from autocolor.files.meshes.repair import MeshReport
from autocolor.files.reading import read_bytes
from autocolor.files.scene_report import OMITTED, SceneReport, scene_report
from autocolor.files.scene_toml.scene_meshes import mesh_file, meshes_of
from autocolor.files.scene_toml.toml_text import LARGEST_TEXT, SceneProblems, parsed_toml
from autocolor.scene.changes import PartChanges
from autocolor.scene.columns import (
    REFUSED,
    Problem,
    RowError,
    SomeRow,
    keys_of,
    replaced,
    unknown_key,
)
from autocolor.scene.creation import MATERIALS, SurfaceSource
from autocolor.scene.defaults import default_surface
from autocolor.scene.scene import Scene
from autocolor.scene.surfaces import MOST_SURFACES, Part, Surface

FILE_KEYS: Final = tuple(key for key in keys_of(Scene) if key != "name")
"""The keys of a scene file; the scene's name is that of its folder or file."""

TABLES: Final = ("mesh", "parts", "surfaces")
"""The keys whose tables refer to each other, and are read together."""


def read_scene_file(path: Path, *, outside: bool = False, surfaces: SurfaceSource = MATERIALS) -> SceneReport:
    """The scene of a scene file, and what was repaired and created.

    With `outside`, mesh files may be outside the scene's folder; `surfaces` is as in `read_scene`. Raises
    InputError with every problem of the file and its meshes, MissingInputError if missing files are the only
    problem.
    """
    return report_of_text(read_bytes(path, LARGEST_TEXT), path, outside=outside, surfaces=surfaces)


def report_of_text(
    data: bytes,
    path: Path,
    *,
    outside: bool = False,
    surfaces: SurfaceSource = MATERIALS,
    meshes: list[MeshReport] | None = None,
) -> SceneReport:
    """The scene that a file with this text would give at a path; see `read_scene_file`.

    `meshes` are the meshes that the text names, if they were read before.
    """
    document = parsed_toml(data, path.name)
    problems = SceneProblems(path.name, data, document)

    fields = _fields(problems, document)
    given = _surfaces(problems, document)
    entries = document.get("mesh", [])
    if not isinstance(entries, list):
        problems.note(("mesh",), f"must be tables, each written [[mesh]], not {shown(entries)}")
        entries = []
    elif not entries:
        problems.note((), 'there must be a [[mesh]] with file = "NAME.obj", not none; add one')
    reports = meshes
    if reports is None:
        reports = meshes_of(problems, entries, path.parent, outside=outside)
    parts = _parts(problems, document, reports if len(reports) == len(entries) else None, tuple(given))
    problems.raise_any()

    name = path.resolve().parent.name if path.name == "scene.toml" else path.stem
    try:
        return scene_report(
            reports,
            mesh_files=tuple(mesh_file(table) for table in entries),
            parts=parts if surfaces == MATERIALS else _with_own_surfaces(parts, reports),
            surfaces=tuple(surface for surface in given.values() if surface is not None),
            name=name or "scene",
            **{**OMITTED, **fields},
        )
    except InputError as error:
        raise InputError([f"{path.name}, {problem}" for problem in error.problems]) from None


def _fields(problems: SceneProblems, document: Mapping[str, Any]) -> dict[str, Any]:
    """The valid values of the keys that are not in TABLES, by key."""
    fields = {}
    for key, value in document.items():
        # Finding the closest key is slow, and a file may have many unknown keys.
        if key not in FILE_KEYS and not problems.full:
            problems.note_all([unknown_key(key, FILE_KEYS)])
        elif key in FILE_KEYS and key not in TABLES:
            refused: list[Problem] = []
            fields[key] = keys_of(Scene)[key].column.kind.validated(value, (key,), refused)
            problems.note_all(refused)
    return {key: value for key, value in fields.items() if value is not REFUSED}


def _surfaces(problems: SceneProblems, document: Mapping[str, Any]) -> dict[str, Surface | None]:
    """The surfaces of the file by name, None for a surface with problems; omitted keys have defaults."""
    tables = document.get("surfaces")
    count = len(tables) if isinstance(tables, dict) else 0
    if count > MOST_SURFACES:
        rule = f"must be at most {MOST_SURFACES}, not {count:,}; let parts share a surface"
        problems.note(("surfaces",), rule)
        return {}
    return _rows_by_name(problems, document, "surfaces", default_surface)


def _parts(
    problems: SceneProblems,
    document: Mapping[str, Any],
    reports: list[MeshReport] | None,
    surface_names: tuple[str, ...],
) -> dict[str, PartChanges]:
    """The fields of the parts in the file, by name. Without `reports`, names are not checked."""
    fields: dict[str, PartChanges] = {}
    part_names = dict.fromkeys(name for report in reports or () for name in report.mesh.part_names)
    materials = (name for report in reports or () for name in report.material_of_part.values())
    names_of_surfaces = dict.fromkeys((*surface_names, *part_names, *materials))
    parts = _rows_by_name(problems, document, "parts", lambda name, _: Part(name, name))
    for name, part in parts.items():
        path, table = ("parts", name), document["parts"][name]
        if problems.full or reports is None:
            break
        if name not in part_names:
            problems.note(path, f"no mesh has a part of this name{nearest(name, part_names)}")
        if part is not None and part.surface not in names_of_surfaces and "surface" in table:
            rule = f"must be a surface, a part or a material of the scene, not {shown(part.surface)}"
            problems.note((*path, "surface"), f"{rule}{nearest(part.surface, names_of_surfaces)}")
        elif part is not None:
            fields[name] = table
    return fields


def _with_own_surfaces(parts: Mapping[str, PartChanges], reports: list[MeshReport]) -> dict[str, PartChanges]:
    """The fields of all parts. A part whose surface the file does not name has a surface of its own name."""
    names = [name for report in reports for name in report.mesh.part_names]
    return {name: {"surface": name, **parts.get(name, {})} for name in names}


def _rows_by_name(
    problems: SceneProblems, document: Mapping[str, Any], key: str, default: Callable[[str, int], SomeRow]
) -> dict[str, SomeRow | None]:
    """The rows of the tables [key.NAME], by NAME; an invalid table gives None and adds problems.

    `default` returns the row, by its name and number, whose values omitted keys have.
    """
    tables = document.get(key, {})
    if not isinstance(tables, dict):
        problems.note((key,), f"must be tables written [{key}.NAME], not {shown(tables)}")
        return {}
    rows: dict[str, SomeRow | None] = dict.fromkeys(tables)
    for number, (name, table) in enumerate(tables.items()):
        if problems.full:
            break
        if not isinstance(table, dict):
            problems.note((key, name), f"it must be a table, not {shown(table)}; write keys and values")
            continue
        present = default(name, number)
        if "name" in table:
            keys = [each for each in keys_of(type(present)) if each != "name"]
            problems.note_all([unknown_key("name", keys)], (key, name))
            continue
        try:
            rows[name] = replaced(present, table)
        except RowError as error:
            problems.note_all(error.row_problems, (key, name))
    return rows
