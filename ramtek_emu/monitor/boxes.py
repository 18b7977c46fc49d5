"""Boxes: text, marks and pages on pixels, for a window's own pages and the inspector's panels.

Pixels are (lines, elements) colors, 0x00RRGGBB. Characters are those of the display's ROM.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from typing import Final, NamedTuple, TypeVar

import numpy as np

from ramtek_emu.arrays import AnyArray, Dots, Indices, PackedColors
from ramtek_emu.memory.character_rom import CELL_ELEMENTS, CELL_LINES, characters

Array = TypeVar("Array", bound=AnyArray)

BLACK: Final = 0x101216
WHITE: Final = 0xFFFFFF
GRAY: Final = 0x8C929C
YELLOW: Final = 0xFFD65A
ORANGE: Final = 0xFF8C3C
BLUE: Final = 0x9CC4FF

ADVANCE: Final = CELL_ELEMENTS + 1
"""Elements from one character to the next."""
ROW: Final = 11
"""The lines of a row of text in a box."""
MARGIN: Final = 8
HELP_ROW: Final = 15
"""The lines of a row of the help page."""


class Span(NamedTuple):
    """Text of one color."""

    text: str
    color: int = WHITE
    background: int | None = None
    """The color behind the text; None for that of the box. Behind blanks it is a swatch of the color."""


Line = tuple[Span, ...]
"""A row of text."""


class PageBox(NamedTuple):
    """A rectangle of pixels: left and top, width and height."""

    left: int
    top: int
    width: int
    height: int

    @property
    def rows(self) -> int:
        """How many rows of text fit."""
        return self.height // ROW

    def holds(self, element: int, line: int) -> bool:
        """Whether a place is in the box."""
        return 0 <= element - self.left < self.width and 0 <= line - self.top < self.height

    def of(self, pixels: Array) -> Array:
        """The pixels or dots in the box, as a view."""
        return pixels[self.top :, self.left :][: self.height, : self.width]  # type: ignore[return-value]


def write(
    pixels: PackedColors,
    text: str,
    left: int,
    top: int,
    color: int = WHITE,
    background: int = BLACK,
    size: int = 1,
) -> None:
    """Write a line of text, magnified by a whole number and clipped."""
    codes = np.frombuffer(text.encode("latin-1", "replace"), np.uint8)
    cells = np.zeros((len(codes), CELL_LINES, ADVANCE), np.bool_)
    cells[:, :, :CELL_ELEMENTS] = characters()[codes]
    dots = cells.transpose(1, 0, 2).reshape(CELL_LINES, -1).repeat(size, axis=0).repeat(size, axis=1)
    part = pixels[top : top + len(dots), left : left + dots.shape[1]]
    part[...] = np.where(dots[: part.shape[0], : part.shape[1]], np.uint32(color), np.uint32(background))


def write_rows(pixels: PackedColors, rows: Sequence[Line], background: int = BLACK) -> None:
    """Write rows of text, from the top of a box on; the rows that do not fit are left out."""
    lines, elements = pixels.shape
    for number, row in enumerate(rows[: lines // ROW]):
        pixels[number * ROW : (number + 1) * ROW] = row_pixels(row, elements, background)


@lru_cache(1024)
def row_pixels(row: Line, elements: int, background: int) -> PackedColors:
    """The (ROW, elements) pixels of a row of text; text that is too long ends in two periods."""
    pixels: PackedColors = np.full((ROW, elements), background, np.uint32)
    left, most = 0, elements // ADVANCE
    for span in row:
        text = span.text
        if left + len(text) > most:
            text = f"{text[: max(0, most - left - 2)]}.."[: most - left]
        begin, left = left * ADVANCE, left + len(text)
        if span.background is None:
            write(pixels, text, begin, 1, span.color, background)
        elif text.isspace():
            # A swatch, apart from the swatches above and below it.
            pixels[1:-1, begin : left * ADVANCE] = span.background
        else:
            # A marked row is marked to its end.
            pixels[:, begin:] = span.background
            write(pixels, text, begin, 1, span.color, span.background)
    return pixels


def mark(pixels: PackedColors, dots: Dots, inner: int, outer: int) -> None:
    """Draw two rings, one around the other, around the dots, (lines, elements) as the pixels.

    The rings have two colors, so that they are seen on any picture. The dots keep their pixels.
    """
    near = grown(dots)
    pixels[grown(near) & ~near] = outer
    pixels[near & ~dots] = inner


def grown(dots: Dots) -> Dots:
    """The dots and the eight neighbors of each."""
    tall = dots.copy()
    tall[1:] |= dots[:-1]
    tall[:-1] |= dots[1:]
    wide = tall.copy()
    wide[:, 1:] |= tall[:, :-1]
    wide[:, :-1] |= tall[:, 1:]
    return wide


def help_page(lines: int, elements: int, title: str, rows: Sequence[tuple[str, str]]) -> PackedColors:
    """A page of (lines, elements) pixels with a title and a line for each row (keys, action)."""
    page = np.full((lines, elements), BLACK, np.uint32)
    size = max(1, elements // 640)
    write(page, title, MARGIN * size, MARGIN * size, YELLOW, size=2 * size)
    middle = MARGIN + ADVANCE * (2 + max(len(keys) for keys, _ in rows))
    for number, (keys, action) in enumerate(rows):
        top = (2 * MARGIN + HELP_ROW * (number + 2)) * size
        write(page, keys, MARGIN * size, top, ORANGE, size=size)
        write(page, action, middle * size, top, size=size)
    return page


@lru_cache(4)
def cells(count: int, lines: int, elements: int) -> Indices:
    """The cell at each of (lines, elements) pixels: 32 x 32 cells for 1024; numbers from `count` on are none.

    Cells are counted along their rows. There are as many columns as rows, or twice as many.
    """
    columns = 1 << ((count - 1).bit_length() + 1) // 2
    rows = -(-count // columns)
    row_of_line = np.arange(lines) * rows // lines
    column_of_element = np.arange(elements) * columns // elements
    return row_of_line[:, np.newaxis] * columns + column_of_element


def entries_page(colors: PackedColors, lines: int, elements: int) -> PackedColors:
    """A page of (lines, elements) pixels with the colors of all words, a cell each."""
    numbers = cells(len(colors), lines, elements)
    page: PackedColors = np.append(colors, np.uint32(BLACK)).take(numbers, mode="clip").astype(np.uint32)
    return page
