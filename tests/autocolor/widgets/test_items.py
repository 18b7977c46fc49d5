from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor.arrays import Booleans
from autocolor.widgets.items import (
    DOWN,
    LEFT,
    RIGHT,
    UP,
    WHITE,
    Area,
    Item,
    area_of,
    clipped,
    filled,
    image,
    lines,
    outline,
    pointer,
    text,
)
from ramtek_emu import PRINCETON_9300, Ramtek9300, instructions
from tests.autocolor.widgets.drawing import TINY, areas, draw_items, items

UNUSED = 1023


def painted(item: Item, *before: Item, ground: int = UNUSED, display: Ramtek9300 | None = None) -> Ramtek9300:
    display = Ramtek9300(TINY) if display is None else display
    draw_items(display, before)
    display.send(instructions.erase(None, ground))
    display.send(instructions.erase((0, 0, display.words.shape[1] - 1, display.words.shape[0] - 1), ground))
    draw_items(display, [item])
    return display


def inside(area: Area, display: Ramtek9300) -> Booleans:
    rows, columns = np.indices(display.words.shape)
    across = np.logical_and(columns >= area.left, columns <= area.right)
    found: Booleans = np.logical_and(across, np.logical_and(rows >= area.top, rows <= area.bottom))
    return found


@given(items(), st.lists(items(), max_size=4))
def test_an_item_draws_its_area_alone_and_the_same_in_any_company(item: Item, before: list[Item]) -> None:
    shown, over_black = painted(item, *before), painted(item, ground=0)
    within = inside(item.area, shown)
    assert (shown.words[~within] == UNUSED).all()
    assert np.array_equal(painted(item).words, shown.words)
    # A solid item draws every pixel of its area.
    assert not item.is_solid or np.array_equal(shown.words[within], over_black.words[within])
    assert item.word is None or (shown.words[within] == item.word).all()


@given(items())
def test_a_display_without_the_operands_of_the_9400_draws_the_same(item: Item) -> None:
    princeton = painted(item, display=Ramtek9300(PRINCETON_9300))
    tiny = painted(item)
    assert np.array_equal(princeton.words[:40, :48], tiny.words)


def test_characters_that_cannot_be_printed_are_drawn_as_question_marks() -> None:
    assert text("a\x00\x1b\u202e\udcffb", 10, 5) == text("a????b", 10, 5)


def test_a_character_has_7_elements_and_9_lines() -> None:
    assert text("Hg", 10, 5, size=2).area == (10, 5, 37, 22)
    assert text("abc", 10, 5).area == (10, 5, 30, 13)
    nothing = text("", 10, 5)
    assert (nothing.area, nothing.is_solid) == ((10, 5, 16, 13), False)


def test_a_line_of_any_length_keeps_its_slope() -> None:
    display = painted(lines([[(-1e6, -1e6), (1e6, 1e6)]], WHITE, Area(0, 0, 39, 39)))
    assert (np.diagonal(display.words[:40, :40]) == WHITE).all()


def test_an_image_is_shown_word_by_word_also_across_the_edge() -> None:
    words = np.arange(60, dtype=np.uint16).reshape(6, 10)
    assert np.array_equal(painted(image(words, -4, -2)).words[:4, :6], words[2:, 4:])


@pytest.mark.parametrize("place", [-1_000_000, 1_000_000])
def test_what_is_beyond_every_display_draws_nothing(place: int) -> None:
    area = Area(place, place, place + 5, place + 5)
    for item in (
        filled(area, 1),
        outline(area, 1),
        text("a", place, place),
        lines([[(0, 0), (9, 9)]], 1, area),
    ):
        assert (painted(item).words == UNUSED).all()
    assert image(np.zeros((2, 2), np.uint16), place, place).stream == b""


def test_an_area_larger_than_every_display_fills_the_display() -> None:
    assert (painted(filled(Area(-100_000, -100_000, 100_000, 100_000), 5)).words == 5).all()


def test_the_area_of_points_has_a_margin_within_a_limit() -> None:
    points = np.array([(3.4, 9.5), (20.0, 2.0)])
    assert area_of(points, 2) == (1, 0, 22, 12)
    assert area_of(points, 2, Area(5, 5, 10, 10)) == (5, 5, 10, 10)
    assert area_of(np.empty((0, 2))).is_empty


@given(areas(), areas())
def test_areas_meet_where_pixels_are_in_both(one: Area, other: Area) -> None:
    def pixels(area: Area) -> set[tuple[int, int]]:
        return {
            (element, line)
            for element in range(area.left, area.right + 1)
            for line in range(area.top, area.bottom + 1)
        }

    assert pixels(one.within(other)) == pixels(one) & pixels(other)
    assert one.is_empty is (not pixels(one))
    if not one.is_empty and not other.is_empty:
        assert one.overlaps(other) is bool(pixels(one) & pixels(other))
        assert one.covers(other) is (pixels(one) >= pixels(other))
        assert len(pixels(one)) == one.width * one.height


AREA = Area(10, 20, 40, 40)

places = st.tuples(st.floats(-100, 100), st.floats(-100, 100))


@given(places, places)
def test_what_is_left_of_a_stroke_is_all_of_it_that_is_in_the_area(
    start: tuple[float, float], end: tuple[float, float]
) -> None:
    found = clipped(np.array([[*start, *end]]), AREA)
    along = np.linspace(0, 1, 201)[:, None]
    points = np.array(start) + along * (np.array(end) - np.array(start))
    inside = [point for point in points.tolist() if AREA.has(*point)]
    if not len(found):
        assert not inside
        return
    (kept,) = found.tolist()
    first, last = kept[:2], kept[2:]
    # Both ends are in the area and on the stroke, and each of its points in the area is between them.
    for place in (first, last):
        assert AREA.has(*place)
        whole = math.dist(start, place) + math.dist(place, end)
        assert whole == pytest.approx(math.dist(start, end), abs=1e-6)
    for point in inside:
        around = math.dist(first, point) + math.dist(point, last)
        assert around == pytest.approx(math.dist(first, last), abs=1e-6)


def test_strokes_of_any_size_end_within_the_area() -> None:
    rng = np.random.default_rng(0)
    strokes = rng.uniform(-1, 1, (2000, 4)) * 10.0 ** rng.uniform(-30, 60, (2000, 1))
    strokes = np.concatenate([strokes, strokes + np.array([20, 25, 20, 25]), [(12, 22, 12, 22 + 1e-14)]])
    strokes = np.concatenate([strokes, [(0, 22, 1e-320, 22), (12, 0, 12, 1e-320)]])
    with np.errstate(all="raise", under="ignore"):
        found = clipped(strokes, AREA)
    assert 0 < len(found) < len(strokes)
    assert (found >= np.tile([AREA.left, AREA.top], 2)).all()
    assert (found <= np.tile([AREA.right, AREA.bottom], 2)).all()


@pytest.mark.parametrize("towards", [RIGHT, DOWN, LEFT, UP])
def test_the_tip_of_a_pointer_is_at_its_place(towards: int) -> None:
    item = pointer(100, 50, towards, WHITE)
    display = Ramtek9300()
    display.send(np.frombuffer(item.stream, np.uint16))
    lines, elements = np.nonzero(display.words == WHITE)
    # It is as wide as two steps from its base to the tip, and on the other side of it.
    assert len(lines) == 25
    across, down = ((-1, 0), (0, -1), (1, 0), (0, 1))[towards]
    assert display.words[50, 100] == WHITE
    assert elements.mean() == pytest.approx(100 + across * 2.8)
    assert lines.mean() == pytest.approx(50 + down * 2.8)
