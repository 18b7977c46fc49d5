from __future__ import annotations

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from ramtek_emu import FAMILY, Ramtek9300, instructions
from ramtek_emu.instruction_set.table import OPERANDS, Flags
from ramtek_emu.memory.character_rom import characters
from ramtek_emu.memory.cursors import BLINK, VISIBLE, Cursor
from ramtek_emu.memory.parameters import Parameters, coefficients, signed
from ramtek_emu.memory.scan_orders import SCAN_ORDERS, Point, Window, paired_parts
from ramtek_emu.processor.processor import Status
from ramtek_emu.testing import words
from tests.ramtek_emu import reference
from tests.ramtek_emu.displays import read
from tests.ramtek_emu.strategies import SMALL, points, scan_codes, sent_words, windows


@given(words(16))
def test_a_word_is_a_number_in_two_s_complement(word: int) -> None:
    assert signed(word) & 0xFFFF == word
    assert -0x8000 <= signed(word) <= 0x7FFF


@given(st.lists(st.integers(-0x8000, 0x7FFF), min_size=6, max_size=6))
def test_a_conic_is_the_same_in_single_words_and_in_pairs(numbers: list[int]) -> None:
    words = [number & 0xFFFF for number in numbers]
    pairs = [half for word in words for half in (0, word)]
    assert coefficients(tuple(words)) == coefficients(tuple(pairs)) == tuple(numbers)


def test_a_pair_with_a_high_word_is_a_number_of_32_bits() -> None:
    assert coefficients((1, 2, 0xFFFF, 0xFFFE, *[0] * 8)) == (0x10002, -2, 0, 0, 0, 0)


@given(windows(), scan_codes, st.sampled_from([0, Flags.INDEX_1, Flags.INDEX_2, Flags.RELATIVE]))
def test_a_window_moves_the_operating_point_to_where_its_scan_starts(
    window: Window, code: int, addressing: int
) -> None:
    parameters = Parameters.at_reset(SMALL)
    parameters.index_1, parameters.index_2, parameters.start = Point(3, -4), Point(-7, 2), Point(5, 6)
    base = parameters.base(addressing)
    words = tuple(number & 0xFFFF for number in window)
    parameters.take({"window": words, "scan_order": (code,)}, addressing)
    assert parameters.window == tuple(np.add(window, [*base, *base]))
    assert parameters.start == reference.corner(parameters.window, code)
    parameters.take({"window": words, "start": (1, 2)}, 0)
    assert parameters.start == (1, 2)


@pytest.mark.parametrize("name", OPERANDS)
def test_every_operand_is_read_as_the_words_that_set_it(name: str) -> None:
    parameters = Parameters.at_reset(SMALL)
    words = tuple(range(1, 1 + OPERANDS[name].words))
    parameters.take({name: words}, 0)
    assert parameters.operand(name) == words


def test_track_stays_on_and_enter_is_reported_once() -> None:
    display = Ramtek9300(FAMILY)
    display.joystick.move_to(320, 200)
    display.joystick.track = True
    display.joystick.press_enter()
    assert display.status == Status.READY | Status.CURSOR
    assert read(display, 0x1700) == [320, 200 | 0x3000]
    assert read(display, 0x1700) == [320, 200 | 0x1000]
    # The other cursor reports ENTER as well, independently.
    assert read(display, 0x1701) == [0, 0x3000]
    display.joystick.track = False
    assert read(display, 0x1701) == [0, 0]
    assert read(display, 0x2500) == [Status.CURSOR]
    assert display.status == Status.READY


def test_a_cursor_is_visible_and_blinks_by_its_bits() -> None:
    for state, is_visible, blinks in [
        (0, False, False), (VISIBLE, True, False), (BLINK, False, True), (VISIBLE | BLINK, True, True),
        (0xFFFF & ~(VISIBLE | BLINK), False, False),
    ]:  # fmt: skip
        cursor = Cursor(state=state)
        assert (cursor.is_visible, cursor.blinks) == (is_visible, blinks)


def test_reset_clears_an_unread_enter_and_leaves_the_cursors() -> None:
    display = Ramtek9300()
    display.send(sent_words([0x1600, 5, 0x406]))
    display.joystick.press_enter()
    display.send(instructions.reset())
    assert display.status == Status.READY
    assert read(display, 0x1700) == [5, 0x406]


def test_the_joystick_stays_on_the_screen_and_moves_its_cursors() -> None:
    display = Ramtek9300(FAMILY)
    display.joystick.move_to(10_000, -5)
    assert display.joystick.position == (639, 0)
    display.joystick.move_by(-9, 7)
    assert read(display, 0x1700, 0x1701) == [630, 7, 0, 0]
    display.send(sent_words([0x3300, 0x0002]))
    display.joystick.move_to(5, 6)
    assert read(display, 0x1700, 0x1701) == [630, 7, 5, 6]
    display.send(sent_words([0x3300, 0x0000]))
    display.joystick.move_to(50, 60)
    assert display.joystick.position == (0, 0)
    assert read(display, 0x1700, 0x1701) == [630, 7, 5, 6]


def places(window: Window) -> set[tuple[int, int]]:
    """Every pixel of a window."""
    elements, lines = range(window.left, window.right + 1), range(window.top, window.bottom + 1)
    return {(element, line) for element in elements for line in lines}


small = st.integers(-3, 6)
small_windows = st.builds(Window, small, small, small, small)


@given(small_windows, small_windows, st.builds(Point, small, small))
@example(Window(0, 0, 3, 3), Window(2, 2, 5, 5), Point(3, 3))
def test_windows_meet_where_pixels_are_in_both(one: Window, other: Window, point: Point) -> None:
    assert places(one.intersection(other)) == places(one) & places(other)
    assert one.is_empty is (not places(one))
    assert one.holds(point) is (point in places(one))
    assert (one.width * one.height) == len(places(one))


@given(windows(), scan_codes, points, st.integers(0, 400))
def test_a_run_steps_along_the_scan(window: Window, code: int, start: Point, count: int) -> None:
    order = SCAN_ORDERS[code]
    places = reference.walk(window, code, start, count)
    assert [order.after(window, start, number) for number in range(1, count + 1)] == places[1:]
    corner = order.corner(window)
    assert [order.stepped(corner, *order.steps(window, Point(*place))) for place in places] == places


@given(windows(), scan_codes, points, st.integers(1, 400))
def test_pixels_in_pairs_take_every_place_of_the_twin_in_order(
    window: Window, code: int, start: Point, count: int
) -> None:
    order = SCAN_ORDERS[code]
    parts = list(paired_parts(window, order, start, count))
    assert 1 <= len(parts) <= 2
    found = [
        order.after(part, begin, number) if number else begin
        for part, begin, size in parts
        for number in range(size)
    ]
    assert found == reference.walk(window, code, start, count, pairs=True)[:-1]


def test_every_printable_character_has_a_shape_of_its_own_that_touches_no_neighbor() -> None:
    shapes = characters()
    assert shapes.shape == (256, 9, 7)
    assert len({shapes[code].tobytes() for code in range(32, 127)}) == 127 - 32
    assert [code for code in range(128) if not shapes[code].any()] == [*range(33), 127]
    assert not shapes[:, 0].any()
    assert not shapes[:, :, [0, 6]].any()
