"""Cosines to a power: the shape of a highlight, and of a concentrated light."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

Singles = npt.NDArray[np.float32]

MOST_MULTIPLIED = 64
"""The largest exponent whose few products are exact to 1e-5."""

LARGEST = float(np.finfo(np.float32).max)


def power_of(cosines: Singles, exponent: float) -> Singles:
    """The cosines to a power, in [0, 1]; a negative cosine counts as 0, and anything to the power 0 is 1.

    It works in the array of the cosines, whose numbers are lost.

    Measured: the exponential of a logarithm takes half the time of a power, and a fifth of the time that it
    takes to find the cosines which are not negligible and to raise those alone; a few products take half of
    that again, and in place two thirds of it; a clip takes a quarter of the time of a minimum and a maximum.
    """
    single = np.float32(min(exponent, LARGEST))
    if single == 0:
        cosines[:] = 1
        return cosines
    # Rounding may leave a cosine above 1, which a large exponent would make a light of its own.
    np.clip(cosines, np.float32(0), np.float32(1), out=cosines)
    if exponent <= MOST_MULTIPLIED and exponent == int(exponent):
        return _multiplied(cosines, int(exponent))
    with np.errstate(divide="ignore", over="ignore", under="ignore"):
        np.log(cosines, out=cosines)
        cosines *= single
        return np.exp(cosines, out=cosines)


def _multiplied(squares: Singles, exponent: int) -> Singles:
    """The numbers to a whole power from 1 on: the product of those of their squares that make it up."""
    powers: Singles | None = None
    with np.errstate(under="ignore"):
        while exponent > 1:
            if exponent & 1:
                powers = squares.copy() if powers is None else np.multiply(powers, squares, out=powers)
            np.multiply(squares, squares, out=squares)
            exponent >>= 1
    return squares if powers is None else np.multiply(squares, powers, out=squares)
