"""The legend of a scalar's colors, as areas of words and lines of text beside the picture.

`sending` or a screen draws it over the picture by instructions. It is no part of the display image, whose
words show the scene alone. Its bar has the words of a surface that the scalar colors, the brightest shade of
each band: so another color scale changes the legend and the surface by the same entries. Its ground and its
letters have words of the screens.
"""

from __future__ import annotations

import math
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
"""Assumed: lines from one number to the next."""

MOST_TITLE: Final = 12
MOST_TITLES: Final = 3
"""Characters of a line of the title, and lines of it."""

CORNERS: Final = ((False, False), (True, False), (False, True), (True, True))
"""The corners of a picture: at the left or not, and at the foot or not."""

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
    """The areas and the texts of a legend, the lowest layer first; the first area is the whole legend."""

    swatches: tuple[Swatch, ...]
    labels: tuple[Label, ...]

    def has(self, element: int, line: int) -> bool:
        """Whether the legend covers a pixel."""
        left, top, right, bottom, _ = self.swatches[0]
        return left <= element <= right and top <= line <= bottom


def legend(image: DisplayImage, end: int | None = None, at_left: bool | None = None) -> Legend | None:
    """The legend of an image; None without a scalar, if its legend is off, and if it would not fit.

    Assumed: `at_left` puts the legend in the upper left or the upper right corner. With None it is in the
    corner where it hides the fewest pixels of the object; ties go to the upper right. With `end`, it is
    placed as if the picture ended before that element.
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
    size = lines, elements if end is None else min(end, elements)
    corners = CORNERS if at_left is None else [(at_left, False)]
    first = image.ranges[name].first
    legends = [laid_out(scalar.name, bands[name], first, size, *corner) for corner in corners]
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
    name: str, bands: Bands, first: int, size: tuple[int, int], at_left: bool, at_foot: bool = False
) -> Legend | None:
    """The legend of a scalar with bands from a first word on, in a corner of a picture of a size."""
    height = lines_of_band(bands.bands)
    numbers, exponent, places = numbers_beside(bands.low, bands.high, bands.bands, height, LEAST_APART)
    title = [*title_lines(name), *([f"x 1e{exponent}"] if exponent else [])]
    above = [("above", bands.above)] * bands.has_above
    below = [("below", bands.below)] * bands.has_below + [("missing", bands.missing)] * bands.has_missing

    # Measure the whole legend.
    beside = max(map(len, (*numbers, *(label for label, _ in (*above, *below)))))
    inner = max(BAR_ELEMENTS + BESIDE + CHARACTER * beside, CHARACTER * max(map(len, title)))
    bar_lines = height * bands.bands
    rows = ROW_LINES * (len(above) + len(below))
    inside = TITLE_LINES * len(title) + TITLE_GAP + 2 * BAR_GAP + bar_lines + rows
    if inner + 3 * MARGIN > MOST_SHARE * size[1] or inside + 4 * MARGIN > size[0]:
        return None

    left = 2 * MARGIN if at_left else size[1] - 2 * MARGIN - inner
    top = size[0] - 2 * MARGIN - inside if at_foot else 2 * MARGIN
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
    for place, number in zip(places, numbers, strict=True):
        put_text(foot - place, number)
    top = foot + BAR_GAP
    for label, band in below:
        put(band, top, LETTER_LINES)
        put_text(top + LETTER_LINES // 2, label)
        top += ROW_LINES
    return Legend(tuple(swatches), tuple(labels))


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

    Numbers are limits of bands. But bands around whole numbers, such as kinds or counts, have the whole
    number beside their middle. Such numbers may be half as far apart, because each number names its band.

    >>> numbers_beside(0, 100, 4, 24, 22)
    PlacedNumbers(texts=['0', '25', '50', '75', '100'], exponent=0, places=[0, 24, 48, 72, 96])
    >>> numbers_beside(0.5, 3.5, 3, 24, 22)
    PlacedNumbers(texts=['1', '2', '3'], exponent=0, places=[12, 36, 60])
    """
    if bands > 1 and high - low == bands and (low - 0.5).is_integer() and max(-low, high) < 10**MOST_DIGITS:
        step = math.ceil(least / 2 / lines)
        middles = range(0, bands, step)
        texts = [str(round(low + 0.5) + band) for band in middles]
        return PlacedNumbers(texts, 0, [band * lines + lines // 2 for band in middles])
    step = bands_apart(bands, lines, least)
    count = bands // step
    numbers = numbers_between(low, high, count)
    return PlacedNumbers(*numbers, [place * step * lines for place in range(count + 1)])


def bands_apart(bands: int, lines: int, least: int) -> int:
    """The bands from one number to the next: the fewest that divide all bands and have `least` lines or more.

    `lines` are the lines of a band. If no number of bands fits, it is all bands: only the ends have numbers.

    >>> bands_apart(16, 14, 22), bands_apart(5, 24, 22), bands_apart(13, 17, 22)
    (2, 1, 13)
    """
    dividing = (step for step in range(1, bands) if bands % step == 0 and step * lines >= least)
    return next(dividing, bands)


class ScaledNumbers(NamedTuple):
    """Numbers as texts, in units of a power of ten."""

    texts: Sequence[str]
    exponent: int


def numbers_between(low: float, high: float, count: int) -> ScaledNumbers:
    """Numbers at `count` equal distances from low to high, both included.

    They have as few decimals as are exact. If four digits of the distance are not exact, all numbers have the
    decimals of three digits. Very large and very small numbers are in thousands, millions or the like.

    >>> numbers_between(0, 250, 4).texts, numbers_between(0, 1.2, 7).texts[:5]
    (['0', '62.5', '125', '187.5', '250'], ['0', '0.171', '0.343', '0.514', '0.686'])
    >>> numbers_between(0, 5e6, 2)
    ScaledNumbers(texts=['0', '2.5', '5'], exponent=6)
    """
    if max(abs(low), abs(high)) < LEAST_SCALED:
        texts, exponent = numbers_between(low * 1e60, high * 1e60, count)
        return ScaledNumbers(texts, exponent - 60)
    distance = (high - low) / count
    values = [low + (high - low) * number / count for number in range(count)] + [high]
    # A number that is zero up to rounding is written as zero.
    values = [0.0 if abs(value) < distance * EXACT else value for value in values]
    exponent = 0
    before, after = (math.floor(math.log10(each)) for each in (max(abs(low), abs(high)), distance))
    if before >= MOST_DIGITS or after < 3 - MOST_DIGITS:
        exponent = before // 3 * 3
    unit = 10.0**exponent
    return ScaledNumbers(_texts([value / unit for value in values], distance / unit), exponent)


def _texts(values: Sequence[float], distance: float) -> Sequence[str]:
    most = max(0, 3 - math.floor(math.log10(distance)))
    for decimals in range(most + 1):
        if all(abs(round(value, decimals) - value) <= distance * EXACT for value in values):
            return [_without_zeros(f"{value:.{decimals}f}") for value in values]
    return ["0" if value == 0 else f"{value:.{max(0, most - 1)}f}" for value in values]


def _without_zeros(number: str) -> str:
    return number.rstrip("0").rstrip(".") if "." in number else number
