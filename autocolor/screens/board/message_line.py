"""The message line: the bottom lines of every screen, where errors, results and hints stand."""

from __future__ import annotations

from typing import Final

from autocolor.widgets.areas import Area
from autocolor.widgets.colors import BLACK, HEIGHT, WIDTH
from autocolor.widgets.items import CHARACTER, Item, filled, fitted, text
from autocolor.widgets.menu import MESSAGE_LINES

MESSAGE: Final = Area(0, HEIGHT - MESSAGE_LINES, WIDTH - 1, HEIGHT - 1)
MOST_CHARACTERS: Final = (WIDTH - 16) // CHARACTER


def message_items(line: str, ink: int, ends: bool = False) -> list[Item]:
    """A message, or an empty line. One that is too long is cut; with `ends`, so that its end is seen."""
    found = [filled(MESSAGE, BLACK)]
    if ends and len(line) > MOST_CHARACTERS:
        line = f"..{line[2 - MOST_CHARACTERS :]}"
    if line:
        found.append(text(fitted(line, MOST_CHARACTERS), 8, MESSAGE.top + 3, ink, BLACK))
    return found
