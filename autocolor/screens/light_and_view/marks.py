"""The eye and the lights in the three views: their movable points, signs, numerals and handles.

The number of instructions takes the time: so lines of one color are drawn together. The chosen eye or light
is yellow and above all others; the numbers are above all lines.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from functools import lru_cache, partial
from typing import Any, Final, NamedTuple

import numpy as np

from autocolor.arrays import Floats
from autocolor.checks import Vector
from autocolor.scene.lights import Light
from autocolor.scene.orbit import side_name, target_of
from autocolor.scene.scene import Scene
from autocolor.scene.view import ASPECT, View
from autocolor.screens.light_and_view.orthographic_views import AXES, OrthographicViews, PointMark, ViewSide
from autocolor.screens.screen import Handle
from autocolor.widgets.items import (
    BLUE,
    CHARACTER,
    CHARACTER_LINES,
    GRAY,
    LIGHT_GRAY,
    SLATE,
    WHITE,
    YELLOW,
    Area,
    Item,
    area_of,
    clipped,
    joined,
    rounded,
    text,
    together,
)
from autocolor.widgets.widget import NOWHERE
from ramtek_emu import instructions

# Points that can be moved.

EYE: Final = "eye"
TARGET: Final = "target"
LIGHT: Final = "position"
AIM: Final = "aim"
DIRECTION: Final = "direction"
FLAP: Final = "flap"
"""The kinds of movable points: the columns of the view and of a light, and the ends of flaps."""

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
        what = f"flap {self.axis}, {self.end}" if self.what == FLAP else self.what
        return self.light if self.what == LIGHT else f"{self.light}: {what}" if self.light else what

    def put(self, scene: Scene, point: Vector) -> Scene:
        """The scene with the movable point at `point`. An end of a flap does not pass the other end."""
        if self.what == FLAP:
            value, flap = point[AXES.index(self.axis)], getattr(scene.lights[self.light].flaps, self.axis)
            value = min(value, flap.maximum) if self.end == "minimum" else max(value, flap.minimum)
            flaps: Any = {self.axis: {self.end: value}}
            return scene.with_light(self.light, flaps=flaps)
        start = scene.lights_in_world[self.light].position if self.light else scene.view.eye
        step = np.subtract(point, start).tolist()
        changes: Any = {self.what: step if self.what == DIRECTION else point}
        if self.what == TARGET and scene.view.target is None:
            changes = {DIRECTION: step}
        return scene.with_light_in_world(self.light, **changes) if self.light else scene.with_view(**changes)

    def message(self, scene: Scene, point: Vector, views: OrthographicViews) -> str:
        """The text of the message line for the movable point at `point` of a scene."""
        if self.what != FLAP:
            places = zip(AXES, point, strict=True)
            return f"{self.label}: " + "  ".join(f"{axis} {views.rounded(place):g}" for axis, place in places)
        flap = getattr(scene.lights[self.light].flaps, self.axis)
        return f"{self.label} {views.rounded(getattr(flap, self.end)):g}"


class MarkedPoint(NamedTuple):
    """A movable point in a view: its coordinates, its mark, and the end of the arrow that begins there.

    A point of a light has the light, in world coordinates, and its number. All coordinates of an end of a
    flap are its value, and its `line` runs across the view (Paper: Figure 9).
    """

    movable: MovablePoint
    point: Vector
    mark: PointMark
    end: Vector | None = None
    light: Light | None = None
    number: int = 0
    line: Area = NOWHERE

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
    points: tuple[list[MarkedPoint], list[MarkedPoint]] = [], []
    for number, light in enumerate([None, *scene.lights_in_world]):
        start, point, what = MovablePoint(EYE, side), scene.view.eye, TARGET
        end: Vector | None = target_of(scene)
        if light is not None:
            start, point = MovablePoint(LIGHT, side, light.name), light.position
            what, end = DIRECTION if light.aim is None else AIM, arrow_end(views, light)
        group = points[start.light == chosen]
        if light is not None and start.light == chosen:
            group += _flaps_in(light, views, side)
        if end is not None:
            at = views.position(side, end)
            group.append(MarkedPoint(start._replace(what=what), end, PointMark(at, at), None, light, number))
        group.append(MarkedPoint(start, point, views.mark(side, point, end), end, light, number))
    return tuple(points[False]), tuple(points[True])


def arrow_end(views: OrthographicViews, light: Light) -> Vector | None:
    """The end of a light's arrow: its aim, or a point in its direction; None without either."""
    if light.aim is not None or light.axis is None:
        return light.aim
    x, y, z = light.position + DIRECTION_LENGTH / views.scale * np.array(light.axis)
    return float(x), float(y), float(z)


