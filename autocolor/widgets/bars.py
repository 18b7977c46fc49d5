"""Bars: numbers that are set by pointing along them."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import lru_cache
from typing import Final

import numpy as np

from autocolor.arrays import Numbers, Words, half_up
from autocolor.errors import UsageError
from autocolor.scene.columns import BarRange
from autocolor.widgets.items import (
    BLACK,
    CHARACTER,
    CHARACTER_LINES,
    DOWN,
    GRAY,
    LEFT,
    LIGHT_GRAY,
    NIGHT,
    REACH,
    RIGHT,
    SLATE,
    UP,
    WHITE,
    YELLOW,
    Area,
    Item,
    filled,
    fitted,
    image,
    pointer,
    text,
)
from autocolor.widgets.widget import (
    BOX,
    MARGIN,
    ROW_CHARACTERS,
    ROW_LINES,
    TEXT_DOWN,
    Entry,
    Place,
    Widget,
    box_items,
)

THIN: Final = 2
"""Lines of the bar in a row."""

LONGEST_LABEL: Final = ROW_CHARACTERS - 4
"""The characters of a label that has room for a short number beside it."""


@dataclass(frozen=True)
class Bar(Widget):
    """A number with a bar over its usual range, `low` to `high`; the number may lie beyond.

    `value` is None while the number is switched off. `flip` switches the number; None for a number that is
    always on. In a menu, a thin bar is drawn below the number; a wide bar has its number beside it.
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
    def typed(self) -> Entry:
        """The number as a text that can be typed over."""
        return Entry(self.label, value="" if self.value is None else f"{self.value:.9g}", take=self._take)

    def _take(self, line: str) -> object:
        try:
            number = float(line.replace(",", "."))
        except ValueError:
            raise UsageError(f"{self.label} must be a number, not {line!r}; type one, such as 1.5") from None
        return self.put(number)

    @property
    def number(self) -> str:
        """The value as text; empty while it is switched off."""
        return "" if self.value is None else number_text(self.value, self.step)

    @property
    def row_lines(self) -> int:
        return ROW_LINES if len(self.label) <= LONGEST_LABEL else 2 * ROW_LINES

    @property
    def share(self) -> float:
        """The place of the value in the usual range, 0 to 1."""
        if self.value is None or self.high <= self.low:
            return 0.0
        return min(1.0, max(0.0, (self.value - self.low) / (self.high - self.low)))

    @property
    def _end(self) -> int:
        """The element of the track at the value."""
        return self._track.left + round(self.share * (self._track.width - 1))

    def items(self, lit: bool) -> list[Item]:
        return self._row_items(lit) if self.area.height == self.row_lines else self._wide_items(lit)

    def _row_items(self, lit: bool) -> list[Item]:
        background = SLATE if lit else NIGHT
        # There is room for the box at the right of the number.
        value = self.number + ("" if self.flip is None else "  ")
        items = self.row(lit, self.label, value)
        if self.flip is not None:
            items += box_items(self._box, self.value is not None, self.ink, background)
        if self.value is not None:
            track = self._track
            items.append(filled(track, GRAY if lit else SLATE))
            if not self.why_not:
                items.append(filled(track._replace(right=self._end), YELLOW if lit else self.word))
        return items

    def _wide_items(self, lit: bool) -> list[Item]:
        left, top, _, bottom = self.area
        track, end = self._track, self._end
        middle = (top + bottom) // 2 - 4
        number = fitted(f"{self.number} {self.unit}".rstrip(), WIDE_NUMBER)
        return [
            filled(self.area, NIGHT),
            filled(track, SLATE),
            filled(track._replace(right=end), YELLOW if lit else self.word),
            filled(Area(end, track.top - 2, end, track.bottom + 2), WHITE),
            text(fitted(self.label, WIDE_LABEL), left + MARGIN, middle, self.ink),
            *([text(number, track.right + MARGIN, middle, self.ink)] if number else ()),
        ]

    @property
    def _box(self) -> Area:
        left = self.area.right + 1 - MARGIN - BOX
        top = self.area.bottom + 1 - ROW_LINES + TEXT_DOWN
        return Area(left, top, left + BOX - 1, top + BOX - 1)

    @property
    def _track(self) -> Area:
        """The area of the bar itself."""
        left, top, right, bottom = self.area
        if self.area.height == self.row_lines:
            return Area(left + MARGIN, bottom - THIN, right - MARGIN, bottom - 1)
        return Area(
            left + CHARACTER * WIDE_LABEL + MARGIN,
            top + 4,
            right - CHARACTER * WIDE_NUMBER - MARGIN,
            bottom - 4,
        )

    def value_at(self, element: int) -> float:
        """The value at an element, rounded to the step; beyond the bar, an end of the usual range."""
        track = self._track
        share = (element - track.left) / (track.width - 1)
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


LEAST_STEPS: Final = 100
"""Assumed: the least number of steps of a bar, so that a step is a small change."""


