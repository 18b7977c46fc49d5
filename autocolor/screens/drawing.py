"""Drawing on the screens: the words of their colors, and instructions for clearing and for text."""

from __future__ import annotations

from typing import Final

from autocolor.mapping.level_ranges import SCREENS
from ramtek_emu import HostPort, instructions

WIDTH: Final = 640
HEIGHT: Final = 480
"""The size that the screens are laid out for, in elements and lines."""

CHARACTER: Final = 7
"""Elements from one character of a text to the next."""

BLACK: Final = SCREENS.first
WHITE: Final = SCREENS.first + 1
LIGHT_GRAY: Final = SCREENS.first + 2
GRAY: Final = SCREENS.first + 3
SLATE: Final = SCREENS.first + 4
NIGHT: Final = SCREENS.first + 5
YELLOW: Final = SCREENS.first + 6
ORANGE: Final = SCREENS.first + 7


def clear(display: HostPort, word: int = NIGHT) -> None:
    """Fill the whole screen with a word."""
    display.send(instructions.reset())
    display.send(instructions.erase((0, 0, WIDTH - 1, HEIGHT - 1), word))


def text(
    display: HostPort,
    line: str,
    left: int,
    top: int,
    word: int = WHITE,
    background: int = NIGHT,
    size: int = 1,
) -> None:
    """Write a line of text whose upper left corner is at (left, top)."""
    display.send(instructions.write_text(line, left, top, word, background, size))


def fitted(line: str, most: int) -> str:
    """A line of text that has at most so many characters; a longer one is cut and ends in two periods.

    >>> fitted("windscreen", 10), fitted("windscreen", 6), fitted("windscreen", 1)
    ('windscreen', 'wind..', '.')
    """
    return line if len(line) <= most else f"{line[: max(0, most - 2)]}.."[:most]
