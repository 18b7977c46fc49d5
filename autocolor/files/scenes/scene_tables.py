"""The view, the lights and the surfaces of a scene file, with every problem noted."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final

from autocolor.errors import InputError
from autocolor.files.scenes.problems import SceneProblems
from autocolor.files.scenes.scene_models import FlapKeys, FlapsKeys, LightKeys, SurfaceKeys, ViewKeys
from autocolor.files.scenes.toml_text import KeyPath
from autocolor.scene.defaults import default_surface
from autocolor.scene.lights import Flap, Light
from autocolor.scene.surfaces import MOST_SURFACES, Surface
from autocolor.scene.view import View

FAR: Final = (1.2345e28, -2.3456e28, 3.4567e28)
"""Stands for a vector that was refused, so that rules between keys are still checked with it."""


def view_of(problems: SceneProblems, table: object) -> View | None:
    """The view, or None after its problems were noted."""
    keys, wrong = problems.checked(("view",), ViewKeys, table)
    _fill(keys, wrong)
    if "eye" not in keys:
        return None
    try:
        return View(**keys)
    except InputError as error:
        problems.note_all(("view",), error, "view: ")
    return None


def _fill(keys: dict[str, Any], wrong: set[str]) -> None:
    """Put other vectors in the place of refused ones; other refused keys are as if left out."""
    for place, key in enumerate(("eye", "position", "direction", "target", "aim")):
        if key in wrong:
            keys[key] = tuple(component * (1 + place) for component in FAR)


def lights_of(problems: SceneProblems, rows: list[Any]) -> list[Light]:
    """The lights that have no problem; their names must differ."""
    lights: list[Light] = []
    names: dict[str, int] = {}
    for row, table in enumerate(rows):
        if problems.full:
            break
        path = ("lights", row)
        keys, wrong = problems.checked(path, LightKeys, table)
        if not isinstance(table, dict):
            continue
        _fill(keys, wrong)
        keys["flaps"] = _flaps(problems, path, keys.get("flaps", {}))
        name = keys.setdefault("name", "?")
        if name in names and "name" not in wrong:
            problems.note(
                (*path, "name"),
                f"name must differ from all others, not repeat lights[{names[name] + 1}]; rename it",
            )
        names.setdefault(name, row)
        try:
            lights.append(Light(**keys))
        except InputError as error:
            problems.note_all(path, error, f"light {name!r}: ")
    return lights


def _flaps(problems: SceneProblems, light: KeyPath, table: object) -> dict[str, Flap]:
    path = (*light, "flaps")
    axes, _ = problems.checked(path, FlapsKeys, table)
    flaps = {}
    for axis, flap in axes.items():
        keys, _ = problems.checked((*path, axis), FlapKeys, flap)
        try:
            flaps[axis] = Flap(**keys)
        except InputError as error:
            problems.note_all((*path, axis), error)
    return flaps


def surfaces_of(problems: SceneProblems, tables: Mapping[str, Any]) -> list[Surface]:
    """The given surfaces; a key that is left out is as in the surface that would be created."""
    surfaces: list[Surface] = []
    if len(tables) > MOST_SURFACES:
        problems.note(
            ("surfaces",),
            f"surfaces must be at most {MOST_SURFACES}, not {len(tables):,}; let parts share a surface",
        )
        return []
    for number, (name, table) in enumerate(tables.items()):
        keys, _ = problems.checked(("surfaces", name), SurfaceKeys, table)
        for group in _independent(keys):
            try:
                default_surface(name, number).replace(**group)
            except InputError as error:
                problems.note_all(("surfaces", name), error, f"surface {name!r}: ")
        if not problems.count:
            surfaces.append(default_surface(name, number).replace(**keys))
    return surfaces


def _independent(keys: Mapping[str, Any]) -> list[dict[str, Any]]:
    """The keys of a surface one by one: the tables of a surface stop at the first that has a problem."""
    return [{key: value} for key, value in keys.items()] or [{}]