def bar_within(low: float, high: float) -> BarRange:
    """The bar from `low` to a larger `high`, with LEAST_STEPS or more steps of 1, 2 or 5 times a power of 10.

    >>> bar_within(0, 180)
    BarRange(low=0, high=180, step=1.0)
    """
    most = (high - low) / LEAST_STEPS
    power = 10.0 ** math.floor(math.log10(most))
    # A step may exceed its bound by no more than rounding: 0.01 is a hundredth of 1.
    factors = [factor for factor in (1, 2, 5, 10) if factor * power <= most * (1 + 1e-9)]
    return BarRange(low, high, float(f"{max(factors, default=1) * power:.12g}"))


def rounded_to(value: float, step: float) -> float:
    """A value rounded to a whole number of steps, without the digits that rounding leaves.

    >>> rounded_to(0.30000000000000004, 0.1), rounded_to(17.2, 5)
    (0.3, 15.0)
    """
    digits = max(0, 2 - math.floor(math.log10(step)))
    return float(round(math.floor(value / step + 0.5) * step, digits))


def number_text(value: float, step: float) -> str:
    """A number with as many decimals as its step, and a further decimal if it is not a whole number of steps.

    So the text is exact to a twentieth of a step. A small number that would be shown as 0 has more digits.

    >>> [number_text(value, 0.1) for value in (20.0, 0.78, -1.60813, 0.00031, 1234567.0)]
    ['20.0', '0.78', '-1.61', '0.00031', '1.23457e+06']
    """
    # Without a sign before zero.
    value += 0.0
    if abs(value) >= 1e6 or not math.isfinite(value):
        return f"{value:g}"
    # One digit more than the step has behind its point, of at most nine.
    text = f"{value:.{len(f'{step:.9f}'.rstrip('0').partition('.')[2]) + 1}f}"
    if value and not float(text):
        return f"{value:.2g}"
    return text[:-1].removesuffix(".") if text.endswith("0") else text


# Component bars: red, green, blue and white of a color, one element for each value of the component. Hue,
# saturation and value have bars of the same length.
#
# Paper: Figure 13, the color bars.

STEPS: Final = 256
"""The values of a component. The track has one element for each value, so you can point at every value."""

LETTER: Final = 16
"""Elements from the left edge to the track, where the letter stands."""

UP_DOWN: Final = 2
"""Lines above and below the track."""


@dataclass(frozen=True)
class ComponentBar(Bar):
    """A bar from 0 to 255, or to `high`, with its letter at the left and its number at the right.

    Its area is at least 312 elements wide, and stands on a ground of NIGHT.
    """

    high: float = STEPS - 1
    step: float = 1
    letter: str = ""
    strip: bytes = b""
    """The words along the track as the bytes of `Words`, instead of a bar of one color; see `level_strip`."""

    @property
    def _track(self) -> Area:
        left, top, _, bottom = self.area
        return Area(left + LETTER, top + UP_DOWN, left + LETTER + STEPS - 1, bottom - UP_DOWN)

    def items(self, lit: bool) -> list[Item]:
        track, end = self._track, self._end
        middle = (self.area.top + self.area.bottom + 1 - CHARACTER_LINES) // 2
        # The bar keeps its color when it is lit, which distinguishes it from the other bars.
        number, ink = fitted(self.number, 5), YELLOW if lit else WHITE
        return [
            text(self.letter, self.area.left, middle, ink),
            component_track(track, end, self.word, self.strip),
            text(number, self.area.right + 1 - CHARACTER * len(number), middle, ink),
        ]

    def nudge(self, steps: float) -> object:
        value = rounded_to((self.value or 0.0) + steps * self.step, self.step)
        return self.put(min(max(value, self.low), self.high))


