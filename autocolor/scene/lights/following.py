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
from collections.abc import Container, Iterator, Mapping, Sequence
from typing import Any, Final, NamedTuple

import numpy as np

from autocolor.arrays import Floats
from autocolor.checks import Vector
from autocolor.scene.columns.problems import REFUSED, Problem
from autocolor.scene.columns.rows import with_values
from autocolor.scene.columns.value_kinds import VectorKind
from autocolor.scene.lights.light import EYE, Light
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
            vector: Any = VectorKind().held(turned[name], (name,), [])
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
