"""The numerals beside the lights in the three views, each where it hides as little as can be."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Final, NamedTuple

from autocolor.widgets.areas import Area
from autocolor.widgets.items import CHARACTER, CHARACTER_LINES

REACH: Final = 4
"""The elements or lines from the middle of a cross to its ends."""

AWAY: Final = 2
"""Assumed: the elements or lines between a cross and its numeral."""

NEAR_ARROW: Final = math.cos(math.radians(50))
"""Assumed: a place within 50 degrees of the arrow of its light is taken only if the others are worse."""

PLACES: Final = ((1, -1), (-1, -1), (1, 1), (-1, 1), (1, 0), (-1, 0), (0, -1), (0, 1))
"""The places around a cross, to the right and down, from the one that is preferred."""


class Cross(NamedTuple):
    """A light in one of the views: its number, its element and line, and the direction of its arrow.

    `arrow` is a unit vector to the right and down, and zero without an arrow.
    """

    number: int
    element: int
    line: int
    arrow: tuple[float, float] = (0.0, 0.0)

    @property
    def area(self) -> Area:
        """The area of the cross."""
        element, line = self.element, self.line
        return Area(element - REACH, line - REACH, element + REACH, line + REACH)

    def numeral(self, right: int, down: int) -> Area:
        """The area of its numeral at one of the places."""
        width = CHARACTER * len(str(self.number))
        gap = REACH + AWAY if right and down else REACH + 2 * AWAY
        left = self.element + (gap if right > 0 else -gap - width + 1 if right < 0 else -(width // 2))
        line = self.line - CHARACTER_LINES // 2
        top = line + down * (CHARACTER_LINES // 2 + gap)
        return Area(left, top, left + width - 1, top + CHARACTER_LINES - 1)


class Numeral(NamedTuple):
    """A cross in an area, and where its numeral stands."""

    cross: Cross
    area: Area


def numerals(crosses: Sequence[Cross], area: Area, taken: Sequence[Area]) -> list[Numeral]:
    """The numerals of the crosses that are within an area, in their order.

    `taken` are areas that should stay free, as far as can be.
    """
    seen = [cross for cross in crosses if area.has(cross.element, cross.line)]
    filled = [*taken, *(cross.area for cross in seen)]
    found = []
    for cross in seen:
        best, least = None, math.inf
        for right, down in PLACES:
            place = cross.numeral(right, down)
            if not area.covers(place):
                continue
            toward = (right * cross.arrow[0] + down * cross.arrow[1]) / math.hypot(right, down)
            burden = sum(place.overlaps(other) for other in filled) + (toward > NEAR_ARROW) / 2
            if burden < least:
                best, least = place, burden
            if least == 0:
                break
        if best is not None:
            found.append(Numeral(cross, best))
            filled.append(best)
    return found
