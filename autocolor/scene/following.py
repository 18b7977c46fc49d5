"""Lights that follow the eye or the aim of another light, and half-spaces that follow their light.

Paper: Figure 7 has one point light at the eye. Such a light stays there in every view. The position, the aim
and the direction of a light that follows something are coordinates of a frame:

- The frame of the eye: its origin is the eye. X points to the right in the picture, y is the view direction,
  and z points up in the picture. A light at (0, 0, 0) is at the eye itself.
- The frame of another light: its origin is the aim of that light. Its axes are the axes of the world.

A half-space that its light carries, like a barn door, is in the frame of the light: its origin is the light.
Flaps stay in object coordinates. A light may be named "eye", and may follow others; but no light follows it,
because `follows` = "eye" means the eye. Departs: a light may follow the eye, or what another light is aimed
at; the paper's lights are fixed to the object.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from graphlib import CycleError, TopologicalSorter
from typing import Final, NamedTuple

import numpy as np

from autocolor.arrays import Floats
from autocolor.checks import Vector, brief
from autocolor.scene.columns import Problem, Row, fields_of, with_values
from autocolor.scene.kinds import VectorKind
from autocolor.scene.lights import EYE, HalfSpace, Light
from autocolor.scene.view import View

DOWN_TO_UP: Final = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])
"""From the axes of camera space, right, down and forward, to right, forward and up."""

NEAREST_AIM: Final = 1e-9
"""Assumed: a fraction of the largest coordinate. A nearer aim has too few digits to give a direction."""

LEAST_COORDINATE: Final = 1e-30
"""The least size of coordinates for NEAREST_AIM, so that a fraction of it is never 0."""


class Frame(NamedTuple):
    """A frame of coordinates, which turns and moves with the eye or a light: its origin and its three axes.

    `origin` is (3,) and `axes` (3, 3), whose rows are the unit vectors of x, y and z, in world coordinates.
    """

    origin: Floats
    axes: Floats

    def point_from_world(self, point: Vector) -> Vector:
        """The coordinates in the frame of a point of the world."""
        return _vector(self.axes @ (np.array(point) - self.origin))

    def direction_to_world(self, direction: Vector) -> Vector:
        """The direction in world axes, given in the axes of the frame."""
        return _vector(np.array(direction) @ self.axes)

    def to_world(self, row: Row) -> dict[str, Vector]:
        """The points and directions of a row of the frame in the world, by column, without None values."""
        return moved_vectors(
            row, lambda each: _vector(self.origin + np.array(each) @ self.axes), self.direction_to_world
        )

    def from_world(self, row: Row) -> dict[str, Vector]:
        """The points and directions of a row of the world in the frame, by column, without None values."""
        return moved_vectors(row, self.point_from_world, lambda each: _vector(self.axes @ np.array(each)))


def moved_vectors(
    row: Row, point: Callable[[Vector], Vector], direction: Callable[[Vector], Vector]
) -> dict[str, Vector]:
    """The vectors of a row by column, converted by `point` or `direction`; None values are left out."""
    return {
        name: (direction if is_direction else point)(vars(row)[name])
        for name, is_direction in vector_columns(type(row)).items()
        if vars(row)[name] is not None
    }


def vector_columns(row_class: type[Row]) -> Mapping[str, bool]:
    """The names of the columns of a row class that are vectors, and whether each is a direction."""
    kinds = {name: field.kind for name, field in fields_of(row_class).items()}
    return {name: kind.has_length for name, kind in kinds.items() if isinstance(kind, VectorKind)}


def eye_frame(view: View) -> Frame:
    """The frame of the eye: x to the right, y along the view direction, z up in the picture."""
    return Frame(np.array(view.eye), DOWN_TO_UP @ view.axes)


def light_frame(light: Light) -> Frame:
    """The frame of a light that is in world coordinates, for the half-spaces that it carries.

    Its origin is the light. Y is the light's direction, x horizontal to the right of it, and z up. A point
    source has the axes of the world. Assumed: a vertical direction has the axes of such a view.
    """
    axis = light.axis
    if axis is None:
        return Frame(np.array(light.position), np.eye(3))
    # A light that follows another may be farther away than an eye may.
    return Frame(np.array(light.position), eye_frame(View((0.0, 0.0, 0.0), direction=axis)).axes)


def frame_of(light: Light, world: Mapping[str, Light], view: View) -> Frame | None:
    """The frame that a light of a scene follows; None for the world.

    `world` must have the light that it follows, if any, in world coordinates.
    """
    if light.follows is None:
        return None
    if light.follows == EYE:
        return eye_frame(view)
    aim = world[light.follows].aim
    assert aim is not None
    return Frame(np.array(aim), np.eye(3))


def in_world(light: Light, frame: Frame | None) -> Light:
    """The light of a frame converted to world coordinates; it then follows nothing."""
    if frame is None:
        return light
    vectors = frame.to_world(light)
    if light.aim is not None:
        vectors["aim"] = _distant_aim(vectors["aim"], vectors["position"], light, frame)
    return with_values(light, {**vectors, "follows": None})


def _distant_aim(aim: Vector, position: Vector, light: Light, frame: Frame) -> Vector:
    """The aim of a light of a frame; aim and position are in world coordinates.

    If rounding put the aim onto the position, or close to it, it is moved ahead.
    """
    nearest = NEAREST_AIM * max(*map(abs, position), LEAST_COORDINATE)
    if math.dist(aim, position) >= nearest or light.axis is None:
        return aim
    x, y, z = (a + nearest * b for a, b in zip(position, frame.direction_to_world(light.axis), strict=True))
    return x, y, z


def in_frame(light: Light, frame: Frame | None, follows: str | None) -> Light:
    """A light of the world converted to the frame that it shall follow; the inverse of `in_world`."""
    if frame is None:
        return light
    return with_values(light, {**frame.from_world(light), "follows": follows})


def lights_in_world(lights: tuple[Light, ...], view: View) -> tuple[Light, ...]:
    """The lights of a scene in world coordinates. Lights that follow nothing are unchanged."""
    if all(light.follows is None for light in lights):
        return lights
    by_name = {light.name: light for light in lights}
    world: dict[str, Light] = {}
    # A light comes after the light that it follows.
    for name in TopologicalSorter(_followed(lights)).static_order():
        light = by_name[name]
        world[name] = in_world(light, frame_of(light, world, view))
    return tuple(world[light.name] for light in lights)


def _followed(lights: Sequence[Light]) -> dict[str, list[str]]:
    """The lights by name, each with the light of the table that it follows, or with none."""
    names = {light.name for light in lights} - {EYE}
    return {light.name: [str(light.follows)] if light.follows in names else [] for light in lights}


def detached(half_space: HalfSpace, light: Light) -> HalfSpace:
    """The half-space of a light of the world in world coordinates; unchanged if it is not carried."""
    if not half_space.carried:
        return half_space
    return with_values(half_space, {**light_frame(light).to_world(half_space), "carried": False})


def attached(half_space: HalfSpace, light: Light) -> HalfSpace:
    """The half-space carried by its light, which is in world coordinates; its plane stays where it is."""
    if half_space.carried:
        return half_space
    return with_values(half_space, {**light_frame(light).from_world(half_space), "carried": True})


def followers_of(name: str, lights: Sequence[Light]) -> list[str]:
    """The names of the lights that directly follow a light, given by its name."""
    return [light.name for light in lights if light.follows == name != EYE]


def names_to_follow(light: Light, lights: Sequence[Light]) -> list[str]:
    """The names of the other lights that a light can follow: they have an aim and do not follow the light."""
    followed, excluded = _followed(lights), {light.name, EYE}
    for name in TopologicalSorter(followed).static_order():
        if excluded.intersection(followed[name]):
            excluded.add(name)
    return [each.name for each in lights if each.aim is not None and each.name not in excluded]


def following_problems(lights: Sequence[Light]) -> Iterator[Problem]:
    """A problem for a circle of lights that follow each other, and for each light followed without an aim.

    The check of references finds names that are not in the table.
    """
    by_name, followed = {light.name: light for light in lights}, _followed(lights)
    try:
        TopologicalSorter(followed).prepare()
    except CycleError as error:
        circle = error.args[1][:0:-1]
        start = circle.index(next(name for name in by_name if name in circle))
        circle = [*circle[start:], *circle[: start + 1]]
        path = " to ".join(map(repr, circle))
        rule = f"must not lead back to it, as {brief(path)} does; change one of them"
        yield Problem((), f"light {circle[0]!r}: follows {rule}")
    for name, others in followed.items():
        for other in others:
            if by_name[other].aim is None:
                rule = f"must be a light with an aim, not {other!r} without one; give it an aim"
                yield Problem((), f"light {name!r}: follows {rule}")


def _vector(components: Floats) -> Vector:
    x, y, z = components.tolist()
    return x, y, z
