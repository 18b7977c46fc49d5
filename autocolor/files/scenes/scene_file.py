"""Scene files: `scene.toml` and the mesh files beside it, read to a Scene.

    ambient = 0.1            scaling = "surface"       contrast = "stretch"      background = "#000000"
    mapping = "linear", or points [[0, 0], [0.3, 0.6], [1, 1]]
    [view]           eye, direction or target, angle, field_of_view
    [[mesh]]         file, or nodes and polygons; up = "z"; crease_angle = 40
    [parts.NAME]     surface
    [surfaces.NAME]  diffuse, specular, exponent, object_color, light_color, blend, light_percentage,
                     two_sided, levels
    [[lights]]       name, position, intensity, on, direction or aim, concentration, cone_angle,
                     flaps.x, flaps.y, flaps.z = { minimum, maximum, on }

All but a mesh may be left out and is then created; `lights = []` is a scene without lights. Parts of the same
name in several meshes become one. Every problem of the file is in one report; rows of `lights` and `mesh`
are counted from 1 there.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from autocolor.errors import InputError
from autocolor.files.reading import read_bytes
from autocolor.files.scenes.problems import SceneProblems
from autocolor.files.scenes.scene_meshes import mesh_file, meshes_of
from autocolor.files.scenes.scene_models import PartKeys, SceneKeys
from autocolor.files.scenes.scene_report import SceneReport, scene_report
from autocolor.files.scenes.scene_tables import lights_of, surfaces_of, view_of
from autocolor.files.scenes.toml_text import LARGEST_TEXT, parsed_toml
from autocolor.scene.mesh import Mesh
from autocolor.scene.scene import Scene
from autocolor.scene.view import View


def read_scene_file(path: Path, *, outside: bool = False) -> SceneReport:
    """The scene of a scene file, and what was repaired and created.

    `outside` allows mesh files outside the scene's folder. Raises InputError with every problem of the file
    and of its meshes, MissingInputError where nothing is wrong but files that are missing.
    """
    data = read_bytes(path, LARGEST_TEXT)
    document = parsed_toml(data, path.name)
    problems = SceneProblems(path.name, data, document)
    keys, wrong = problems.checked((), SceneKeys, document)

    fields = _scene_fields(problems, keys)
    view = view_of(problems, keys["view"]) if "view" in keys else None
    lights = None if keys.get("lights") is None else lights_of(problems, keys["lights"])
    surfaces = surfaces_of(problems, keys.get("surfaces", {}))
    reports = meshes_of(problems, keys.get("mesh", []), path.parent, outside=outside)
    if not keys.get("mesh") and "mesh" not in wrong:
        problems.note((), 'there must be a [[mesh]] with file = "NAME.obj", not none; add one')
    part_names = tuple(dict.fromkeys(name for report in reports for name in report.mesh.part_names))
    complete = len(reports) == len(keys.get("mesh", []))
    surface_names = (*keys.get("surfaces", {}), *part_names)
    surface_of_part = _parts(problems, keys.get("parts", {}), part_names if complete else None, surface_names)
    problems.raise_any()

    mesh = Mesh.joined([report.mesh for report in reports])
    name = path.resolve().parent.name if path.name == "scene.toml" else path.stem
    try:
        return scene_report(
            mesh,
            repairs=tuple(repair for report in reports for repair in report.repairs),
            mesh_files=tuple(mesh_file(table) for table in keys["mesh"]),
            surface_of_part=surface_of_part,
            surfaces=surfaces,
            lights=lights,
            view=view,
            name=name or "scene",
            **fields,
        )
    except InputError as error:
        raise InputError([f"{path.name}, {problem}" for problem in error.problems]) from None


def _scene_fields(problems: SceneProblems, keys: Mapping[str, Any]) -> dict[str, Any]:
    """The fields of a scene that are no tables, checked by an empty scene that has them."""
    names = ("ambient", "scaling", "mapping", "contrast", "background")
    fields = {name: keys[name] for name in names if name in keys}
    empty = Mesh(np.empty((0, 3)), np.empty((0, 4), np.intp), np.empty(0, np.intp), ())
    try:
        Scene(empty, (), (), (), View((0, 0, 0), direction=(0, 1, 0)), **fields)
    except InputError as error:
        problems.note_all((), error)
    return fields


def _parts(
    problems: SceneProblems,
    tables: Mapping[str, Any],
    part_names: tuple[str, ...] | None,
    surface_names: tuple[str, ...],
) -> dict[str, str]:
    """The surface of each part that names one; no names are checked where a mesh could not be read."""
    surface_of_part: dict[str, str] = {}
    known_parts, known_surfaces = set(part_names or ()), set(surface_names)
    for name, table in tables.items():
        if problems.full:
            break
        keys, _ = problems.checked(("parts", name), PartKeys, table)
        if part_names is None:
            continue
        if name not in known_parts:
            problems.note(("parts", name), "no mesh has a part of this name", (name, part_names))
        surface = keys.get("surface")
        if surface is not None and surface not in known_surfaces:
            problems.note(
                ("parts", name, "surface"),
                f"surface must be a surface or a part of the scene, not {surface[:60]!r}",
                (surface, tuple(dict.fromkeys(surface_names))),
            )
        elif surface is not None:
            surface_of_part[name] = surface
    return surface_of_part
