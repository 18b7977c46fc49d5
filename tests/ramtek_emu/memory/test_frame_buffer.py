from __future__ import annotations

import copy
import pickle
from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from ramtek_emu.memory.frame_buffer import FrameBuffer, WriteEnable
from ramtek_emu.memory.scan_orders import SCAN_ORDERS, Point, Window
from tests.ramtek_emu.strategies import SMALL, masks
from tests.tables import refused

seeds = st.integers(0, 2**32 - 1)
rasters = seeds.map(lambda seed: np.random.default_rng(seed).integers(0, 1024, (9, 13), np.uint16))
"""Words of a small memory."""


@given(rasters, masks, st.booleans())
def test_written_counts_the_words_whose_dots_are_true(
    raster: NDArray[np.uint16], mask: int, has_dots: bool
) -> None:
    buffer = FrameBuffer(SMALL)
    dots = raster % 2 == 1 if has_dots else None
    buffer.write_block(Point(0, 0), SCAN_ORDERS[0], raster, WriteEnable(mask), dots)
    most = raster.size if dots is None else np.count_nonzero(dots)
    assert buffer.written == (most if mask & 1023 else 0)


def test_written_counts_the_words_that_reached_the_memory() -> None:
    buffer = FrameBuffer(SMALL)
    counts = []
    for window, mask in ((Window(-2, 0, 1, 0), 0xFFFF), (Window(0, 0, 3, 3), 0), (Window(12, 7, 20, 20), 1)):
        buffer.fill(window, 5, WriteEnable(mask))
        counts.append(buffer.written)
    buffer.write_points(np.array([0, 50]), np.array([0, 0]), 9)
    assert [*counts, buffer.written] == [2, 2, 4, 5]


def test_the_words_of_a_display_are_read_only_and_stay_current() -> None:
    buffer = FrameBuffer(SMALL)
    words = buffer.words
    buffer.fill(buffer.window, 3)
    assert (words == 3).all()
    with pytest.raises(ValueError, match="read-only"):
        words[0, 0] = 1


test_words_that_do_not_fit_are_refused_by_name = refused(
    lambda given: FrameBuffer(SMALL).write(*given),
    [
        (([[0, 1024]], 0, 0), "a word must be 0 to 1023, not 1024 (line 0, element 1); use fewer levels"),
        (([[0], [-1]], 0, 0), "a word must be 0 to 1023, not -1 (line 1, element 0); use fewer levels"),
        (
            ([[0.5]], 0, 0),
            "words must be whole numbers, not float64; convert them first, rounding half up",
        ),
        (
            ([1, 2], 0, 0),
            "words must be a (lines, elements) array with at least one word, not of shape (2,); "
            "pass words[np.newaxis] for one line",
        ),
        (
            ([[1, 2]], 12, 0),
            "the words' window must lie within elements 0 to 12 and lines 0 to 8, not 12 to 13 and 0 to 0; "
            "move it or cut it",
        ),
    ],
)


@pytest.mark.parametrize("copied", [copy.deepcopy, lambda memory: pickle.loads(pickle.dumps(memory))])
def test_a_copy_has_its_own_words_and_a_view_of_them(copied: Callable[[FrameBuffer], FrameBuffer]) -> None:
    memory = FrameBuffer(SMALL)
    memory.write([[1, 2]], 3, 1)
    twin = copied(memory)
    assert twin.words[1, 3:5].tolist() == [1, 2]
    assert not twin.words.flags.writeable
    twin.write([[7]], 3, 1)
    assert (twin.words[1, 3], memory.words[1, 3]) == (7, 1)
    assert (twin.written, memory.written) == (3, 2)
    assert (twin.planes, twin.window) == (memory.planes, memory.window)
