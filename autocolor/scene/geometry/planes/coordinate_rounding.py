"""How much the coordinates of a mesh were rounded, told from the coordinates themselves."""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np

from autocolor.arrays import Floats

EXACT: Final = 2.0**-46
"""Assumed: what placing a mesh in 64-bit numbers may round, as a fraction of the largest coordinate."""

HALF_SINGLE: Final = 2.0**-24
"""Half a unit in the last place of a 32-bit number, as a fraction of the number, at most."""

LAST_BITS: Final = np.uint32(15)
"""Of a 32-bit number; where they are not all 0 it has at least 20 bits."""

MOST_DECIMALS: Final = 9

FIRST_TESTED: Final = 64


class Rounding(NamedTuple):
    """The most by which a coordinate may be rounded, and the same as a fraction of each coordinate.

    Decimals that were equal before they were rounded are equal afterwards; the second is then that of 64-bit
    numbers. Both are where nothing is `known`, as of coordinates that were turned after they were rounded.
    """

    most: float
    fraction: float
    known: bool = True


def coordinate_rounding(coordinate_rows: Floats) -> Rounding:
    """How coordinates, (3, n), were rounded: some to 32-bit numbers, all to at most nine decimals, or none.

    A mesh that was moved after its coordinates were rounded to decimals still shows it.

    >>> coordinate_rounding(np.array([[0.123, 4.567], [0.1, 2.0], [0.0, 0.0]])).most
    0.0005
    """
    largest = float(np.abs(coordinate_rows).max(initial=0.0))
    exact = EXACT * largest
    with np.errstate(over="ignore", under="ignore"):
        singles = coordinate_rows.astype(np.float32)
    same = singles == coordinate_rows
    # Some may have been rounded and others not. A number of few bits says nothing.
    if same.all() or (same & ((singles.view(np.uint32) & LAST_BITS) > 0)).any():
        return Rounding(HALF_SINGLE * largest, HALF_SINGLE)
    moved = coordinate_rows - coordinate_rows[:, :1]
    for decimals in range(MOST_DECIMALS + 1):
        if _have_decimals(moved, decimals, largest):
            return Rounding(max(10.0**-decimals / 2, exact), EXACT)
    return Rounding(exact, EXACT, known=False)


def _have_decimals(coordinates: Floats, decimals: int, largest: float) -> bool:
    """Whether all coordinates have so many decimals, but for the rounding of 64-bit numbers."""
    within = 4 * float(np.spacing(largest))
    # Of random numbers one in sixteen, at most, seems to have them.
    if not 64 * within < 10.0**-decimals < np.inf:
        return False
    few = coordinates.ravel()[:FIRST_TESTED]
    return all(bool((np.abs(part.round(decimals) - part) <= within).all()) for part in (few, coordinates))
