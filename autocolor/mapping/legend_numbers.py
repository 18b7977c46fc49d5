"""The numbers beside the bar of a legend: which limits of bands are told, and in which digits."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Final, NamedTuple

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
