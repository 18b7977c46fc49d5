"""The legend: what the colors of a scalar mean, as areas of words and lines of text beside the picture.

It is drawn by instructions over the picture, by `sending` or by a screen, and is no part of the picture: the
words of an image are those of the scene alone. Its bar is in the words of a surface that the scalar colors,
in the brightest shade of each band; so another color scale changes the legend with the surface, by the same
entries. Its ground and its letters are in words of the screens.
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

# -------------------- legend_numbers
# The numbers beside the bar of a legend: which limits of bands are told, and in which digits.

MOST_DIGITS: Final = 6
"""Assumed: digits before or after the point up to which numbers are told without a power of ten."""

EXACT: Final = 1e-7
"""Assumed: what a number may be off by, as a fraction of the distance to the next; limits are of float32."""


def bands_apart(bands: int, lines: int, least: int) -> int:
    """The bands from one number to the next: the fewest that divide them all and are `least` lines or more.

    `lines` are those of a band. If no such number divides them, only the ends are told.

    >>> bands_apart(16, 14, 22), bands_apart(5, 24, 22), bands_apart(13, 17, 22)
    (2, 1, 13)
    """
    dividing = (step for step in range(1, bands) if bands % step == 0 and step * lines >= least)
    return next(dividing, bands)


class PlacedNumbers(NamedTuple):
    """Numbers as texts, in units of a power of ten, and the lines of each above the foot of the bar."""

    texts: Sequence[str]
    exponent: int
    places: Sequence[int]


def numbers_beside(low: float, high: float, bands: int, lines: int, least: int) -> PlacedNumbers:
    """The numbers beside a bar of bands of so many lines each, from the lowest, `least` lines apart.

    They are limits of bands. But bands that are each around a whole number, as of kinds or of counts, have
    that number beside their middle, and these may be half as far apart: each names its band.

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


class Numbers(NamedTuple):
    """Numbers as texts, in units of a power of ten."""

    texts: Sequence[str]
    exponent: int


def numbers_between(low: float, high: float, count: int) -> Numbers:
    """Numbers at `count` equal distances from low to high, both included.

    They have as few digits as are exact; if four digits of the distance are not, all have the same decimals,
    three digits of it. Very large and very small ones are in thousands, millions or the like.

    >>> numbers_between(0, 250, 4).texts, numbers_between(0, 1.2, 7).texts[:5]
    (['0', '62.5', '125', '187.5', '250'], ['0', '0.171', '0.343', '0.514', '0.686'])
    >>> numbers_between(0, 5e6, 2)
    Numbers(texts=['0', '2.5', '5'], exponent=6)
    """
    distance = (high - low) / count
    values = [low + (high - low) * number / count for number in range(count)] + [high]
    # What is zero but for rounding is told as zero.
    values = [0.0 if abs(value) < distance * EXACT else value for value in values]
    exponent = 0
    before, after = (math.floor(math.log10(each)) for each in (max(abs(low), abs(high)), distance))
    if before >= MOST_DIGITS or after < 3 - MOST_DIGITS:
        exponent = before // 3 * 3
    unit = 10.0**exponent
    return Numbers(_texts([value / unit for value in values], distance / unit), exponent)


def _texts(values: Sequence[float], distance: float) -> Sequence[str]:
    most = max(0, 3 - math.floor(math.log10(distance)))
    for decimals in range(most + 1):
        if all(abs(round(value, decimals) - value) <= distance * EXACT for value in values):
            return [_without_zeros(f"{value:.{decimals}f}") for value in values]
    return ["0" if value == 0 else f"{value:.{max(0, most - 1)}f}" for value in values]


def _without_zeros(number: str) -> str:
    return number.rstrip("0").rstrip(".") if "." in number else number


CHARACTER: Final = 7
LETTER_LINES: Final = 9
"""Hardware: the cell of a character of the smallest size, in elements and lines."""

INK: Final = SCREENS.first + 1
GROUND: Final = SCREENS.first + 5
FRAME: Final = SCREENS.first + 4

MARGIN: Final = 8
"""Elements and lines between the legend and the edges of the picture, and around what stands in it."""

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
"""The corners of a picture: whether each is at the left, and whether it is at the foot."""

MOST_SHARE: Final = 0.4
"""Assumed: the largest part of the width of the picture that the legend takes; a smaller picture has none."""


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
    """The areas and the texts of a legend, from the lowest; the first area is the whole of it."""

    swatches: tuple[Swatch, ...]
    labels: tuple[Label, ...]

    def has(self, element: int, line: int) -> bool:
        """Whether it covers a pixel."""
        left, top, right, bottom, _ = self.swatches[0]
        return left <= element <= right and top <= line <= bottom


def legend(image: DisplayImage, end: int | None = None, at_left: bool | None = None) -> Legend | None:
    """The legend of an image; None without a scalar, where that has none, and where it would not fit.

    Assumed: it stands in the upper right corner or the upper left one, as `at_left` tells; if that is None,
    in that of the four where it hides fewest pixels of the object, the upper right one before others. `end`
    puts it as if the picture ended before an element.
    """
    scalar = image.scene.scalar
    if scalar is None or not scalar.legend:
        return None
    seen = {image.picture.surfaces[each.surface_number - 1] for each in image.picture.slices}
    found = {name: bands for name, bands in image.bands.items() if name in seen}
    if not found:
        return None
    lines, elements = image.words.shape
    # A surface where a value is missing has all the bands that there are.
    name = max(found, key=lambda name: found[name].has_missing)
    size = lines, elements if end is None else min(end, elements)
    corners = CORNERS if at_left is None else [(at_left, False)]
    first = image.ranges[name].first
    legends = [laid_out(scalar.name, found[name], first, size, *corner) for corner in corners]
    return min(filter(None, legends), key=lambda legend: _hidden(image, legend), default=None)


def _hidden(image: DisplayImage, legend: Legend) -> int:
    """How many pixels of the object a legend hides; what is on the stage is none of it."""
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

    # The size of it all.
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

    # The title, what is above the limits, the bar with its numbers, and what else there is.
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
    """The name of a scalar in at most three lines, broken between words; what is too long is cut.

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
