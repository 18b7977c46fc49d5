"""Which rows of a table another table uses, and how far they reach; no table is copied."""

from __future__ import annotations

from typing import Final

import numpy as np

from autocolor.arrays import Booleans, Floats, Indices, chunks

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


def used_bounds(rows: Floats, numbers: Indices) -> tuple[Floats, Floats]:
    """The least and the largest of each of some rows, (k, count), where numbers use it; infinite if none do.

    >>> low, high = used_bounds(np.array([[5.0, 2.0, 3.0]]), np.array([[0, 2]]))
    >>> low.tolist(), high.tolist()
    ([3.0], [5.0])
    """
    used = used_rows(numbers, rows.shape[1])
    low: Floats = rows.min(axis=1, where=used, initial=np.inf)
    high: Floats = rows.max(axis=1, where=used, initial=-np.inf)
    return low, high
