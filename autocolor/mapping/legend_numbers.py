"""The numbers beside the bar of a legend: which limits of bands are told, and in which digits."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Final

LARGE: Final = 1e6
SMALL: Final = 1e-4
"""Assumed: numbers from LARGE on, and those at distances below SMALL, are told with exponents."""

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


def numbers_between(low: float, high: float, count: int) -> Sequence[str]:
    """Numbers at `count` equal distances from low to high, both included.

    They have as few digits as are exact; if four digits of the distance are not, all have the same decimals,
    three digits of it.

    >>> numbers_between(0, 250, 4), numbers_between(0, 1.2, 7)[:5]
    (['0', '62.5', '125', '187.5', '250'], ['0', '0.171', '0.343', '0.514', '0.686'])
    """
    distance = (high - low) / count
    values = [low + (high - low) * number / count for number in range(count)] + [high]
    # What is zero but for rounding is told as zero.
    values = [0.0 if abs(value) < distance * EXACT else value for value in values]
    largest = max(abs(low), abs(high))
    if largest >= LARGE or distance < SMALL:
        digits = min(7, max(4, 2 + math.ceil(math.log10(largest / distance))))
        return [f"{value:.{digits}g}" for value in values]
    most = max(0, 3 - math.floor(math.log10(distance)))
    for decimals in range(most + 1):
        if all(abs(round(value, decimals) - value) <= distance * EXACT for value in values):
            return [_without_zeros(f"{value:.{decimals}f}") for value in values]
    return ["0" if value == 0 else f"{value:.{max(0, most - 1)}f}" for value in values]


def _without_zeros(number: str) -> str:
    return number.rstrip("0").rstrip(".") if "." in number else number
