"""The help screen: what each key does, and the limits of the method."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from autocolor.screens.pages import PageRow, Pages
from autocolor.widgets.items import LIGHT_GRAY, ORANGE

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
    heading = "AUTOCOLOR"

    def rows(self) -> Sequence[PageRow]:
        keys = [PageRow(key, ORANGE, does) for key, does in self.session.keys]
        return [*keys, PageRow(), *(PageRow(line, LIGHT_GRAY) for line in LIMITS)]
