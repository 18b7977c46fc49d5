"""The items of one of the three views: the object, the eye, and the lights with their numbers.

The number of instructions takes the time: so lines of one color are drawn together, and unchanged items are
cached. The chosen eye or light is yellow and above all others; the numbers are above all lines.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from itertools import chain, product
from typing import Final, NamedTuple

import numpy as np

from autocolor.arrays import Floats
from autocolor.checks import Vector
from autocolor.scene.lights import Light
from autocolor.scene.scene import Scene
from autocolor.scene.view import View
from autocolor.screens.light_and_view.orthographic_views import (
    AXES,
    PICTURE_ASPECT,
    OrthographicViews,
    PointMark,
    ViewSide,
)
from autocolor.screens.picture.picture_edits import side_name
from autocolor.screens.screen import Cached
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

# Arrows on the screen: a shaft, and a head whose size does not depend on the shaft.

HEAD: Final = 7.0
"""Assumed: the length of the head in elements; at most half of the arrow."""

HALF_WIDTH: Final = 0.45
"""Assumed: how far the head opens to each side, as a fraction of its length."""

SHORTEST: Final = 3.0
"""Assumed: a shorter arrow, in elements, has no head: it points at the viewer or away."""


def arrow(start: tuple[float, float], end: tuple[float, float]) -> Floats:
    """The strokes of an arrow from a position to another, (1 or 3, 4).

    >>> arrow((0, 0), (20, 0))[1:].round(2).tolist()
    [[13.0, 3.15, 20.0, 0.0], [20.0, 0.0, 13.0, -3.15]]
    """
    shaft = joined([start, end])
    length = math.hypot(end[0] - start[0], end[1] - start[1])
    if length < SHORTEST:
        return shaft
    x, y = (end[0] - start[0]) / length, (end[1] - start[1]) / length
    back = min(HEAD, length / 2)
    wide = HALF_WIDTH * back
    foot = end[0] - back * x, end[1] - back * y
    head = [(foot[0] - wide * y, foot[1] + wide * x), end, (foot[0] + wide * y, foot[1] - wide * x)]
    return together([shaft, joined(head)])


# The marks of the eye in the three views: an eye, its view direction, and the edges of the picture.
#
# Paper: Figure 5, "Each view shows the eye position and view direction". Assumed: the edges of the picture
# are shown too.

LIDS: Final = np.array([(-7, 0), (-3, -3), (3, -3), (7, 0), (3, 3), (-3, 3), (-7, 0)], np.float64)
PUPIL: Final = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1), (-1, -1)], np.float64)
"""The eye: positions relative to the eye's position, joined by strokes."""


OUTWARD: Final = np.array([(6, 0), (-4, 5), (-4, -5), (6, 0)], np.float64)
"""The arrow at the edge that leads to a point outside: positions along it and across, joined by strokes."""

BESIDE: Final = 12.0
"""Assumed: elements or lines from the arrow at the edge back to the eye that it belongs to."""


def outward(mark: PointMark) -> Floats:
    """The strokes of the arrow at the edge of a view that leads to a point outside, (3, 4)."""
    x, y = mark.away or (0.0, 0.0)
    return joined(OUTWARD @ np.array([(x, y), (-y, x)]) + mark.place)


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
    place = np.array(mark.place) - BESIDE * np.array(mark.away or (0.0, 0.0))
    lines = [joined(LIDS + place), joined(PUPIL + place)]
    eye = together(lines if mark.away is None else [*lines, outward(mark)])
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

RIM_SIDES: Final = 36
"""Assumed: strokes of an ellipse."""


