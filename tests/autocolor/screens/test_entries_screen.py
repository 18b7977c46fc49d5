from __future__ import annotations

import numpy as np
import pytest

from autocolor.mapping.level_ranges import BACKGROUND, SCREENS, LevelRange
from autocolor.screens.drawing import YELLOW
from autocolor.screens.entries_screen import CELL_HEIGHT, CELL_WIDTH, SIDE, cell_words, draw_entries
from ramtek_emu import Ramtek9300

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
    page = cell_words(RANGES)
    assert page.shape == (480, 640)
    for word in range(1024):
        inner = page[cell(word)][1:-1, 1:-1]
        assert (inner == word).all()


@pytest.mark.parametrize("word", [0, 1, 31, 32, 33, 500, 501, 532, 540, 541, 1007, 1008, 1023])
def test_a_line_runs_between_cells_of_different_owners(word: int) -> None:
    page = cell_words(RANGES)[cell(word)]
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


def test_the_page_is_drawn_by_instructions() -> None:
    display = Ramtek9300()
    draw_entries(display, RANGES)
    assert np.array_equal(display.words, cell_words(RANGES))
