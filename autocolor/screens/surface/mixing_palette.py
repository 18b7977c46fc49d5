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
from autocolor.mapping.colors import FULL, Hsv, color_of_hsv, entries_of
from autocolor.mapping.ranges import BACKGROUND, SCREENS, WORDS, LevelRange, borrowed_words, without_words
from autocolor.scene.surfaces import Paint
from autocolor.widgets.items import NIGHT, Area

SHADE_STEPS: Final = 64
"""The shades of a color, from black to the color itself."""

GRAYS: Final = read_only(np.linspace((26, 28, 33), (104, 106, 112), 16).astype(np.uint8))
"""Assumed: the grays of the surfaces that are not chosen, from black to white; dim beside the chosen one."""

HUES: Final = read_only(np.array([color_of_hsv(Hsv(hue, 100, 100)) for hue in range(0, 361, 10)], np.uint8))
"""The colors along the hue bar."""

LUMINANCE: Final = (0.299, 0.587, 0.114)
"""The shares of red, green and blue in the gray that stands for a color, as in television."""

Ranges = tuple[tuple[str, LevelRange], ...]
"""The level ranges of the surfaces in use by name, so that they can be a key."""


class MixingWords(NamedTuple):
    """The words that show a surface and the colors beside it."""

    borrowed: Words
    """The words for colors, rising: the shades of two colors, the grays, the hues, then the swatches."""
    runs: tuple[slice, ...]
    """The runs of consecutive words in `borrowed`."""
    shown: Words
    """The word that stands for each word of the picture, (1024,): NIGHT for words of other surfaces."""
    others: Words
    """The words of the other surfaces, (n,)."""

    @property
    def light_shades(self) -> Words:
        """The words of the shades of the light color, from the darkest."""
        return self.borrowed[:SHADE_STEPS]

    @property
    def object_shades(self) -> Words:
        """The words of the shades of the object color, from the darkest."""
        return self.borrowed[SHADE_STEPS : 2 * SHADE_STEPS]

    @property
    def grays(self) -> Words:
        """The words of the grays, from the darkest."""
        return self.borrowed[2 * SHADE_STEPS :][: len(GRAYS)]

    @property
    def hues(self) -> Words:
        """The words of the hues, from 0 to 360 degrees."""
        return self.borrowed[2 * SHADE_STEPS + len(GRAYS) :][: len(HUES)]

    @property
    def swatches(self) -> Words:
        """The words of the swatches."""
        return self.borrowed[2 * SHADE_STEPS + len(GRAYS) + len(HUES) :]

    def loads(self, light: Color, object_color: Color, swatches: Bytes) -> list[tuple[int, Bytes]]:
        """The entries of the words, as runs of colors from a first entry on; `swatches` has (n, 3)."""
        colors = np.concatenate([shades_of(light), shades_of(object_color), GRAYS, HUES, swatches])
        return [(int(self.borrowed[run.start]), colors[run]) for run in self.runs]

    def dimmed(self, entries: Bytes) -> Words:
        """`shown`, with a gray for each word of another surface, as light as its entry; (1024,) uint16.

        It is the same array as long as the entries of the other surfaces are equal.
        """
        others = entries.take(self.others, axis=0).tobytes()
        return _dimmed(self.shown.tobytes(), self.others.tobytes(), self.grays.tobytes(), others)


@lru_cache(maxsize=8)
def mixing_words(ranges: Ranges, surface: str, swatches: int) -> MixingWords:
    """The words for a surface in use and a number of swatches.

    Raises UsageError if there are too few words to borrow.
    """
    levels = dict(ranges)[surface]
    count = 2 * SHADE_STEPS + len(GRAYS) + len(HUES) + swatches
    borrowed = borrowed_words(dict(ranges), {surface}, count)
    ends = np.flatnonzero(np.diff(borrowed) != 1) + 1
    bounds = [0, *ends.tolist(), len(borrowed)]
    own = np.arange(levels.first, levels.last + 1, dtype=np.uint16)
    shown = np.full(WORDS, NIGHT, np.uint16)
    shown[own] = without_words(own, borrowed, {surface: levels})
    others = np.setdiff1d(np.arange(BACKGROUND + 1, SCREENS.first, dtype=np.uint16), own)
    return MixingWords(borrowed, tuple(map(slice, bounds, bounds[1:])), read_only(shown), read_only(others))


@lru_cache(maxsize=8)
def _dimmed(shown: bytes, others: bytes, grays: bytes, entries: bytes) -> Words:
    """The words of `MixingWords.dimmed`, from arrays as bytes."""
    colors = np.frombuffer(entries, np.uint8).reshape(-1, 3)
    steps = np.floor(colors @ np.array(LUMINANCE) * ((len(GRAYS) - 1) / FULL) + HALF).astype(np.int64)
    words = np.frombuffer(shown, np.uint16).copy()
    words[np.frombuffer(others, np.uint16)] = np.frombuffer(grays, np.uint16)[steps]
    return read_only(words)


@lru_cache(maxsize=64)
def shades_of(color: Color) -> Bytes:
    """The shades of a color, (SHADE_STEPS, 3) uint8: step k is k / (SHADE_STEPS - 1) of it, half up.

    They are the entries of a surface of that color alone, with as many levels.
    """
    return entries_of(Paint(color, color, blend=1.0), SHADE_STEPS)


# A crop: the part of the picture that shows a surface as large as an area allows, at most at its full size.
# Words are picked and never averaged, so a crop is recolored by the table alone.

AROUND: Final = 4
"""Elements and lines of the picture that are shown around a surface, if the picture has them."""


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
    lines, elements = np.flatnonzero(is_shown.any(axis=1)), np.flatnonzero(is_shown.any(axis=0))
    top, bottom = _widened(lines, is_shown.shape[0])
    left, right = _widened(elements, is_shown.shape[1])
    scale = max((right - left) / room.width, (bottom - top) / room.height, 1.0)
    down = _along(top, bottom, scale, room.height, is_shown.shape[0])
    across = _along(left, right, scale, room.width, is_shown.shape[1])
    left_edge = room.left + (room.width - len(across)) // 2
    top_edge = room.top + (room.height - len(down)) // 2
    area = Area(left_edge, top_edge, left_edge + len(across) - 1, top_edge + len(down) - 1)
    return Crop(area, down, across)


def _widened(places: Numbers, length: int) -> tuple[int, int]:
    """The first place and the end of rising places, with some more around them; of no places, all."""
    if not len(places):
        return 0, length
    return max(0, int(places[0]) - AROUND), min(length, int(places[-1]) + 1 + AROUND)


def _along(first: int, end: int, scale: float, room: int, length: int) -> Numbers:
    """The places of a picture of some length that fill a room, with `first` to `end` in its middle."""
    count = min(room, math.floor(length / scale + 1e-9))
    start = min(max((first + end - count * scale) / 2, 0.0), length - count * scale)
    places: Numbers = (start + (np.arange(count) + 0.5) * scale).astype(np.int64)
    return np.minimum(places, length - 1)
