"""The letter panel: keys to type by pointing, for a user who has the joystick unit alone."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Final, NamedTuple

from autocolor.widgets.items import NIGHT, SLATE, Area, Item, filled, outline
from autocolor.widgets.menu import WORK
from autocolor.widgets.widget import MARGIN, PanelButton, Widget


class PanelKey(NamedTuple):
    """A key: its label, its name and its character, as a keyboard gives them, and its width in letters."""

    label: str
    name: str
    typed: str = ""
    width: int = 1


ROWS: Final = (
    *(
        tuple(PanelKey(letter, letter, letter) for letter in letters)
        for letters in ("1234567890-_.", "abcdefghijklm", "nopqrstuvwxyz")
    ),
    (
        PanelKey("#", "#", "#"),
        PanelKey("space", "space", " ", 3),
        PanelKey("back", "backspace", "", 2),
        PanelKey("end", "end", "", 2),
        PanelKey("cancel", "escape", "", 2),
        PanelKey("OK", "return", "", 3),
    ),
)

KEY_ELEMENTS: Final = 36
KEY_LINES: Final = 22
LETTERS_ACROSS: Final = 13

RAISED: Final = 40
"""Lines between the panel and the menu's foot, for the lines of a refusal and of the text."""

PANEL: Final = Area(
    WORK.left + MARGIN,
    WORK.bottom + 1 - RAISED - KEY_LINES * len(ROWS) - 2 * MARGIN,
    WORK.left + KEY_ELEMENTS * LETTERS_ACROSS + 3 * MARGIN - 1,
    WORK.bottom - RAISED,
)
"""The panel, between the work area's left edge and the menu."""


@dataclass(frozen=True)
class Panel(Widget):
    """The ground of the keys, on which a pick does nothing."""

    def items(self, lit: bool) -> list[Item]:
        return [filled(self.area, NIGHT), outline(self.area, SLATE)]


def letter_panel(press: Callable[[str, str], object]) -> list[Widget]:
    """The keys, the topmost widgets first, and their panel; `press` is called with a name and a character."""
    keys: list[Widget] = []
    for row, panel_keys in enumerate(ROWS):
        top, left = PANEL.top + MARGIN + KEY_LINES * row, PANEL.left + MARGIN
        for label, name, typed, width in panel_keys:
            right = left + KEY_ELEMENTS * width
            area = Area(left + 1, top + 1, right - 2, top + KEY_LINES - 2)
            keys.append(PanelButton(label, area=area, run=partial(press, name, typed), within="letters"))
            left = right
    return [*keys, Panel("letters", area=PANEL)]
