"""Level bars: the levels of a surface in its own words, with a handle at the blend level.

Paper: Figures 13 and 14. In the horizontal bar of color mixing, intensity rises to the right; in the vertical
bar of light blending, upward. Since a bar shows the surface's own words, loading its entries recolors it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import lru_cache
from typing import Final

import numpy as np

from autocolor.arrays import Booleans, Numbers, Words
from autocolor.mapping.rounding import half_up
from autocolor.widgets.areas import Area
from autocolor.widgets.colors import GRAY, NIGHT, WHITE, YELLOW
from autocolor.widgets.items import CHARACTER, Item, filled, image, text
from autocolor.widgets.widget import Place, Widget

LANE: Final = 8
"""Elements or lines beside the levels, where the handle stands."""

REACH: Final = 4
"""Elements or lines from the middle of a handle to its ends."""

RIGHT: Final = 0
DOWN: Final = 1
LEFT: Final = 2
UP: Final = 3
"""Where a pointer points."""


@dataclass(frozen=True)
class LevelBar(Widget):
    """The levels of a surface, from the left or, of an upright bar, from below; a pick or a drag selects one.

    `words` has the word that shows each level. The area has the levels and the lanes of the handle: above and
    below, or at the left of an upright bar, beyond which stands its number.
    """

    words: Words = field(default_factory=lambda: np.zeros(2, np.uint16))
    level: int = 0
    put: Callable[[int], object] = lambda _: None
    number: str = ""
    upright: bool = False

    @property
    def strip(self) -> Area:
        """Where the levels are."""
        left, top, right, bottom = self.area
        if self.upright:
            return Area(left + LANE, top, right, bottom)
        return Area(left, top + LANE, right, bottom - LANE)

    def level_at(self, place: Place) -> int:
        """The level at a place; beyond the ends of the bar, the lowest or the highest one."""
        levels = levels_along(self._length, len(self.words))
        along = self.strip.bottom - place.line if self.upright else place.element - self.strip.left
        return int(levels[min(max(along, 0), self._length - 1)])

    @property
    def _length(self) -> int:
        return self.strip.height if self.upright else self.strip.width

    def items(self, lit: bool) -> list[Item]:
        strip, ink = self.strip, YELLOW if lit else WHITE
        along = half_up(self.level * (self._length - 1) / (len(self.words) - 1))
        # A frame that is seen beside dark levels, over a picture whose background is dark, too.
        found = [filled(strip.inset(-1), GRAY), level_strip(self.words.tobytes(), strip, self.upright)]
        if not self.upright:
            element = strip.left + along
            down, up = pointer(element, strip.top - 2, DOWN, ink), pointer(element, strip.bottom + 2, UP, ink)
            return [*found, down, up]
        line = strip.bottom - along
        found.append(pointer(strip.left - 2, line, RIGHT, ink))
        if self.number:
            left = self.area.left - CHARACTER * len(self.number)
            found.append(text(self.number, left, line - REACH, ink, NIGHT))
        return found

    def pick(self, place: Place) -> object:
        return self.put(self.level_at(place))

    def drag(self, start: Place, last: Place, place: Place) -> object:
        return self.put(self.level_at(place))

    def nudge(self, steps: float) -> object:
        return self.put(min(max(self.level + half_up(steps), 0), len(self.words) - 1))


@dataclass(frozen=True)
class PercentBar(Widget):
    """A handle at a percentage of the height of what stands at the left of the area, with its number."""

    value: float = 100.0
    put: Callable[[float], object] = lambda _: None

    def items(self, lit: bool) -> list[Item]:
        ink = YELLOW if lit else WHITE
        line = self.area.bottom - half_up(self.value / 100 * (self.area.height - 1))
        number = f"{self.value:.0f}%"
        return [
            pointer(self.area.left + 2, line, LEFT, ink),
            text(number, self.area.left + LANE, line - REACH, ink, NIGHT),
        ]

    def percent_at(self, place: Place) -> float:
        """The whole percentage at a place."""
        share = (self.area.bottom - place.line) / (self.area.height - 1)
        return float(half_up(100 * min(max(share, 0.0), 1.0)))

    def pick(self, place: Place) -> object:
        return self.put(self.percent_at(place))

    def drag(self, start: Place, last: Place, place: Place) -> object:
        return self.put(self.percent_at(place))

    def nudge(self, steps: float) -> object:
        return self.put(min(max(float(half_up(self.value + steps)), 0.0), 100.0))


def levels_along(length: int, levels: int) -> Numbers:
    """The level at each element of a bar, (length,): the ends are the lowest and the highest one."""
    return (np.arange(length) * (levels - 1) * 2 // (length - 1) + 1) // 2


def pointer(element: int, line: int, towards: int, word: int) -> Item:
    """A triangle whose tip is at an element and a line."""
    shape = _POINTERS[towards]
    down, across = shape.shape
    left = element - (across - 1, REACH, 0, REACH)[towards]
    top = line - (REACH, down - 1, REACH, 0)[towards]
    return image(np.where(shape, word, NIGHT).astype(np.uint16), left, top)


def _triangle() -> Booleans:
    across, down = np.arange(REACH + 1), np.arange(-REACH, REACH + 1)
    shape: Booleans = across + np.abs(down)[:, None] <= REACH
    return shape


_RIGHT: Final = _triangle()
_POINTERS: Final = (_RIGHT, _RIGHT.T, _RIGHT[:, ::-1], _RIGHT.T[::-1])


@lru_cache(maxsize=16)
def level_strip(data: bytes, area: Area, upright: bool = False) -> Item:
    """Levels in their words, given as the bytes of `Words`: the last one is at the right, or at the top."""
    words = np.frombuffer(data, np.uint16)
    along = words[levels_along(area.height if upright else area.width, len(words))]
    filling = np.broadcast_to(along[::-1, None] if upright else along, (area.height, area.width))
    return image(filling, area.left, area.top)
