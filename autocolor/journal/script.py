"""A session as a Python script, one line a step, which gives the same scenes when it is run.

    scene = autocolor.read_scene('/home/ann/coupe', up='z', surfaces='materials')
    scene = scene.replace(parts=[...], surfaces=[...], lights=[...], view={...}, ambient=0.1, ...)
    studio = autocolor.Studio(scene)
    studio.recolor('body', blend=0.5)
    studio.edit(studio.scene.with_light('key', on=False), same_step=True)
    studio.open('/home/ann/car.obj', up='y', surfaces='parts', tables={...}, checksum='03ab...')
    studio.edit(studio.scene.replace(mesh=autocolor.read_scene('/home/ann/scene-2').mesh, parts=[...]))
    studio.keep_variant('A')
    studio.mark_saved({'/home/ann/car/scene.toml': '77d0...', '/home/ann/car.npz': 'c1e9...'})
    studio.undo()

A script is an export: a session is recovered from its journal.
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Final

from autocolor.journal.history import Drop, Edit, History, Keep, Move, Open, Rename, Saved, Show, Step
from autocolor.journal.journal import MeshesBeside, change_between
from autocolor.journal.places import Source, checksum_of
from autocolor.scene.columns import fields_of, to_plain
from autocolor.scene.scene import Scene
from autocolor.scene.surfaces import Paint

STUDIO_METHODS: Final = {
    "with_surface": "surface",
    "with_light": "light",
    "with_view": "view",
    "with_scalar": "scalar",
    "with_new_light": "add_light",
    "without_light": "remove_light",
}
"""The methods of a studio that edit its scene, by the methods of a scene."""


def script_of(history: History, source: Source, meshes: MeshesBeside) -> str:
    """The script of a session; meshes that were changed are saved with `meshes`.

    All tables of the first scene are in it, so that only the mesh must still be in the files of the source.
    Raises as `MeshesBeside.folder_of`.
    """
    lines = [
        '"""A session of autocolor: run it with Python."""',
        "import autocolor",
        "",
        f"scene = autocolor.read_scene({_arguments(os.path.abspath(source.path), **_options(source))})",
        f"scene = scene.replace({_arguments(**to_plain(history.start))})",
        "studio = autocolor.Studio(scene)",
        *(step_statement(step, history.start, meshes) for step in history.steps),
    ]
    return "\n".join([*lines, ""])


def step_statement(step: Step, start: Scene, meshes: MeshesBeside) -> str:
    """The statement that takes a step; `start` is the first scene. Raises as `script_of`."""
    match step:
        case Edit():
            return _edit_statement(step, start, meshes)
        case Open(scene, source):
            tables = {"tables": to_plain(scene), "checksum": checksum_of(scene)}
            return f"studio.open({_arguments(os.path.abspath(source.path), **_options(source), **tables)})"
        case Keep(name) | Show(name) | Drop(name):
            return f"studio.{type(step).__name__.lower()}_variant({literal(name)})"
        case Rename(name, to):
            return f"studio.rename_variant({literal(name)}, {literal(to)})"
        case Saved():
            return f"studio.mark_saved({literal(step.files)})"
        case Move(way, steps):
            return f"studio.{way}({'' if steps == 1 else steps})"


def _edit_statement(edit: Edit, start: Scene, meshes: MeshesBeside) -> str:
    method, row, columns = change_between(edit.before, edit.after)
    arguments = _arguments(*([] if row is None else [row]), **columns)
    if edit.before.mesh is not edit.after.mesh:
        mesh = "scene.mesh"
        if edit.after.mesh is not start.mesh:
            mesh = f"autocolor.read_scene({literal(os.path.abspath(meshes.folder_of(edit.after)))}).mesh"
        arguments = ", ".join([f"mesh={mesh}", *([arguments] if arguments else [])])
    elif edit.joins:
        pass
    elif method == "with_surface" and columns.keys() <= fields_of(Paint).keys():
        return f"studio.recolor({arguments})"
    elif method in STUDIO_METHODS:
        return f"studio.{STUDIO_METHODS[method]}({arguments})"
    elif method == "without_scalar":
        return "studio.scalar(None)"
    elif columns.keys() == {"exposure"} and not isinstance(columns["exposure"], str):
        return f"studio.hold_exposure({literal(columns['exposure'])})"
    same_step = ", same_step=True" if edit.joins else ""
    return f"studio.edit(studio.scene.{method}({arguments}){same_step})"


def literal(value: object) -> str:
    """A plain value as Python writes it; infinity is 1e999.

    >>> literal({"x": {"maximum": float("inf")}, "on": True})
    "{'x': {'maximum': 1e999}, 'on': True}"
    """
    if isinstance(value, Mapping):
        return f"{{{', '.join(f'{literal(key)}: {literal(inner)}' for key, inner in value.items())}}}"
    if isinstance(value, (list, tuple)):
        return f"[{', '.join(map(literal, value))}]"
    if isinstance(value, float):
        return repr(float(value)).replace("inf", "1e999")
    # Names may be of a class that numpy derives from str.
    return repr(str(value)) if isinstance(value, str) else repr(value)


def _arguments(*names: str, **keywords: object) -> str:
    return ", ".join([*map(literal, names), *(f"{key}={literal(value)}" for key, value in keywords.items())])


def _options(source: Source) -> dict[str, object]:
    """The keywords with which a source is read."""
    scale = {} if source.scale == 1 else {"scale": source.scale}
    return {"up": source.up, "surfaces": source.surfaces, **scale}
