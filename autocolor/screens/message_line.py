"""The message line: the last lines of the display, where a message stands for a while.

It is drawn in the frame buffer, over the picture or another page, and the words that it covered are sent
again afterwards.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Final

from autocolor.screens.drawing import BLACK, CHARACTER, HEIGHT, WHITE, WIDTH, fitted, text
from ramtek_emu import HostPort, instructions

LINES: Final = 16
LEFT: Final = 8
TOP: Final = HEIGHT - LINES
MOST_CHARACTERS: Final = (WIDTH - 2 * LEFT) // CHARACTER
MESSAGE_SECONDS: Final = 5.0
"""Assumed: how long a message stands."""


class MessageLine:
    """The message of a screen: the text, until when it stands, and what it was drawn over."""

    def __init__(self, display: HostPort, restore: Callable[[], object]) -> None:
        """`restore` draws again what is below the line."""
        self.display = display
        self._restore = restore
        self._text = ""
        self._until = 0.0
        self._drawn: tuple[str, object] | None = None
        """The text that is on the display, and what it covers."""

    @property
    def text(self) -> str:
        """The last message."""
        return self._text

    @text.setter
    def text(self, message: str) -> None:
        self._text, self._until = message, time.monotonic() + MESSAGE_SECONDS

    def update(self, is_shown: bool, below: object) -> None:
        """Draw the message if it is to be shown and its time has not passed; else draw what is below again.

        `below` stands for what is below the line: when it is another object, that was drawn anew.
        """
        if self._drawn is not None and self._drawn[1] is not below:
            self._drawn = None
        wanted = self._text if is_shown and time.monotonic() < self._until else ""
        if wanted and (self._drawn is None or self._drawn[0] != wanted):
            draw_message(self.display, wanted)
            self._drawn = wanted, below
        elif not wanted and self._drawn is not None:
            self._drawn = None
            self._restore()


def draw_message(display: HostPort, message: str) -> None:
    """Draw a message in the line; one that is too long ends in two periods."""
    display.send(instructions.erase((0, TOP, WIDTH - 1, HEIGHT - 1), BLACK))
    text(display, fitted(message, MOST_CHARACTERS), LEFT, TOP + 3, WHITE, BLACK)
