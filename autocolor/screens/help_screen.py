"""The help screen: what each key does, and the limits of the method."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from autocolor.screens.input import Gesture
from autocolor.screens.screen import Screen
from autocolor.screens.session import Session
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


class HelpScreen(Screen):
    """The keys and the mouse."""

    name = "help"
    title = "help"
    help = "What keys and the mouse do"
    has_menu = False
    shows_scene = False

    def __init__(self, session: Session) -> None:
        super().__init__(session)
        self._page = 0

    def enter(self) -> None:
        self._page = 0

    def items(self) -> Sequence[Item]:
        return help_items(TITLE, self.session.keys, self._page)

    def pick(self, gesture: Gesture) -> None:
        self._page += 1

    def wheel(self, gesture: Gesture) -> None:
        self._page += 1 if gesture.steps < 0 else -1

    def key(self, name: str, typed: str) -> bool:
        step = {"space": 1, "page down": 1, "page up": -1}.get(name, 0)
        self._page += step
        return step != 0


def help_items(title: str, rows: Sequence[tuple[str, str]], page: int = 0) -> list[Item]:
    """A title, a line for each row (keys, what they do) of a page, and the limits of the method.

    After the last page comes the first.
    """
    items = [text(title, LEFT, 22, YELLOW, size=2)]
    pages = max(1, -(-len(rows) // ROWS_A_PAGE))
    page %= pages
    if pages > 1:
        turn = f"page {page + 1} of {pages}; a click, the wheel or Space: the next page"
        items.append(text(turn, MIDDLE, 28, LIGHT_GRAY))
    for number, (keys, does) in enumerate(rows[page * ROWS_A_PAGE : (page + 1) * ROWS_A_PAGE]):
        top = TOP + STEP * number
        items += [text(keys, LEFT, top, ORANGE), text(does, MIDDLE, top, WHITE)]
    return items + [text(line, LEFT, END + 12 * number, LIGHT_GRAY) for number, line in enumerate(LIMITS)]
