"""Overlay: pages and messages over the field of a display whose memory belongs to a host.

The words of a page in the frame buffer would overwrite the host's picture, and all entries may be in use. So
these pages are drawn here, in the colors of the window; the display does not contain them.
"""

from __future__ import annotations

import time
from collections.abc import Sequence
from typing import Final

import numpy as np

from ramtek_emu.arrays import PackedColors
from ramtek_emu.memory.character_rom import CELL_ELEMENTS, CELL_LINES, characters

BLACK: Final = 0x101216
WHITE: Final = 0xFFFFFF
YELLOW: Final = 0xFFD65A
ORANGE: Final = 0xFF8C3C

ADVANCE: Final = CELL_ELEMENTS + 1
"""Elements from one character to the next."""
MESSAGE_LINES: Final = 16
"""The lines of a message, at the bottom of the field."""
ROW_LINES: Final = 16
MARGIN: Final = 8
MESSAGE_SECONDS: Final = 5.0
"""How long a message is shown over the field."""
PAGES: Final = {"f1": "help", "f4": "entries"}
"""The pages by the key that shows them."""

KEYS: Final = (
    ("F1", "this help, and back"),
    ("F2", "show all words in gray, in another gray, as the display does"),
    ("F3", "record the fields as a film; again: end it"),
    ("F4", "the entries of the lookup table, and back"),
    ("F10", "fill the window, or show whole multiples"),
    ("F11, Alt+Enter", "full screen, and back"),
    ("F12", "save a numbered screenshot of the field"),
    ("Esc", "leave full screen, then a page"),
    ("Ctrl+Q", "close the window"),
    ("mouse", "the joystick: moves the cursors"),
    ("left button", "ENTER"),
    ("right button", "TRACK, while it is down"),
)
"""The keys of a window, and the mouse as the joystick, with their actions."""


def write(
    pixels: PackedColors,
    text: str,
    left: int,
    top: int,
    color: int = WHITE,
    background: int = BLACK,
    size: int = 1,
) -> None:
    """Write a line of text on (lines, elements) pixels, magnified by a whole number and clipped."""
    codes = np.frombuffer(text.encode("latin-1", "replace"), np.uint8)
    cells = np.zeros((len(codes), CELL_LINES, ADVANCE), np.bool_)
    cells[:, :, :CELL_ELEMENTS] = characters()[codes]
    dots = cells.transpose(1, 0, 2).reshape(CELL_LINES, -1).repeat(size, axis=0).repeat(size, axis=1)
    part = pixels[top : top + len(dots), left : left + dots.shape[1]]
    part[...] = np.where(dots[: part.shape[0], : part.shape[1]], np.uint32(color), np.uint32(background))


def help_page(lines: int, elements: int, title: str, rows: Sequence[tuple[str, str]] = KEYS) -> PackedColors:
    """A page of (lines, elements) pixels with a title and a line for each row (keys, action)."""
    page = np.full((lines, elements), BLACK, np.uint32)
    size = max(1, elements // 640)
    write(page, title, MARGIN * size, MARGIN * size, YELLOW, size=2 * size)
    middle = MARGIN + ADVANCE * (2 + max(len(keys) for keys, _ in rows))
    for number, (keys, action) in enumerate(rows):
        top = (2 * MARGIN + ROW_LINES * (number + 2)) * size
        write(page, keys, MARGIN * size, top, ORANGE, size=size)
        write(page, action, middle * size, top, size=size)
    return page


def cells_of(words: int) -> tuple[int, int]:
    """The columns and rows of the page of entries for so many words."""
    columns = 1 << ((words - 1).bit_length() + 1) // 2
    return columns, -(-words // columns)


def entries_page(colors: PackedColors, lines: int, elements: int) -> PackedColors:
    """A page of (lines, elements) pixels with the colors of all words: 32 x 32 cells for 1024 words."""
    columns, rows = cells_of(len(colors))
    row_of_line = np.arange(lines) * rows // lines
    column_of_element = np.arange(elements) * columns // elements
    words = row_of_line[:, np.newaxis] * columns + column_of_element
    page: PackedColors = np.append(colors, np.uint32(BLACK)).take(words, mode="clip").astype(np.uint32)
    return page


def write_message(pixels: PackedColors, message: str) -> None:
    """Write a message on the last lines of a field; a message that is too long ends in two periods."""
    lines, elements = pixels.shape
    size = max(1, elements // 640)
    most = (elements // size - 2 * MARGIN) // ADVANCE
    shown = message if len(message) <= most else f"{message[: most - 2]}.."
    bottom = pixels[max(0, lines - MESSAGE_LINES * size) :]
    bottom[...] = BLACK
    write(bottom, shown, MARGIN * size, (MESSAGE_LINES - CELL_LINES) // 2 * size, size=size)


class Overlay:
    """A page over the field, and a message for a while."""

    def __init__(self) -> None:
        self.page = ""
        """One of `PAGES`; "" for none."""
        self._message, self._until = "", 0.0

    @property
    def message(self) -> str:
        """The message; "" after its time has passed."""
        return self._message if time.monotonic() < self._until else ""

    @message.setter
    def message(self, message: str) -> None:
        self._message, self._until = message, time.monotonic() + MESSAGE_SECONDS

    @property
    def stamp(self) -> tuple[str, str]:
        """A value that changes whenever the overlay does."""
        return self.page, self.message

    def turn_to(self, page: str) -> None:
        """Show a page, or the field if the page is shown already."""
        self.page = "" if self.page == page else page

    def draw(self, pixels: PackedColors, colors: PackedColors, title: str) -> None:
        """Draw over the pixels of a field, (lines, elements); `colors` are the colors of all words."""
        if self.page:
            lines, elements = pixels.shape
            is_help = self.page == PAGES["f1"]
            page = help_page(lines, elements, title) if is_help else entries_page(colors, lines, elements)
            pixels[...] = page
        if self.message:
            write_message(pixels, self.message)
