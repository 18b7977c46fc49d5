"""The points of the eye and the lights that can be moved in the three views, and their handles."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from typing import Any, Final, NamedTuple

from autocolor.checks import Vector
from autocolor.scene.lights import Light
from autocolor.scene.scene import Scene
from autocolor.screens.light_and_view.orthographic_views import (
    AXES,
    OrthographicViews,
    PointMark,
    ViewSide,
)
from autocolor.screens.picture.picture_edits import target_of
from autocolor.screens.screen import Handle
from autocolor.widgets.items import Area
from autocolor.widgets.widget import NOWHERE

EYE: Final = "eye"
TARGET: Final = "target"
LIGHT: Final = "light"
AIM: Final = "aim"
DIRECTION: Final = "direction"
FLAP: Final = "flap"
"""The kinds of movable points."""

DIRECTION_LENGTH: Final = 40.0
"""Assumed: the length of the arrow of a light with a direction and no aim, in elements."""

BETWEEN: Final = 14
"""Assumed: elements or lines between neighboring handles along the line of a flap."""


class MovablePoint(NamedTuple):
    """A point that can be moved in a view: the eye, its target, or a point of a light.

    A flap has an axis and an end.
    """

    what: str
    side: ViewSide
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

    def message(self, scene: Scene, point: Vector, views: OrthographicViews) -> str:
        """The text of the message line for the movable point at `point` of a scene."""
        if self.what != FLAP:
            places = zip(AXES, point, strict=True)
            return f"{self.label}: " + "  ".join(f"{axis} {views.rounded(place):g}" for axis, place in places)
        flap = getattr(scene.lights[self.light].flaps, self.axis)
        return f"{self.label} {views.rounded(getattr(flap, self.end)):g}"


class MarkedPoint(NamedTuple):
    """A movable point in a view: its coordinates, its mark, and the end of the arrow that begins there.

    All coordinates of an end of a flap are its value. A point of a light has the light, in world coordinates,
    and its number.
    """

    movable: MovablePoint
    point: Vector
    mark: PointMark
    end: Vector | None = None
    light: Light | None = None
    number: int = 0

    @property
    def pixel(self) -> tuple[int, int]:
        """The element and the line of the mark."""
        return round(self.mark.place[0]), round(self.mark.place[1])


def points_in(
    scene: Scene, views: OrthographicViews, side: ViewSide, chosen: str
) -> tuple[tuple[MarkedPoint, ...], tuple[MarkedPoint, ...]]:
    """The movable points in a view; those of the chosen light or eye are apart, in the second tuple.

    `chosen` is the name of a light, or empty for the eye. A chosen light has its flaps.
    """
    eye = MovablePoint(EYE, side), scene.view.eye, MovablePoint(TARGET, side), target_of(scene), None
    arrows: list[tuple[MovablePoint, Vector, MovablePoint, Vector | None, Light | None]] = [eye]
    for light in scene.lights_in_world:
        start = MovablePoint(LIGHT, side, light.name)
        end = start._replace(what=DIRECTION if light.aim is None else AIM)
        arrows.append((start, light.position, end, arrow_end(views, light), light))
    points: tuple[list[MarkedPoint], list[MarkedPoint]] = [], []
    for number, (start, point, end, end_point, shining) in enumerate(arrows):
        group = points[start.light == chosen]
        if shining is not None and start.light == chosen:
            group += _flaps_in(shining, views, side)
        if end_point is not None:
            at = views.position(side, end_point)
            group.append(MarkedPoint(end, end_point, PointMark(at, at), None, shining, number))
        mark = views.mark(side, point, end_point)
        group.append(MarkedPoint(start, point, mark, end_point, shining, number))
    return tuple(points[False]), tuple(points[True])


def arrow_end(views: OrthographicViews, light: Light) -> Vector | None:
    """The end of a light's arrow: its aim, or a point in its direction; None without either."""
    if light.aim is not None or light.axis is None:
        return light.aim
    x, y, z = light.position
    length = DIRECTION_LENGTH / views.scale
    return x + length * light.axis[0], y + length * light.axis[1], z + length * light.axis[2]


def _flaps_in(light: Light, views: OrthographicViews, side: ViewSide) -> Iterator[MarkedPoint]:
    """The ends of a light's flaps that a view shows: of its two coordinates, finite and within its area."""
    for axis in (side.right, side.up):
        flap = getattr(light.flaps, AXES[axis])
        for end in ("minimum", "maximum") if flap is not None else ():
            value = float(getattr(flap, end))
            if math.isfinite(value):
                at = views.position(side, (value, value, value))
                movable = MovablePoint(FLAP, side, light.name, AXES[axis], end)
                marked = MarkedPoint(movable, (value, value, value), PointMark(at, at), light=light)
                if side.area.covers(line_of_flap(marked)):
                    yield marked


def line_of_flap(flap: MarkedPoint) -> Area:
    """The line across a view at an end of a flap (Paper: Figure 9)."""
    side, (element, line) = flap.movable.side, flap.pixel
    if flap.movable.axis == AXES[side.right]:
        return side.area._replace(left=element, right=element)
    return side.area._replace(top=line, bottom=line)


def handles_of(
    points: Sequence[MarkedPoint],
    scene: Scene,
    views: OrthographicViews,
    signs: Mapping[MovablePoint, Area],
    hold: Callable[[MarkedPoint], object],
) -> Iterator[Handle]:
    """The handles of points in the view that shows them or has an arrow to them, with their numerals.

    Of handles at one place, the last is grabbed. A flap has handles all along its line.
    """
    for each in points:
        movable = each.movable
        places = [each.pixel] if movable.side.area.has(*each.pixel) else []
        if movable.what == FLAP:
            left, top, right, bottom = line_of_flap(each)
            along = range(BETWEEN // 2, max(right - left, bottom - top), BETWEEN)
            places = [(left + step, top) if top == bottom else (left, top + step) for step in along]
        label, sign = movable.message(scene, each.point, views), signs.get(movable, NOWHERE)
        for place in places:
            yield Handle(movable, *place, label, sign, hold=partial(hold, each))


def _step(start: Vector, end: Vector) -> Vector:
    """The direction from a point to another."""
    return end[0] - start[0], end[1] - start[1], end[2] - start[2]