def _flaps_in(light: Light, views: OrthographicViews, side: ViewSide) -> Iterator[MarkedPoint]:
    """The ends of a light's flaps that a view shows: of its two coordinates, finite and within its area."""
    for number, axis in enumerate((side.right, side.up)):
        flap = getattr(light.flaps, AXES[axis])
        for end in ("minimum", "maximum") if flap is not None else ():
            value = float(getattr(flap, end))
            point = value, value, value
            if math.isfinite(value) and side.area.covers(line := views.lines_through(side, point)[number]):
                at = views.position(side, point)
                movable = MovablePoint(FLAP, side, light.name, AXES[axis], end)
                yield MarkedPoint(movable, point, PointMark(at, at), light=light, line=line)


# Arrows on the screen: a shaft, and a head whose size does not depend on the shaft. Shapes are positions
# along an arrow and across it, joined by strokes.

HEAD: Final = np.array([(-7, 3.15), (0, 0), (-7, -3.15)])
"""Assumed: the head of an arrow. It takes at most half of the arrow."""

OUTWARD: Final = np.array([(6, 0), (-4, 5), (-4, -5), (6, 0)])
"""Assumed: the arrow at the edge of a view that leads to a point outside."""


def arrow(start: tuple[float, float], end: tuple[float, float]) -> Floats:
    """The strokes of an arrow from a position to another, (3, 4).

    >>> arrow((0, 0), (20, 0))[1:].round(2).tolist()
    [[13.0, 3.15, 20.0, 0.0], [20.0, 0.0, 13.0, -3.15]]
    """
    head = min(1.0, math.dist(start, end) / 14) * HEAD
    return together([joined([start, end]), turned(head, unit(start, end), end)])


def turned(shape: Floats, along: Floats, place: tuple[float, float]) -> Floats:
    """The strokes of a shape at a place, turned to a unit vector to the right and down."""
    x, y = along
    return joined(shape @ np.array([(x, y), (-y, x)]) + place)


def unit(start: tuple[float, float], end: tuple[float, float]) -> Floats:
    """The unit vector from a position to another; zeros between equal positions."""
    vector: Floats = np.subtract(end, start) / (math.dist(start, end) or 1.0)
    return vector


# The eye and the lights. Outside of a view, they have an arrow at its edge.
#
# Paper: Figure 5, "Each view shows the eye position and view direction", "the position and direction of each
# light. Point source lights would be shown with only a cross at the light position". Assumed: the edges of
# the picture are shown too.

LIDS: Final = np.array([(-7, 0), (-3, -3), (3, -3), (7, 0), (3, 3), (-3, 3), (-7, 0)], np.float64)
PUPIL: Final = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1), (-1, -1)], np.float64)
"""The eye: positions relative to the eye's position, joined by strokes."""

BESIDE: Final = 16.0
"""Assumed: elements or lines from the arrow at the edge back to the eye that it belongs to."""

CROSS: Final = np.array([(-4, 0, 4, 0), (0, -4, 0, 4)], np.float64)
"""A light: strokes relative to its position."""


def sign_of(what: str, mark: PointMark) -> Floats:
    """The strokes at the mark of the eye or of a light."""
    away = unit(mark.place, mark.at)
    outward = [turned(OUTWARD, away, mark.place)] if mark.is_outside else []
    if what == EYE:
        place = np.array(mark.place) - BESIDE * away
        return together([joined(LIDS + place), joined(PUPIL + place), *outward])
    return together(outward or [CROSS + np.tile(mark.place, 2)])


def picture_corners(view: View, target: Vector) -> Floats:
    """The points at the corners of the picture, (4, 3), at the depth of the target, from the upper left."""
    places = np.array([(-ASPECT, -1), (ASPECT, -1), (ASPECT, 1), (-ASPECT, 1)])
    rays = view.axes[2] + view.half_height(ASPECT) * places @ view.axes[:2]
    corners: Floats = np.array(view.eye) + view.axes[2] @ np.subtract(target, view.eye) * rays
    return corners


# The outline of a light's cone as it is seen in one of the three views.
#
# The cone is drawn as far as the end of the arrow: its rim is a circle of points at that distance from the
# light. Seen from the side, the outline is two lines from the light that touch the rim; seen along the axis,
# from within the cone, it is the rim alone, an ellipse.

