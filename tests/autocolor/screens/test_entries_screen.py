from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor.mapping.ranges import BACKGROUND, SCREENS, LevelRange
from autocolor.screens.entries_screen import (
    CELL_HEIGHT,
    CELL_WIDTH,
    SIDE,
    cell_words,
    named_cells,
)
from autocolor.widgets.items import CHARACTER, YELLOW

RANGES = {"body": LevelRange(1, 500), "glass": LevelRange(501, 40)}


def owner(word: int) -> str:
    if word == BACKGROUND:
        return "background"
    if word >= SCREENS.first:
        return "screens"
    return next(
        (name for name, (first, levels) in RANGES.items() if first <= word < first + levels), "nobody"
    )


def cell(word: int) -> tuple[slice, slice]:
    line, element = divmod(word, SIDE)
    return slice(line * CELL_HEIGHT, (line + 1) * CELL_HEIGHT), slice(
        element * CELL_WIDTH, (element + 1) * CELL_WIDTH
    )


def test_every_cell_shows_its_own_word() -> None:
    page = cell_words(tuple(RANGES.values()))
    assert page.shape == (480, 640)
    for word in range(1024):
        inner = page[cell(word)][1:-1, 1:-1]
        assert (inner == word).all()


@pytest.mark.parametrize("word", [0, 1, 31, 32, 33, 500, 501, 532, 540, 541, 1007, 1008, 1023])
def test_a_line_runs_between_cells_of_different_owners(word: int) -> None:
    page = cell_words(tuple(RANGES.values()))[cell(word)]
    line, element = divmod(word, SIDE)
    edges = (
        (line > 0, -SIDE, page[0, 1:-1]),
        (line < SIDE - 1, SIDE, page[-1, 1:-1]),
        (element > 0, -1, page[1:-1, 0]),
        (element < SIDE - 1, 1, page[1:-1, -1]),
    )
    for has_neighbor, step, edge in edges:
        apart = has_neighbor and owner(word) != owner(word + step)
        assert (edge == (YELLOW if apart else word)).all()


@given(st.lists(st.tuples(st.text("abc", min_size=1, max_size=30), st.integers(2, 300)), max_size=6))
def test_a_name_stands_within_the_cells_of_its_range(rows: list[tuple[str, int]]) -> None:
    ranges, first = {}, 1
    for name, levels in rows:
        if first + levels <= SCREENS.first and name not in ranges:
            ranges[name] = LevelRange(first, levels)
            first += levels
    named = list(named_cells(ranges))
    assert len(named) == len(ranges) + 1
    for (name, line, element), (whole, (start, levels)) in zip(
        named, [*ranges.items(), ("screens", SCREENS)], strict=True
    ):
        width = len(name) * CHARACTER + 3
        cells = range(line * SIDE + element, line * SIDE + element - (-width // CELL_WIDTH))
        assert set(cells) <= set(range(start, start + levels))
        assert element * CELL_WIDTH + width <= 640
        assert whole == name or name.rstrip(".") == whole[: len(name.rstrip("."))]
