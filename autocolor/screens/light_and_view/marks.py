"""The items of one of the three views: the object, the eye, and the lights with their numbers.

Lines of one color are drawn together, and those that did not change are kept: what takes time is the number
of instructions. What is chosen is yellow and lies over all others, the numbers over all lines.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from autocolor.arrays import Floats
from autocolor.checks import Vector
from autocolor.scene.lights.light import Light
from autocolor.scene.scene import Scene
from autocolor.scene.view import View
from autocolor.screens.light_and_view.arrows import SHORTEST
from autocolor.screens.light_and_view.eye_marks import LIDS, EyeMarks, eye_marks
from autocolor.screens.light_and_view.kept import Kept
from autocolor.screens.light_and_view.light_marks import arrow_end, flap_marks, light_marks
from autocolor.screens.light_and_view.numerals import Cross, Numeral, numerals
from autocolor.screens.light_and_view.object_lines import ObjectStrokes
from autocolor.screens.light_and_view.orthographic_views import AXES, OrthographicViews, Side
from autocolor.widgets.areas import Area
from autocolor.widgets.colors import BLUE, GRAY, LIGHT_GRAY, SLATE, WHITE, YELLOW
from autocolor.widgets.items import Item, rounded, segments, text
from autocolor.widgets.strokes import joined, together
from ramtek_emu import instructions

Numbered = tuple[int, Light]
"""A light, after its number in the table, from 1 on."""


class SideItems:
    """The items of one of the views, which are made anew as far as something changed."""

    def __init__(self, side: Side) -> None:
        self._side = side
        self._eye: Kept[EyeMarks] = Kept()
        self._still: Kept[list[Item]] = Kept()
        self._chosen: Kept[list[Item]] = Kept()
        self._numerals: Kept[list[Numeral]] = Kept()
        self._lights: Kept[tuple[Light, ...]] = Kept()
        title = f"{side.name}   {AXES[side.right]} >  {AXES[side.up]} ^"
        self._label = text(title, side.area.left + 8, side.area.top + 4, GRAY)

    def items(
        self,
        views: OrthographicViews,
        scene: Scene,
        target: Vector,
        strokes: ObjectStrokes,
        chosen: str,
        moved: Vector | None,
    ) -> list[Item]:
        """The items of a scene, from the lowest to the highest.

        `target` is that of the view, `chosen` the name of a light, empty for the eye, and `moved` a point
        that is being placed, through which lines run across the views.
        """
        side, view = self._side, scene.view
        in_world = self._lights.of(lambda: scene.lights_in_world, scene.lights, scene.view)
        lights = list(enumerate(in_world, start=1))
        ours = [each for each in lights if each[1].name == chosen]
        others = [each for each in lights if each[1].name != chosen]
        tables = [light for _, light in others]
        eye = self._eye.of(lambda: eye_marks(views, side, view, target), views, view, strokes)

        def still() -> list[Item]:
            return still_items(views, side, eye, strokes, tables, bool(ours))

        def above() -> list[Item]:
            return [item for _, light in ours for item in chosen_items(views, side, light)] or eye_items(eye)

        return [
            self._label,
            *([] if moved is None else [lines_across(views, side, moved)]),
            *self._still.of(still, views, eye, strokes, bool(ours), *tables),
            *self._chosen.of(above, views, eye, *(light for _, light in ours)),
            *self._numeral_items(views, view, others, ours),
        ]

    def _numeral_items(
        self, views: OrthographicViews, view: View, others: Sequence[Numbered], ours: Sequence[Numbered]
    ) -> list[Item]:
        """The numbers of the lights. That of the chosen one makes way for the others, which stay in place."""
        side = self._side
        taken = [self._label.area, area_around(joined(LIDS + views.position(side, view.eye)))]

        def found() -> list[Numeral]:
            return numerals([cross_of(views, side, *each) for each in others], side.area, taken)

        kept = self._numerals.of(found, views, view, *(part for each in others for part in each))
        around = [area for cross, area in kept] + [cross.area for cross, _ in kept]
        own = numerals([cross_of(views, side, *each) for each in ours], side.area, [*taken, *around])
        is_on = {number: light.on for number, light in others}
        return [
            *(numeral_item(each, WHITE if is_on[each.cross.number] else GRAY) for each in kept),
            *(numeral_item(each, YELLOW) for each in own),
        ]


def still_items(
    views: OrthographicViews,
    side: Side,
    eye: EyeMarks,
    strokes: ObjectStrokes,
    lights: Sequence[Light],
    has_eye: bool,
) -> list[Item]:
    """The object, the edges of the picture, and what is not chosen: some lights, and maybe the eye."""
    layers: dict[int, list[Floats]] = {
        SLATE: [strokes.stage, eye.picture],
        GRAY: [strokes.features],
        LIGHT_GRAY: [strokes.silhouette],
        BLUE: [eye.direction, eye.eye] if has_eye else [],
        WHITE: [],
    }
    for light in lights:
        marks = light_marks(views, side, light)
        layers[GRAY].append(marks.cone)
        layers[LIGHT_GRAY if light.on else GRAY].append(marks.arrow)
        layers[WHITE if light.on else GRAY].append(marks.cross)
    return drawn_items(layers)


def eye_items(eye: EyeMarks) -> list[Item]:
    """The eye that is chosen, and its direction."""
    return drawn_items({YELLOW: [eye.direction, eye.eye]})


def chosen_items(views: OrthographicViews, side: Side, light: Light) -> list[Item]:
    """The light that is chosen, with its flaps."""
    layers: dict[int, list[Floats]] = {GRAY: [], YELLOW: []}
    for mark in flap_marks(views, side, light):
        layers[YELLOW if mark.on else GRAY].append(mark.stroke)
    layers[YELLOW] += light_marks(views, side, light)
    return drawn_items(layers)


def numeral_item(numeral: Numeral, word: int) -> Item:
    """The number of a light in a color."""
    return text(str(numeral.cross.number), numeral.area.left, numeral.area.top, word)


def cross_of(views: OrthographicViews, side: Side, number: int, light: Light) -> Cross:
    """Where a light is in one of the views, and where its arrow points."""
    element, line = views.position(side, light.position)
    end, arrow = arrow_end(views, light), (0.0, 0.0)
    if end is not None:
        right, down = (a - b for a, b in zip(views.position(side, end), (element, line), strict=True))
        length = math.hypot(right, down)
        # An arrow that points at the viewer or away is in no place's way.
        if length > SHORTEST:
            arrow = right / length, down / length
    return Cross(number, round(element), round(line), arrow)


def lines_across(views: OrthographicViews, side: Side, point: Vector) -> Item:
    """Thin lines through a point, which run on in the view beside or above."""
    area = side.area
    element, line = views.position(side, point)
    upright = joined([(element, area.top), (element, area.bottom)])
    level = joined([(area.left, line), (area.right, line)])
    return segments(together([upright, level]), SLATE, area)


def drawn_items(layers: Mapping[int, Sequence[Floats]]) -> list[Item]:
    """Strokes that are clipped already, by their words, each with the area that they need."""
    found = []
    for word, parts in layers.items():
        strokes = together(parts)
        if len(strokes):
            stream = instructions.write_segments(rounded(strokes), word).tobytes()
            found.append(Item(area_around(strokes), stream))
    return found


def area_around(strokes: Floats) -> Area:
    """The pixels around some strokes, at least one."""
    low, high = rounded(strokes.min(axis=0)).tolist(), rounded(strokes.max(axis=0)).tolist()
    return Area(min(low[0], low[2]), min(low[1], low[3]), max(high[0], high[2]), max(high[1], high[3]))
