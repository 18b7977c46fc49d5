"""The entries screen: the 1024 entries as 32 x 32 cells, each level range with its outline and name."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import lru_cache
from typing import Final

import numpy as np

from autocolor.arrays import Words
from autocolor.mapping.ranges import BACKDROP, BACKGROUND, SCREENS, WORDS, LevelRange
from autocolor.screens.screen import Content, Screen, Surroundings
from autocolor.widgets.items import BLACK, CHARACTER, HEIGHT, WHITE, WIDTH, YELLOW, fitted, text

SIDE: Final = 32
CELL_WIDTH: Final = WIDTH // SIDE
CELL_HEIGHT: Final = HEIGHT // SIDE
MARGIN: Final = 3


@lru_cache(maxsize=1)
def cell_words(ranges: tuple[LevelRange, ...]) -> Words:
    """The page, (480, 640) uint16: a cell is filled with its word. Equal ranges give the same array."""
    words = np.arange(WORDS, dtype=np.uint16)
    owners = np.zeros(WORDS, np.uint16)
    for number, (first, levels) in enumerate([*ranges, SCREENS, LevelRange(BACKGROUND, 1)], start=1):
        owners[first : first + levels] = number
    pages = (each.reshape(SIDE, SIDE) for each in (words, owners))
    page, owner = (each.repeat(CELL_HEIGHT, axis=0).repeat(CELL_WIDTH, axis=1) for each in pages)
    # Draw the outlines: mark each pixel that has a neighbor of another owner.
    around = np.pad(owner, 1, "edge")
    neighbors = around[1:-1, :-2], around[1:-1, 2:], around[:-2, 1:-1], around[2:, 1:-1]
    page[np.any([each != owner for each in neighbors], axis=0)] = YELLOW
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


class EntriesScreen(Screen):
    """The present lookup table; changes of the entries show at once."""

    name = "entries"
    title = "entries"
    word = "table"
    help = "The 1024 entries of the lookup table, and who owns them"
    has_menu = False
    shows_scene = False

    def build(self, around: Surroundings) -> Content:
        backdrop = {"backdrop": BACKDROP} if self.session.scene.has_backdrop else {}
        ranges = {**backdrop, **self.session.studio.level_ranges}
        names = [
            text(name, column * CELL_WIDTH + MARGIN, row * CELL_HEIGHT + MARGIN, WHITE, BLACK)
            for name, row, column in named_cells(ranges)
        ]
        return Content(base=cell_words(tuple(ranges.values())), items=names)
