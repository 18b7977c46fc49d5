"""Cosines to a power: the shape of a highlight, and of a concentrated light."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

Singles = npt.NDArray[np.float32]

LARGEST = float(np.finfo(np.float32).max)


def power_of(cosines: Singles, exponent: float) -> Singles:
    """The cosines to a power, in [0, 1]; a negative cosine counts as 0, and anything to the power 0 is 1.

    Measured: the exponential of a logarithm takes half the time of a power, and a fifth of the time that it
    takes to find the cosines which are not negligible and to raise those alone.
    """
    if exponent == 0:
        return np.ones_like(cosines)
    # Rounding may leave a cosine above 1, which a large exponent would make a light of its own.
    powers: Singles = np.minimum(cosines, np.float32(1))
    np.maximum(powers, np.float32(0), out=powers)
    if exponent == 1:
        return powers
    with np.errstate(divide="ignore", over="ignore", under="ignore"):
        np.log(powers, out=powers)
        powers *= np.float32(min(exponent, LARGEST))
        return np.exp(powers, out=powers)
