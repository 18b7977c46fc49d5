"""The help page: what each key does, and the limits of the method."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from autocolor.screens.drawing import LIGHT_GRAY, ORANGE, WHITE, YELLOW, clear, text
from ramtek_emu import HostPort

LEFT: Final = 24
MIDDLE: Final = 220
TOP: Final = 62
STEP: Final = 15

LIMITS: Final = (
    "The blend gives the brightest points of a surface the color of the light.",
    "This is an approximation; it does not predict the true color.",
)
"""Paper: "Light Source Color Blending", the simplifications of the method."""


def draw_help(display: HostPort, title: str, rows: Sequence[tuple[str, str]]) -> None:
    """Show a title, a line for each row (keys, what they do), and the limits of the method."""
    clear(display)
    text(display, title, LEFT, 22, YELLOW, size=2)
    for number, (keys, does) in enumerate(rows):
        top = TOP + STEP * number
        text(display, keys, LEFT, top, ORANGE)
        text(display, does, MIDDLE, top, WHITE)
    for number, line in enumerate(LIMITS):
        text(display, line, LEFT, 446 + 12 * number, LIGHT_GRAY)
