"""The letter panel: keys to type by pointing, for a user who has the joystick unit alone."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Final

from autocolor.widgets.items import Area
from autocolor.widgets.menu import WORK
from autocolor.widgets.widget import MARGIN, Panel, PanelButton, Widget

LETTERS: Final = ("1234567890-_.", "abcdefghijklm", "nopqrstuvwxyz", "#")

LABELS: Final = (
    ("space", "space", 3),
    ("back", "backspace", 2),
    ("end", "end", 2),
    ("cancel", "escape", 2),
    ("OK", "return", 3),
)
"""The keys after the last letter: the label, the name of the key on a keyboard, and the width in letters."""

KEY_ELEMENTS: Final = 36
KEY_LINES: Final = 22

RAISED: Final = 40
"""Lines between the panel and the menu's foot, for the lines of a refusal and of the text."""

PANEL: Final = Area(
    WORK.left + MARGIN,
    WORK.bottom + 1 - RAISED - KEY_LINES * len(LETTERS) - 2 * MARGIN,
    WORK.left + KEY_ELEMENTS * len(LETTERS[0]) + 3 * MARGIN - 1,
    WORK.bottom - RAISED,
)
"""The panel, between the work area's left edge and the menu."""


def letter_panel(press: Callable[[str, str], object]) -> list[Widget]:
    """The keys, the topmost widgets first, and their panel; `press` is called with a name and a character."""
    keys: list[Widget] = []
    for row, letters in enumerate(LETTERS):
        top, left = PANEL.top + MARGIN + KEY_LINES * row, PANEL.left + MARGIN
        labels = LABELS if letters == LETTERS[-1] else ()
        for label, name, width in (*((letter, letter, 1) for letter in letters), *labels):
            right = left + KEY_ELEMENTS * width
            area = Area(left + 1, top + 1, right - 2, top + KEY_LINES - 2)
            typed = " " if name == "space" else name if width == 1 else ""
            keys.append(PanelButton(label, area=area, run=partial(press, name, typed), within="letters"))
            left = right
    return [*keys, Panel("letters", area=PANEL)]
