"""The items of the marks in the three views: the eye, the lights with their numbers, the chosen one's flaps.

What did not move is not made anew: items are kept by the values that they show.
"""

from __future__ import annotations

from functools import lru_cache

from autocolor.checks import Vector
from autocolor.scene.lights import Light
from autocolor.scene.view import View
from autocolor.screens.light_and_view.eye_marks import eye_marks
from autocolor.screens.light_and_view.light_marks import flap_marks, light_marks
from autocolor.screens.light_and_view.orthographic_views import OrthographicViews, Side
from autocolor.widgets.areas import Area
from autocolor.widgets.colors import BLUE, GRAY, LIGHT_GRAY, SLATE, WHITE, YELLOW
from autocolor.widgets.items import CHARACTER, CHARACTER_LINES, Item, filled, segments, text


@lru_cache(maxsize=64)
def eye_items(views: OrthographicViews, side: Side, view: View, target: Vector) -> tuple[Item, ...]:
    """The eye, the view direction, and the edges of the picture."""
    marks = eye_marks(views, side, view, target)
    return (
        segments(marks.picture, SLATE, side.area),
        segments(marks.direction, BLUE, side.area),
        segments(marks.eye, BLUE, side.area),
    )


@lru_cache(maxsize=512)
def light_items(
    views: OrthographicViews, side: Side, light: Light, number: int, is_chosen: bool
) -> tuple[Item, ...]:
    """A light with its number: a cross, an arrow, its cone; of the chosen one the lines of its flaps, too."""
    area = side.area
    word = YELLOW if is_chosen else WHITE if light.on else GRAY
    marks = light_marks(views, side, light)
    quiet = word if is_chosen else GRAY
    found = [
        segments(marks.cone, quiet, area),
        segments(marks.arrow, word if is_chosen else LIGHT_GRAY if light.on else GRAY, area),
        segments(marks.cross, word, area),
    ]
    element, line = (round(each) for each in views.position(side, light.position))
    left, top = element + 6, line - 11
    numeral = Area(left, top, left + CHARACTER * len(str(number)) - 1, top + CHARACTER_LINES - 1)
    if area.covers(numeral):
        found.append(text(str(number), left, top, word))
    if is_chosen:
        for mark in flap_marks(views, side, light):
            found.append(segments(mark.stroke, word if mark.on else GRAY, area))
    return tuple(found)


def lines_across(views: OrthographicViews, side: Side, point: Vector) -> list[Item]:
    """Thin lines through a point, which run on in the view beside or above."""
    area = side.area
    element, line = (round(each) for each in views.position(side, point))
    found = []
    if area.left <= element <= area.right:
        found.append(filled(Area(element, area.top, element, area.bottom), SLATE))
    if area.top <= line <= area.bottom:
        found.append(filled(Area(area.left, line, area.right, line), SLATE))
    return found