RIM_SIDES: Final = 72
"""Assumed: strokes of an ellipse."""


def cone_outline(views: OrthographicViews, side: ViewSide, light: Light, end: Vector) -> Floats:
    """The strokes of the outline of a light's cone, (n, 4); none for a light without a cone.

    `end` is the end of its arrow. A cone of more than 90 degrees opens behind the light. A cone of 180
    degrees contains all points and has no outline.
    """
    if light.cone_angle is None or light.cone_angle == 180:
        return np.empty((0, 4))
    angle, slant = math.radians(light.cone_angle), math.dist(end, light.position)
    axis, turns = np.array(light.axis), np.linspace(0, 2 * math.pi, RIM_SIDES + 1)
    # Two unit vectors that are perpendicular to the axis and to each other.
    first = np.cross(axis, np.eye(3)[np.abs(axis).argmin()])
    first /= np.linalg.norm(first)
    circle = np.cos(turns)[:, None] * first + np.sin(turns)[:, None] * np.cross(axis, first)
    points = np.array(light.position) + slant * (math.cos(angle) * axis + math.sin(angle) * circle)
    rim, at = views.positions(side, points), np.array(views.position(side, light.position))
    away = rim - at
    # From outside the ellipse, all of it is seen within less than half a turn around its middle.
    middle = away[:-1].mean(axis=0)
    across, along = away @ (-middle[1], middle[0]), away @ middle
    if along.min() <= 0:
        return joined(rim)
    ends = rim[[(across / along).argmin(), (across / along).argmax()]]
    return np.concatenate([[at, at], ends], axis=1)


# The numerals beside the lights and their aims in the three views, at the places where they hide least. Aims
# have numerals, too, because they may be closer together than their handles reach.

REACH: Final = 4
"""The elements or lines from the middle of a cross to its ends."""

AWAY: Final = 2
"""Assumed: the elements or lines between a cross and its numeral."""

RINGS: Final = 2
RING: Final = 7
"""Assumed: the rings of places around a cross, and the elements or lines between them."""

PLACES: Final = np.array([(1, -1), (-1, -1), (1, 1), (-1, 1), (1, 0), (-1, 0), (0, -1), (0, 1)])
"""The places around a cross, to the right and down, in order of preference."""


