"""The items of one of the three views: the object, the eye, and the lights with their numbers.

The number of instructions takes the time: so lines of one color are drawn together, and unchanged items are
cached. The chosen eye or light is yellow and above all others; the numbers are above all lines.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from itertools import product
from typing import Final, NamedTuple

import numpy as np

from autocolor.arrays import Floats
from autocolor.checks import Vector
from autocolor.scene.lights import Light
from autocolor.scene.scene import Scene
from autocolor.scene.view import View
from autocolor.screens.cached import Cached
from autocolor.screens.light_and_view.orthographic_views import (
    AXES,
    PICTURE_ASPECT,
    OrthographicViews,
    ViewSide,
)
from autocolor.screens.picture.picture_edits import side_name
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
    between,
    clipped,
    filled,
    joined,
    rounded,
    text,
    together,
)
from ramtek_emu import instructions

# Arrows on the screen: a shaft, and a head whose size does not depend on the shaft. Shapes are positions
# along an arrow and across it, joined by strokes.

HEAD: Final = np.array([(-7, 3.15), (0, 0), (-7, -3.15)])
"""Assumed: the head of an arrow. It takes at most half of the arrow."""

OUTWARD: Final = np.array([(6, 0), (-4, 5), (-4, -5), (6, 0)])
"""Assumed: the arrow at the edge of a view that leads to a point outside."""

SHORTEST: Final = 3.0
"""Assumed: a shorter arrow, in elements, has no head: it points at the viewer or away."""


def arrow(start: tuple[float, float], end: tuple[float, float]) -> Floats:
    """The strokes of an arrow from a position to another, (1 or 3, 4).

    >>> arrow((0, 0), (20, 0))[1:].round(2).tolist()
    [[13.0, 3.15, 20.0, 0.0], [20.0, 0.0, 13.0, -3.15]]
    """
    shaft, length = joined([start, end]), math.dist(start, end)
    if length < SHORTEST:
        return shaft
    return together([shaft, turned(min(1.0, length / 14) * HEAD, unit(start, end), end)])


def turned(shape: Floats, along: Floats, place: tuple[float, float]) -> Floats:
    """The strokes of a shape at a place, turned to a unit vector to the right and down."""
    x, y = along
    return joined(shape @ np.array([(x, y), (-y, x)]) + place)


def unit(start: tuple[float, float], end: tuple[float, float]) -> Floats:
    """The unit vector from a position to another; zeros between equal positions."""
    vector: Floats = np.subtract(end, start) / (math.dist(start, end) or 1.0)
    return vector


# The marks of the eye in the three views: an eye, its view direction, and the edges of the picture.
#
# Paper: Figure 5, "Each view shows the eye position and view direction". Assumed: the edges of the picture
# are shown too.

LIDS: Final = np.array([(-7, 0), (-3, -3), (3, -3), (7, 0), (3, 3), (-3, 3), (-7, 0)], np.float64)
PUPIL: Final = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1), (-1, -1)], np.float64)
"""The eye: positions relative to the eye's position, joined by strokes."""

BESIDE: Final = 12.0
"""Assumed: elements or lines from the arrow at the edge back to the eye that it belongs to."""


class EyeMarks(NamedTuple):
    """The strokes of the eye, of the arrow to its target, and of the edges of the picture, each (n, 4)."""

    eye: Floats
    direction: Floats
    picture: Floats


def eye_marks(
    views: OrthographicViews, side: ViewSide, view: View, target: Vector, aspect: float = PICTURE_ASPECT
) -> EyeMarks:
    """The marks of the eye and its view in one of the three views, clipped by its area.

    An eye outside the area stands behind an arrow at the edge.

    The arrow ends at `target`: the view's target, or a point in its direction. `aspect` is the width of the
    picture over its height. The picture is drawn at the depth of the target, as the base of a pyramid with
    the eye at its top.
    """
    at, mark = views.position(side, view.eye), views.mark(side, view.eye, target)
    corners = views.positions(side, picture_corners(view, target, aspect))
    picture = together([between(np.broadcast_to(at, (4, 2)), corners), joined([*corners, corners[0]])])
    away = unit(mark.place, mark.at)
    place = np.array(mark.place) - BESIDE * away
    lines = [joined(LIDS + place), joined(PUPIL + place)]
    eye = together([*lines, turned(OUTWARD, away, mark.place)] if mark.is_outside else lines)
    direction = arrow(at, views.position(side, target))
    return EyeMarks(clipped(eye, side.area), clipped(direction, side.area), clipped(picture, side.area))


