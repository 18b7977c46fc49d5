"""What a format does not hold of a scene, counted, to be told when the scene is written in it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Final

from autocolor.checks import shown
from autocolor.files.conversion.obj_output import beyond_materials
from autocolor.files.conversion.output import LIGHTS, SETTINGS, SURFACES, VIEW, Output
from autocolor.files.meshes.formats import NODE_SCALARS, PARTS, POLYGON_SCALARS
from autocolor.scene.columns.column import fields_of
from autocolor.scene.geometry.node_normals import CREASE_ANGLE
from autocolor.scene.scalars.mesh_scalars import NODE
from autocolor.scene.scene import Scene

MOST_NAMED: Final = 5


def left_out(scene: Scene, output: Output, *, is_bare: bool) -> list[str]:
    """A phrase for each thing that a format does not hold of a scene: "2 node scalars ('stress', 'u')".

    Of a mesh without a scene, which `is_bare`, only what belongs to the mesh is told: all else was created.
    """
    phrases = list(_of_mesh(scene, output))
    if not is_bare:
        phrases.extend(_of_scene(scene, output))
    return phrases


def _of_mesh(scene: Scene, output: Output) -> Iterator[str]:
    mesh = scene.mesh
    if PARTS not in output.holds and len(mesh.part_names) > 1:
        yield f"{len(mesh.part_names):,} parts ({_named(mesh.part_names)})"
    for held, noun in ((NODE_SCALARS, "node scalar"), (POLYGON_SCALARS, "polygon scalar")):
        names = [each.name for each in mesh.scalars if (each.of == NODE) == (held == NODE_SCALARS)]
        if held not in output.holds and names:
            yield f"{len(names):,} {noun}{'s' if len(names) > 1 else ''} ({_named(names)})"
    if SETTINGS not in output.holds and mesh.crease_angle != CREASE_ANGLE:
        yield f"the crease angle of {mesh.crease_angle:g} degrees"


def _of_scene(scene: Scene, output: Output) -> Iterator[str]:
    count = len(scene.surfaces)
    if SURFACES not in output.holds and count:
        named = _named([each.name for each in scene.surfaces])
        yield f"{count:,} surface{'s' if count > 1 else ''} ({named})"
    elif LIGHTS not in output.holds and (names := beyond_materials(scene.surfaces)):
        yield f"what a material does not have of {len(names):,} of {count:,} surfaces ({_named(names)})"
    if LIGHTS not in output.holds and scene.lights:
        count = len(scene.lights)
        yield f"{count:,} light{'s' if count > 1 else ''} ({_named([each.name for each in scene.lights])})"
    if VIEW not in output.holds:
        yield "the view"
    if SETTINGS not in output.holds and (names := _settings(scene)):
        yield f"{len(names)} setting{'s' if len(names) > 1 else ''} ({_named(names)})"


def _settings(scene: Scene) -> list[str]:
    """The names of the fields of a scene, tables apart, that are not their defaults."""
    return [
        name
        for name, field in fields_of(Scene).items()
        if name not in ("name", "view", "lights", "parts", "surfaces")
        and field.default is not None
        and vars(scene)[name] != field.default()
    ]


def _named(names: Sequence[str]) -> str:
    more = f" and {len(names) - MOST_NAMED:,} more" if len(names) > MOST_NAMED else ""
    return ", ".join(shown(name) for name in names[:MOST_NAMED]) + more