def cone_outline(views: OrthographicViews, side: ViewSide, light: Light, end: Vector) -> tuple[Floats, ...]:
    """The outline of the cone of a light, as polylines, each (positions, 2). The light must have a cone.

    `end` is the end of its arrow. A cone of more than 90 degrees opens behind the light. A cone of 180
    degrees contains all points and has no outline.

    In the view, the rim is an ellipse whose half axes are r |cos F| along the axis of the cone and r across
    it, at the distance l sin F from the light: F is the angle between the axis and the direction of looking,
    l and r are the height of the cone and the radius of its rim. Tangents from the light to the ellipse exist
    if F is larger than the cone angle.
    """
    assert light.cone_angle is not None
    assert light.axis is not None
    if light.cone_angle == 180:
        return ()
    angle = math.radians(light.cone_angle)
    slant = math.dist(end, light.position)
    height, radius = slant * math.cos(angle), slant * math.sin(angle)
    axis, position = np.array(light.axis), np.array(light.position)

    across = np.array([axis[side.right], axis[side.up]])
    sine, cosine = float(np.hypot(*across)), float(abs(axis @ np.array(side.toward)))
    distance, half = height * sine, radius * cosine
    if abs(distance) <= half:
        turns = np.linspace(0, 2 * math.pi, RIM_SIDES + 1)
        # Two unit vectors that are perpendicular to the axis and to each other.
        first = np.cross(axis, np.eye(3)[np.abs(axis).argmin()])
        first /= np.linalg.norm(first)
        rim = np.cos(turns)[:, None] * first + np.sin(turns)[:, None] * np.cross(axis, first)
        return (views.positions(side, position + height * axis + radius * rim),)

    # The tangents touch the ellipse on the polar line of the light.
    touching = distance - half * half / distance
    beside = radius * math.sqrt(1 - (half / distance) ** 2)
    forward = across / sine
    left = np.array([-forward[1], forward[0]])
    lines = []
    for sign in (1, -1):
        flat = touching * forward + sign * beside * left
        point = position.copy()
        point[[side.right, side.up]] += flat
        lines.append(views.positions(side, np.stack([position, point])))
    return tuple(lines)


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
            cone = together([joined(each) for each in cone_outline(views, side, light, end)])
    cross = CROSS + np.tile(mark.place, 2) if mark.away is None else outward(mark)
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

NEAR_ARROW: Final = math.cos(math.radians(50))
"""Assumed: a place within 50 degrees of the light's arrow is taken only if all other places are worse."""

RINGS: Final = 2
RING: Final = 7
"""Assumed: the rings of places around a cross, and the elements or lines between them."""

PLACES: Final = ((1, -1), (-1, -1), (1, 1), (-1, 1), (1, 0), (-1, 0), (0, -1), (0, 1))
"""The places around a cross, to the right and down, in order of preference."""


class Cross(NamedTuple):
    """A light or its aim in a view: the light's number, the element and line, the direction of the arrow.

    `arrow` is a unit vector to the right and down, and zero without an arrow.
    """

    number: int
    element: int
    line: int
    arrow: tuple[float, float] = (0.0, 0.0)
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
        best, least = None, math.inf
        for ring, (right, down) in product(range(RINGS), PLACES):
            place = cross.numeral(right, down, ring)
            if not area.covers(place):
                continue
            toward = (right * cross.arrow[0] + down * cross.arrow[1]) / math.hypot(right, down)
            # Farther away, it is less clear to which cross a numeral belongs.
            burden = sum(map(place.overlaps, filled)) + (toward > NEAR_ARROW) / 2 + ring * 3 / 4
            if burden < least:
                best, least = place, burden
            if least == 0:
                break
        if best is not None:
            placed.append(Numeral(cross, best))
            filled.append(best)
    return placed


Numbered = tuple[int, Light]
"""A light, after its number in the table, from 1 on."""


