"""The items of one of the three views: the eye, the lights with their numbers, and the lines through a point.

The number of instructions takes the time: so lines of one color are drawn together. The chosen eye or light
is yellow and above all others; the numbers are above all lines.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import cache, lru_cache
from itertools import product
from typing import Final

import numpy as np

from autocolor.arrays import Floats, Numbers
from autocolor.checks import Vector
from autocolor.scene.lights import Light
from autocolor.scene.scene import Scene
from autocolor.scene.view import View
from autocolor.screens.light_and_view.handles import (
    AIM,
    EYE,
    FLAP,
    LIGHT,
    MarkedPoint,
    MovablePoint,
    line_of_flap,
)
from autocolor.screens.light_and_view.orthographic_views import (
    AXES,
    OrthographicViews,
    PointMark,
    ViewSide,
)
from autocolor.screens.picture.picture_edits import side_name, target_of
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

BESIDE: Final = 12.0
"""Assumed: elements or lines from the arrow at the edge back to the eye that it belongs to."""

CROSS: Final = np.array([(-4, 0, 4, 0), (0, -4, 0, 4)], np.float64)
"""A light: strokes relative to its position."""

PICTURE_ASPECT: Final = 640 / 480
"""The width of a picture over its height. Paper: Figure 11, 640 x 480."""


def sign_of(what: str, mark: PointMark) -> Floats:
    """The strokes at the mark of the eye or of a light."""
    away = unit(mark.place, mark.at)
    outward = [turned(OUTWARD, away, mark.place)] if mark.is_outside else []
    if what == EYE:
        place = np.array(mark.place) - BESIDE * away
        return together([joined(LIDS + place), joined(PUPIL + place), *outward])
    return together(outward or [CROSS + np.tile(mark.place, 2)])


def picture_corners(view: View, target: Vector) -> Floats:
    """The points at the corners of the picture, (4, 3), at the depth of the target.

    They run around the picture from the upper left corner.
    """
    right, down, forward = view.axes
    depth = float(forward @ (np.array(target) - np.array(view.eye)))
    half = view.half_height(PICTURE_ASPECT)
    across = half * PICTURE_ASPECT
    rays = [forward + across * x * right + half * y * down for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    return np.array(view.eye) + depth * np.array(rays)


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
    return between(np.stack([at, at]), ends)


# The numerals beside the lights and their aims in the three views, at the places where they hide least. Aims
# have numerals, too, because they may be closer together than their handles reach.

REACH: Final = 4
"""The elements or lines from the middle of a cross to its ends."""

AWAY: Final = 2
"""Assumed: the elements or lines between a cross and its numeral."""

RINGS: Final = 2
RING: Final = 7
"""Assumed: the rings of places around a cross, and the elements or lines between them."""

PLACES: Final = ((1, -1), (-1, -1), (1, 1), (-1, 1), (1, 0), (-1, 0), (0, -1), (0, 1))
"""The places around a cross, to the right and down, in order of preference."""


@cache
def places_around(digits: int) -> Numbers:
    """The areas for a numeral of some digits around a cross at (0, 0), (places, 4), the preferred first."""
    half, down_half = CHARACTER * digits // 2, CHARACTER_LINES // 2
    corners = []
    for ring, (right, down) in product(range(RINGS), PLACES):
        gap = REACH + (AWAY if right and down else 2 * AWAY) + ring * RING
        corners.append((right * (gap + half) - half, down * (gap + down_half) - down_half))
    size = CHARACTER * digits - 1, CHARACTER_LINES - 1
    return np.concatenate([corners, np.add(corners, size)], axis=1)


@lru_cache(maxsize=64)
def numerals(
    crosses: tuple[tuple[int, int, int], ...], area: Area, taken: tuple[Area, ...]
) -> tuple[Area, ...]:
    """The areas within an area of the numerals of crosses: of their numbers, elements and lines.

    The crosses and the `taken` areas stay free if possible.
    """
    occupied = [*taken, *(cross_area(element, line) for _, element, line in crosses)]
    placed = []
    for number, element, line in crosses:
        places = places_around(len(str(number))) + np.array([element, line, element, line])
        others, starts, ends = np.array(occupied), places[:, :2], places[:, 2:]
        overlaps = (starts[:, None] <= others[:, 2:]) & (ends[:, None] >= others[:, :2])
        counts = overlaps.all(axis=2).sum(axis=1)
        is_outside = (starts < area[:2]).any(axis=1) | (ends > area[2:]).any(axis=1)
        # The first of the places that overlap the fewest areas.
        best = np.where(is_outside, len(others) + 1, counts).argmin()
        placed.append(Area(*places[best].tolist()))
        occupied.append(placed[-1])
    return tuple(placed)


def cross_area(element: int, line: int) -> Area:
    """The area of a cross."""
    return Area(element, line, element, line).inset(-REACH)


# The items of a view.


def side_items(
    scene: Scene,
    views: OrthographicViews,
    side: ViewSide,
    others: tuple[MarkedPoint, ...],
    ours: tuple[MarkedPoint, ...],
) -> tuple[list[Item], dict[MovablePoint, Area]]:
    """The items of a view from the lowest to the highest, and the areas of its numerals.

    `ours` are the movable points of the chosen light or eye. Their numerals make way for the others, which
    stay in place.
    """
    # As on an engineering drawing, the name of a view is below it.
    name = f"{side_name(scene, side.toward)}   {AXES[side.right]} >  {AXES[side.up]} ^"
    title = text(name, side.area.left + 8, side.area.bottom - CHARACTER_LINES - 3, GRAY)
    edges = edge_items(views, side, scene.view, target_of(scene))
    items = [title, *edges, *point_items(views, others, False), *point_items(views, ours, True)]
    eyes = [sign_of(EYE, each.mark) for each in (*others, *ours) if each.movable.what == EYE]
    taken = [title.area, *(area_of(eye.reshape(-1, 2), limit=side.area) for eye in eyes)]
    signs = {}
    for points in (others, ours):
        shown = [each for each in points if each.movable.what in (LIGHT, AIM) and side.area.has(*each.pixel)]
        areas = numerals(tuple((each.number, *each.pixel) for each in shown), side.area, tuple(taken))
        for each, area in zip(shown, areas, strict=True):
            ink, *_ = inks_of(each, points is ours)
            items.append(text(str(each.number), area.left, area.top, ink))
            signs[each.movable] = area
            taken += [cross_area(*each.pixel), area]
    return items, signs


def inks_of(point: MarkedPoint, is_chosen: bool) -> tuple[int, int, int]:
    """The words of the sign, the arrow and the cone of the eye or a light."""
    if is_chosen:
        return YELLOW, YELLOW, YELLOW
    if point.light is None:
        return BLUE, BLUE, BLUE
    return (WHITE, LIGHT_GRAY, GRAY) if point.light.on else (GRAY, GRAY, GRAY)


@lru_cache(maxsize=64)
def point_items(
    views: OrthographicViews, points: tuple[MarkedPoint, ...], are_chosen: bool
) -> Sequence[Item]:
    """The items of the eye, of lights and of flaps; during a drag, most points stay the same."""
    layers: dict[int, list[Floats]] = {word: [] for word in (GRAY, LIGHT_GRAY, BLUE, WHITE, YELLOW)}
    for each in points:
        what, side, light = each.movable.what, each.movable.side, each.light
        sign, shaft, cone = inks_of(each, are_chosen)
        if what == FLAP:
            is_on = light is not None and getattr(light.flaps, each.movable.axis).on
            layers[YELLOW if is_on else GRAY].append(np.array([line_of_flap(each)], np.float64))
        elif what in (EYE, LIGHT):
            layers[sign].append(sign_of(what, each.mark))
            if each.end is not None:
                layers[shaft].append(arrow(each.mark.at, views.position(side, each.end)))
                if light is not None:
                    layers[cone].append(cone_outline(views, side, light, each.end))
    return [item for word, parts in layers.items() for item in drawn_item(parts, word, side)]


@lru_cache(maxsize=64)
def edge_items(views: OrthographicViews, side: ViewSide, view: View, target: Vector) -> Sequence[Item]:
    """The items of the picture's edges at the depth of the target, and of the rays to its corners."""
    corners = views.positions(side, picture_corners(view, target))
    rays = between(np.broadcast_to(views.position(side, view.eye), (4, 2)), corners)
    return drawn_item([rays, joined([*corners, corners[0]])], SLATE, side)


def drawn_item(parts: Sequence[Floats], word: int, side: ViewSide) -> list[Item]:
    """The item of all strokes of one word, clipped at the area of a view; none if there are no strokes."""
    strokes = clipped(together(parts), side.area)
    if not len(strokes):
        return []
    stream = instructions.write_segments(rounded(strokes), word).tobytes()
    return [Item(area_of(strokes.reshape(-1, 2)), stream)]


def lines_across(views: OrthographicViews, side: ViewSide, point: Vector) -> list[Item]:
    """Thin lines through a point, which continue in the views beside and above."""
    area = side.area
    element, line = (round(each) for each in views.position(side, point))
    upright, level = area._replace(left=element, right=element), area._replace(top=line, bottom=line)
    return [filled(each, SLATE) for each in (upright, level) if area.covers(each)]
