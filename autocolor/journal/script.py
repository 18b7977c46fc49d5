"""The journal of a session: a Python script, one line a step, that gives the same scenes when it is run.

    scene = autocolor.read_scene('/home/ann/coupe', up='z', surfaces='materials')
    scene = scene.replace(parts=[...], surfaces=[...], lights=[...], view={...}, ambient=0.1, ...)
    checksum = '9f2c...'
    studio = autocolor.Studio(scene, Ramtek9300())
    studio.recolor('body', blend=0.5)
    studio.edit(studio.scene.with_light('key', on=False), same_step=True)
    studio.open('/home/ann/car.obj', up='y', surfaces='parts', tables={...}, checksum='03ab...')
    studio.edit(studio.scene.replace(mesh=autocolor.read_scene('/home/ann/scene-2').mesh, parts=[...]))
    studio.keep_variant('A')
    studio.mark_saved({'/home/ann/car/scene.toml': '77d0...', '/home/ann/car.npz': 'c1e9...'})
    studio.undo()

What a step changed is told by the columns (see `difference`); a changed mesh is saved beside the journal.
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from itertools import count
from pathlib import Path
from typing import Any, Final, NamedTuple

from autocolor.errors import InputError
from autocolor.files.paths import SCENE_FILE
from autocolor.files.scene_writing import write_scene
from autocolor.files.scenes.scene_meshes import source_of
from autocolor.journal.history import Drop, Edit, History, Keep, Open, Saved, Show, Step
from autocolor.journal.opening import checksum_of
from autocolor.journal.places import Source
from autocolor.scene.columns import difference, fields_of, to_plain
from autocolor.scene.mesh import Mesh
from autocolor.scene.scene import AUTO, Scene
from autocolor.scene.surfaces import Paint

# -------------------- meshes_beside
# The meshes that a session changed, saved beside its journal, each in a scene of its own.

SCENE_STEM: Final = "scene"


class MeshesBeside:
    """The folders of the scenes that hold changed meshes, each written when it is first asked for.

    `folder` is that of the journal, None if nothing may be written.
    """

    def __init__(self, folder: Path | None = None) -> None:
        self._folder = folder
        self._paths: dict[Mesh, Path] = {}

    def path_of(self, scene: Scene) -> Path:
        """The folder of a scene with the mesh of this one.

        Raises InputError if there is no folder to write to; OutputError or WriteError if writing fails.
        """
        if self._folder is None:
            raise InputError(
                "a mesh that a session changed must be saved beside its journal, and no folder is named for"
                " it; name one with beside="
            )
        if scene.mesh not in self._paths:
            self._paths[scene.mesh] = _there(self._folder, scene.mesh) or _written(self._folder, scene)
        return self._paths[scene.mesh]


def _there(folder: Path, mesh: Mesh) -> Path | None:
    """The folder from which a mesh was read, if it is beside the journal already."""
    source = source_of(mesh)
    if source is None or source.scene_file is None or source.folder.parent != folder.resolve():
        return None
    return folder / source.folder.name


def _written(folder: Path, scene: Scene) -> Path:
    """Write a scene to a folder of a free name."""
    os.makedirs(folder, exist_ok=True)
    for number in count(2):
        path = folder / f"{SCENE_STEM}-{number}"
        if not os.path.lexists(path):
            break
    write_scene(path / SCENE_FILE, scene)
    return path


HEADER: Final = (
    '"""A session of autocolor: run it with Python, or recover it with `autocolor view --recover`."""',
    "import autocolor",
    "from ramtek_emu import Ramtek9300",
)
STUDIO: Final = "studio = autocolor.Studio(scene, Ramtek9300())"

FIRST_MESH: Final = "scene.mesh"
"""The mesh of the first scene."""

ROW_METHODS: Final = {"parts": "with_part", "surfaces": "with_surface", "lights": "with_light"}
"""The methods of a scene that change one row of a table."""

SHORT: Final = {
    "with_surface": "surface",
    "with_light": "light",
    "with_view": "view",
    "with_scalar": "scalar",
    "with_new_light": "add_light",
    "without_light": "remove_light",
}
"""The methods of a studio that edit its scene by one of a scene."""


class Call(NamedTuple):
    """A call of a method of a scene, by which an edit makes another."""

    method: str
    names: tuple[str, ...]
    changes: Mapping[str, object]


def journal_text(history: History, source: Source, beside: MeshesBeside) -> str:
    """The journal of a session as a script; meshes that were changed are saved `beside` it.

    Raises InputError if one was changed and there is no folder for it; OutputError or WriteError.
    """
    steps = (step_line(step, history.start, beside) for step in history.steps)
    return "\n".join([*first_lines(history.start, source), *steps, ""])


def first_lines(start: Scene, source: Source) -> list[str]:
    """The lines of a journal up to the studio, which make the first scene.

    All its tables are told, so that only the mesh must still be in the files: the others may have been saved
    over since.
    """
    path = os.path.abspath(source.path)
    return [
        *HEADER,
        "",
        f"scene = autocolor.read_scene({_arguments((path,), _options(source))})",
        f"scene = scene.replace({_arguments((), to_plain(start))})",
        f"checksum = {literal(checksum_of(start))}",
        STUDIO,
    ]


def step_line(step: Step, start: Scene, beside: MeshesBeside) -> str:
    """The line of a journal that takes a step; `start` is the first scene. Raises as `journal_text`."""
    match step:
        case Edit():
            return _edit_line(step, start, beside)
        case Open(scene, source):
            options = {**_options(source), "tables": to_plain(scene), "checksum": checksum_of(scene)}
            return f"studio.open({_arguments((os.path.abspath(source.path),), options)})"
        case Keep(name):
            return f"studio.keep_variant({literal(name)})"
        case Show(name):
            return f"studio.show_variant({literal(name)})"
        case Drop(name):
            return f"studio.drop_variant({literal(name)})"
        case Saved():
            return f"studio.mark_saved({literal(step.files)})"
        case _:
            return f"studio.{step}()"


def _edit_line(step: Edit, start: Scene, beside: MeshesBeside) -> str:
    method, names, changes = call_between(step.before, step.after)
    arguments = _arguments(names, changes)
    if step.before.mesh is not step.after.mesh:
        mesh = _mesh_expression(step.after, start, beside)
        arguments = ", ".join([f"mesh={mesh}", *([arguments] if arguments else [])])
    elif step.joins:
        pass
    elif method == "with_surface" and changes.keys() <= fields_of(Paint).keys():
        return f"studio.recolor({arguments})"
    elif method in SHORT:
        return f"studio.{SHORT[method]}({arguments})"
    elif method == "without_scalar":
        return "studio.scalar(None)"
    elif changes == {"exposure": AUTO}:
        return "studio.release_exposure()"
    elif changes.keys() == {"exposure"}:
        return f"studio.hold_exposure({literal(changes['exposure'])})"
    same_step = ", same_step=True" if step.joins else ""
    return f"studio.edit(studio.scene.{method}({arguments}){same_step})"


def _mesh_expression(scene: Scene, start: Scene, beside: MeshesBeside) -> str:
    """The expression that gives the mesh of a scene, of which no column tells."""
    if scene.mesh is start.mesh:
        return FIRST_MESH
    path = os.path.abspath(beside.path_of(scene))
    return f"autocolor.read_scene({literal(path)}).mesh"


def call_between(before: Scene, after: Scene) -> Call:
    """The narrowest call of a method of a scene that makes another of it."""
    changes = difference(before, after)
    if len(changes) == 1 and before.mesh is after.mesh:
        (table,) = changes
        if table == "view":
            return Call("with_view", (), difference(before.view, after.view))
        if table == "scalar":
            if after.scalar is None:
                return Call("without_scalar", (), {})
            row = after.scalar
            return Call("with_scalar", (), difference(before.scalar, row) if before.scalar else to_plain(row))
        if table in ROW_METHODS:
            rows, others = vars(before)[table], vars(after)[table]
            call = _row_call(ROW_METHODS[table], rows, others)
            if call is None and table == "lights":
                call = _light_call(rows, others)
            if call is not None:
                return call
    return Call("replace", (), changes)


def _row_call(method: str, rows: tuple[Any, ...], others: tuple[Any, ...]) -> Call | None:
    """The call that changes one row of a table; None if more than that was changed."""
    if len(rows) != len(others):
        return None
    told = [(row, difference(row, other)) for row, other in zip(rows, others, strict=True) if row != other]
    return Call(method, (told[0][0].name,), told[0][1]) if len(told) == 1 and told[0][1] else None


def _light_call(lights: tuple[Any, ...], others: tuple[Any, ...]) -> Call | None:
    """The call that adds or removes a light; None if more than that was changed."""
    if others[:-1] == lights:
        fields = to_plain(others[-1])
        return Call("with_new_light", (str(fields.pop("name")),), fields)
    removed = [light for light in lights if light not in others]
    if len(removed) == 1 and tuple(light for light in lights if light is not removed[0]) == others:
        return Call("without_light", (removed[0].name,), {})
    return None


def literal(value: object) -> str:
    """A plain value as Python writes it, and `ast.literal_eval` reads it; infinity is 1e999.

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


def _arguments(names: tuple[str, ...], changes: Mapping[str, object]) -> str:
    return ", ".join([*map(literal, names), *(f"{key}={literal(value)}" for key, value in changes.items())])


def _options(source: Source) -> dict[str, object]:
    scale = {} if source.scale == 1 else {"scale": source.scale}
    return {"up": source.up, "surfaces": source.surfaces, **scale}
