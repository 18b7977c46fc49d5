"""Copies of a light: under a free name, and mirrored to the other side of the object."""

from __future__ import annotations

import re
from collections.abc import Collection
from dataclasses import replace
from typing import Final

from autocolor.checks import Vector, either
from autocolor.errors import UsageError
from autocolor.scene.lights.flaps import Flap
from autocolor.scene.lights.light import Light

AXES: Final = ("x", "y", "z")
"""The axes of the world in the order of coordinates."""

NUMBER_AT_END: Final = re.compile(r" [0-9]{1,9}\Z")


def free_name(name: str, taken: Collection[str]) -> str:
    """The name if it is free, else with the lowest number from 2 that makes it free.

    >>> free_name("key", ["key", "key 2"]), free_name("key 2", ["key", "key 2"]), free_name("rim", ["key"])
    ('key 3', 'key 3', 'rim')
    """
    if name not in taken:
        return name
    stem, number = NUMBER_AT_END.sub("", name), 2
    while f"{stem} {number}" in taken:
        number += 1
    return f"{stem} {number}"


def mirrored(light: Light, name: str, axis: str, about: float) -> Light:
    """The light mirrored in the plane where the coordinate of an axis is `about`, under another name.

    Its position, its aim or direction, and the flap of that axis are mirrored. Raises UsageError for an axis
    that is not x, y or z, InputError where a coordinate would be too large.
    """
    place = axis_number(axis)
    direction = light.direction
    if direction is not None:
        direction = _with_component(direction, place, 0.0 - direction[place])
    flap: Flap | None = getattr(light.flaps, axis)
    if flap is not None:
        flap = Flap(2 * about - flap.maximum, 2 * about - flap.minimum, flap.on)
    return light.replace(
        name=name,
        position=_reflected(light.position, place, about),
        direction=direction,
        aim=None if light.aim is None else _reflected(light.aim, place, about),
        flaps=replace(light.flaps, **{axis: flap}),
    )


def axis_number(axis: str) -> int:
    """The number of an axis, 0 to 2. Raises UsageError if there is none of that name."""
    if axis not in AXES:
        raise UsageError(f"an axis must be {either(AXES)}, not {axis!r}")
    return AXES.index(axis)


def _reflected(point: Vector, place: int, about: float) -> Vector:
    return _with_component(point, place, 2 * about - point[place])


def _with_component(vector: Vector, place: int, component: float) -> Vector:
    x, y, z = (component if number == place else each for number, each in enumerate(vector))
    return x, y, z
