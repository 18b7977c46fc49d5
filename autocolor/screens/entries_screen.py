"""The table page: the 1024 entries as 32 x 32 cells, each filled with its own word, the ranges outlined."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

import numpy as np

from autocolor.arrays import Words
from autocolor.mapping.level_ranges import BACKGROUND, SCREENS, WORDS, LevelRange
from autocolor.screens.drawing import HEIGHT, WIDTH, YELLOW
from ramtek_emu import HostPort, instructions

SIDE: Final = 32
ACROSS: Final = WIDTH // SIDE
DOWN: Final = HEIGHT // SIDE


def cell_words(ranges: Mapping[str, LevelRange]) -> Words:
    """The page as words, (480, 640) uint16: a line runs between cells of different owners."""
    words = np.arange(WORDS, dtype=np.uint16).reshape(SIDE, SIDE)
    owners = np.zeros(WORDS, np.intp)
    for number, (first, levels) in enumerate([*ranges.values(), SCREENS, LevelRange(BACKGROUND, 1)], start=1):
        owners[first : first + levels] = number
    owner = owners.reshape(SIDE, SIDE)
    page = words.repeat(DOWN, axis=0).repeat(ACROSS, axis=1)
    # Mark each cell's border where its neighbor has another owner, on both sides of it.
    owner = owner.repeat(DOWN, axis=0).repeat(ACROSS, axis=1)
    across, down = owner[:, 1:] != owner[:, :-1], owner[1:] != owner[:-1]
    for part, other in ((page[:, 1:], across), (page[:, :-1], across), (page[1:], down), (page[:-1], down)):
        part[other] = YELLOW
    return page


def draw_entries(display: HostPort, ranges: Mapping[str, LevelRange]) -> None:
    """Show the page; entries that change afterwards change on it too."""
    display.send(instructions.write_image(cell_words(ranges)))
