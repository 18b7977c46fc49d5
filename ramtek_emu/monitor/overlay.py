"""Overlay: pages, messages and the mark of a film over the field of a display whose memory belongs to a host.

The words of a page in the frame buffer would overwrite the host's picture, and all entries may be in use. So
these pages are drawn here, in the colors of the window; the display does not contain them.
"""

from __future__ import annotations

import time
from typing import Final

from ramtek_emu.arrays import PackedColors
from ramtek_emu.memory.character_rom import CELL_LINES
from ramtek_emu.monitor.boxes import ADVANCE, BLACK, MARGIN, entries_page, help_page, write

MESSAGE_LINES: Final = 16
"""The lines of a message, at the bottom of the field."""
MARK: Final = 8
"""The lines and elements of the mark of a film that is recorded, at the lower right of the field."""
RED: Final = 0xF03C3C
MESSAGE_SECONDS: Final = 5.0
"""How long a message is shown over the field."""
PAGES: Final = {"f1": "help", "f4": "entries"}
"""The pages by the key that shows them."""

KEYS: Final = (
    ("F1", "this help, and back"),
    ("F2", "show words in gray, another gray, or colors"),
    ("F3", "begin to record a film, or end it"),
    ("F4", "the entries of the lookup table, and back"),
    ("F10", "fill the window, or show a whole multiple"),
    ("F11, Alt+Enter", "full screen, and back"),
    ("F12", "save a numbered screenshot of the field"),
    ("Esc", "leave full screen, or close the page"),
    ("Ctrl+Q", "close the window"),
    ("mouse", "the joystick: moves the cursors"),
    ("left button", "ENTER"),
    ("right button", "TRACK, while it is down"),
)
"""The keys of a window, and the mouse as the joystick, with their actions."""


class Overlay:
    """A page over the field, a message for a while, and a red mark while a film is recorded."""

    def __init__(self) -> None:
        self.page = ""
        """One of `PAGES`; "" for none."""
        self.is_recording = False
        self._message, self._until = "", 0.0

    @property
    def message(self) -> str:
        """The message; "" after its time has passed."""
        return self._message if time.monotonic() < self._until else ""

    @message.setter
    def message(self, message: str) -> None:
        self._message, self._until = message, time.monotonic() + MESSAGE_SECONDS

    @property
    def stamp(self) -> tuple[str, str, bool]:
        """A value that changes whenever the overlay does."""
        return self.page, self.message, self.is_recording

    def turn_to(self, page: str) -> None:
        """Show a page, or the field if the page is shown already."""
        self.page = "" if self.page == page else page

    def draw(self, pixels: PackedColors, colors: PackedColors, title: str) -> None:
        """Draw over the pixels of a field, (lines, elements); `colors` are the colors of all words.

        The message is on the last lines. If it is too long, it ends in two periods.
        """
        lines, elements = pixels.shape
        size = max(1, elements // 640)
        if self.page == PAGES["f1"]:
            pixels[...] = help_page(lines, elements, title, KEYS)
        elif self.page:
            pixels[...] = entries_page(colors, lines, elements)
        if message := self.message:
            most = (elements // size - 2 * MARGIN) // ADVANCE
            shown = message if len(message) <= most else f"{message[: most - 2]}.."
            bottom = pixels[max(0, lines - MESSAGE_LINES * size) :]
            bottom[...] = BLACK
            write(bottom, shown, MARGIN * size, (MESSAGE_LINES - CELL_LINES) // 2 * size, size=size)
        if self.is_recording:
            mark, frame = MARK * size, MARK * size // 4
            pixels[-mark - 2 * frame :, -mark - 2 * frame :] = BLACK
            pixels[-mark - frame : -frame, -mark - frame : -frame] = RED
