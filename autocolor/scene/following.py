"""Lights that follow: where a light is that is fixed to the eye, or to the aim of another light.

Paper: Figure 7 has one point light at the eye. Such a light stays there in every view. The position, the aim
and the direction of a light that follows something are told in the coordinates of a frame:

- that of the eye: its origin is the eye; x is to the right in the picture, y the view direction, z up in the
  picture. A light at (0, 0, 0) is at the eye itself.
- that of another light: its origin is the point at which that is aimed; its axes are those of the world.

A light of a scene may be named like the eye; it can follow others, but what follows "eye" follows the eye.
Flaps stay in object coordinates. Departs: the paper's lights are all fixed to the object.
"""

from __future__ import annotations

import math
import re
from collections.abc import Collection, Container, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any, Final, NamedTuple

import numpy as np

from autocolor.arrays import Floats
from autocolor.checks import Vector, either
from autocolor.errors import UsageError
from autocolor.scene.columns import REFUSED, Problem, with_values
from autocolor.scene.kinds import VectorKind
from autocolor.scene.lights import EYE, Flap, HalfSpace, Light
from autocolor.scene.view import View

DOWN_TO_UP: Final = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])
"""From the axes of camera space, right, down and forward, to right, forward and up."""

NEAREST_AIM: Final = 1e-9
"""Assumed: of the largest coordinate; an aim nearer than that has too few digits to tell a direction."""

LEAST_COORDINATE: Final = 1e-30
"""Coordinates below this count as large as this, so that a fraction of them is not 0."""

MOST_TOLD: Final = 8
"""Assumed: names of a circle that a message has room for."""


class Frame(NamedTuple):
    """A place and the directions of three axes there: coordinates that turn and move with something.

    `origin` is (3,) and `axes` (3, 3), whose rows are the unit vectors of x, y and z, in world coordinates.
    """

    origin: Floats
    axes: Floats

    def point_to_world(self, point: Vector) -> Vector:
        """The world coordinates of a point of the frame."""
        return _vector(self.origin + np.array(point) @ self.axes)

    def point_from_world(self, point: Vector) -> Vector:
        """The coordinates in the frame of a point of the world."""
        return _vector(self.axes @ (np.array(point) - self.origin))

    def direction_to_world(self, direction: Vector) -> Vector:
        """The direction in world axes of one in those of the frame."""
        return _vector(np.array(direction) @ self.axes)

    def direction_from_world(self, direction: Vector) -> Vector:
        """The direction in the axes of the frame of one in world axes."""
        return _vector(self.axes @ np.array(direction))


def eye_frame(view: View) -> Frame:
    """The frame of the eye: x to the right, y along the view direction, z up in the picture."""
    return Frame(np.array(view.eye), DOWN_TO_UP @ view.axes)


def light_frame(light: Light) -> Frame:
    """The frame of a light that is in world coordinates, for what it carries.

    Its origin is the light. Y is the light's direction, x horizontal to the right of it, and z up. A point
    source has the axes of the world. Assumed: for a vertical direction, what `View.axes` has.
    """
    axis = light.axis
    if axis is None:
        return Frame(np.array(light.position), np.eye(3))
    # A light that follows another may be farther away than an eye may.
    return Frame(np.array(light.position), eye_frame(View((0.0, 0.0, 0.0), direction=axis)).axes)


def frame_of(light: Light, world: Mapping[str, Light], view: View) -> Frame | None:
    """The frame in which a light of a scene is told; None for the world's.

    `world` has the light that it follows, if any, in world coordinates.
    """
    if light.follows is None:
        return None
    if light.follows == EYE:
        return eye_frame(view)
    aim = world[light.follows].aim
    assert aim is not None
    return Frame(np.array(aim), np.eye(3))


def in_world(light: Light, frame: Frame | None) -> Light:
    """The light of a frame in world coordinates, where it follows nothing."""
    if frame is None:
        return light
    position = frame.point_to_world(light.position)
    return with_values(
        light,
        {
            "position": position,
            "aim": None if light.aim is None else _aim_in_world(light, light.aim, position, frame),
            "direction": None if light.direction is None else frame.direction_to_world(light.direction),
            "follows": None,
        },
    )


def _aim_in_world(light: Light, aim: Vector, position: Vector, frame: Frame) -> Vector:
    """The aim of a light of a frame in world coordinates, in which the light is at a position.

    One that rounding moves onto the position, or close to it, is farther ahead.
    """
    there = frame.point_to_world(aim)
    nearest = NEAREST_AIM * max(*map(abs, position), LEAST_COORDINATE)
    if math.dist(there, position) >= nearest or light.axis is None:
        return there
    x, y, z = (a + nearest * b for a, b in zip(position, frame.direction_to_world(light.axis), strict=True))
    return x, y, z


def in_frame(light: Light, frame: Frame | None, follows: str | None) -> Light:
    """A light of the world in the coordinates of the frame of what it is to follow; inverse of `in_world`."""
    if frame is None:
        return light
    told = {name: vars(light)[name] for name in ("position", "aim", "direction")}
    return with_values(light, {**changes_in_frame(told, frame), "follows": follows})


