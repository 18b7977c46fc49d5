"""Grips: what can be taken hold of in the three views, and the scene after it was put elsewhere."""

from __future__ import annotations

import math
from typing import Any, Final, NamedTuple

from autocolor.arrays import Floats
from autocolor.checks import Vector
from autocolor.scene.lights import Light
from autocolor.scene.scene import Scene
from autocolor.screens.light_and_view.light_marks import arrow_end, flap_marks
from autocolor.screens.light_and_view.orthographic_views import SIDES, OrthographicViews, Side
from autocolor.screens.orbit import target_of
from autocolor.screens.screen import Handle

AXES: Final = "xyz"

EYE: Final = "eye"
TARGET: Final = "target"
LIGHT: Final = "light"
AIM: Final = "aim"
DIRECTION: Final = "direction"
FLAP: Final = "flap"
"""What a grip moves."""

ALONG_FLAP: Final = (0.2, 0.5, 0.8)
"""Assumed: where the line of a flap can be taken hold of, as fractions of its length."""


class Grip(NamedTuple):
    """What is moved, in the view of a side: the eye, its target, or something of a light."""

    what: str
    side: str
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
            return vector(target_of(scene))
        light = next((each for each in scene.lights if each.name == self.light), None)
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
            return scene.with_light(self.light, position=point)
        if self.what == AIM:
            return scene.with_light(self.light, aim=point)
        if self.what == DIRECTION:
            return scene.with_light(self.light, direction=_step(scene.light(self.light).position, point))
        value, flap = point[AXES.index(self.axis)], getattr(scene.light(self.light).flaps, self.axis)
        value = min(value, flap.maximum) if self.end == "minimum" else max(value, flap.minimum)
        flaps: Any = {self.axis: {self.end: value}}
        return scene.with_light(self.light, flaps=flaps)


def handles_in(scene: Scene, views: OrthographicViews, chosen: str) -> list[Handle]:
    """Everything that can be taken hold of; the chosen light comes last, and goes before the others."""
    found: list[Handle] = []
    for side in SIDES:
        _add(found, Grip(TARGET, side.name), side, scene, views)
        _add(found, Grip(EYE, side.name), side, scene, views)
    for light in sorted(scene.lights, key=lambda each: each.name == chosen):
        for side in SIDES:
            if light.name == chosen:
                _add_flaps(found, light, side, views)
            if light.axis is not None:
                what = AIM if light.aim is not None else DIRECTION
                _add(found, Grip(what, side.name, light.name), side, scene, views)
            _add(found, Grip(LIGHT, side.name, light.name), side, scene, views)
    return found


def _add(found: list[Handle], grip: Grip, side: Side, scene: Scene, views: OrthographicViews) -> None:
    point = grip.point_in(scene, views)
    if point is not None:
        element, line = (round(each) for each in views.position(side, point))
        if side.area.has(element, line):
            found.append(Handle(grip, element, line, f"{grip.label}: {told(point)}"))


def _add_flaps(found: list[Handle], light: Light, side: Side, views: OrthographicViews) -> None:
    for mark in flap_marks(views, side, light):
        left, top, right, bottom = mark.stroke[0]
        grip = Grip(FLAP, side.name, light.name, AXES[mark.axis], mark.end)
        for share in ALONG_FLAP:
            element, line = left + share * (right - left), top + share * (bottom - top)
            found.append(Handle(grip, round(element), round(line), grip.label))


def told(point: Vector) -> str:
    """A point as the message line tells it.

    >>> told((4.02, -6.1, 5.0))
    'x 4.02  y -6.1  z 5'
    """
    return "  ".join(f"{axis} {value:.6g}" for axis, value in zip(AXES, point, strict=True))


def vector(values: Floats) -> Vector:
    """Three coordinates as plain numbers."""
    return float(values[0]), float(values[1]), float(values[2])


def _step(start: Vector, end: Vector) -> Vector:
    """The direction from a point to another."""
    return end[0] - start[0], end[1] - start[1], end[2] - start[2]
