"""Swatch fields: colors to pick from, in rows of cells."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import lru_cache
from typing import Final

import numpy as np

from autocolor.arrays import Words
from autocolor.widgets.areas import Area
from autocolor.widgets.colors import NIGHT
from autocolor.widgets.items import Item, image
from autocolor.widgets.widget import Place, Widget

GROUT: Final = 1
"""Lines and elements of the ground at the right and lower edge of each cell."""


@dataclass(frozen=True)
class SwatchField(Widget):
    """Cells, each filled with a word of its own, row by row from the upper left corner of the area.

    `take` is called with the number of a cell: of the one that is picked, and, in a drag, of each one that is
    come to. The number of cells may be less than what fits.
    """

    words: Words = field(default_factory=lambda: np.empty(0, np.uint16))
    across: int = 1
    """Cells in a row."""
    width: int = 16
    height: int = 16
    """Elements and lines of a cell."""
    take: Callable[[int], object] = lambda _: None

    def items(self, lit: bool) -> list[Item]:
        return list(_cells(self.words.tobytes(), self.area, self.across, self.width, self.height))

    def cell_at(self, place: Place) -> int | None:
        """The number of the cell at a place, if there is one."""
        column, row = (
            (place.element - self.area.left) // self.width,
            (place.line - self.area.top) // self.height,
        )
        number = row * self.across + column
        is_there = 0 <= column < self.across and 0 <= number < len(self.words)
        return number if is_there else None

    def pick(self, place: Place) -> object:
        number = self.cell_at(place)
        return None if number is None else self.take(number)

    def drag(self, start: Place, last: Place, place: Place) -> object:
        return self.pick(place)


@lru_cache(maxsize=8)
def _cells(data: bytes, area: Area, across: int, width: int, height: int) -> tuple[Item, ...]:
    words = np.frombuffer(data, np.uint16)
    if not len(words):
        return ()
    rows = -(-len(words) // across)
    grid = np.full(rows * across, NIGHT, np.uint16)
    grid[: len(words)] = words
    cells = grid.reshape(rows, across).repeat(height, axis=0).repeat(width, axis=1)
    for edge in range(GROUT):
        cells[height - 1 - edge :: height] = NIGHT
        cells[:, width - 1 - edge :: width] = NIGHT
    return (image(cells, area.left, area.top),)
