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

from autocolor.mapping.display_image import DisplayImage
from autocolor.mapping.level_ranges import SCREENS
from autocolor.mapping.scalar_bands import Bands

CHARACTER: Final = 7
LETTER_LINES: Final = 9
"""Hardware: the cell of a character of the smallest size, in elements and lines."""

INK: Final = SCREENS.first + 1
GROUND: Final = SCREENS.first + 5
FRAME: Final = SCREENS.first + 4

MARGIN: Final = 8
"""Elements and lines between the legend and the edges of the picture, and around what stands in it."""

BAR_ELEMENTS: Final = 16
BESIDE: Final = 5
"""Elements between the bar and its numbers."""

BAR_LINES: Final = 224
"""Assumed: the most lines of the bar while no band would have less than one."""

MOST_BAND_LINES: Final = 24
LEAST_APART: Final = 22
"""Assumed: lines from one number to the next."""

MOST_TITLE: Final = 12
"""Characters of a line of the title."""

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


def legend(image: DisplayImage, right: int | None = None, bottom: int | None = None) -> Legend | None:
    """The legend of an image; None without a scalar, where that has none, and where it would not fit.

    It stands in the upper right corner of the picture, or of what is to the left of an element and above a
    line.
    """
    scalar = image.scene.scalar
    seen = {image.picture.surfaces[each.surface_number - 1] for each in image.picture.slices}
    found = {name: bands for name, bands in image.bands.items() if name in seen}
    if scalar is None or not scalar.legend or not found:
        return None
    lines, elements = image.words.shape
    # A surface where a value is missing has all the bands that there are.
    name = max(found, key=lambda name: found[name].has_missing)
    return _laid_out(
        scalar.name,
        found[name],
        image.ranges[name].first,
        elements if right is None else min(right, elements),
        lines if bottom is None else min(bottom, lines),
    )


def _laid_out(name: str, bands: Bands, first: int, right: int, bottom: int) -> Legend | None:
    """The legend of a scalar with bands, to the left of an element and above a line."""
    title = title_lines(name)
    step = step_of_numbers(bands.bands, band_lines(bands.bands))
    numbers = [number_text(value, bands) for value in limits_of_bands(bands, step)]
    ends = [("above", bands.above, bands.has_above), ("below", bands.below, bands.has_below)]
    above, below = ([(label, band)] if has_it else [] for label, band, has_it in ends)
    below += [("missing", bands.missing)] if bands.has_missing else []

    beside = max(len(each) for each in (*numbers, *(label for label, _ in (*above, *below))))
    inner = max(BAR_ELEMENTS + BESIDE + CHARACTER * beside, CHARACTER * max(len(each) for each in title))
    row = LETTER_LINES + 4
    height = band_lines(bands.bands) * bands.bands
    inner_lines = (LETTER_LINES + 1) * len(title) + 10 + height + 4 + row * (len(above) + len(below))
    if right < (inner + 3 * MARGIN) / MOST_SHARE or bottom < inner_lines + 4 * MARGIN:
        return None

    left, top = right - 2 * MARGIN - inner, 2 * MARGIN
    panel = (left - MARGIN, top - MARGIN, right - MARGIN - 1, top + inner_lines + MARGIN - 1)
    swatches = [
        Swatch(*panel, FRAME),
        Swatch(*(each + inset for each, inset in zip(panel, (1, 1, -1, -1), strict=True)), GROUND),
    ]
    labels = []
    for line in title:
        labels.append(Label(left, top, line))
        top += LETTER_LINES + 1
    top += 6

    def put_row(label: str, band: int) -> None:
        word = first + bands.brightest(band)
        swatches.append(Swatch(left, top, left + BAR_ELEMENTS - 1, top + LETTER_LINES - 1, word))
        labels.append(Label(left + BAR_ELEMENTS + BESIDE, top, label))

    for each in above:
        put_row(*each)
        top += row
    top += 4
    lines = band_lines(bands.bands)
    for band in range(bands.bands):
        low = top + height - band * lines
        word = first + bands.brightest(band)
        swatches.append(Swatch(left, low - lines, left + BAR_ELEMENTS - 1, low - 1, word))
    for place, number in enumerate(numbers):
        middle = top + height - place * step * lines
        labels.append(Label(left + BAR_ELEMENTS + BESIDE, middle - LETTER_LINES // 2 - 1, number))
        swatches.append(
            Swatch(
                left + BAR_ELEMENTS,
                min(middle, top + height - 1),
                left + BAR_ELEMENTS + 2,
                min(middle, top + height - 1),
                INK,
            )
        )
    top += height + 8
    for each in below:
        put_row(*each)
        top += row
    return Legend(tuple(swatches), tuple(labels))


def title_lines(name: str) -> Sequence[str]:
    """The name of a scalar in lines, broken between words; a line that is too long is cut.

    >>> title_lines("gaussian curvature"), title_lines("stress")
    (['gaussian', 'curvature'], ['stress'])
    """
    lines: list[str] = []
    for word in name.split() or [name]:
        if lines and len(lines[-1]) + 1 + len(word) <= MOST_TITLE:
            lines[-1] += f" {word}"
        else:
            lines.append(word if len(word) <= MOST_TITLE else f"{word[: MOST_TITLE - 2]}..")
    return lines if len(lines) <= 3 else [*lines[:2], f"{lines[2][: MOST_TITLE - 2]}.."]


def band_lines(bands: int) -> int:
    """The lines of each band of the bar."""
    return max(1, min(MOST_BAND_LINES, BAR_LINES // bands))


def step_of_numbers(bands: int, lines: int) -> int:
    """The bands from one number to the next: the fewest that divide them all and leave room for a number.

    >>> step_of_numbers(16, 14), step_of_numbers(5, 24), step_of_numbers(13, 17)
    (2, 1, 13)
    """
    return next(
        step
        for step in range(1, bands + 1)
        if bands % step == 0 and (step * lines >= LEAST_APART or step == bands)
    )


def limits_of_bands(bands: Bands, step: int) -> Sequence[float]:
    """The limits of every so many bands, from the lowest."""
    extent = bands.high - bands.low
    return [bands.low + extent * number / bands.bands for number in range(0, bands.bands + 1, step)]


def number_text(value: float, bands: Bands) -> str:
    """A limit of a band in as few characters as tell it from the next ones, with at most four digits.

    >>> number_text(62.5, Bands(0, 250, 16, 8)), number_text(0.1234567, Bands(-1e-7, 1, 4, 1))
    ('62.5', '0.1235')
    """
    extent = bands.high - bands.low
    # What is zero but for rounding is told as zero.
    value = 0.0 if abs(value) < extent * 1e-9 else value
    digits = 4
    # Limits far from zero in comparison with their distance need more digits.
    largest = max(abs(bands.low), abs(bands.high))
    if largest > 0:
        digits = min(7, max(4, 2 + math.ceil(math.log10(largest / extent * bands.bands))))
    return f"{value:.{digits}g}"
