from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from ramtek_emu.memory.frame_buffer import FrameBuffer, WriteEnable
from ramtek_emu.memory.scan_orders import SCAN_ORDERS, Point, Window
from ramtek_emu.testing import words
from tests.ramtek_emu import reference
from tests.ramtek_emu.strategies import SMALL, masks, points, scan_codes, windows

seeds = st.integers(0, 2**32 - 1)
rasters = seeds.map(lambda seed: np.random.default_rng(seed).integers(0, 1024, (9, 13), np.uint16))
"""Words of a small memory."""


def filled(raster: NDArray[np.uint16]) -> FrameBuffer:
    buffer = FrameBuffer(SMALL)
    buffer.restore({"words": raster})
    return buffer


@given(
    rasters,
    windows(),
    scan_codes,
    points,
    seeds,
    st.integers(0, 300),
    masks,
    windows() | st.just(WriteEnable().window),
    st.booleans(),
)
def test_writing_a_run_equals_a_walk_word_by_word(
    raster: NDArray[np.uint16],
    window: Window,
    code: int,
    start: Point,
    seed: int,
    count: int,
    mask: int,
    clip: Window,
    has_whole_runs: bool,
) -> None:
    order = SCAN_ORDERS[code]
    if has_whole_runs:
        along, runs = order.inner_and_outer(window)
        start = order.stepped(order.corner(window), 0, count % runs)
        count -= count % along
    words = np.random.default_rng(seed).integers(0, 1 << 16, count, np.uint16)
    buffer = filled(raster)
    twin = raster.tolist()
    after = buffer.write_scan(window, order, start, words, WriteEnable(mask, clip))
    twin_after = reference.write_scan(twin, window, code, start, words.tolist(), mask & 1023, clip)
    assert buffer.words.tolist() == twin
    assert after == twin_after


@given(rasters, windows(), scan_codes, points, st.integers(0, 300))
def test_reading_a_run_equals_a_walk_word_by_word(
    raster: NDArray[np.uint16], window: Window, code: int, start: Point, count: int
) -> None:
    words, after = filled(raster).read_scan(window, SCAN_ORDERS[code], start, count)
    twin_words, twin_after = reference.read_scan(raster.tolist(), window, code, start, count)
    assert words.tolist() == twin_words
    assert after == twin_after


@given(rasters, windows(), words(16), masks, st.none() | st.integers(0, 1 << 32))
def test_a_fill_equals_a_run_of_a_repeated_word(
    raster: NDArray[np.uint16], window: Window, word: int, mask: int, seed: int | None
) -> None:
    buffer, twin = filled(raster), filled(raster)
    size = window.width * window.height
    dots = None if seed is None else np.random.default_rng(seed).random(size) < 0.5
    shape = window.height, window.width
    buffer.fill(window, word, WriteEnable(mask), None if dots is None else dots.reshape(shape))
    twin.write_scan(
        window,
        SCAN_ORDERS[0],
        Point(window.left, window.top),
        np.full(size, word, np.uint16),
        WriteEnable(mask),
        dots,
    )
    assert buffer.written == twin.written
    assert buffer.words.tolist() == twin.words.tolist()


@pytest.mark.parametrize("window", [Window(5, 3, 4, 3), Window(5, 3, 5, 2), Window(20, 20, 30, 30)])
def test_a_window_without_words_takes_none_and_leaves_the_point(window: Window) -> None:
    buffer = FrameBuffer(SMALL)
    buffer.fill(window, 7)
    corner = Point(window.left, window.top)
    after = buffer.write_scan(window, SCAN_ORDERS[0], corner, np.array([1, 2, 3], np.uint16))
    assert not buffer.words.any()
    if not (window.width and window.height):
        assert after == Point(5, 3)


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


def test_the_words_of_a_display_are_read_only_and_stay_current() -> None:
    buffer = FrameBuffer(SMALL)
    words = buffer.words
    buffer.fill(buffer.window, 3)
    assert (words == 3).all()
    with pytest.raises(ValueError, match="read-only"):
        words[0, 0] = 1
