"""Grips: what can be taken hold of in the three views, and the scene after it was put elsewhere."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any, Final, NamedTuple

from autocolor.checks import Vector
from autocolor.scene.lights import Light
from autocolor.scene.scene import Scene
from autocolor.screens.light_and_view.marks import arrow_end, flap_marks
from autocolor.screens.light_and_view.orthographic_views import AXES, SIDES, OrthographicViews
from autocolor.screens.picture.picture_edits import target_of
from autocolor.screens.screen import Handle

EYE: Final = "eye"
TARGET: Final = "target"
LIGHT: Final = "light"
AIM: Final = "aim"
DIRECTION: Final = "direction"
FLAP: Final = "flap"
"""What a grip moves."""

BETWEEN: Final = 14
"""Assumed: elements or lines from one place where the line of a flap can be taken hold of to the next."""


class Grip(NamedTuple):
    """What is moved, in a view by its name: the eye, its target, or something of a light."""

    what: str
    side: str = ""
    light: str = ""
    axis: str = ""
    end: str = ""

    @property
    def label(self) -> str:
        """What the message line calls it."""
        if not self.light:
            return self.what
        if self.what == FLAP:
            return f"{self.light}: flap {self.axis}, {self.end}"
        return self.light if self.what == LIGHT else f"{self.light}: {self.what}"

    def point_in(self, scene: Scene, views: OrthographicViews) -> Vector | None:
        """The point that it stands for; None if it is gone."""
        if self.what == EYE:
            return scene.view.eye
        if self.what == TARGET:
            return target_in(scene)
        light = next((each for each in scene.lights_in_world if each.name == self.light), None)
        if light is None or self.what == LIGHT:
            return None if light is None else light.position
        if self.what == FLAP:
            flap = getattr(light.flaps, self.axis)
            value = math.inf if flap is None else float(getattr(flap, self.end))
            return (value, value, value) if math.isfinite(value) else None
        return arrow_end(views, light)

    def put(self, scene: Scene, point: Vector) -> Scene:
        """The scene with what it moves at a point. An end of a flap does not pass the other one."""
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
            start = scene.light_in_world(self.light).position
            return scene.with_light_in_world(self.light, direction=_step(start, point))
        value, flap = point[AXES.index(self.axis)], getattr(scene.light(self.light).flaps, self.axis)
        value = min(value, flap.maximum) if self.end == "minimum" else max(value, flap.minimum)
        flaps: Any = {self.axis: {self.end: value}}
        return scene.with_light(self.light, flaps=flaps)


def grip_of(handle: Handle) -> Grip:
    """What a handle of this screen moves."""
    assert isinstance(handle.key, Grip)
    return handle.key


def handles_in(scene: Scene, views: OrthographicViews, chosen: str) -> list[Handle]:
    """Everything that can be taken hold of; what is chosen comes last, and goes before all others.

    `chosen` is the name of a light, or empty for the eye.
    """
    eye = [*_handles(Grip(TARGET), scene, views), *_handles(Grip(EYE), scene, views)]
    found = eye if chosen else []
    for light in sorted(scene.lights, key=lambda each: each.name == chosen):
        if light.name == chosen:
            found += _handles_of_flaps(light, views)
        if light.axis is not None:
            what = AIM if light.aim is not None else DIRECTION
            found += _handles(Grip(what, light=light.name), scene, views)
        found += _handles(Grip(LIGHT, light=light.name), scene, views)
    return found if chosen else found + eye


def _handles(grip: Grip, scene: Scene, views: OrthographicViews) -> Iterator[Handle]:
    """The handles of something in the views that show it."""
    point = grip.point_in(scene, views)
    assert point is not None
    label = f"{grip.label}: {told(point)}"
    for side in SIDES:
        element, line = (round(each) for each in views.position(side, point))
        if side.area.has(element, line):
            yield Handle(grip._replace(side=side.name), element, line, label)


def _handles_of_flaps(light: Light, views: OrthographicViews) -> Iterator[Handle]:
    """The handles along the lines of a light's flaps."""
    for side in SIDES:
        for mark in flap_marks(views, side, light):
            grip = Grip(FLAP, side.name, light.name, AXES[mark.axis], mark.end)
            left, top, right, bottom = (round(each) for each in mark.stroke[0])
            for along in range(BETWEEN // 2, max(right - left, bottom - top), BETWEEN):
                is_level = mark.axis == side.up
                place = (left + along, top) if is_level else (left, top + along)
                yield Handle(grip, *place, grip.label)


def told(point: Vector) -> str:
    """A point as the message line tells it.

    >>> told((4.02, -6.1, 5.0))
    'x 4.02  y -6.1  z 5'
    """
    return "  ".join(f"{axis} {value:.6g}" for axis, value in zip(AXES, point, strict=True))


def target_in(scene: Scene) -> Vector:
    """The target of the view; without one, the point at which it is as deep as the object."""
    x, y, z = target_of(scene).tolist()
    return x, y, z


def _step(start: Vector, end: Vector) -> Vector:
    """The direction from a point to another."""
    return end[0] - start[0], end[1] - start[1], end[2] - start[2]
