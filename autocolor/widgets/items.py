"""Items: the parts of a page, each with the area that it covers and the instructions that draw it.

An item changes no pixel outside its area. Its instructions set every parameter that they depend on, so that
items can be drawn in any company; equal items draw the same. An item beyond every display draws nothing.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import lru_cache
from typing import Final, NamedTuple

import numpy as np

from autocolor.arrays import Floats, Numbers, Words
from autocolor.checks import printable
from autocolor.mapping.ranges import SCREENS
from ramtek_emu import instructions

# The words on a page, and who owns their entries. Word 0, the background, and the words of the surfaces have
# the entries of the scene. The sixteen highest words, `SCREENS`, have constant entries: the colors below.
#
# Screen                        Words                                            Borrowed entries
# over the picture              all; SCREENS over the picture                    none
# light and view                SCREENS; all in its small picture                none
# color mixing                  SCREENS; the chosen surface's in a picture       shades, hues, swatches, and
#                               and a bar                                        grays of the other surfaces
# light blending                all; the chosen surface's again in a bar         none
# entries                       all, each in its cell                            none
# variants, file                SCREENS                                          the palette of a gallery, in
#                                                                                the words of all surfaces
# sent, help                    SCREENS                                          none
#
# A screen borrows entries by `Content.loads` alone. A sheet loads the entries that differ from the page
# before, and writes the words of another base. So the next page restores what a screen borrowed or covered.

WIDTH: Final = 640
HEIGHT: Final = 480
"""The size that the screens are laid out for, in elements and lines."""

BLACK: Final = SCREENS.first
WHITE: Final = SCREENS.first + 1
LIGHT_GRAY: Final = SCREENS.first + 2
GRAY: Final = SCREENS.first + 3
SLATE: Final = SCREENS.first + 4
NIGHT: Final = SCREENS.first + 5
YELLOW: Final = SCREENS.first + 6
ORANGE: Final = SCREENS.first + 7
RED: Final = SCREENS.first + 8
GREEN: Final = SCREENS.first + 9
BLUE: Final = SCREENS.first + 10
"""White is for text, light gray for dim text, yellow for the chosen thing, orange for warnings; red, green
and blue are for axes and for components of colors."""


# Positions are an element and a line. Whole numbers are the centers of pixels, line 0 on top.


class Area(NamedTuple):
    """A rectangle of pixels, its edges included."""

    left: int
    top: int
    right: int
    bottom: int

    @property
    def width(self) -> int:
        """The number of elements."""
        return self.right - self.left + 1

    @property
    def height(self) -> int:
        """The number of lines."""
        return self.bottom - self.top + 1

    @property
    def is_empty(self) -> bool:
        """Whether it has no pixels."""
        return self.right < self.left or self.bottom < self.top

    def has(self, element: float, line: float) -> bool:
        """Whether a position is inside."""
        return self.left <= element <= self.right and self.top <= line <= self.bottom

    @property
    def middle(self) -> tuple[float, float]:
        """The element and the line of the middle, which may lie between pixels."""
        return (self.left + self.right) / 2, (self.top + self.bottom) / 2

    def overlaps(self, other: Area) -> bool:
        """Whether the two have a pixel in common."""
        return not self.within(other).is_empty

    def covers(self, other: Area) -> bool:
        """Whether all pixels of another area are inside."""
        return self.within(other) == other

    def within(self, other: Area) -> Area:
        """The pixels that both areas have."""
        return Area(
            max(self.left, other.left),
            max(self.top, other.top),
            min(self.right, other.right),
            min(self.bottom, other.bottom),
        )

    def inset(self, margin: int) -> Area:
        """The area without a margin on all sides."""
        return Area(self.left + margin, self.top + margin, self.right - margin, self.bottom - margin)


SCREEN: Final = Area(0, 0, WIDTH - 1, HEIGHT - 1)


# Strokes: straight lines on the screen, (n, 4) float64: element and line of the start, and of the end.


def clipped(strokes: Floats, area: Area) -> Floats:
    """The parts of strokes within an area, between the centers of its outer pixels, (inside, 4).

    A stroke outside of the area is left out; a stroke that touches its border leaves a point.
    """
    # Most strokes of most screens are inside.
    if (strokes >= (*area[:2], *area[:2])).all() and (strokes <= (*area[2:], *area[2:])).all():
        return strokes
    start, end = strokes.T[:2], strokes.T[2:]
    step = end - start
    low = np.array([[area.left], [area.top]], np.float64)
    high = np.array([[area.right], [area.bottom]], np.float64)

    # Find the fractions of each stroke at which it enters and leaves between two borders. A stroke parallel
    # to both borders is between them over its whole length, or never.
    along = step == 0
    divisor = np.where(along, 1.0, step)
    with np.errstate(over="ignore"):
        at_low, at_high = (low - start) / divisor, (high - start) / divisor
    outside = (along & ((start < low) | (start > high))).any(axis=0)
    enters = np.where(along, 0.0, np.minimum(at_low, at_high)).max(axis=0, initial=0.0)
    leaves = np.where(along, 1.0, np.maximum(at_low, at_high)).min(axis=0, initial=1.0)
    inside = np.flatnonzero(~outside & (enters <= leaves))

    # Keep the ends that lie in the area as they are, and let no rounding lead outside of it.
    start, step, end = start[:, inside], step[:, inside], end[:, inside]
    enters, leaves = enters[inside], leaves[inside]
    starts = np.where(enters > 0, start + enters * step, start)
    ends = np.where(leaves < 1, start + leaves * step, end)
    return np.concatenate([np.clip(starts, low, high), np.clip(ends, low, high)]).T


def joined(positions: Floats | Sequence[tuple[float, float]]) -> Floats:
    """The strokes from each position of (n, 2) to the next, (n - 1, 4).

    >>> joined([(0, 0), (4, 0), (4, 3)]).tolist()
    [[0.0, 0.0, 4.0, 0.0], [4.0, 0.0, 4.0, 3.0]]
    """
    places = np.asarray(positions, np.float64).reshape(-1, 2)
    return np.concatenate([places[:-1], places[1:]], axis=1)


def together(strokes: Sequence[Floats]) -> Floats:
    """All strokes of several arrays, (n, 4)."""
    return np.concatenate([np.empty((0, 4)), *strokes])


CHARACTER: Final = 7
"""Elements from one character of a text to the next."""

CHARACTER_LINES: Final = 9


DRAWABLE: Final = Area(-0x8000, -0x8000, 0x7FFF, 0x7FFF)
"""Hardware: the range of the sixteen bits of an element and a line."""


class Item(NamedTuple):
    """A part of a page: its area, and the words of its instructions in bytes, as in an array of `Words`.

    A solid item draws every pixel of its area, whatever is below it.
    """

    area: Area
    stream: bytes
    is_solid: bool = False
    word: int | None = None
    """The word of every pixel; None if there are several."""


@lru_cache(maxsize=4096)
def filled(area: Area, word: int) -> Item:
    """An area filled with one word."""
    drawn = area.within(DRAWABLE)
    if drawn.is_empty:
        return Item(area, b"")
    return Item(drawn, instructions.erase(drawn, word).tobytes(), True, word)


@lru_cache(maxsize=4096)
def text(line: str, left: int, top: int, word: int = WHITE, background: int = NIGHT, size: int = 1) -> Item:
    """A line of text whose upper left corner is at (left, top), on a background."""
    width = CHARACTER * size * max(1, len(line))
    area = Area(left, top, left + width - 1, top + CHARACTER_LINES * size - 1)
    if not line or not DRAWABLE.covers(area):
        return Item(area, b"")
    stream = instructions.write_text(printable(line), left, top, word, background, size).tobytes()
    return Item(area, stream, True)


@lru_cache(maxsize=1024)
def outline(area: Area, word: int) -> Item:
    """The edges of an area, one pixel wide."""
    left, top, right, bottom = area
    return lines([[(left, top), (right, top), (right, bottom), (left, bottom), (left, top)]], word, area)


def lines(polylines: Iterable[Sequence[tuple[float, float]] | Floats], word: int, area: Area) -> Item:
    """Polylines, each of (n, 2) elements and lines, clipped at an area, without infinite strokes."""
    return segments(together([joined(each) for each in polylines]), word, area)


def segments(strokes: Floats, word: int, area: Area) -> Item:
    """Unlinked lines, (n, 4) element and line of both ends, clipped at an area.

    Hardware: the 9300 clips lines at its memory alone; the write window is of later models.
    """
    inside = area.within(DRAWABLE)
    pixels = rounded(clipped(strokes[np.isfinite(strokes).all(axis=1)], inside))
    is_drawn = len(pixels) and not inside.is_empty
    return Item(area, instructions.write_segments(pixels, word).tobytes() if is_drawn else b"")


def image(words: Words, left: int, top: int) -> Item:
    """An array of words, (lines, elements), with its upper left corner at (left, top)."""
    down, across = words.shape
    area = Area(left, top, left + across - 1, top + down - 1)
    if area.is_empty or not DRAWABLE.covers(area):
        return Item(area, b"")
    return Item(area, instructions.write_image(words, left, top).tobytes(), is_solid=True)


# Pointers: triangles that show where a handle stands, and where something opens.

REACH: Final = 4
"""Elements or lines from the middle of a pointer to its ends."""

RIGHT: Final = 0
DOWN: Final = 1
LEFT: Final = 2
UP: Final = 3
"""The directions of a pointer."""


@lru_cache(maxsize=1024)
def pointer(element: int, line: int, towards: int, word: int, ground: int = NIGHT) -> Item:
    """A triangle whose tip is at an element and a line, on a ground."""
    shape = _POINTERS[towards]
    down, across = shape.shape
    left = element - (across - 1, REACH, 0, REACH)[towards]
    top = line - (REACH, down - 1, REACH, 0)[towards]
    return image(np.where(shape, word, ground).astype(np.uint16), left, top)


_RIGHT: Final = np.arange(REACH + 1) + np.abs(np.arange(-REACH, REACH + 1))[:, None] <= REACH
_POINTERS: Final = (_RIGHT, _RIGHT.T, _RIGHT[:, ::-1], _RIGHT.T[::-1])


def area_of(points: Floats, margin: int = 0, limit: Area = SCREEN) -> Area:
    """The area of (n, 2) elements and lines with a margin around them, within a limit."""
    if not len(points):
        return Area(limit.left, limit.top, limit.left - 1, limit.top - 1)
    low, high = rounded(points.min(axis=0)), rounded(points.max(axis=0))
    around = Area(int(low[0]) - margin, int(low[1]) - margin, int(high[0]) + margin, int(high[1]) + margin)
    return around.within(limit)


def rounded(places: Floats) -> Numbers:
    """Places as whole elements and lines, half up, within `DRAWABLE`."""
    return np.clip(np.floor(places + 0.5), DRAWABLE.left, DRAWABLE.right).astype(np.int64)


def fitted(line: str, most: int) -> str:
    """A text of at most `most` characters. A longer text loses its middle, because ends of names differ.

    >>> fitted("fender of the left door 12.obj", 16), fitted("windscreen", 1), fitted("windscreen", -1)
    ('fender .. 12.obj', '.', '')
    """
    if len(line) <= most:
        return line
    end = max(0, (most - 2) // 2)
    return f"{line[: max(0, most - 2 - end)]}..{line[len(line) - end :]}"[: max(0, most)]
