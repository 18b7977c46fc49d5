"""Bars: numbers that are set by pointing along them."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

from autocolor.errors import UsageError
from autocolor.widgets.areas import Area
from autocolor.widgets.colors import GRAY, LIGHT_GRAY, NIGHT, SLATE, WHITE, YELLOW
from autocolor.widgets.items import CHARACTER, Item, filled, fitted, text
from autocolor.widgets.labels import short_label
from autocolor.widgets.widget import BOX, MARGIN, ROW_LINES, TEXT_DOWN, Place, Typed, Widget, box_items

THIN: Final = 2
"""Lines of the bar in a row."""

BESIDE_BOX: Final = "  "
"""What the number leaves to the box at its right."""


@dataclass(frozen=True)
class Bar(Widget):
    """A number with a bar from `low` to `high`, the usual range; it may lie beyond.

    `value` is None where the number is switched off, which `flip` does where it can be; `flip` is None where
    it cannot. In a row it is a thin bar below the number; a wide one has its number beside it.
    """

    value: float | None = 0.0
    low: float = 0.0
    high: float = 1.0
    step: float = 0.01
    unit: str = ""
    put: Callable[[float], object] = lambda _: None
    flip: Callable[[], object] | None = None
    word: int = LIGHT_GRAY
    """The color of the bar."""

    @property
    def typed(self) -> Typed:
        return Typed(self.number, self._take)

    def _take(self, line: str) -> object:
        try:
            number = float(line.replace(",", "."))
        except ValueError:
            raise UsageError(f"{self.label} must be a number, not {line!r}; type one, such as 1.5") from None
        return self.put(number)

    @property
    def number(self) -> str:
        """The value as text; nothing where it is switched off."""
        return "" if self.value is None else number_text(self.value, self.step)

    @property
    def share(self) -> float:
        """Where the value stands in the usual range, 0 to 1."""
        if self.value is None or self.high <= self.low:
            return 0.0
        return min(1.0, max(0.0, (self.value - self.low) / (self.high - self.low)))

    def items(self, lit: bool) -> list[Item]:
        return self._row_items(lit) if self.area.height <= ROW_LINES else self._wide_items(lit)

    def _row_items(self, lit: bool) -> list[Item]:
        background = SLATE if lit else NIGHT
        value = self._row_number + ("" if self.flip is None else BESIDE_BOX)
        room = (self.area.width - 2 * MARGIN) // CHARACTER
        found = self.row(lit, short_label(self.label, room - len(value) - 1), value)
        if self.flip is not None:
            found += box_items(self._box, self.value is not None, self.ink, background)
        track = self._track
        found.append(filled(track, GRAY if lit else SLATE))
        if self.value is not None and not self.why_not:
            end = track.left + round(self.share * (track.width - 1))
            found.append(filled(track._replace(right=end), YELLOW if lit else self.word))
        return found

    @property
    def _row_number(self) -> str:
        """The number as it stands in a row: to its step if the label would be cut by more digits."""
        room = (self.area.width - 2 * MARGIN) // CHARACTER - len(self.label) - 1
        if self.value is None or len(self.number) <= room - (0 if self.flip is None else len(BESIDE_BOX)):
            return self.number
        return number_text(rounded_to(self.value, self.step), self.step)

    def _wide_items(self, lit: bool) -> list[Item]:
        left, top, right, bottom = self.area
        track = self._track
        end = track.left + round(self.share * (track.width - 1))
        middle = (top + bottom) // 2 - 4
        label = fitted(self.label, (track.left - left - MARGIN) // CHARACTER)
        number = fitted(f"{self.number} {self.unit}".rstrip(), (right - track.right - MARGIN) // CHARACTER)
        found = [
            filled(self.area, NIGHT),
            filled(track, SLATE),
            filled(track._replace(right=end), YELLOW if lit else self.word),
            filled(Area(end, track.top - 2, end, track.bottom + 2), WHITE),
        ]
        if label:
            found.append(text(label, left + MARGIN, middle, self.ink))
        if number:
            found.append(text(number, track.right + MARGIN, middle, self.ink))
        return found

    @property
    def _box(self) -> Area:
        left = self.area.right + 1 - MARGIN - BOX
        top = self.area.top + TEXT_DOWN
        return Area(left, top, left + BOX - 1, top + BOX - 1)

    @property
    def _track(self) -> Area:
        """Where the bar is drawn."""
        left, top, right, bottom = self.area
        if self.area.height <= ROW_LINES:
            return Area(left + MARGIN, bottom - THIN, right - MARGIN, bottom - 1)
        beside = CHARACTER * WIDE_LABEL + MARGIN if self.area.width > 3 * CHARACTER * WIDE_LABEL else MARGIN
        return Area(left + beside, top + 4, right - CHARACTER * WIDE_NUMBER - MARGIN, bottom - 4)

    def value_at(self, element: int) -> float:
        """The value at an element, rounded to the step; at the ends, those of the usual range."""
        track = self._track
        share = (element - track.left) / max(1, track.width - 1)
        if not 0 < share < 1:
            return self.low if share <= 0 else self.high
        value = rounded_to(self.low + share * (self.high - self.low), self.step)
        return min(max(value, self.low), self.high)

    def is_switched_at(self, place: Place) -> bool:
        """Whether a pick at a place switches the number on or off."""
        return self.flip is not None and (self.value is None or place.element >= self._box.left - MARGIN)

    def pick(self, place: Place) -> object:
        if self.flip is not None and self.is_switched_at(place):
            return self.flip()
        return self.put(self.value_at(place.element))

    def drag(self, start: Place, last: Place, place: Place) -> object:
        return self.put(self.value_at(place.element))

    def nudge(self, steps: float) -> object:
        return None if self.value is None else self.put(rounded_to(self.value + steps * self.step, self.step))


WIDE_LABEL: Final = 16
WIDE_NUMBER: Final = 12
"""Characters beside a wide bar."""


def rounded_to(value: float, step: float) -> float:
    """A value rounded to a whole number of steps, without the digits that rounding leaves.

    >>> rounded_to(0.30000000000000004, 0.1), rounded_to(17.2, 5)
    (0.3, 15.0)
    """
    if step <= 0:
        return value
    digits = max(0, 2 - math.floor(math.log10(step)))
    return float(round(math.floor(value / step + 0.5) * step, digits))


def number_text(value: float, step: float) -> str:
    """A number with as many digits as its step has, and at most six significant ones where it is large.

    >>> number_text(0.5, 0.01), number_text(20.0, 1), number_text(1.5, 1), number_text(1234567.0, 1)
    ('0.50', '20', '1.5', '1.23457e+06')
    """
    # Without a sign before zero.
    value += 0.0
    if abs(value) >= 1e6 or not math.isfinite(value):
        return f"{value:g}"
    if rounded_to(value, step) != round(value, 9):
        return f"{value:.6g}"
    return f"{value:.{digits_of(step)}f}"


def digits_of(step: float) -> int:
    """The digits behind the point of a step, at most nine.

    >>> digits_of(5.0), digits_of(0.25), digits_of(0.1)
    (0, 2, 1)
    """
    digits = f"{step:.9f}".rstrip("0")
    return len(digits) - digits.index(".") - 1
