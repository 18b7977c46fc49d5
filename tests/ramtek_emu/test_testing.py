from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import find, given

from ramtek_emu import Ramtek9300
from ramtek_emu.arrays import Colors, Raster
from ramtek_emu.testing import check_words_within_planes, entries, rasters, streams, words
from tests.ramtek_emu.strategies import SMALL


@pytest.mark.parametrize("planes", [1, 8, 10, 16])
def test_the_largest_and_the_least_word_are_those_of_the_planes(planes: int) -> None:
    largest = (1 << planes) - 1
    assert find(words(planes), lambda word: word == largest) == largest
    assert find(words(planes), lambda word: True) == 0


@given(rasters(3, 4), entries(5))
def test_rasters_and_entries_have_the_shapes_and_types_of_the_memories(
    raster: Raster[np.uint16], table: Colors
) -> None:
    assert (raster.shape, raster.dtype.str) == ((3, 4), "<u2")
    assert (table.shape, table.dtype.str) == ((5, 3), "|u1")
    check_words_within_planes(raster)


def test_the_simplest_stream_that_writes_a_word_is_short() -> None:
    def writes_a_word(stream: list[int]) -> bool:
        display = Ramtek9300(SMALL)
        display.send(np.array(stream, np.uint16))
        return bool(display.words.any())

    assert len(find(streams(), writes_a_word)) <= 6


@pytest.mark.parametrize(
    ("wrong", "planes", "message"),
    [
        ([[0, 1023], [7, 1024]], 10, "from 0 to 1023, not 1024 (line 1, element 1)"),
        (np.array([[-1, 5]]), 10, "from 0 to 1023, not -1 (line 0, element 0)"),
        (np.array([[0, 256, 999]], np.uint16), 8, "from 0 to 255, not 256 (line 0, element 1), and 1 more"),
        ([0, 70000], 16, "from 0 to 65535, not 70000 (at index 1)"),
        (4096, 12, "from 0 to 4095, not 4096"),
        ([[0.5]], 10, "from 0 to 1023, not float64"),
        ([True], 10, "from 0 to 1023, not bool"),
    ],
)
def test_words_outside_of_the_planes_are_told_with_their_place(wrong: Any, planes: int, message: str) -> None:
    with pytest.raises(AssertionError) as failure:
        check_words_within_planes(wrong, planes)
    assert str(failure.value) == f"words must be whole numbers {message}"


@pytest.mark.parametrize("planes", [1, 10, 16])
def test_words_within_the_planes_pass_whatever_their_type(planes: int) -> None:
    largest = (1 << planes) - 1
    for right in ([], 0, [[0, largest]], np.array([largest], np.int64), np.full((2, 2), largest, np.uint16)):
        check_words_within_planes(right, planes)
