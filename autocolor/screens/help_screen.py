"""The help screen: what each key does, and the limits of the method."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from autocolor.screens.screen import Pages, page_of
from autocolor.widgets.items import LIGHT_GRAY, ORANGE, WHITE, YELLOW, Item, text

TITLE: Final = "AUTOCOLOR"
LEFT: Final = 24
MIDDLE: Final = 220
TOP: Final = 50
STEP: Final = 13
END: Final = 438
"""The line of the limits of the method, below the rows of keys."""
ROWS_A_PAGE: Final = (END - TOP) // STEP - 1

LIMITS: Final = (
    "The blend gives the brightest points of a surface the color of the light.",
    "This is an approximation; it does not predict the true color.",
)
"""Paper: "Light Source Color Blending", the simplifications of the method."""


class HelpScreen(Pages):
    """The keys and the mouse."""

    name = "help"
    title = "help"
    help = "What keys and the mouse do"

    def items(self) -> Sequence[Item]:
        return help_items(TITLE, self.session.keys, self.page)


def help_items(title: str, rows: Sequence[tuple[str, str]], page: int = 0) -> list[Item]:
    """A title, a line for each row (keys, what they do) of a page, and the limits of the method."""
    items = [text(title, LEFT, 22, YELLOW, size=2)]
    shown, turn = page_of(rows, page, ROWS_A_PAGE)
    if turn:
        items.append(text(turn, MIDDLE, 28, LIGHT_GRAY))
    for number, (keys, does) in enumerate(shown):
        top = TOP + STEP * number
        items += [text(keys, LEFT, top, ORANGE), text(does, MIDDLE, top, WHITE)]
    return items + [text(line, LEFT, END + 12 * number, LIGHT_GRAY) for number, line in enumerate(LIMITS)]
