"""Reading a scene from a `scene.toml` and the mesh files beside it.

The keys are the columns of the tables, which docs/COLUMNS.md lists; `[[mesh]]` names the mesh files.
Everything but a mesh is optional and created with defaults when omitted; `lights = []` means no lights. Parts
of the same name in several meshes become one part. All problems of the values are reported together, and then
those of names that the scene lacks; messages count the rows of `lights`, `views` and `mesh` from 1.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, Final

from autocolor.checks import shown
from autocolor.errors import InputError
from autocolor.files.meshes.repair import MeshReport
from autocolor.files.reading import read_bytes
from autocolor.files.scene_report import OMITTED, SceneReport, scene_report
from autocolor.files.scene_toml.scene_meshes import meshes_of
from autocolor.files.scene_toml.toml_text import LARGEST_TEXT, SceneProblems, parsed_toml
from autocolor.scene.columns import Problem, RowError, SomeRow, keys_of, replaced, unknown_key
from autocolor.scene.creation import MATERIALS, SurfaceSource
from autocolor.scene.defaults import default_surface
from autocolor.scene.scene import Scene
from autocolor.scene.surfaces import Part

FILE_KEYS: Final = tuple(key for key in keys_of(Scene) if key != "name")
"""The keys of a scene file; the scene's name is that of its folder or file."""


def read_scene_file(
    path: Path,
    *,
    outside: bool = False,
    surfaces: SurfaceSource = MATERIALS,
    data: bytes | None = None,
    meshes: list[MeshReport] | None = None,
) -> SceneReport:
    """The scene of a scene file, and what was repaired and created.

    With `outside`, mesh files may be outside the scene's folder; `surfaces` is as in `read_scene`. `data` is
    the text that the file would have, and `meshes` are the meshes that it names, if they were read before.
    Raises InputError with every problem of the file and its meshes, MissingInputError if missing files are
    the only problem.
    """
    data = read_bytes(path, LARGEST_TEXT) if data is None else data
    document = parsed_toml(data, path.name)
    problems = SceneProblems(path.name, data, document)

    fields = {}
    for key, value in document.items():
        if key not in FILE_KEYS and not problems.full:
            problems.note_all([unknown_key(key, FILE_KEYS)])
        elif key in FILE_KEYS and key not in ("mesh", "parts", "surfaces"):
            refused: list[Problem] = []
            fields[key] = keys_of(Scene)[key].column.kind.validated(value, (key,), refused)
            problems.note_all(refused)
    given = _rows(problems, document, "surfaces", default_surface)
    entries = document.get("mesh", [])
    if not isinstance(entries, list):
        problems.note(("mesh",), f"must be tables, each written [[mesh]], not {shown(entries)}")
        entries = []
    elif not entries:
        problems.note((), 'there must be a [[mesh]] with file = "NAME.obj", not none; add one')
    reports = meshes_of(problems, entries, path.parent, outside=outside) if meshes is None else meshes
    part_rows = _rows(problems, document, "parts", lambda name, _: Part(name, name))
    problems.raise_any()
    parts = {part: document["parts"][part] for part in part_rows}
    if surfaces != MATERIALS:
        # A part whose surface the file does not name has a surface of its own name.
        names = [name for report in reports for name in report.mesh.part_names]
        parts |= {name: {"surface": name, **parts.get(name, {})} for name in names}

    name = path.resolve().parent.name if path.name == "scene.toml" else path.stem
    try:
        return scene_report(
            reports,
            mesh_files=tuple(
                {key: value for key, value in entry.items() if key != "crease_angle"} for entry in entries
            ),
            parts=parts,
            surfaces=tuple(given.values()),
            name=name or "scene",
            **{**OMITTED, **fields},
        )
    except InputError as error:
        raise InputError([f"{path.name}, {problem}" for problem in error.problems]) from None


def _rows(
    problems: SceneProblems, document: Mapping[str, Any], key: str, default: Callable[[str, int], SomeRow]
) -> dict[str, SomeRow]:
    """The rows of the tables [key.NAME] by NAME, as `default` makes them where they have problems."""
    tables = document.get(key, {})
    if not isinstance(tables, dict):
        problems.note((key,), f"must be tables written [{key}.NAME], not {shown(tables)}")
        return {}
    rows = {}
    for number, (name, table) in enumerate(tables.items()):
        if problems.full:
            break
        rows[name] = default(name, number)
        if not isinstance(table, dict):
            problems.note((key, name), f"it must be a table, not {shown(table)}; write keys and values")
        elif "name" in table:
            keys = [each for each in keys_of(type(rows[name])) if each != "name"]
            problems.note_all([unknown_key("name", keys)], (key, name))
        else:
            try:
                rows[name] = replaced(rows[name], table)
            except RowError as error:
                problems.note_all(error.row_problems, (key, name))
    return rows
