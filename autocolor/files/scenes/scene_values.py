"""A scene but its mesh as plain values, dictionaries and lists, and back: what a picture file has."""

from __future__ import annotations

import dataclasses
import math
from typing import Any, Final

from numpy.typing import NDArray

from autocolor.checks import known_fields
from autocolor.errors import InputError
from autocolor.scene.lights import Flap, Flaps, Light
from autocolor.scene.mesh import Mesh
from autocolor.scene.scene import Scene
from autocolor.scene.surfaces import MOST_SURFACES, Paint, Part, Reflectance, Surface
from autocolor.scene.view import View

MOST_KEYS: Final = 32
MOST_ROWS: Final = 1_000_000
"""Assumed: more keys than any table of ours has; as many rows as a header has values."""

PLAIN: Final = ("ambient", "scaling", "mapping", "contrast", "background", "name")


def values_of_scene(scene: Scene) -> dict[str, Any]:
    """The scene's tables but the mesh's arrays as values that JSON can hold; None and infinities left out."""
    values: dict[str, Any] = {name: getattr(scene, name) for name in PLAIN}
    values["mesh"] = {"part_names": scene.mesh.part_names, "crease_angle": scene.mesh.crease_angle}
    values["view"] = _stated(scene.view)
    for table in ("parts", "surfaces", "lights"):
        values[table] = [_stated(row) for row in getattr(scene, table)]
    return values


def scene_of_values(
    values: object,
    coordinates: NDArray[Any],
    node_numbers: NDArray[Any],
    part_numbers: NDArray[Any],
) -> Scene:
    """The scene of such values and the mesh's arrays; InputError where they break a rule."""
    tables = _table(values, "scene")
    names = {field.name for field in dataclasses.fields(Scene)}
    if set(tables) != names:
        raise InputError(f"scene: its tables must be {sorted(names)}, not {sorted(map(str, tables))}")
    mesh = _table(tables["mesh"], "mesh")
    part_names = _list(mesh.get("part_names"), "part_names")
    parts = tuple(_made(Part, row, "part") for row in _list(tables["parts"], "parts"))
    surfaces = tuple(_surface(row) for row in _list(tables["surfaces"], "surfaces", MOST_SURFACES))
    surface_names = {surface.name for surface in surfaces}
    if not isinstance(tables["name"], str):
        raise InputError(f"scene: its name must be a text, not {tables['name']!r}")
    # Before the scene looks for the nearest right name of each.
    for part in parts:
        if part.surface not in surface_names:
            raise InputError(f"part {part.name!r}: surface {part.surface!r} is not in the surface table")
    return Scene(
        Mesh(coordinates, node_numbers, part_numbers, tuple(part_names), mesh.get("crease_angle", math.nan)),
        parts,
        surfaces,
        tuple(_light(row) for row in _list(tables["lights"], "lights")),
        _made(View, tables["view"], "view"),
        **{name: tables[name] for name in PLAIN},
    )


def _surface(row: object) -> Surface:
    fields = _table(row, "surface")
    for name, cls in (("reflectance", Reflectance), ("paint", Paint)):
        fields[name] = _made(cls, fields.get(name), name)
    surface: Surface = _made(Surface, fields, "surface")
    return surface


def _light(row: object) -> Light:
    fields = _table(row, "light")
    flaps = {
        axis: _made(Flap, flap, "flap") for axis, flap in _table(fields.pop("flaps", {}), "flaps").items()
    }
    light: Light = _made(Light, {**fields, "flaps": _made(Flaps, flaps, "flaps")}, "light")
    return light


def _made(cls: type, row: object, place: str) -> Any:
    """A dataclass of a dictionary of its fields."""
    try:
        return cls(**known_fields(cls, _table(row, place), place))
    except TypeError as error:
        raise InputError(f"{place}: {error}") from None


def _table(value: object, place: str) -> dict[str, Any]:
    if not isinstance(value, dict) or len(value) > MOST_KEYS:
        raise InputError(f"{place}: it must be a table of at most {MOST_KEYS} keys, not {str(value)[:60]}")
    return dict(value)


def _list(value: object, place: str, most: int = MOST_ROWS) -> list[Any]:
    if not isinstance(value, list) or len(value) > most:
        raise InputError(f"{place}: it must be a list of at most {most:,} rows, not {str(value)[:60]}")
    return value


def _stated(row: Any) -> dict[str, Any]:
    """The fields of a dataclass, and of those in it, that are neither None nor infinite."""
    stated = {}
    for entry in dataclasses.fields(row):
        value = getattr(row, entry.name)
        if dataclasses.is_dataclass(value):
            value = _stated(value)
        if value is not None and not (isinstance(value, float) and math.isinf(value)):
            stated[entry.name] = value
    return stated
