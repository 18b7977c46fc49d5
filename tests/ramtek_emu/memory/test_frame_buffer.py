from __future__ import annotations

from random import Random

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from ramtek_emu.memory.frame_buffer import FrameBuffer, WriteEnable
from ramtek_emu.memory.scan_orders import SCAN_ORDERS, Point, Window
from tests.ramtek_emu.strategies import SMALL, scan_codes, windows


def test_written_counts_the_words_that_reached_the_memory() -> None:
    buffer = FrameBuffer(SMALL)
    counts = []
    for window, mask in ((Window(-2, 0, 1, 0), 0xFFFF), (Window(0, 0, 3, 3), 0), (Window(12, 7, 20, 20), 1)):
        buffer.fill(window, 5, WriteEnable(mask))
        counts.append(buffer.written)
    buffer.write_points(np.array([0, 50]), np.array([0, 0]), 9)
    counts.append(buffer.written)
    dots = np.array([[True, False, True]])
    buffer.write_block(Window(0, 0, 2, 0), SCAN_ORDERS[0], np.ones((1, 3), np.uint16), WriteEnable(1), dots)
    assert [*counts, buffer.written] == [2, 2, 4, 5, 7]


@given(
    windows(),
    scan_codes,
    st.integers(0, 99),
    windows(),
    st.tuples(st.integers(-3, 9), st.integers(-3, 9)),
    st.none() | st.randoms(use_true_random=False),
    st.booleans(),
)
def test_words_around_a_window_are_written_and_read_as_single_words_or_pairs_are(
    window: Window,
    code: int,
    count: int,
    write_window: Window,
    start: tuple[int, int],
    random: Random | None,
    pairs: bool,
) -> None:
    order, enable = SCAN_ORDERS[code], WriteEnable(0x3F5, write_window)
    whole, single = FrameBuffer(SMALL), FrameBuffer(SMALL)
    words = np.arange(1, count + 1, dtype=np.uint16)
    dots = None if random is None else np.array([random.random() < 0.3 for _ in words], np.bool_)
    end = whole.write_scan(window, order, Point(*start), words, enable, dots, pairs)
    place = Point(*start)
    parts = [slice(first, first + 1 + pairs) for first in range(0, count, 1 + pairs)]
    for part in parts:
        part_dots = None if dots is None else dots[part]
        place = single.write_scan(window, order, place, words[part], enable, part_dots, pairs)
    assert end == place
    assert (whole.words == single.words).all()
    assert whole.written == single.written
    read, place = [], Point(*start)
    for part in parts:
        row, place = single.read_scan(window, order, place, len(words[part]), pairs)
        read += row.tolist()
    row, end = whole.read_scan(window, order, Point(*start), count, pairs)
    assert (row.tolist(), end) == (read, place)
