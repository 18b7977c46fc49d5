"""The words that the color mixing screen borrows: for the ramps of two colors, and for swatches.

A surface may own nearly all words, so there are none for these colors between the surfaces; see
`borrowed_words`. The chosen surface stays visible: where it has to lend words, too, they are spread so that
each level that it lends is shown by its neighbor.
"""

from __future__ import annotations

from functools import lru_cache
from typing import Final, NamedTuple

import numpy as np

from autocolor.arrays import Bytes, Words
from autocolor.checks import Color
from autocolor.immutable import read_only
from autocolor.mapping.borrowed_words import borrowed_words, without_words
from autocolor.mapping.color_blending import entries_of
from autocolor.mapping.level_ranges import WORDS, LevelRange
from autocolor.scene.surfaces import Paint
from autocolor.widgets.colors import NIGHT

RAMP_STEPS: Final = 64
"""The intensities of a ramp, from black to the color itself."""

Ranges = tuple[tuple[str, LevelRange], ...]
"""The level ranges of the surfaces in use by name, so that they can be a key."""


class Palette(NamedTuple):
    """The words that show a surface, and colors beside it."""

    borrowed: Words
    """The words for colors: those of two ramps of RAMP_STEPS each, then those of swatches; rising."""
    runs: tuple[slice, ...]
    """The parts of `borrowed` whose words follow each other."""
    shown: Words
    """The word that stands for each word of the picture, (1024,): NIGHT for those of other surfaces."""

    @property
    def light_ramp(self) -> Words:
        """The words of the intensities of the light color, from the lowest."""
        return self.borrowed[:RAMP_STEPS]

    @property
    def object_ramp(self) -> Words:
        """The words of the intensities of the object color, from the lowest."""
        return self.borrowed[RAMP_STEPS : 2 * RAMP_STEPS]

    @property
    def swatches(self) -> Words:
        """The words of the swatches."""
        return self.borrowed[2 * RAMP_STEPS :]

    def loads(self, light: Color, object_color: Color, swatches: Bytes) -> list[tuple[int, Bytes]]:
        """The entries of the words, as runs of colors from a first entry on; `swatches` has (n, 3)."""
        colors = np.concatenate([ramp_of(light), ramp_of(object_color), swatches])
        return [(int(self.borrowed[run.start]), colors[run]) for run in self.runs]


@lru_cache(maxsize=8)
def palette_of(ranges: Ranges, surface: str, swatches: int) -> Palette:
    """The palette for a surface in use and a number of swatches.

    Raises UsageError if there are not so many words to borrow.
    """
    levels = dict(ranges)[surface]
    borrowed = borrowed_words(dict(ranges), {surface}, 2 * RAMP_STEPS + swatches)
    ends = np.flatnonzero(np.diff(borrowed) != 1) + 1
    bounds = [0, *ends.tolist(), len(borrowed)]
    own = np.arange(levels.first, levels.last + 1, dtype=np.uint16)
    shown = np.full(WORDS, NIGHT, np.uint16)
    shown[own] = without_words(own, borrowed, {surface: levels})
    return Palette(borrowed, tuple(map(slice, bounds, bounds[1:])), read_only(shown))


def ramp_of(color: Color) -> Bytes:
    """The intensities of a color, (RAMP_STEPS, 3) uint8: step k is k / (RAMP_STEPS - 1) of it, half up.

    They are the entries of a surface of that color alone, with as many levels.
    """
    return entries_of(Paint(color, color, blend=1.0), RAMP_STEPS)
