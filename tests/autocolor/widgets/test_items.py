from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor.arrays import Booleans
from autocolor.widgets.areas import Area
from autocolor.widgets.colors import NIGHT, WHITE
from autocolor.widgets.items import (
    DRAWABLE,
    Item,
    area_of,
    filled,
    image,
    lines,
    outline,
    text,
)
from ramtek_emu import PRINCETON_9300, Ramtek9300, instructions
from tests.autocolor.widgets.drawing import TINY, draw_items, items

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


@given(items())
def test_an_item_changes_no_pixel_outside_its_area(item: Item) -> None:
    for ground in (UNUSED, 0):
        display = painted(item, ground=ground)
        assert (display.words[~inside(item.area, display)] == ground).all()


@given(items())
def test_a_solid_item_draws_every_pixel_of_its_area(item: Item) -> None:
    one, other = painted(item, ground=UNUSED), painted(item, ground=0)
    if item.is_solid:
        within = inside(item.area, one)
        assert np.array_equal(one.words[within], other.words[within])


@given(items(), st.lists(items(), max_size=4))
def test_an_item_draws_the_same_in_any_company(item: Item, before: list[Item]) -> None:
    assert np.array_equal(painted(item).words, painted(item, *before).words)


@given(items())
def test_a_display_without_the_operands_of_the_9400_draws_the_same(item: Item) -> None:
    princeton = painted(item, display=Ramtek9300(PRINCETON_9300))
    tiny = painted(item)
    assert np.array_equal(princeton.words[:40, :48], tiny.words)


def test_text_stays_in_its_cells() -> None:
    display = painted(text("Hg", 10, 5, size=2), ground=NIGHT)
    line_numbers, elements = np.nonzero(display.words == WHITE)
    assert line_numbers.min() >= 5
    assert line_numbers.max() < 23
    assert elements.min() >= 10
    assert elements.max() < 38


def test_lines_that_leave_an_area_are_drawn_inside_it_and_come_back() -> None:
    area = Area(10, 10, 20, 20)
    display = painted(lines([[(5, 15), (25, 15), (25, 12), (12, 12)]], WHITE, area))
    assert (display.words[15, 10:21] == WHITE).all()
    assert (display.words[12, 12:21] == WHITE).all()
    assert np.count_nonzero(display.words == WHITE) == 11 + 9


def test_a_line_of_any_length_keeps_its_slope() -> None:
    display = painted(lines([[(-1e6, -1e6), (1e6, 1e6)]], WHITE, Area(0, 0, 39, 39)))
    assert (np.diagonal(display.words[:40, :40]) == WHITE).all()


def test_a_line_inside_its_area_is_drawn_as_one_instruction_draws_it() -> None:
    vertices = [(3, 4), (30, 17), (8, 30)]
    expected = painted(filled(Area(0, 0, -1, -1), 0))
    expected.send(instructions.write_vectors(vertices, WHITE))
    assert np.array_equal(painted(lines([vertices], WHITE, Area(0, 0, 47, 39))).words, expected.words)


def test_an_outline_is_one_pixel_wide() -> None:
    display = painted(outline(Area(5, 6, 14, 12), WHITE))
    assert np.count_nonzero(display.words == WHITE) == 2 * 10 + 2 * 5


def test_an_image_is_shown_word_by_word_also_across_the_edge() -> None:
    words = np.arange(60, dtype=np.uint16).reshape(6, 10)
    display = painted(image(words, -4, -2))
    assert np.array_equal(display.words[:4, :6], words[2:, 4:])


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


def test_an_area_larger_than_what_can_be_told_fills_the_display() -> None:
    assert (painted(filled(Area(-100_000, -100_000, 100_000, 100_000), 5)).words == 5).all()
    assert DRAWABLE.covers(filled(Area(-100_000, 0, 100_000, 9), 5).area)


def test_the_area_of_points_has_a_margin_within_a_limit() -> None:
    points = np.array([(3.4, 9.5), (20.0, 2.0)])
    assert area_of(points, 2) == (1, 0, 22, 12)
    assert area_of(points, 2, Area(5, 5, 10, 10)) == (5, 5, 10, 10)
    assert area_of(np.empty((0, 2))).is_empty
