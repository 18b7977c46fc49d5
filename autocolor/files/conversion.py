"""Which format a scene is written in, and which parts of the scene that format cannot hold.

A format is recognized by the name of the file or folder that is written, or chosen by its own name.
"""

from __future__ import annotations

import difflib
import os
from collections.abc import Sequence
from pathlib import Path
from typing import Final

from autocolor.checks import shown
from autocolor.errors import UsageError
from autocolor.files.formats import (
    NORMALS,
    PARTS,
    QUADS,
    SCALARS,
    SETTINGS,
    SURFACES,
    Format,
    format_named,
    format_of_folder,
    suffix_rule,
    suffixes_of,
)
from autocolor.files.meshes.obj_writing import beyond_materials
from autocolor.files.opening import FORMATS, SCENE
from autocolor.files.paths import SCENE_FILE
from autocolor.scene.columns import MISSING, fields_of
from autocolor.scene.geometry.normals import CREASE_ANGLE
from autocolor.scene.scalar import NODE
from autocolor.scene.scene import Scene

OUTPUTS: Final = tuple(
    sorted((each for each in FORMATS if each.write is not None), key=lambda each: each.name.casefold())
)
"""The formats that a scene can be written in, sorted by name."""


def output_named(name: str) -> Format:
    """The format with this name, in any capitals. Raises UsageError if no format has it."""
    formats = {output.name.casefold(): output for output in OUTPUTS}
    if name.casefold() in formats:
        return formats[name.casefold()]
    near = difflib.get_close_matches(name.casefold(), formats, 1)
    *names, last = [output.name for output in OUTPUTS]
    raise UsageError(
        f"--to must be {', '.join(names)} or {last}, not {name!r}"
        + (f"; did you mean {formats[near[0]].name}?" if near else "; choose one")
    )


def output_of(path: Path) -> Format:
    """The format for a path that is written.

    An existing folder keeps its format; an empty folder gets a scene. The name of a file decides if it is the
    name of a file in a mesh folder, such as nodes.csv; otherwise the suffix decides. A path without a suffix
    becomes the folder of a scene. Raises UsageError for an unknown suffix.
    """
    # Unlike `Path.is_dir`, it never raises for a name that is too long.
    if os.path.isdir(path):
        if (path / SCENE_FILE).exists():
            return SCENE
        mesh_format = format_of_folder(path)
        if mesh_format is not None and mesh_format.write is not None:
            return mesh_format
        return format_named(path, [each for each in OUTPUTS if each.in_folder]) or SCENE
    output = next((each for each in OUTPUTS if path.name in each.in_folder), None)
    output = output or format_named(path, OUTPUTS)
    if output is not None:
        return output
    if not path.suffix:
        return SCENE
    raise UsageError(
        f"OUT must {suffix_rule(path, suffixes_of(OUTPUTS))}; name another, without an ending for the folder"
        " of a scene, or choose a format with --to"
    )


# The parts of a scene that a format cannot hold.

MOST_NAMED: Final = 5


def left_out(scene: Scene, output: Format, *, is_bare: bool) -> list[str]:
    """A phrase for each part of a scene that a format cannot hold: "2 node scalars ('stress', 'u')".

    If the source `is_bare`, a mesh without a scene, only parts of the mesh count: all else was created.
    """
    mesh, surfaces, views = scene.mesh, scene.surfaces, len(scene.views)
    quads = len(mesh.node_numbers) - mesh.triangle_count
    angle = "" if mesh.crease_angle == CREASE_ANGLE else f"the crease angle of {mesh.crease_angle:g} degrees"
    phrases = [
        (PARTS, _counted("part", mesh.part_names) if len(mesh.part_names) > 1 else ""),
        (SCALARS, _counted("node scalar", [each.name for each in mesh.scalars if each.of == NODE])),
        (SCALARS, _counted("polygon scalar", [each.name for each in mesh.scalars if each.of != NODE])),
        (QUADS, f"{_counted('quad', range(quads))} (each is written as two triangles)" if quads else ""),
        (NORMALS, "the file's own normals (they will be computed)" if mesh.own_normals is not None else ""),
        (SETTINGS, angle),
    ]
    if not is_bare:
        has_materials = SURFACES in output.holds and SETTINGS not in output.holds
        beyond = beyond_materials(surfaces) if has_materials else []
        phrases += [
            (SURFACES, _counted("surface", [each.name for each in surfaces])),
            (SETTINGS, f"what a material does not have of {_counted('surface', beyond)}" if beyond else ""),
            (SETTINGS, _counted("light", [each.name for each in scene.lights])),
            (SETTINGS, f"the view and {_counted('named view', range(views))}" if views else "the view"),
            (SETTINGS, _counted("setting", _settings(scene))),
        ]
    return [phrase for held, phrase in phrases if phrase and held not in output.holds]


def _counted(noun: str, names: Sequence[object]) -> str:
    """The number of things, and the first of their names if they have any; empty if there are none."""
    count = len(names)
    listed = [shown(name) for name in names[:MOST_NAMED] if isinstance(name, str)]
    more = f" and {count - MOST_NAMED:,} more" if count > MOST_NAMED else ""
    named = f" ({', '.join(listed)}{more})" if listed else ""
    return f"{count:,} {noun}{'s' if count > 1 else ''}{named}" if count else ""


def _settings(scene: Scene) -> list[str]:
    """The names of the fields of a scene, without its tables, that differ from their defaults."""
    return [
        name
        for name, field in fields_of(Scene).items()
        if name not in ("name", "view", "views", "lights", "parts", "surfaces")
        and field.default not in (MISSING, vars(scene)[name])
    ]
