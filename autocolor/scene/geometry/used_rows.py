"""Which rows of a table another table uses."""

from __future__ import annotations

from typing import Final

import numpy as np

from autocolor.arrays import Booleans, Indices, chunks

AT_ONCE: Final = 1 << 16


def used_rows(numbers: Indices, count: int) -> Booleans:
    """Which of `count` rows appear in the numbers, (k, n), which are never copied whole.

    >>> used_rows(np.array([[0, 3], [1, 3]]), 5).tolist()
    [True, True, False, True, False]
    """
    used = np.zeros(count, np.bool_)
    for chunk in chunks(numbers.shape[1], AT_ONCE):
        used[numbers[:, chunk]] = True
    return used
