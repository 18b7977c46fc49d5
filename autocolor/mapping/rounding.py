"""Rounding half up, the only rounding rule of the package; `color_blending` applies it as it blends."""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from autocolor.arrays import Singles

HALF: Final = 0.5
"""Added before taking the floor."""


def half_up(value: float) -> int:
    """The nearest integer; halves are rounded up.

    >>> half_up(2.5), half_up(-2.5)
    (3, -2)
    """
    return math.floor(value + HALF)


def halves_up(values: Singles, out: Singles | None = None) -> Singles:
    """The nearest integers of an array, as float32; halves are rounded up. `out` may be `values`."""
    rounded = np.add(values, np.float32(HALF), out=out)
    return np.floor(rounded, out=rounded)
