"""The words of the color mixing screen: borrowed words for colors, and the words of its picture.

The surfaces may own nearly all words, so the screen borrows words of surfaces; see `borrowed_words`. If the
chosen surface must lend words, too, they are spread over its levels, and the level beside each lent level is
shown instead. The other surfaces are shown in GRAYS, whose words are borrowed, too.
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import Final, NamedTuple

import numpy as np

from autocolor.arrays import HALF, Booleans, Bytes, Numbers, Words
from autocolor.checks import Color
from autocolor.immutable import read_only
from autocolor.mapping.colors import FULL, Hsv, color_of_hsv, ramp_entries
from autocolor.mapping.ranges import BACKGROUND, SCREENS, WORDS, LevelRange, borrowed_words, without_words
from autocolor.widgets.items import NIGHT, Area

SHADE_STEPS: Final = 64
"""The shades of a color, from black to the color itself."""

GRAYS: Final = read_only(np.linspace((26, 28, 33), (104, 106, 112), 16).astype(np.uint8))
"""Assumed: the grays of the surfaces that are not chosen, from black to white; dim beside the chosen one."""

HUES: Final = read_only(np.array([color_of_hsv(Hsv(hue, 100, 100)) for hue in range(0, 361, 10)], np.uint8))
"""The colors along the hue bar."""

LUMINANCE: Final = (0.299, 0.587, 0.114)
"""The shares of red, green and blue in the gray that stands for a color, as in television."""


class MixingWords(NamedTuple):
    """The words that show a surface and the colors beside it."""

    light_shades: Words
    object_shades: Words
    """The words of the shades of the two colors, from the darkest."""
    grays: Words
    """The words of the grays, from the darkest."""
    hues: Words
    """The words of the hues, from 0 to 360 degrees."""
    swatches: Words
    """The words of the swatches."""
    shown: Words
    """The word that stands for each word of the picture, (1024,): NIGHT for words of other surfaces."""
    others: Words
    """The words of the other surfaces, (n,)."""

    def table(self, entries: Bytes, light: Color, object_color: Color, swatches: Bytes) -> Bytes:
        """The lookup table with the colors of the borrowed words, (1024, 3); `swatches` has (n, 3)."""
        table = np.array(entries)
        shades = [ramp_entries(((0, 0, 0), color), SHADE_STEPS) for color in (light, object_color)]
        table[np.concatenate(self[:5])] = np.concatenate([*shades, GRAYS, HUES, swatches])
        return table

    def dimmed(self, entries: Bytes) -> Words:
        """`shown`, with a gray for each word of another surface, as light as its entry; (1024,) uint16."""
        light = entries[self.others] @ np.array(LUMINANCE)
        words = np.array(self.shown)
        words[self.others] = self.grays[(light * ((len(GRAYS) - 1) / FULL) + HALF).astype(np.int64)]
        return words


@lru_cache(maxsize=8)
def mixing_words(ranges: tuple[tuple[str, LevelRange], ...], surface: str, swatches: int) -> MixingWords:
    """The words for a surface in use and a number of swatches, by the level ranges of the surfaces in use.

    Raises UsageError if there are too few words to borrow.
    """
    levels = dict(ranges)[surface]
    counts = np.cumsum([SHADE_STEPS, SHADE_STEPS, len(GRAYS), len(HUES), swatches])
    borrowed = borrowed_words(dict(ranges), {surface}, int(counts[-1]))
    own = np.arange(levels.first, levels.last + 1, dtype=np.uint16)
    shown = np.full(WORDS, NIGHT, np.uint16)
    shown[own] = without_words(own, borrowed, {surface: levels})
    others = np.setdiff1d(np.arange(BACKGROUND + 1, SCREENS.first, dtype=np.uint16), own)
    light, object_color, grays, hues, cells = np.split(borrowed, counts[:-1])
    return MixingWords(light, object_color, grays, hues, cells, read_only(shown), read_only(others))


# A crop: the part of the picture that shows a surface as large as an area allows, at most at its full size.
# Words are picked and never averaged, so a crop is recolored by the table alone.


class Crop(NamedTuple):
    """An area of the screen, and the line and the element of the picture that its lines and elements show."""

    area: Area
    lines: Numbers
    elements: Numbers

    def of(self, words: Words) -> Words:
        """The words of a picture that the area shows."""
        return words[self.lines[:, None], self.elements]

    def pixel_at(self, element: int, line: int) -> tuple[int, int] | None:
        """The line and the element of the picture at a place of the screen; None beside the area."""
        if not self.area.has(element, line):
            return None
        return int(self.lines[line - self.area.top]), int(self.elements[element - self.area.left])


def crop_of(is_shown: Booleans, room: Area) -> Crop:
    """The crop around some pixels of a picture, (lines, elements), in the middle of a room.

    If no pixel is to be shown, the crop is the whole picture.
    """
    if not is_shown.any():
        is_shown = np.ones_like(is_shown)
    down, across = (np.flatnonzero(is_shown.any(axis=axis)) for axis in (1, 0))
    scale = max(1.0, (down[-1] + 1 - down[0]) / room.height, (across[-1] + 1 - across[0]) / room.width)
    lines = _around(down, scale, room.height, is_shown.shape[0])
    elements = _around(across, scale, room.width, is_shown.shape[1])
    left = room.left + (room.width - len(elements)) // 2
    top = room.top + (room.height - len(lines)) // 2
    return Crop(Area(left, top, left + len(elements) - 1, top + len(lines) - 1), lines, elements)


def _around(shown: Numbers, scale: float, room: int, length: int) -> Numbers:
    """The places of a picture of some length that fill a room, with `shown` in the middle if possible."""
    count = min(room, math.floor(length / scale + 1e-9))
    start = min(max((shown[0] + shown[-1] + 1 - count * scale) / 2, 0.0), length - count * scale)
    places: Numbers = (start + (np.arange(count) + 0.5) * scale).astype(np.int64)
    return places
