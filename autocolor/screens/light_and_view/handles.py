"""The points of the eye and the lights that can be moved in the three views, and their handles."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any, Final, NamedTuple

from autocolor.checks import Vector
from autocolor.scene.lights import Light
from autocolor.scene.scene import Scene
from autocolor.screens.light_and_view.marks import arrow_end, flap_marks
from autocolor.screens.light_and_view.orthographic_views import (
    AXES,
    SIDES,
    OrthographicViews,
    PointMark,
    ViewSide,
)
from autocolor.screens.picture.picture_edits import target_of
from autocolor.screens.screen import Handle

EYE: Final = "eye"
TARGET: Final = "target"
LIGHT: Final = "light"
AIM: Final = "aim"
DIRECTION: Final = "direction"
FLAP: Final = "flap"
"""The kinds of movable points."""

BETWEEN: Final = 14
"""Assumed: elements or lines between neighboring handles along the line of a flap."""


class MovablePoint(NamedTuple):
    """A point that can be moved in a view: the eye, its target, or a point of a light.

    `side` is the name of the view. A flap has an axis and an end.
    """

    what: str
    side: str = ""
    light: str = ""
    axis: str = ""
    end: str = ""

    @property
    def label(self) -> str:
        """The name of the point in the message line."""
        if not self.light:
            return self.what
        if self.what == FLAP:
            return f"{self.light}: flap {self.axis}, {self.end}"
        return self.light if self.what == LIGHT else f"{self.light}: {self.what}"

    def point_in(self, scene: Scene, views: OrthographicViews) -> Vector | None:
        """The place of the point in a scene; None if the scene does not have the point."""
        if self.what == EYE:
            return scene.view.eye
        if self.what == TARGET:
            return target_of(scene)
        light = next((each for each in scene.lights_in_world if each.name == self.light), None)
        if light is None or self.what == LIGHT:
            return None if light is None else light.position
        if self.what == FLAP:
            flap = getattr(light.flaps, self.axis)
            value = math.inf if flap is None else float(getattr(flap, self.end))
            return (value, value, value) if math.isfinite(value) else None
        return arrow_end(views, light)

    def put(self, scene: Scene, point: Vector) -> Scene:
        """The scene with the movable point at `point`. An end of a flap does not pass the other end."""
        if self.what == EYE:
            return scene.with_view(eye=point)
        if self.what == TARGET and scene.view.target is not None:
            return scene.with_view(target=point)
        if self.what == TARGET:
            return scene.with_view(direction=_step(scene.view.eye, point))
        if self.what == LIGHT:
            return scene.with_light_in_world(self.light, position=point)
        if self.what == AIM:
            return scene.with_light_in_world(self.light, aim=point)
        if self.what == DIRECTION:
            start = scene.lights_in_world[self.light].position
            return scene.with_light_in_world(self.light, direction=_step(start, point))
        value, flap = point[AXES.index(self.axis)], getattr(scene.lights[self.light].flaps, self.axis)
        value = min(value, flap.maximum) if self.end == "minimum" else max(value, flap.minimum)
        flaps: Any = {self.axis: {self.end: value}}
        return scene.with_light(self.light, flaps=flaps)


def movable_of(handle: Handle) -> MovablePoint:
    """The point that a handle of this screen moves."""
    assert isinstance(handle.key, MovablePoint)
    return handle.key


def side_of(movable: MovablePoint) -> ViewSide:
    """The view in which a handle moves its point."""
    return next(side for side in SIDES if side.name == movable.side)


def handles_in(scene: Scene, views: OrthographicViews, chosen: str) -> list[Handle]:
    """All handles. The chosen light or eye is last: of handles at one place, the last is grabbed.

    `chosen` is the name of a light, or empty for the eye.
    """
    eye = [*_handles(MovablePoint(TARGET), scene, views), *_handles(MovablePoint(EYE), scene, views)]
    handles = eye if chosen else []
    for light in sorted(scene.lights, key=lambda each: each.name == chosen):
        if light.name == chosen:
            handles += _handles_of_flaps(light, views)
        if light.axis is not None:
            what = AIM if light.aim is not None else DIRECTION
            handles += _handles(MovablePoint(what, light=light.name), scene, views)
        handles += _handles(MovablePoint(LIGHT, light=light.name), scene, views)
    return handles if chosen else handles + eye


def mark_of(movable: MovablePoint, side: ViewSide, scene: Scene, views: OrthographicViews) -> PointMark:
    """The mark of a point in a view: of the eye and of a light, an arrow at the edge if it is outside."""
    point = movable.point_in(scene, views)
    assert point is not None
    if movable.what == EYE:
        return views.mark(side, point, target_of(scene))
    if movable.what == LIGHT:
        return views.mark(side, point, arrow_end(views, scene.lights_in_world[movable.light]))
    return PointMark(*(views.position(side, point),) * 2)


def _handles(movable: MovablePoint, scene: Scene, views: OrthographicViews) -> Iterator[Handle]:
    """The handles of a point in the views that show it or have an arrow to it."""
    point = movable.point_in(scene, views)
    assert point is not None
    label = f"{movable.label}: {point_text(point, views)}"
    for side in SIDES:
        element, line = (round(each) for each in mark_of(movable, side, scene, views).place)
        if side.area.has(element, line):
            yield Handle(movable._replace(side=side.name), element, line, label)


def _handles_of_flaps(light: Light, views: OrthographicViews) -> Iterator[Handle]:
    """The handles along the lines of a light's flaps."""
    for side in SIDES:
        for mark in flap_marks(views, side, light):
            movable = MovablePoint(FLAP, side.name, light.name, AXES[mark.axis], mark.end)
            left, top, right, bottom = (round(each) for each in mark.stroke[0])
            for along in range(BETWEEN // 2, max(right - left, bottom - top), BETWEEN):
                is_level = mark.axis == side.up
                place = (left + along, top) if is_level else (left, top + along)
                yield Handle(movable, *place, movable.label)


def point_text(point: Vector, views: OrthographicViews) -> str:
    """The coordinates of a point, for the message line, as exact as the views can place it.

    >>> point_text((4.02, -1.60813, 5.0), OrthographicViews((0.0, 0.0, 0.0), 20.0))
    'x 4.02  y -1.61  z 5'
    """
    return "  ".join(f"{axis} {views.rounded(value):g}" for axis, value in zip(AXES, point, strict=True))


def _step(start: Vector, end: Vector) -> Vector:
    """The direction from a point to another."""
    return end[0] - start[0], end[1] - start[1], end[2] - start[2]
