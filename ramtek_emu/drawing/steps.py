"""Steps: the points of many lines or circles, numbered along each, some thousands at once."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

import numpy as np

from ramtek_emu.arrays import Indices, Numbers

MOST_POINTS: Final = 1 << 15
"""How many points are computed at once, or those of one row if they are more: a bound on memory."""


def steps(counts: Numbers) -> Iterator[tuple[Indices, Numbers]]:
    """The rows with so many points each, in order: for each point its row, and its number in that row from 0.

    >>> [(rows.tolist(), numbers.tolist()) for rows, numbers in steps(np.array([2, 0, 3]))]
    [([0, 0, 2, 2, 2], [0, 1, 0, 1, 2])]
    """
    done = np.cumsum(counts)
    rows = np.arange(len(counts))
    row = before = 0
    while row < len(counts):
        until = max(row + 1, int(np.searchsorted(done, before + MOST_POINTS, side="right")))
        which = np.repeat(rows[row:until], counts[row:until])
        yield which, np.arange(before, before + len(which)) - (done - counts)[which]
        row, before = until, int(done[until - 1])