def lights_in_world(lights: tuple[Light, ...], view: View) -> tuple[Light, ...]:
    """The lights of a scene in world coordinates; the same ones where they follow nothing."""
    if all(light.follows is None for light in lights):
        return lights
    by_name = {light.name: light for light in lights}
    world: dict[str, Light] = {}
    for light in lights:
        # Walk to what follows nothing else that is to be found, and come back.
        chain = [light]
        while chain[-1].follows not in (None, EYE) and chain[-1].follows not in world:
            chain.append(by_name[str(chain[-1].follows)])
        for each in reversed(chain):
            world[each.name] = in_world(each, frame_of(each, world, view))
    return tuple(world[light.name] for light in lights)


def changes_in_frame(changes: Mapping[str, Any], frame: Frame | None) -> dict[str, Any]:
    """Changes of a light whose places and directions are in world coordinates, as changes in a frame.

    What is no vector stays, to be refused by the row.
    """
    turned = dict(changes)
    if frame is not None:
        turns = {
            "position": frame.point_from_world,
            "aim": frame.point_from_world,
            "direction": frame.direction_from_world,
        }
        for name in turns.keys() & turned.keys():
            vector: Any = VectorKind().validated(turned[name], (name,), [])
            if vector is not REFUSED:
                turned[name] = turns[name](vector)
    return turned


def followers_of(name: str, lights: Sequence[Light]) -> list[str]:
    """The names of the lights that follow the light of a name, not those that follow them in turn."""
    return [light.name for light in lights if light.follows == name != EYE]


def names_to_follow(light: Light, lights: Sequence[Light]) -> list[str]:
    """The names of the other lights that a light can follow: those with an aim that do not follow it."""
    by_name = {each.name: each for each in lights}
    return [
        each.name
        for each in lights
        if each.aim is not None and each.name != EYE and light.name not in _path(each, by_name)
    ]


def following_problems(lights: Sequence[Light]) -> Iterator[Problem]:
    """The problems of lights that follow each other in a circle, each told once, or one that has no aim.

    Names that are not in the table are left to the check of references.
    """
    by_name = {light.name: light for light in lights}
    clear: set[str] = set()
    for light in lights:
        if light.follows in (None, EYE) or str(light.follows) not in by_name:
            continue
        path = _path(light, by_name, clear)
        circle, followed = path[path.index(path[-1]) :], by_name[str(light.follows)]
        if len(circle) > 1:
            rule = f"must not lead back to it, as {_told(circle)} does; change one of them"
            yield Problem((), f"light {circle[0]!r}: follows {rule}")
        elif followed.aim is None:
            rule = f"must be a light with an aim, not {followed.name!r} without one; give it an aim"
            yield Problem((), f"light {light.name!r}: follows {rule}")
        clear.update(path)


def _path(light: Light, by_name: Mapping[str, Light], clear: Container[str] = ()) -> list[str]:
    """The names from a light to what follows no other light, is `clear`, or is on the path already."""
    path = {light.name: None}
    while True:
        follows = by_name[next(reversed(path))].follows
        if follows is None or follows == EYE or follows not in by_name:
            return list(path)
        if follows in path:
            return [*path, follows]
        if follows in clear:
            return list(path)
        path[follows] = None


def _told(path: Sequence[str]) -> str:
    """A path in words; of a long one, its beginning and its end.

    >>> _told(["key", "fill", "key"])
    "'key' to 'fill' to 'key'"
    """
    names = [repr(name) for name in path]
    if len(names) > MOST_TOLD:
        names = [*names[: MOST_TOLD - 2], "...", names[-1]]
    return " to ".join(names)


def _vector(components: Floats) -> Vector:
    x, y, z = components.tolist()
    return x, y, z


# -------------------- carried
# What a light carries, as barn doors are: half-spaces in the frame of the light, and in the world.
#
# The lights are in world coordinates here, where they follow nothing; see `following.lights_in_world`.


def set_down(half_space: HalfSpace, light: Light) -> HalfSpace:
    """The half-space of a light in world coordinates; the same one if it is not carried."""
    if not half_space.carried:
        return half_space
    frame = light_frame(light)
    return with_values(
        half_space,
        {
            "point": frame.point_to_world(half_space.point),
            "direction": frame.direction_to_world(half_space.direction),
            "carried": False,
        },
    )


def taken_up(half_space: HalfSpace, light: Light) -> HalfSpace:
    """The half-space in the frame of its light, carried from now on; its plane stays where it is."""
    if half_space.carried:
        return half_space
    frame = light_frame(light)
    return with_values(
        half_space,
        {
            "point": frame.point_from_world(half_space.point),
            "direction": frame.direction_from_world(half_space.direction),
            "carried": True,
        },
    )


# -------------------- light_copies
# Copies of a light: under a free name, and mirrored to the other side of the object.

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