def picture_corners(view: View, target: Vector, aspect: float = PICTURE_ASPECT) -> Floats:
    """The points at the corners of the picture, (4, 3), at the depth of the target.

    They run around the picture from the upper left corner.
    """
    right, down, forward = view.axes
    depth = float(forward @ (np.array(target) - np.array(view.eye)))
    half = view.half_height(aspect)
    rays = [forward + half * (aspect * x * right + y * down) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    return np.array(view.eye) + depth * np.array(rays)


# The outline of a light's cone as it is seen in one of the three views.
#
# The cone is drawn as far as the end of the arrow: its rim is a circle of points at that distance from the
# light. Seen from the side, the outline is two lines from the light that touch the rim; seen along the axis,
# from within the cone, it is the rim alone, an ellipse.

RIM_SIDES: Final = 72
"""Assumed: strokes of an ellipse."""


def cone_outline(views: OrthographicViews, side: ViewSide, light: Light, end: Vector) -> Floats:
    """The strokes of the outline of a light's cone, (n, 4). The light must have a cone.

    `end` is the end of its arrow. A cone of more than 90 degrees opens behind the light. A cone of 180
    degrees contains all points and has no outline.
    """
    assert light.cone_angle is not None
    assert light.axis is not None
    if light.cone_angle == 180:
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
    return between(np.stack([at, at]), ends)


# The marks of a light in the three views: its cross, the arrow to its aim, its cone and its flaps.
#
# Paper: Figure 5, "the position and direction of each light. Point source lights would be shown with only a
# cross at the light position".

CROSS: Final = np.array([(-4, 0, 4, 0), (0, -4, 0, 4)], np.float64)
"""The cross: strokes relative to the light's position."""

DIRECTION_LENGTH: Final = 40.0
"""Assumed: the length of the arrow of a light with a direction and no aim, in elements."""


class LightMarks(NamedTuple):
    """The strokes of the cross, the arrow and the cone of a light, each (n, 4); n is 0 if there is none."""

    cross: Floats
    arrow: Floats
    cone: Floats


class FlapMark(NamedTuple):
    """The line of an end of a flap. `axis` is 0 to 2, `on` is the flap's switch, `stroke` is (1, 4)."""

    axis: int
    end: str
    on: bool
    stroke: Floats


def arrow_end(views: OrthographicViews, light: Light) -> Vector | None:
    """The end of a light's arrow: its aim, or a point in its direction; None without either."""
    if light.aim is not None or light.axis is None:
        return light.aim
    x, y, z = light.position
    length = DIRECTION_LENGTH / views.scale
    return x + length * light.axis[0], y + length * light.axis[1], z + length * light.axis[2]


def light_marks(views: OrthographicViews, side: ViewSide, light: Light) -> LightMarks:
    """The marks of a light in one of the views, clipped by its area, without its flaps.

    A light outside the area has an arrow at the edge in place of its cross.
    """
    at = views.position(side, light.position)
    end = arrow_end(views, light)
    mark = views.mark(side, light.position, end)
    shaft = cone = np.empty((0, 4))
    if end is not None:
        shaft = arrow(at, views.position(side, end))
        if light.cone_angle is not None:
            cone = cone_outline(views, side, light, end)
    cross = CROSS + np.tile(mark.place, 2)
    if mark.is_outside:
        cross = turned(OUTWARD, unit(mark.place, mark.at), mark.place)
    return LightMarks(clipped(cross, side.area), clipped(shaft, side.area), clipped(cone, side.area))


def flap_marks(views: OrthographicViews, side: ViewSide, light: Light) -> tuple[FlapMark, ...]:
    """The ends of a light's flaps that one of the views shows, as lines across its area.

    A view shows the flaps of its two coordinates. An end at infinity or outside of the area has no line.
    Paper: Figure 9.
    """
    area, marks = side.area, []
    for axis in (side.right, side.up):
        flap = (light.flaps.x, light.flaps.y, light.flaps.z)[axis]
        if flap is None:
            continue
        for end, value in (("minimum", flap.minimum), ("maximum", flap.maximum)):
            if not math.isfinite(value):
                continue
            element, line = views.position(side, (value, value, value))
            if axis == side.right:
                ends: list[tuple[float, float]] = [(element, area.top), (element, area.bottom)]
            else:
                ends = [(area.left, line), (area.right, line)]
            stroke = clipped(joined(ends), area)
            if len(stroke):
                marks.append(FlapMark(axis, end, flap.on, stroke))
    return tuple(marks)


# The numerals beside the lights in the three views, at the places where they hide least.

REACH: Final = 4
"""The elements or lines from the middle of a cross to its ends."""

AWAY: Final = 2
"""Assumed: the elements or lines between a cross and its numeral."""

RINGS: Final = 2
RING: Final = 7
"""Assumed: the rings of places around a cross, and the elements or lines between them."""

PLACES: Final = ((1, -1), (-1, -1), (1, 1), (-1, 1), (1, 0), (-1, 0), (0, -1), (0, 1))
"""The places around a cross, to the right and down, in order of preference."""


class Cross(NamedTuple):
    """A light or its aim in a view: the light's number, the element and line."""

    number: int
    element: int
    line: int
    is_aim: bool = False

    @property
    def area(self) -> Area:
        """The area of the cross."""
        element, line = self.element, self.line
        return Area(element - REACH, line - REACH, element + REACH, line + REACH)

    def numeral(self, right: int, down: int, ring: int = 0) -> Area:
        """The area of its numeral at one of the places, nearest in ring 0."""
        width = CHARACTER * len(str(self.number))
        gap = (REACH + AWAY if right and down else REACH + 2 * AWAY) + ring * RING
        left = self.element + (gap if right > 0 else -gap - width + 1 if right < 0 else -(width // 2))
        line = self.line - CHARACTER_LINES // 2
        top = line + down * (CHARACTER_LINES // 2 + gap)
        return Area(left, top, left + width - 1, top + CHARACTER_LINES - 1)


class Numeral(NamedTuple):
    """A cross, and the area of its numeral."""

    cross: Cross
    area: Area


def numerals(crosses: Sequence[Cross], area: Area, taken: Sequence[Area]) -> list[Numeral]:
    """The numerals of the crosses within an area, in order; `taken` areas stay free if possible."""
    seen = [cross for cross in crosses if area.has(cross.element, cross.line)]
    filled = [*taken, *[cross.area for cross in seen]]
    placed = []
    for cross in seen:
        places = (cross.numeral(*place, ring) for ring, place in product(range(RINGS), PLACES))
        inside = [place for place in places if area.covers(place)]
        if inside:
            # The first of the places that overlap the fewest areas.
            best = min(inside, key=lambda place: sum(map(place.overlaps, filled)))
            placed.append(Numeral(cross, best))
            filled.append(best)
    return placed


class SideItems:
    """The items of one of the views. The items that are not of the chosen light or eye are cached."""

    def __init__(self, side: ViewSide) -> None:
        self._side = side
        self._eye: Cached[EyeMarks] = Cached()
        self._others: Cached[tuple[list[Item], list[Numeral]]] = Cached()
        self.numerals: Sequence[Numeral] = ()
        """The numerals of the last items."""

    def items(
        self, views: OrthographicViews, scene: Scene, target: Vector, chosen: str, moved: Vector | None
    ) -> list[Item]:
        """The items of a scene, from the lowest to the highest.

        `target` is the view's target, `chosen` the name of a light, or empty for the eye. Lines run across
        the views through `moved`, a point that is being placed.
        """
        side, view = self._side, scene.view
        lights = scene.lights_in_world
        ours = [light for light in lights if light.name == chosen]
        others = [light for light in lights if light.name != chosen]
        title = f"{side_name(scene, side.toward)}   {AXES[side.right]} >  {AXES[side.up]} ^"
        label = text(title, side.area.left + 8, side.area.top + 4, GRAY)
        eye = self._eye.of(lambda: eye_marks(views, side, view, target), views, view)
        number = {light.name: place for place, light in enumerate(lights, start=1)}

        def numerals_of(lights: Sequence[Light], taken: Sequence[Area]) -> list[Numeral]:
            crosses = [cross for each in lights for cross in crosses_of(views, side, number[each.name], each)]
            return numerals(crosses, side.area, [*taken, label.area, area_of(eye.eye.reshape(-1, 2))])

        def below() -> tuple[list[Item], list[Numeral]]:
            return still_items(views, side, eye, others, bool(ours)), numerals_of(others, [])

        items, placed = self._others.of(below, views, eye, bool(ours), *others)
        above = [item for light in ours for item in chosen_items(views, side, light)]
        # The numerals of the chosen light make way for the others, which stay in place.
        own = numerals_of(ours, [each for cross, area in placed for each in (area, cross.area)])
        self.numerals = [*placed, *own]
        words = {number[light.name]: WHITE if light.on else GRAY for light in others}
        return [
            label,
            *([] if moved is None else lines_across(views, side, moved)),
            *items,
            *(above or drawn_items({YELLOW: [eye.direction, eye.eye]})),
            *[
                text(str(cross.number), area.left, area.top, words.get(cross.number, YELLOW))
                for cross, area in self.numerals
            ],
        ]


def still_items(
    views: OrthographicViews,
    side: ViewSide,
    eye: EyeMarks,
    lights: Sequence[Light],
    has_eye: bool,
) -> list[Item]:
    """The edges of the picture, and the lights and the eye that are not chosen."""
    layers: dict[int, list[Floats]] = {
        SLATE: [eye.picture],
        GRAY: [],
        LIGHT_GRAY: [],
        BLUE: [eye.direction, eye.eye] if has_eye else [],
        WHITE: [],
    }
    for light in lights:
        marks = light_marks(views, side, light)
        layers[GRAY].append(marks.cone)
        layers[LIGHT_GRAY if light.on else GRAY].append(marks.arrow)
        layers[WHITE if light.on else GRAY].append(marks.cross)
    return drawn_items(layers)


def chosen_items(views: OrthographicViews, side: ViewSide, light: Light) -> list[Item]:
    """The chosen light, with its flaps."""
    layers: dict[int, list[Floats]] = {GRAY: [], YELLOW: []}
    for mark in flap_marks(views, side, light):
        layers[YELLOW if mark.on else GRAY].append(mark.stroke)
    layers[YELLOW] += light_marks(views, side, light)
    return drawn_items(layers)


def crosses_of(views: OrthographicViews, side: ViewSide, number: int, light: Light) -> list[Cross]:
    """The mark of a light in one of the views, and the place of its aim.

    Aims have numerals, too, because they may be closer together than their handles reach.
    """
    mark = views.mark(side, light.position, arrow_end(views, light)).place
    places = [mark] if light.aim is None else [mark, views.position(side, light.aim)]
    return [
        Cross(number, round(element), round(line), is_aim)
        for is_aim, (element, line) in zip((False, True), places, strict=False)
    ]


def lines_across(views: OrthographicViews, side: ViewSide, point: Vector) -> list[Item]:
    """Thin lines through a point, which continue in the views beside and above."""
    area = side.area
    element, line = (round(each) for each in views.position(side, point))
    upright, level = area._replace(left=element, right=element), area._replace(top=line, bottom=line)
    return [filled(each, SLATE) for each in (upright, level) if area.covers(each)]


def drawn_items(layers: Mapping[int, Sequence[Floats]]) -> list[Item]:
    """The items of clipped strokes, by their words."""
    items = []
    for word, parts in layers.items():
        strokes = together(parts)
        if len(strokes):
            stream = instructions.write_segments(rounded(strokes), word).tobytes()
            items.append(Item(area_of(strokes.reshape(-1, 2)), stream))
    return items