@lru_cache(maxsize=64)
def numerals(
    crosses: tuple[tuple[int, int, int], ...], area: Area, taken: tuple[Area, ...]
) -> tuple[Area, ...]:
    """The areas within an area of the numerals of crosses: of their numbers, elements and lines.

    The crosses and the `taken` areas stay free if possible.
    """
    occupied = [*taken, *(cross_area(element, line) for _, element, line in crosses)]
    gaps = REACH + np.where(PLACES.all(axis=1), AWAY, 2 * AWAY)[:, np.newaxis]
    placed = []
    for number, *cross in crosses:
        size = np.array([CHARACTER * len(str(number)), CHARACTER_LINES])
        rings = [PLACES * (gaps + RING * ring + size // 2) - size // 2 for ring in range(RINGS)]
        starts = np.concatenate(rings) + cross
        others, ends = np.array(occupied), starts + size - 1
        overlaps = (starts[:, None] <= others[:, 2:]) & (ends[:, None] >= others[:, :2])
        counts = overlaps.all(axis=2).sum(axis=1)
        is_outside = (starts < area[:2]).any(axis=1) | (ends > area[2:]).any(axis=1)
        # The first of the places that overlap the fewest areas.
        best = np.where(is_outside, len(others) + 1, counts).argmin()
        placed.append(Area(*starts[best].tolist(), *ends[best].tolist()))
        occupied.append(placed[-1])
    return tuple(placed)


def cross_area(element: int, line: int) -> Area:
    """The area of a cross."""
    return Area(element, line, element, line).inset(-REACH)


# The items and the handles of a view.


def marks_in(
    scene: Scene,
    views: OrthographicViews,
    side: ViewSide,
    chosen: str,
    hold: Callable[[MarkedPoint], object],
) -> tuple[list[Item], list[Handle]]:
    """The items of a view from the lowest to the highest, and its handles, which call `hold`.

    `chosen` is the name of a light, or empty for the eye. Its numerals make way for the others, which stay in
    place. Of handles at one place, the last is grabbed.
    """
    # As on an engineering drawing, the name of a view is below it.
    name = f"{side_name(scene, side.toward)}   {AXES[side.right]} >  {AXES[side.up]} ^"
    title = text(name, side.area.left + 8, side.area.bottom - CHARACTER_LINES - 3, LIGHT_GRAY)
    others, ours = points_in(scene, views, side, chosen)
    items = [title, *edge_items(views, side, scene.view, target_of(scene))]
    items += [*point_items(views, side, others, False), *point_items(views, side, ours, True)]
    eyes = [sign_of(EYE, each.mark) for each in (*others, *ours) if each.movable.what == EYE]
    taken = [title.area, *(area_of(eye.reshape(-1, 2), limit=side.area) for eye in eyes)]
    handles = []
    for points in (others, ours):
        shown = [each for each in points if each.movable.what in (LIGHT, AIM) and side.area.has(*each.pixel)]
        areas = numerals(tuple((each.number, *each.pixel) for each in shown), side.area, tuple(taken))
        for each, area in zip(shown, areas, strict=True):
            ink, *_ = inks_of(each, points is ours)
            items.append(text(str(each.number), area.left, area.top, ink))
            taken += [cross_area(*each.pixel), area]
        signs = dict(zip(shown, areas, strict=True))
        for each in points:
            label, sign = each.movable.message(scene, each.point, views), signs.get(each, NOWHERE)
            for place in places_of_handles(each):
                handles.append(Handle(each.movable, *place, label, sign, hold=partial(hold, each)))
    return items, handles


def places_of_handles(point: MarkedPoint) -> list[tuple[int, int]]:
    """The places where a point can be grabbed: at its mark in the view, or all along the line of a flap."""
    if point.movable.what != FLAP:
        return [point.pixel] if point.movable.side.area.has(*point.pixel) else []
    left, top, right, bottom = point.line
    along = range(BETWEEN // 2, max(right - left, bottom - top), BETWEEN)
    return [(left + step, top) if top == bottom else (left, top + step) for step in along]


def inks_of(point: MarkedPoint, is_chosen: bool) -> tuple[int, int, int]:
    """The words of the sign, the arrow and the cone of the eye or a light."""
    if is_chosen:
        return YELLOW, YELLOW, YELLOW
    if point.light is None:
        return BLUE, BLUE, BLUE
    return (WHITE, LIGHT_GRAY, GRAY) if point.light.on else (GRAY, GRAY, GRAY)


@lru_cache(maxsize=64)
def point_items(
    views: OrthographicViews, side: ViewSide, points: tuple[MarkedPoint, ...], are_chosen: bool
) -> Sequence[Item]:
    """The items of the eye, lights and flaps of one view; during a drag, most points stay the same."""
    layers: dict[int, list[Floats]] = {word: [] for word in (GRAY, LIGHT_GRAY, BLUE, WHITE, YELLOW)}
    for each in points:
        what, light = each.movable.what, each.light
        sign, shaft, cone = inks_of(each, are_chosen)
        if what == FLAP:
            is_on = light is not None and getattr(light.flaps, each.movable.axis).on
            layers[YELLOW if is_on else GRAY].append(np.array([each.line], np.float64))
        elif what in (EYE, LIGHT):
            layers[sign].append(sign_of(what, each.mark))
            if each.end is not None:
                layers[shaft].append(arrow(each.mark.at, views.position(side, each.end)))
                if light is not None:
                    layers[cone].append(cone_outline(views, side, light, each.end))
    return tuple(item for word, parts in layers.items() for item in drawn_item(parts, word, side))


@lru_cache(maxsize=64)
def edge_items(views: OrthographicViews, side: ViewSide, view: View, target: Vector) -> Sequence[Item]:
    """The items of the picture's edges at the depth of the target, and of the rays to its corners."""
    corners = views.positions(side, picture_corners(view, target))
    eyes = np.broadcast_to(views.position(side, view.eye), (4, 2))
    rays = np.concatenate([eyes, corners], axis=1)
    return drawn_item([rays, joined([*corners, corners[0]])], SLATE, side)


def drawn_item(parts: Sequence[Floats], word: int, side: ViewSide) -> Sequence[Item]:
    """The item of all strokes of one word, clipped at the area of a view; none if there are no strokes."""
    strokes = clipped(together(parts), side.area)
    if not len(strokes):
        return ()
    stream = instructions.write_segments(rounded(strokes), word).tobytes()
    return (Item(area_of(strokes.reshape(-1, 2)), stream),)
