from __future__ import annotations

from collections.abc import Generator
from typing import TypeVar

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from ramtek_emu.drawing.areas import area

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


@given(st.integers(1, 12), st.integers(1, 13), st.sampled_from([0.4, 0.6, 0.8]), st.integers(0, 2**32 - 1))
def test_an_area_has_the_pixels_that_a_walk_reaches(
    lines: int, elements: int, density: float, seed: int
) -> None:
    random = np.random.default_rng(seed)
    for _ in range(8):
        open_pixels = random.random((lines, elements)) < density
        line, element = int(random.integers(lines)), int(random.integers(elements))
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