class SideItems:
    """The items of one of the views. Unchanged items are cached."""

    def __init__(self, side: ViewSide) -> None:
        self._side = side
        self._eye: Cached[EyeMarks] = Cached()
        self._still: Cached[list[Item]] = Cached()
        self._chosen: Cached[list[Item]] = Cached()
        self._numerals: Cached[list[Numeral]] = Cached()
        self.numerals: Sequence[Numeral] = ()
        """The numerals of the last items."""
        self._lights: Cached[tuple[Light, ...]] = Cached()
        self._label: Cached[Item] = Cached()

    def items(
        self,
        views: OrthographicViews,
        scene: Scene,
        target: Vector,
        chosen: str,
        moved: Vector | None,
    ) -> list[Item]:
        """The items of a scene, from the lowest to the highest.

        `target` is the view's target, `chosen` the name of a light, or empty for the eye. Lines run across
        the views through `moved`, a point that is being placed.
        """
        side, view = self._side, scene.view
        in_world = self._lights.of(lambda: scene.lights_in_world, scene.lights, scene.view)
        lights = list(enumerate(in_world, start=1))
        ours = [each for each in lights if each[1].name == chosen]
        others = [each for each in lights if each[1].name != chosen]
        tables = [light for _, light in others]
        eye = self._eye.of(lambda: eye_marks(views, side, view, target), views, view)

        def title() -> Item:
            name = f"{side_name(scene, side.toward)}   {AXES[side.right]} >  {AXES[side.up]} ^"
            return text(name, side.area.left + 8, side.area.top + 4, GRAY)

        def still() -> list[Item]:
            return still_items(views, side, eye, tables, bool(ours))

        def above() -> list[Item]:
            light_items = [item for _, light in ours for item in chosen_items(views, side, light)]
            return light_items or drawn_items({YELLOW: [eye.direction, eye.eye]})

        label = self._label.of(title, scene.front)
        return [
            label,
            *([] if moved is None else lines_across(views, side, moved)),
            *self._still.of(still, views, eye, bool(ours), *tables),
            *self._chosen.of(above, views, eye, *[light for _, light in ours]),
            *self._numeral_items(views, view, target, label.area, others, ours),
        ]

    def _numeral_items(
        self,
        views: OrthographicViews,
        view: View,
        target: Vector,
        label: Area,
        others: Sequence[Numbered],
        ours: Sequence[Numbered],
    ) -> list[Item]:
        """The numerals of the lights. The chosen light's makes way for the others, which stay in place."""
        side = self._side
        taken = [label, area_of(LIDS + views.mark(side, view.eye, target).place)]

        def compute() -> list[Numeral]:
            return numerals(
                [cross for each in others for cross in crosses_of(views, side, *each)], side.area, taken
            )

        placed = self._numerals.of(compute, views, view, *chain.from_iterable(others))
        around = [area for cross, area in placed] + [cross.area for cross, _ in placed]
        own = numerals(
            [cross for each in ours for cross in crosses_of(views, side, *each)], side.area, [*taken, *around]
        )
        self.numerals = [*placed, *own]
        is_on = {number: light.on for number, light in others}
        return [
            *[numeral_item(each, WHITE if is_on[each.cross.number] else GRAY) for each in placed],
            *[numeral_item(each, YELLOW) for each in own],
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


def numeral_item(numeral: Numeral, word: int) -> Item:
    """The number of a light in a color."""
    return text(str(numeral.cross.number), numeral.area.left, numeral.area.top, word)


def crosses_of(views: OrthographicViews, side: ViewSide, number: int, light: Light) -> list[Cross]:
    """The cross of a light in one of the views, with the direction of its arrow, and the place of its aim.

    Aims have numerals, too, because they may be closer together than their handles reach.
    """
    element, line = views.position(side, light.position)
    end, arrow = arrow_end(views, light), (0.0, 0.0)
    if end is not None:
        to_element, to_line = views.position(side, end)
        right, down = to_element - element, to_line - line
        length = math.hypot(right, down)
        # An arrow that points at the viewer or away covers no place.
        if length > SHORTEST:
            arrow = right / length, down / length
    element, line = views.mark(side, light.position, end).place
    crosses = [Cross(number, round(element), round(line), arrow)]
    if light.aim is not None and end is not None:
        crosses.append(Cross(number, round(to_element), round(to_line), (-arrow[0], -arrow[1]), is_aim=True))
    return crosses


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