@lru_cache(maxsize=1024)
def component_track(track: Area, end: int, word: int, strip: bytes) -> Item:
    """The bar of a component up to an element, or its strip with a mark there."""
    # One image is drawn faster than a bar, the rest of its track and a mark, and covers the bar before.
    along = np.full(track.width, SLATE, np.uint16)
    mark = end - track.left
    if strip:
        along[:] = np.frombuffer(strip, np.uint16)[levels_along(track.width, len(strip) // 2)]
        along[max(0, mark - 1) : mark + 2] = BLACK
    else:
        along[:mark] = word
    along[mark] = WHITE
    return image(np.broadcast_to(along, (track.height, track.width)), track.left, track.top)


# Level bars: the levels of a surface in its own words, with a handle at the blend level.
#
# Paper: Figures 13 and 14. In the horizontal bar of color mixing, intensity rises to the right; in the
# vertical bar of light blending, upward. A bar shows the surface's own words, so loading the entries of the
# surface recolors the bar, too.

LANE: Final = 8
"""Elements or lines beside the levels, for the handle."""


@dataclass(frozen=True)
class LevelBar(Widget):
    """The levels of a surface, and a handle at `value`, 0 to `most`, which a pick or a drag puts elsewhere.

    `words` has the word that shows each level, from the left or, in an upright bar, from below. The area
    holds the levels and the lanes of the handle: above and below, or at the left of an upright bar. The
    number stands beyond that lane; it is part of the handle.
    """

    words: Words = field(default_factory=lambda: np.zeros(2, np.uint16))
    value: float = 0
    most: int = 1
    put: Callable[[int], object] = lambda _: None
    number: str = ""
    upright: bool = False

    @property
    def strip(self) -> Area:
        """The area of the levels."""
        left, top, right, bottom = self.area
        if self.upright:
            return Area(left + LANE, top, right, bottom)
        return Area(left, top + LANE, right, bottom - LANE)

    def has(self, element: int, line: int) -> bool:
        return super().has(element, line) or self._number_area.has(element, line)

    @property
    def _number_area(self) -> Area:
        """The area of the number, at the left of an upright bar."""
        left, top = self.area.left, self.strip.bottom - self._along(self.value) - REACH
        return Area(left - CHARACTER * len(self.number), top, left - 1, top + CHARACTER_LINES - 1)

    @property
    def _last(self) -> int:
        """The elements or lines from the lowest value to the highest."""
        return (self.strip.height if self.upright else self.strip.width) - 1

    def _along(self, value: float) -> int:
        """The elements or lines from the lowest value to another."""
        return half_up(value * self._last / self.most)

    def value_at(self, place: Place) -> int:
        """The value at a place; beyond the ends of the bar, the lowest or the highest."""
        along = self.strip.bottom - place.line if self.upright else place.element - self.strip.left
        return half_up(min(max(along, 0), self._last) * self.most / self._last)

    def items(self, lit: bool) -> list[Item]:
        strip, ink, along = self.strip, YELLOW if lit else WHITE, self._along(self.value)
        # The frame is seen beside dark levels, over a dark picture.
        items = [filled(strip.inset(-1), GRAY), level_strip(self.words.tobytes(), strip, self.upright)]
        if not self.upright:
            element = strip.left + along
            down, up = pointer(element, strip.top - 2, DOWN, ink), pointer(element, strip.bottom + 2, UP, ink)
            return [*items, down, up]
        items.append(pointer(strip.left - 2, strip.bottom - along, RIGHT, ink))
        return [*items, *([text(self.number, *self._number_area[:2], ink, NIGHT)] if self.number else ())]

    def pick(self, place: Place) -> object:
        return self.put(self.value_at(place))

    def drag(self, start: Place, last: Place, place: Place) -> object:
        return self.put(self.value_at(place))

    def nudge(self, steps: float) -> object:
        return self.put(min(max(half_up(self.value + steps), 0), self.most))


@dataclass(frozen=True)
class RampBar(LevelBar):
    """The levels of a surface with a ramp, with a pointer at each color of the ramp if there is room.

    The handle is at the chosen color. A pick or a key chooses another; a drag moves the color where it began:
    `move` is called with its new place among the colors.
    """

    move: Callable[[int], object] = lambda _: None

    def items(self, lit: bool) -> list[Item]:
        strip, colors = self.strip, range(self.most + 1)
        has_room = len(colors) <= strip.width // (2 * REACH + 1)
        elements = [strip.left + self._along(color) for color in colors] if has_room else []
        stops = [pointer(element, strip.top - 2, DOWN, LIGHT_GRAY) for element in elements]
        return [*stops, *super().items(lit)]

    def drag(self, start: Place, last: Place, place: Place) -> object:
        if last == start:
            self.put(self.value_at(start))
        return self.move(self.value_at(place))


@dataclass(frozen=True)
class PercentBar(LevelBar):
    """A handle at a percentage of the height of the area, with its number, beside an upright level bar."""

    most: int = 100
    upright: bool = True

    def items(self, lit: bool) -> list[Item]:
        ink, line = YELLOW if lit else WHITE, self.strip.bottom - self._along(self.value)
        return [
            pointer(self.area.left + 2, line, LEFT, ink),
            text(f"{self.value:.0f}%", self.area.left + LANE, line - REACH, ink, NIGHT),
        ]


def levels_along(length: int, levels: int) -> Numbers:
    """The level at each element of a bar, (length,): the ends are the lowest and the highest level."""
    return (np.arange(length) * (levels - 1) * 2 // (length - 1) + 1) // 2


@lru_cache(maxsize=16)
def level_strip(data: bytes, area: Area, upright: bool = False) -> Item:
    """Levels in their words, given as the bytes of `Words`; the last level is at the right, or at the top."""
    words = np.frombuffer(data, np.uint16)
    along = words[levels_along(area.height if upright else area.width, len(words))]
    filling = np.broadcast_to(along[::-1, None] if upright else along, (area.height, area.width))
    return image(filling, area.left, area.top)
