"""The one rounding rule: to the nearest whole number, halves up; `color_blending` does it as it mixes."""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from autocolor.arrays import Singles

HALF: Final = 0.5
"""What is added to a number before the next lower whole number is taken."""


def half_up(value: float) -> int:
    """The whole number nearest to a number, the upper one of two.

    >>> half_up(2.5), half_up(-2.5)
    (3, -2)
    """
    return math.floor(value + HALF)


def halves_up(values: Singles, out: Singles | None = None) -> Singles:
    """The whole numbers nearest to an array's numbers, halves up; `out` may be the array itself."""
    rounded = np.add(values, np.float32(HALF), out=out)
    return np.floor(rounded, out=rounded)
