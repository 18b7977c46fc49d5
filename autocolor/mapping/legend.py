"""The legend of a scalar's colors, as areas of words and lines of text beside the picture.

`sending` or a screen draws it over the picture by instructions. It is no part of the display image, whose
words show the scene alone. Its bar has the words of a surface that the scalar colors, the brightest shade of
each band: so another color scale changes the legend and the surface by the same entries. Its ground and its
letters have words of the screens.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final, NamedTuple

import numpy as np

from autocolor.mapping.bands import Bands
from autocolor.mapping.display_image import DisplayImage
from autocolor.mapping.ranges import SCREENS, WORDS

CHARACTER: Final = 7
LETTER_LINES: Final = 9
"""Hardware: the cell of a character of the smallest size, in elements and lines."""

INK: Final = SCREENS.first + 1
GROUND: Final = SCREENS.first + 5
FRAME: Final = SCREENS.first + 4

MARGIN: Final = 8
"""Elements and lines between the legend and the edges of the picture, and within its frame."""

BAR_ELEMENTS: Final = 16
BAR_LINES: Final = 224
"""Assumed: the most lines of the bar, unless there are more bands."""

MOST_BAND_LINES: Final = 24
BESIDE: Final = 6
"""Elements between the bar and its numbers."""

BAR_GAP: Final = 8
"""Lines above and below the bar, beyond which its numbers reach."""

TITLE_LINES: Final = 11
TITLE_GAP: Final = 4
ROW_LINES: Final = 12
"""Lines from one line of the title, or of the other colors, to the next."""

LEAST_APART: Final = 22
"""Assumed: lines from one number to the next; at least half of it from a limit that is written."""

TICK: Final = 3
"""Elements of the mark between the bar and a number."""

NO_VALUE: Final = "no value"
"""The text beside the color of missing values."""

MOST_TITLE: Final = 12
MOST_TITLES: Final = 3
"""Characters of a line of the title, and lines of it."""

CORNERS: Final = ((1.0, 0.0), (0.0, 0.0), (1.0, 1.0), (0.0, 1.0))
"""The corners of a picture as places: upper right, upper left, lower right, lower left."""

MOST_SHARE: Final = 0.4
"""Assumed: the largest part of the width of the picture for a legend; a smaller picture has no legend."""

MOST_DIGITS: Final = 6
"""Assumed: numbers with more digits before or after the point are written with a power of ten."""

EXACT: Final = 1e-7
"""Assumed: the error of an exact number, as a fraction of the distance to the next; limits are float32."""

LEAST_SCALED: Final = 1e-290
"""Quotients and powers of smaller numbers would lose their digits, or vanish."""


class Swatch(NamedTuple):
    """An area of one word; its edges are included."""

    left: int
    top: int
    right: int
    bottom: int
    word: int


class Label(NamedTuple):
    """A line of text in words INK and GROUND, with its upper left corner."""

    left: int
    top: int
    text: str


@dataclass(frozen=True)
class Legend:
    """The areas and the texts of a legend, the lowest layer first; the first area is the whole legend.

    `room` are the elements and lines that the legend can be moved by, from the left and from line `begin`.
    """

    swatches: tuple[Swatch, ...]
    labels: tuple[Label, ...]
    room: tuple[int, int]
    begin: int = 0

    def place_at(self, left: int, top: int) -> Corner:
        """The place at which its upper left corner is at an element and a line, as far as there is room."""
        moved = left - MARGIN, top - MARGIN - self.begin
        x, y = (at / (room or 1) for at, room in zip(moved, self.room, strict=True))
        return round(min(max(x, 0.0), 1.0), 4), round(min(max(y, 0.0), 1.0), 4)

    def has(self, element: int, line: int) -> bool:
        """Whether the legend covers a pixel."""
        left, top, right, bottom, _ = self.swatches[0]
        return left <= element <= right and top <= line <= bottom


Corner = tuple[float, float]
"""A place in the room of a legend, from the left and from the top, 0 to 1 each."""


def legend(
    image: DisplayImage,
    end: int | None = None,
    corners: Sequence[Corner] = CORNERS,
    begin: int = 0,
) -> Legend | None:
    """The legend of an image; None without a scalar, if its legend is off, and if it would not fit.

    Its place is the scalar's `legend_place`. Assumed: without one, it is in the corner of `corners` where it
    hides the fewest pixels of the object; ties go to the first. With `begin` and `end`, it is placed as if
    the picture began at that line, and ended before that element.
    """
    scalar = image.scene.scalar
    if scalar is None or not scalar.legend:
        return None
    visible = {image.picture.surfaces[each.surface_number - 1] for each in image.picture.slices}
    bands = {name: each for name, each in image.bands.items() if name in visible}
    if not bands:
        return None
    lines, elements = image.words.shape
    # A surface with missing values has all bands.
    name = max(bands, key=lambda name: bands[name].has_missing)
    size = lines - begin, elements if end is None else min(end, elements)
    # Values beyond the limits are in the end bands, or in bands of their own.
    low, high = image.picture.scalar_limits or (math.inf, -math.inf)
    beyond = low < bands[name].low, high > bands[name].high
    first = image.ranges[name].first
    places = corners if scalar.legend_place is None else [scalar.legend_place]
    legends = [laid_out(scalar.name, bands[name], first, size, place, beyond, begin) for place in places]
    return min(filter(None, legends), key=lambda legend: _hidden(image, legend), default=None)


def _hidden(image: DisplayImage, legend: Legend) -> int:
    """The number of pixels of the object that a legend hides; the stage does not count."""
    of_object = {part.surface for part in image.scene.parts if not part.stage}
    is_object = np.zeros(WORDS, np.bool_)
    for name, (first, levels) in image.ranges.items():
        is_object[first : first + levels] = name in of_object
    left, top, right, bottom, _ = legend.swatches[0]
    return int(np.count_nonzero(is_object[image.words[top : bottom + 1, left : right + 1]]))


def laid_out(
    name: str,
    bands: Bands,
    first: int,
    size: tuple[int, int],
    place: Corner,
    beyond: tuple[bool, bool] = (False, False),
    begin: int = 0,
) -> Legend | None:
    """The legend of a scalar with bands from a first word on, at a place of a picture of a size.

    The picture begins at line `begin`. `beyond` is whether values are below and above the limits. If so, the
    limit is written after "<" or ">".
    """
    height = lines_of_band(bands.bands)
    numbers, exponent, places = numbers_beside(bands.low, bands.high, bands.bands, height, LEAST_APART)
    title = [*title_lines(name), *([f"x 1e{exponent}"] if exponent else [])]
    # The power of ten alone may be too small for a number.
    half = 10.0 ** (exponent // 2)
    limits = [
        f"{sign} {value / half / 10.0 ** (exponent - exponent // 2):.4g}"
        for sign, value in (("<", bands.low), (">", bands.high))
    ]
    above = [(limits[1], bands.above)] * bands.has_above
    below = [(limits[0], bands.below)] * bands.has_below + [(NO_VALUE, bands.missing)] * bands.has_missing

    # A limit that values exceed is written at its end of the bar, unless these values have their own color.
    at = dict(zip(places, numbers, strict=True))
    ends = (0, beyond[0] and not bands.has_below), (height * bands.bands, beyond[1] and not bands.has_above)
    for (height_of_end, is_written), limit in zip(ends, limits, strict=True):
        if is_written:
            at = {each: text for each, text in at.items() if 2 * abs(each - height_of_end) >= LEAST_APART}
            at[height_of_end] = limit
    numbers = list(at.values())

    # Measure the whole legend.
    beside = max(map(len, (*numbers, *(label for label, _ in (*above, *below)))))
    inner = max(BAR_ELEMENTS + BESIDE + CHARACTER * beside, CHARACTER * max(map(len, title)))
    bar_lines = height * bands.bands
    rows = ROW_LINES * (len(above) + len(below))
    inside = TITLE_LINES * len(title) + TITLE_GAP + 2 * BAR_GAP + bar_lines + rows
    if inner + 3 * MARGIN > MOST_SHARE * size[1] or inside + 4 * MARGIN > size[0]:
        return None

    left = 2 * MARGIN + round(place[0] * (size[1] - 4 * MARGIN - inner))
    top = begin + 2 * MARGIN + round(place[1] * (size[0] - 4 * MARGIN - inside))
    frame = Swatch(left - MARGIN, top - MARGIN, left + inner + MARGIN - 1, top + inside + MARGIN - 1, FRAME)
    ground = Swatch(frame.left + 1, frame.top + 1, frame.right - 1, frame.bottom - 1, GROUND)
    swatches, labels = [frame, ground], []

    def put(band: int, top: int, lines: int) -> None:
        word = first + bands.brightest(band)
        swatches.append(Swatch(left, top, left + BAR_ELEMENTS - 1, top + lines - 1, word))

    def put_text(middle: int, text: str) -> None:
        labels.append(Label(left + BAR_ELEMENTS + BESIDE, middle - LETTER_LINES // 2, text))

    # Place the title, the color above the limits, the bar with its numbers, and the other colors.
    for line in title:
        labels.append(Label(left, top, line))
        top += TITLE_LINES
    top += TITLE_GAP
    for label, band in above:
        put(band, top, LETTER_LINES)
        put_text(top + LETTER_LINES // 2, label)
        top += ROW_LINES
    foot = top + BAR_GAP + bar_lines
    for band in range(bands.bands):
        put(band, foot - (band + 1) * height, height)
    for above_foot, number in at.items():
        mark, middle = left + BAR_ELEMENTS, foot - above_foot
        swatches.append(Swatch(mark, middle, mark + TICK - 1, middle, INK))
        put_text(middle, number)
    top = foot + BAR_GAP
    for label, band in below:
        put(band, top, LETTER_LINES)
        put_text(top + LETTER_LINES // 2, label)
        top += ROW_LINES
    room = size[1] - 4 * MARGIN - inner, size[0] - 4 * MARGIN - inside
    return Legend(tuple(swatches), tuple(labels), room, begin)


def title_lines(name: str) -> Sequence[str]:
    """The name of a scalar in at most three lines, broken between words; longer lines are cut.

    >>> title_lines("gaussian curvature"), title_lines("stress")
    (['gaussian', 'curvature'], ['stress'])
    """
    lines: list[str] = []
    for word in name.split() or [name]:
        if lines and len(lines[-1]) + 1 + len(word) <= MOST_TITLE:
            lines[-1] += f" {word}"
        else:
            lines.append(word)
    if len(lines) > MOST_TITLES:
        lines = [*lines[: MOST_TITLES - 1], " ".join(lines[MOST_TITLES - 1 :])]
    return [line if len(line) <= MOST_TITLE else f"{line[: MOST_TITLE - 2]}.." for line in lines]


def lines_of_band(bands: int) -> int:
    """The lines of each band of the bar."""
    return max(1, min(MOST_BAND_LINES, BAR_LINES // bands))


class PlacedNumbers(NamedTuple):
    """Numbers as texts, in units of a power of ten, and the lines of each above the foot of the bar."""

    texts: Sequence[str]
    exponent: int
    places: Sequence[int]


def numbers_beside(low: float, high: float, bands: int, lines: int, least: int) -> PlacedNumbers:
    """The numbers beside a bar, from the lowest up, at least `least` lines apart; a band has `lines` lines.

    Numbers are round: multiples of 1, 2 or 5 times a power of ten. If fewer than two of them are between the
    limits, the limits are the numbers. But bands around whole numbers, such as kinds or counts, have the
    whole number beside their middle. Such numbers may be half as far apart, because each names its band.

    >>> numbers_beside(0, 100, 4, 24, 22)
    PlacedNumbers(texts=['0', '50', '100'], exponent=0, places=[0, 48, 96])
    >>> numbers_beside(0.5, 3.5, 3, 24, 22)
    PlacedNumbers(texts=['1', '2', '3'], exponent=0, places=[12, 36, 60])
    """
    if bands > 1 and high - low == bands and (low - 0.5).is_integer() and max(-low, high) < 10**MOST_DIGITS:
        step = math.ceil(least / 2 / lines)
        middles = range(0, bands, step)
        texts = [str(round(low + 0.5) + band) for band in middles]
        return PlacedNumbers(texts, 0, [band * lines + lines // 2 for band in middles])
    values = round_numbers(low, high, max(1, bands * lines // least))
    written, exponent = in_few_digits(values, values[1] - values[0])
    places = [round((value - low) / (high - low) * bands * lines) for value in values]
    return PlacedNumbers(written, exponent, places)


def round_numbers(low: float, high: float, count: int) -> list[float]:
    """The multiples of 1, 2 or 5 times a power of ten from low to high, at most `count` + 1 of them.

    If there are fewer than two, or if rounding would move them, they are low and high.

    >>> round_numbers(0.13, 0.87, 10), round_numbers(0.13, 0.87, 1)
    ([0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8], [0.13, 0.87])
    """
    least = (high - low) / count
    if least * EXACT <= sys.float_info.epsilon * max(-low, high):
        return [low, high]
    power = math.floor(math.log10(least))
    for factor, exponent in ((1, power), (2, power), (5, power), (1, power + 1)):
        if -exponent > sys.float_info.max_10_exp:
            continue
        # An exact quotient: 0.1 times 3 is not 0.3.
        step, divisor = factor * 10.0 ** max(exponent, 0), 10.0 ** max(-exponent, 0)
        if step / divisor < least * (1 - EXACT):
            continue
        first = math.ceil(low * divisor / step - EXACT)
        last = math.floor(high * divisor / step + EXACT)
        if last > first:
            return [number * step / divisor for number in range(first, last + 1)]
    return [low, high]


class ScaledNumbers(NamedTuple):
    """Numbers as texts, in units of a power of ten."""

    texts: Sequence[str]
    exponent: int


def in_few_digits(values: Sequence[float], distance: float) -> ScaledNumbers:
    """Numbers at a distance from each other, with as few decimals as are exact.

    If four digits of the distance are not exact, all numbers have the decimals of three digits. Very large
    and very small numbers are in thousands, millions or the like.

    >>> in_few_digits([0, 2.5e6, 5e6], 2.5e6)
    ScaledNumbers(texts=['0', '2.5', '5'], exponent=6)
    """
    largest = max(map(abs, values))
    if largest < LEAST_SCALED:
        texts, exponent = in_few_digits([value * 1e60 for value in values], distance * 1e60)
        return ScaledNumbers(texts, exponent - 60)
    # A number that is zero up to rounding is written as zero.
    rounded = [0.0 if abs(value) < distance * EXACT else value for value in values]
    exponent = 0
    before, after = (math.floor(math.log10(each)) for each in (largest, distance))
    if before >= MOST_DIGITS or after < 3 - MOST_DIGITS:
        exponent = before // 3 * 3
    unit = 10.0**exponent
    return ScaledNumbers(_texts([value / unit for value in rounded], distance / unit), exponent)


def _texts(values: Sequence[float], distance: float) -> Sequence[str]:
    most = max(0, 3 - math.floor(math.log10(distance)))
    for decimals in range(most + 1):
        if all(abs(round(value, decimals) - value) <= distance * EXACT for value in values):
            return [_without_zeros(f"{value:.{decimals}f}") for value in values]
    return ["0" if value == 0 else f"{value:.{max(0, most - 1)}f}" for value in values]


def _without_zeros(number: str) -> str:
    return number.rstrip("0").rstrip(".") if "." in number else number
