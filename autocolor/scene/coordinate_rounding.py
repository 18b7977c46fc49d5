"""How much the coordinates of a mesh were rounded, told from the coordinates themselves."""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np

from autocolor.arrays import Floats

EXACT: Final = 2.0**-46
"""Assumed: what placing a mesh in 64-bit numbers may round, as a fraction of the largest coordinate."""

HALF_SINGLE: Final = 2.0**-24
"""Half a unit in the last place of a 32-bit number, as a fraction of the number, at most."""

MOST_DECIMALS: Final = 9

FIRST_TESTED: Final = 64


class Rounding(NamedTuple):
    """The most by which a coordinate may be rounded, and the same as a fraction of each coordinate.

    Coordinates rounded to decimals are rounded by less than the first even where they are small; two that
    were equal before are equal afterwards, so that the second is that of 64-bit numbers.
    """

    most: float
    fraction: float


def coordinate_rounding(coordinates: Floats) -> Rounding:
    """How much coordinates were rounded: to 32-bit numbers, to up to nine decimals, or not at all.

    >>> coordinate_rounding(np.array([0.123, 4.567])).most
    0.0005
    """
    largest = float(np.abs(coordinates).max(initial=0.0))
    exact = EXACT * largest
    with np.errstate(over="ignore", under="ignore"):
        singles = coordinates.astype(np.float32)
    if np.array_equal(singles, coordinates):
        return Rounding(HALF_SINGLE * largest, HALF_SINGLE)
    for decimals in range(MOST_DECIMALS + 1):
        if _have_decimals(coordinates, decimals, largest):
            return Rounding(max(10.0**-decimals / 2, exact), EXACT)
    return Rounding(exact, EXACT)


def _have_decimals(coordinates: Floats, decimals: int, largest: float) -> bool:
    """Whether all coordinates have so many decimals, but for the rounding of 64-bit numbers."""
    within = 2 * float(np.spacing(largest))
    # Of random numbers one in sixteen, at most, seems to have them.
    if not 64 * within < 10.0**-decimals < np.inf:
        return False
    few = coordinates.ravel()[:FIRST_TESTED]
    return all(bool((np.abs(part.round(decimals) - part) <= within).all()) for part in (few, coordinates))
