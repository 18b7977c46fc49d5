from __future__ import annotations

from collections.abc import Generator
from typing import TypeVar

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays
from numpy.typing import NDArray

from ramtek_emu.drawing.areas import area, connected, links

Result = TypeVar("Result")


def returned(pauses: Generator[None, None, Result]) -> Result:
    """What a generator returns after all its pauses."""
    while True:
        try:
            next(pauses)
        except StopIteration as end:
            result: Result = end.value
            return result


def reached(open_pixels: NDArray[np.bool_], line: int, element: int) -> set[tuple[int, int]]:
    """The open pixels that a walk from a pixel reaches, step by step."""
    lines, elements = open_pixels.shape
    waiting = [(line, element)] if open_pixels[line, element] else []
    filled = set(waiting)
    while waiting:
        n, e = waiting.pop()
        for place in ((n + 1, e), (n - 1, e), (n, e + 1), (n, e - 1)):
            inside = 0 <= place[0] < lines and 0 <= place[1] < elements
            if inside and place not in filled and open_pixels[place]:
                filled.add(place)
                waiting.append(place)
    return filled


@given(arrays.arrays(np.bool_, st.tuples(st.integers(1, 8), st.integers(1, 9))), st.data())
def test_an_area_has_the_pixels_that_a_walk_reaches(
    open_pixels: NDArray[np.bool_], data: st.DataObject
) -> None:
    line = data.draw(st.integers(0, open_pixels.shape[0] - 1))
    element = data.draw(st.integers(0, open_pixels.shape[1] - 1))
    filled = {(n, e) for n, e in np.argwhere(returned(area(open_pixels, line, element))).tolist()}
    assert filled == reached(open_pixels, line, element)


@pytest.mark.parametrize("side", [1, 2, 31, 200])
def test_a_spiral_is_one_area_from_its_end_to_its_middle(side: int) -> None:
    open_pixels = np.zeros((side, side), np.bool_)
    steps = [(0, 1), (1, 0), (0, -1), (-1, 0)]
    line = element = turn = 0
    open_pixels[0, 0] = True
    length = side - 1
    while length > 0:
        for _ in range(2 if turn else 3):
            down, across = steps[turn % 4]
            for _ in range(length):
                line, element = line + down, element + across
                open_pixels[line, element] = True
            turn += 1
        length -= 2
    assert (returned(area(open_pixels, 0, 0)) == open_pixels).all()
    assert (returned(area(open_pixels, line, element)) == open_pixels).all()


def test_runs_touch_when_they_share_an_element_of_neighboring_lines() -> None:
    # Lines of ten pixels with runs 1 to 3; then 2 to 5 and 7 to 8; then 5 to 6.
    starts, ends = np.array([1, 12, 17, 25]), np.array([4, 16, 19, 27])
    upper, lower = links(starts, ends, 10)
    assert list(zip(upper.tolist(), lower.tolist(), strict=True)) == [(0, 1), (1, 3)]


@given(st.integers(1, 12), st.lists(st.tuples(st.integers(0, 11), st.integers(0, 11)), max_size=15))
def test_linked_runs_have_equal_labels(count: int, pairs: list[tuple[int, int]]) -> None:
    pairs = [(one % count, other % count) for one, other in pairs]
    one, other = (np.array([pair[side] for pair in pairs], np.intp) for side in (0, 1))
    labels = returned(connected(one, other, count)).tolist()
    groups = [{number} for number in range(count)]
    for first, second in pairs:
        merged = groups[first] | groups[second]
        for number in merged:
            groups[number] = merged
    for number in range(count):
        assert {other for other in range(count) if labels[other] == labels[number]} == groups[number]
