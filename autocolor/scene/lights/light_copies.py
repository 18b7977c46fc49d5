"""Copies of a light: under a free name, and mirrored to the other side of the object."""

from __future__ import annotations

import re
from collections.abc import Collection
from dataclasses import replace
from typing import Final

import numpy as np

from autocolor.checks import Vector, either
from autocolor.errors import UsageError
from autocolor.scene.lights.flaps import Flap
from autocolor.scene.lights.following import light_frame
from autocolor.scene.lights.half_spaces import HalfSpace
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

    Its position, its aim or direction, its half-spaces and the flap of that axis are mirrored. Raises
    UsageError for an axis that is not x, y or z, InputError where a coordinate would be too large.
    """
    place = axis_number(axis)
    direction = light.direction
    if direction is not None:
        direction = _reflected(direction, place, 0.0)
    flap: Flap | None = getattr(light.flaps, axis)
    if flap is not None:
        flap = flap.replace(minimum=2 * about - flap.maximum, maximum=2 * about - flap.minimum)
    copy = light.replace(
        name=name,
        position=_reflected(light.position, place, about),
        direction=direction,
        aim=None if light.aim is None else _reflected(light.aim, place, about),
        flaps=replace(light.flaps, **{axis: flap}),
    )
    return copy.replace(half_spaces=_mirrored_half_spaces(light, copy, place, about))


def _mirrored_half_spaces(light: Light, copy: Light, place: int, about: float) -> list[HalfSpace]:
    """The half-spaces of a light for its mirrored copy; those that are carried in the frame of the copy."""
    if not light.half_spaces:
        return []
    mirror = np.eye(3)
    mirror[place, place] = -1
    # Mirrored axes are left-handed: the frame of the copy has the opposite of one of them.
    turned = np.diag(light_frame(copy).axes @ mirror @ light_frame(light).axes.T) < 0
    found = []
    for half_space in light.half_spaces:
        point, direction = half_space.point, half_space.direction
        for axis in np.flatnonzero(turned).tolist() if half_space.carried else [place]:
            point = _reflected(point, axis, 0.0 if half_space.carried else about)
            direction = _reflected(direction, axis, 0.0)
        found.append(half_space.replace(point=point, direction=direction))
    return found


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
