"""Items: the parts of a page, each with the area that it covers and the instructions that draw it.

An item changes no pixel outside its area. Its instructions set every parameter that they depend on, so that
items can be drawn in any company; two that are equal draw the same. What lies beyond every display draws
nothing.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import lru_cache
from typing import Final, NamedTuple

import numpy as np

from autocolor.arrays import Floats, Numbers, Words
from autocolor.widgets.areas import SCREEN, Area
from autocolor.widgets.colors import NIGHT, WHITE
from autocolor.widgets.strokes import clipped, joined
from ramtek_emu import instructions

CHARACTER: Final = 7
"""Elements from one character of a text to the next."""

CHARACTER_LINES: Final = 9


DRAWABLE: Final = Area(-0x8000, -0x8000, 0x7FFF, 0x7FFF)
"""Hardware: what the sixteen bits of an element and a line can tell."""


class Item(NamedTuple):
    """Something on a page: its area, and the words of its instructions in bytes, as `Words` holds them.

    `is_solid` tells that it draws every pixel of its area, whatever was there.
    """

    area: Area
    stream: bytes
    is_solid: bool = False
    word: int | None = None
    """The word that fills it whole, if it is of one."""


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
    return Item(area, instructions.write_text(line, left, top, word, background, size).tobytes(), True)


@lru_cache(maxsize=1024)
def outline(area: Area, word: int) -> Item:
    """The edges of an area, one pixel wide."""
    left, top, right, bottom = area
    return lines([[(left, top), (right, top), (right, bottom), (left, bottom), (left, top)]], word, area)


def lines(polylines: Iterable[Sequence[tuple[float, float]] | Floats], word: int, area: Area) -> Item:
    """Polylines, each of (n, 2) elements and lines, clipped at an area; what is not finite is left out."""
    parts = []
    for each in polylines:
        pixels = pixels_inside(joined(each), area)
        # What is still linked after the clipping goes into one instruction.
        breaks = np.flatnonzero((pixels[1:, :2] != pixels[:-1, 2:]).any(axis=1)) + 1
        for chain in np.split(pixels, breaks):
            if len(chain):
                parts.append(instructions.write_vectors(np.vstack([chain[:1, :2], chain[:, 2:]]), word))
    return Item(area, np.concatenate(parts).tobytes() if parts else b"")


def segments(strokes: Floats, word: int, area: Area) -> Item:
    """Unlinked lines, (n, 4) element and line of both ends, clipped at an area, by WVU of later models."""
    pixels = pixels_inside(strokes, area)
    return Item(area, instructions.write_segments(pixels, word).tobytes() if len(pixels) else b"")


def pixels_inside(strokes: Floats, area: Area) -> Numbers:
    """The pixels at both ends, (kept, 4), of what is inside an area of finite strokes, (n, 4).

    Hardware: the 9300 clips lines at its memory alone; the write window is of later models.
    """
    area = area.within(DRAWABLE)
    if area.is_empty:
        return np.empty((0, 4), np.int64)
    strokes = strokes[np.isfinite(strokes).all(axis=1)]
    return rounded(clipped(strokes, area))


def image(words: Words, left: int, top: int) -> Item:
    """An array of words, (lines, elements), with its upper left corner at (left, top)."""
    down, across = words.shape
    area = Area(left, top, left + across - 1, top + down - 1)
    if area.is_empty or not DRAWABLE.covers(area):
        return Item(area, b"")
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
    return np.clip(np.floor(places + 0.5), DRAWABLE.left, DRAWABLE.right).astype(np.int64)


def fitted(line: str, most: int) -> str:
    """A line of text that has at most so many characters; a longer one is cut and ends in two periods.

    >>> fitted("windscreen", 10), fitted("windscreen", 6), fitted("windscreen", 1), fitted("windscreen", -1)
    ('windscreen', 'wind..', '.', '')
    """
    return line if len(line) <= most else f"{line[: max(0, most - 2)]}.."[: max(0, most)]
