"""Items: the parts of a page, each with the area that it covers and the instructions that draw it.

An item changes no pixel outside its area. Its instructions set every parameter that they depend on, so that
items can be drawn in any company; two that are equal draw the same.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import lru_cache
from typing import Final, NamedTuple

import numpy as np

from autocolor.arrays import Floats, Numbers, Words
from autocolor.widgets.colors import HEIGHT, NIGHT, WHITE, WIDTH
from ramtek_emu import instructions

CHARACTER: Final = 7
"""Elements from one character of a text to the next."""

CHARACTER_LINES: Final = 9


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

    def has(self, element: int, line: int) -> bool:
        """Whether a pixel is inside."""
        return self.left <= element <= self.right and self.top <= line <= self.bottom

    def overlaps(self, other: Area) -> bool:
        """Whether the two have a pixel in common."""
        return (
            self.left <= other.right
            and other.left <= self.right
            and self.top <= other.bottom
            and other.top <= self.bottom
        )

    def covers(self, other: Area) -> bool:
        """Whether all pixels of another area are inside."""
        return (
            self.left <= other.left
            and other.right <= self.right
            and self.top <= other.top
            and other.bottom <= self.bottom
        )

    def within(self, other: Area) -> Area:
        """The pixels that both have."""
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


class Item(NamedTuple):
    """Something on a page: its area, and the words of its instructions in bytes, as `Words` holds them.

    `is_solid` tells that it draws every pixel of its area, whatever was there.
    """

    area: Area
    stream: bytes
    is_solid: bool = False


@lru_cache(maxsize=4096)
def filled(area: Area, word: int) -> Item:
    """An area filled with one word."""
    return Item(area, instructions.erase(area, word).tobytes(), is_solid=True)


@lru_cache(maxsize=4096)
def text(line: str, left: int, top: int, word: int = WHITE, background: int = NIGHT, size: int = 1) -> Item:
    """A line of text whose upper left corner is at (left, top), on a background."""
    width = CHARACTER * size * max(1, len(line))
    area = Area(left, top, left + width - 1, top + CHARACTER_LINES * size - 1)
    return Item(area, instructions.write_text(line, left, top, word, background, size).tobytes(), True)


@lru_cache(maxsize=1024)
def outline(area: Area, word: int) -> Item:
    """The edges of an area, one pixel wide."""
    left, top, right, bottom = area
    corners = ((left, top), (right, top), (right, bottom), (left, bottom), (left, top))
    return lines([corners], word, area)


def lines(polylines: Iterable[Sequence[Sequence[float]] | Floats], word: int, area: Area) -> Item:
    """Polylines, each of (n, 2) elements and lines, clipped at an area."""
    parts = [instructions.set_parameters(window=tuple(area), foreground=word)]
    for each in polylines:
        vertices = rounded(np.asarray(each, np.float64))
        if len(vertices):
            parts.append(instructions.write_vectors(vertices))
    return Item(area, np.concatenate(parts).tobytes())


def segments(strokes: Floats, word: int, area: Area) -> Item:
    """Unlinked lines, (n, 4) element and line of both ends, clipped at an area."""
    if not len(strokes):
        return Item(area, b"")
    return Item(area, instructions.write_segments(rounded(strokes), word, area).tobytes())


def image(words: Words, left: int, top: int) -> Item:
    """An array of words, (lines, elements), with its upper left corner at (left, top)."""
    down, across = words.shape
    area = Area(left, top, left + across - 1, top + down - 1)
    return Item(area, instructions.write_image(words, left, top).tobytes(), is_solid=True)


def area_of(points: Floats, margin: int = 0, limit: Area = SCREEN) -> Area:
    """The area of (n, 2) elements and lines with a margin around them, within a limit."""
    if not len(points):
        return Area(limit.left, limit.top, limit.left - 1, limit.top - 1)
    low, high = rounded(points.min(axis=0)), rounded(points.max(axis=0))
    around = Area(int(low[0]) - margin, int(low[1]) - margin, int(high[0]) + margin, int(high[1]) + margin)
    return around.within(limit)


def rounded(places: Floats) -> Numbers:
    """Places as whole elements and lines, half up, within what a vertex can be."""
    return np.clip(np.floor(places + 0.5), -0x8000, 0x7FFF).astype(np.int64)


def fitted(line: str, most: int) -> str:
    """A line of text that has at most so many characters; a longer one is cut and ends in two periods.

    >>> fitted("windscreen", 10), fitted("windscreen", 6), fitted("windscreen", 1)
    ('windscreen', 'wind..', '.')
    """
    return line if len(line) <= most else f"{line[: max(0, most - 2)]}.."[:most]
