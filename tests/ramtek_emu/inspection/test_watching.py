from __future__ import annotations

import copy

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from ramtek_emu import Ramtek9300
from ramtek_emu.inspection.watching import watched, watched_table
from ramtek_emu.memory.frame_buffer import WriteEnable
from ramtek_emu.memory.scan_orders import SCAN_ORDERS, Window
from ramtek_emu.testing import streams
from tests.ramtek_emu.strategies import SMALL, masks, points, scan_codes, windows


@given(st.data(), windows(), scan_codes, masks, windows())
def test_a_scan_touches_the_words_that_it_writes(
    data: st.DataObject, window: Window, code: int, mask: int, enabled: Window
) -> None:
    along = data.draw(st.integers(1, 40))
    dots = data.draw(st.none() | st.lists(st.booleans(), min_size=along, max_size=along))
    watch = data.draw(windows().map(lambda window: window.intersection(Window(0, 0, 12, 8))))
    if watch.is_empty:
        watch = Window(0, 0, 12, 8)
    written = []
    touched = np.zeros((9, 13), np.bool_)
    # A word that becomes 0 whether it was 0 or all ones before is written.
    for before in (0, 0x3FF):
        frame_buffer = watched(Ramtek9300(SMALL))
        frame_buffer.fill(frame_buffer.window, before)
        touched = frame_buffer.watch(watch)
        frame_buffer.write_scan(
            window,
            SCAN_ORDERS[code],
            SCAN_ORDERS[code].corner(window),
            np.zeros(along, np.uint16),
            WriteEnable(mask, enabled),
            None if dots is None else np.array(dots),
        )
        written.append(frame_buffer.words.copy())
    differs_less = (written[0] ^ written[1]) != 0x3FF
    assert (touched == differs_less[watch.top : watch.bottom + 1, watch.left : watch.right + 1]).all()


@given(st.lists(points, max_size=12), masks, windows())
def test_points_touch_the_words_that_they_write(
    places: list[tuple[int, int]], mask: int, enabled: Window
) -> None:
    frame_buffer = watched(Ramtek9300(SMALL))
    touched = frame_buffer.watch(Window(2, 1, 9, 7))
    elements, lines = np.array(places, np.int64).reshape(-1, 2).T
    frame_buffer.write_points(elements, lines, 5, WriteEnable(mask, enabled))
    expected = np.zeros((9, 13), np.bool_)
    for element, line in places:
        if 0 <= element <= 12 and 0 <= line <= 8 and mask & 0x3FF:
            expected[line, element] |= enabled.left <= element <= enabled.right and (
                enabled.top <= line <= enabled.bottom
            )
    assert (touched == expected[1:8, 2:10]).all()


@given(streams())
def test_a_watched_display_draws_as_any_other(words: list[int]) -> None:
    plain, display = Ramtek9300(SMALL), Ramtek9300(SMALL)
    watched(display).watch(display.frame_buffer.window)
    watched_table(display).watch()
    for each in (plain, display):
        each.send(np.array(words, np.uint16))
    assert (display.words == plain.words).all()
    assert (display.entries == plain.entries).all()
    assert display.frame_buffer.written == plain.frame_buffer.written
    # A copy is not watched.
    copied = copy.deepcopy(display)
    copied.frame_buffer.fill(copied.frame_buffer.window, 1)
    assert (display.words == plain.words).all()
