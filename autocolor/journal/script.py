"""The journal of a session: a Python script, one line a step, that gives the same scenes when it is run.

    scene = autocolor.read_scene('/home/ann/coupe', up='z', surfaces='materials')
    scene = scene.replace(parts=[...], surfaces=[...], lights=[...], view={...}, ambient=0.1, ...)
    checksum = '9f2c...'
    studio = autocolor.Studio(scene, Ramtek9300())
    studio.recolor('body', blend=0.5)
    studio.edit(studio.scene.with_light('key', on=False), same_step=True)
    studio.undo()

What a step changed is told by the columns (see `difference`).
"""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Mapping
from typing import Any, Final, NamedTuple

import numpy as np

from autocolor.errors import InputError
from autocolor.files.plain_scene import plain_scene
from autocolor.journal.history import Edit, History, Step
from autocolor.scene.columns.column import Row, fields_of
from autocolor.scene.columns.rows import difference, plain
from autocolor.scene.creation import SurfaceSource
from autocolor.scene.scene import Scene
from autocolor.scene.surfaces import Paint

HEADER: Final = (
    '"""A session of autocolor: run it with Python, or recover it with `autocolor view --recover`."""',
    "import autocolor",
    "from ramtek_emu import Ramtek9300",
)
STUDIO: Final = "studio = autocolor.Studio(scene, Ramtek9300())"

ROW_METHODS: Final = {"parts": "with_part", "surfaces": "with_surface", "lights": "with_light"}
"""The methods of a scene that change one row of a table."""

SHORT: Final = {
    "with_surface": "surface",
    "with_light": "light",
    "with_view": "view",
    "with_new_light": "add_light",
    "without_light": "remove_light",
}
"""The methods of a studio that edit its scene by one of a scene."""


class Source(NamedTuple):
    """What the first scene of a session is read from, and how (see `read_scene`)."""

    path: str
    up: str = "z"
    surfaces: SurfaceSource = "materials"


class Call(NamedTuple):
    """A call of a method of a scene, by which an edit makes another."""

    method: str
    names: tuple[str, ...]
    changes: Mapping[str, object]


def journal_text(history: History, source: Source) -> str:
    """The journal of a session as a script.

    Raises InputError if the mesh was changed, which no line tells: save the scene, and begin with that.
    """
    return "\n".join([*first_lines(history.start, source), *map(step_line, history.steps), ""])


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
        f"scene = scene.replace({_arguments((), plain(start))})",
        f"checksum = {literal(checksum_of(start))}",
        STUDIO,
    ]


def step_line(step: Step) -> str:
    """The line of a journal that takes a step. Raises InputError if the mesh was changed."""
    if not isinstance(step, Edit):
        return f"studio.{step}()"
    _refuse_another_mesh(step.before, step.after)
    method, names, changes = call_between(step.before, step.after)
    arguments = _arguments(names, changes)
    if step.joins:
        return f"studio.edit(studio.scene.{method}({arguments}), same_step=True)"
    if method == "with_surface" and changes.keys() <= fields_of(Paint).keys():
        return f"studio.recolor({arguments})"
    if method in SHORT:
        return f"studio.{SHORT[method]}({arguments})"
    return f"studio.edit(studio.scene.{method}({arguments}))"


def call_between(before: Scene, after: Scene) -> Call:
    """The narrowest call of a method of a scene that makes another of it."""
    changes = difference(before, after)
    if len(changes) == 1:
        (table,) = changes
        if table == "view":
            return Call("with_view", (), difference(before.view, after.view))
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
        fields = plain(others[-1])
        return Call("with_new_light", (str(fields.pop("name")),), fields)
    removed = [light for light in lights if light not in others]
    if len(removed) == 1 and tuple(light for light in lights if light is not removed[0]) == others:
        return Call("without_light", (removed[0].name,), {})
    return None


def checksum_of(scene: Scene) -> str:
    """The SHA-256 of all values of a scene, its mesh included, in hexadecimal digits."""
    digest = hashlib.sha256(json.dumps(plain_scene(scene), sort_keys=True).encode())
    mesh = scene.mesh
    for array, kind in ((mesh.coordinates, "<f8"), (mesh.node_numbers, "<i8"), (mesh.part_numbers, "<i8")):
        digest.update(np.ascontiguousarray(array, kind).tobytes())
    return digest.hexdigest()


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
    return {"up": source.up, "surfaces": source.surfaces}


def _refuse_another_mesh(before: Row, after: Row) -> None:
    if vars(before)["mesh"] is not vars(after)["mesh"]:
        raise InputError(
            "a journal must keep to one mesh, and this session changed it; save the scene, and begin with it"
        )
