"""The lookup table page: its 1024 entries as 32 x 32 cells, each level range with its outline and name."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Final

import numpy as np

from autocolor.arrays import Words
from autocolor.mapping.level_ranges import BACKGROUND, SCREENS, WORDS, LevelRange
from autocolor.screens.drawing import BLACK, CHARACTER, HEIGHT, WHITE, WIDTH, YELLOW, fitted, text
from ramtek_emu import HostPort, instructions

SIDE: Final = 32
CELL_WIDTH: Final = WIDTH // SIDE
CELL_HEIGHT: Final = HEIGHT // SIDE
MARGIN: Final = 3


def cell_words(ranges: Mapping[str, LevelRange]) -> Words:
    """The page as words, (480, 640) uint16: each cell is filled with its own word."""
    words = np.arange(WORDS, dtype=np.uint16).reshape(SIDE, SIDE)
    owners = np.zeros(WORDS, np.intp)
    for number, (first, levels) in enumerate([*ranges.values(), SCREENS, LevelRange(BACKGROUND, 1)], start=1):
        owners[first : first + levels] = number
    owner = owners.reshape(SIDE, SIDE)
    page = words.repeat(CELL_HEIGHT, axis=0).repeat(CELL_WIDTH, axis=1)
    # Draw the outlines: mark both pixels wherever neighboring pixels have different owners.
    owner = owner.repeat(CELL_HEIGHT, axis=0).repeat(CELL_WIDTH, axis=1)
    columns_differ, rows_differ = owner[:, 1:] != owner[:, :-1], owner[1:] != owner[:-1]
    page[:, 1:][columns_differ] = YELLOW
    page[:, :-1][columns_differ] = YELLOW
    page[1:][rows_differ] = YELLOW
    page[:-1][rows_differ] = YELLOW
    return page


def named_cells(ranges: Mapping[str, LevelRange]) -> Iterator[tuple[str, int, int]]:
    """The name of each range, cut to fit, with the row and the column of the cell where it is written.

    It is written in the first row of the range, or in the second one if it fits only there.
    """
    for name, (first, levels) in {**ranges, "screens": SCREENS}.items():
        row, column = divmod(first, SIDE)
        cells = min(levels, SIDE - column)
        if _characters(cells) < min(len(name), _characters(levels - cells)):
            row, column, cells = row + 1, 0, levels - cells
        yield fitted(name, _characters(cells)), row, column


def _characters(cells: int) -> int:
    """How many characters fit in some cells of a row."""
    return (min(cells, SIDE) * CELL_WIDTH - 2 * MARGIN) // CHARACTER


def draw_entries(display: HostPort, ranges: Mapping[str, LevelRange]) -> None:
    """Show the page; it also shows later changes of the entries."""
    display.send(instructions.write_image(cell_words(ranges)))
    for name, row, column in named_cells(ranges):
        text(display, name, column * CELL_WIDTH + MARGIN, row * CELL_HEIGHT + MARGIN, WHITE, BLACK)
