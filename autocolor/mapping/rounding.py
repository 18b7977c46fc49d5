"""The one rounding rule: to the nearest whole number, halves up; `color_blending` does it as it mixes."""

from __future__ import annotations

import math
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

HALF: Final = 0.5
"""What is added to a number before the next lower whole number is taken."""


def half_up(value: float) -> int:
    """The whole number nearest to a number, the upper one of two.

    >>> half_up(2.5), half_up(-2.5)
    (3, -2)
    """
    return math.floor(value + HALF)


def halves_up(values: NDArray[Any]) -> NDArray[Any]:
    """The whole numbers nearest to an array's numbers, in the array itself."""
    values += values.dtype.type(HALF)
    np.floor(values, out=values)
    return values
