from __future__ import annotations

import numpy as np
from hypothesis import strategies as st

from ramtek_emu.memory.frame_buffer import FrameBuffer, WriteEnable
from ramtek_emu.memory.scan_orders import SCAN_ORDERS, Point, Window
from tests.ramtek_emu.strategies import SMALL

seeds = st.integers(0, 2**32 - 1)
rasters = seeds.map(lambda seed: np.random.default_rng(seed).integers(0, 1024, (9, 13), np.uint16))
"""Words of a small memory."""


def test_written_counts_the_words_that_reached_the_memory() -> None:
    buffer = FrameBuffer(SMALL)
    counts = []
    for window, mask in ((Window(-2, 0, 1, 0), 0xFFFF), (Window(0, 0, 3, 3), 0), (Window(12, 7, 20, 20), 1)):
        buffer.fill(window, 5, WriteEnable(mask))
        counts.append(buffer.written)
    buffer.write_points(np.array([0, 50]), np.array([0, 0]), 9)
    counts.append(buffer.written)
    dots = np.array([[True, False, True]])
    buffer.write_block(Point(0, 0), SCAN_ORDERS[0], np.ones((1, 3), np.uint16), WriteEnable(1), dots)
    assert [*counts, buffer.written] == [2, 2, 4, 5, 7]
