"""The help screen: what each key does, and the limits of the method."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from autocolor.screens.screen import Screen
from autocolor.widgets.items import LIGHT_GRAY, ORANGE, WHITE, YELLOW, Item, text

TITLE: Final = "AUTOCOLOR"
LEFT: Final = 24
MIDDLE: Final = 220
TOP: Final = 50
STEP: Final = 13

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

    def items(self) -> Sequence[Item]:
        return help_items(TITLE, self.session.keys)


def help_items(title: str, rows: Sequence[tuple[str, str]]) -> list[Item]:
    """A title, a line for each row (keys, what they do), and the limits of the method."""
    items = [text(title, LEFT, 22, YELLOW, size=2)]
    for number, (keys, does) in enumerate(rows):
        top = TOP + STEP * number
        items += [text(keys, LEFT, top, ORANGE), text(does, MIDDLE, top, WHITE)]
    return items + [text(line, LEFT, 438 + 12 * number, LIGHT_GRAY) for number, line in enumerate(LIMITS)]
