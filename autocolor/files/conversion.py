"""Which format a scene is written in, and which parts of the scene that format cannot hold.

A format is recognized by the name of the file or folder that is written, or chosen by its own name.
"""

from __future__ import annotations

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
    suffix_rule,
    suffixes_of,
)
from autocolor.files.meshes.obj_writing import beyond_materials
from autocolor.files.opening import FORMATS, SCENE, format_of_folder
from autocolor.scene.geometry.normals import CREASE_ANGLE
from autocolor.scene.scalar import NODE
from autocolor.scene.scene import Scene

OUTPUTS: Final = tuple(
    sorted((each for each in FORMATS if each.write is not None), key=lambda each: each.name.casefold())
)
"""The formats that a scene can be written in, sorted by name."""


def output_named(name: str) -> Format:
    """The format with this name, in any capitals. Raises UsageError if no format has it."""
    for output in OUTPUTS:
        if name.casefold() == output.name.casefold():
            return output
    *names, last = [output.name for output in OUTPUTS]
    raise UsageError(f"--to must be {', '.join(names)} or {last}, not {name!r}; choose one")


def output_of(path: Path) -> Format:
    """The format for a path that is written.

    An existing folder keeps its format; an empty folder gets a scene. For a file or a new folder the suffix
    decides. A path without a suffix becomes the folder of a scene. Raises UsageError for an unknown suffix.
    """
    # Unlike `Path.is_dir`, it never raises for a name that is too long.
    is_folder = os.path.isdir(path)
    output = format_of_folder(path) if is_folder else format_named(path, OUTPUTS)
    if output is None and path.suffix and not is_folder:
        raise UsageError(
            f"OUT must {suffix_rule(path, suffixes_of(OUTPUTS))}; name another, without an ending for the"
            " folder of a scene, or choose a format with --to"
        )
    return output or SCENE


MOST_NAMED: Final = 5
"""Limit: names that a phrase lists."""


def left_out(scene: Scene, output: Format, *, is_bare: bool) -> list[str]:
    """A phrase for each part of a scene that a format cannot hold: "2 node scalars ('stress', 'u')".

    If the source `is_bare`, a mesh without a scene, only parts of the mesh count: all else was created.
    """
    mesh = scene.mesh
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
        beyond = beyond_materials(scene.surfaces) if SURFACES in output.holds else []
        phrases += [
            (SURFACES, _counted("surface", [each.name for each in scene.surfaces])),
            (SETTINGS, f"what a material does not have of {_counted('surface', beyond)}" if beyond else ""),
            (SETTINGS, "the lights, the views and the settings of the scene"),
        ]
    return [phrase for held, phrase in phrases if phrase and held not in output.holds]


def _counted(noun: str, names: Sequence[object]) -> str:
    """The number of things, and the first of their names if they have any; empty if there are none."""
    count = len(names)
    listed = [shown(name) for name in names[:MOST_NAMED] if isinstance(name, str)]
    more = f" and {count - MOST_NAMED:,} more" if count > MOST_NAMED else ""
    named = f" ({', '.join(listed)}{more})" if listed else ""
    return f"{count:,} {noun}{'s' if count > 1 else ''}{named}" if count else ""
