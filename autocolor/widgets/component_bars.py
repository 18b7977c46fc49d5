"""Component bars: red, green, blue and white of a color, each as long as it is, one element a step.

Paper: Figure 13, the color bars.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from autocolor.widgets.areas import Area
from autocolor.widgets.bars import Bar
from autocolor.widgets.colors import SLATE, WHITE, YELLOW
from autocolor.widgets.items import CHARACTER, CHARACTER_LINES, Item, filled, fitted, text

STEPS: Final = 256
"""The values of a component; the track has as many elements, so that each can be pointed at."""

LETTER: Final = 16
"""Elements from the left edge to the track, where the letter stands."""

UP_DOWN: Final = 5
"""Lines above and below the track."""


@dataclass(frozen=True)
class ComponentBar(Bar):
    """A bar from 0 to 255 with its letter at the left and its number at the right.

    Its area is at least 308 elements wide, and stands on a ground of NIGHT.
    """

    high: float = STEPS - 1
    step: float = 1
    letter: str = ""

    @property
    def _track(self) -> Area:
        left, top, _, bottom = self.area
        return Area(left + LETTER, top + UP_DOWN, left + LETTER + STEPS - 1, bottom - UP_DOWN)

    def items(self, lit: bool) -> list[Item]:
        track = self._track
        end = track.left + round(self.share * (track.width - 1))
        middle = (self.area.top + self.area.bottom + 1 - CHARACTER_LINES) // 2
        # The bar keeps its color when it is lit: it is one of four.
        number, ink = fitted(self.number, 4), YELLOW if lit else WHITE
        return [
            text(self.letter, self.area.left, middle, ink),
            filled(track, SLATE),
            filled(track._replace(right=end), self.word),
            filled(Area(end, track.top - 2, end, track.bottom + 2), WHITE),
            text(number, self.area.right + 1 - CHARACTER * len(number), middle, ink),
        ]
