"""Things that are joined in pairs, and so in groups: directly, or one through the other.

The groups grow in an array that leads from each thing to a lower one of its group, and from the lowest to
itself. At first every thing is alone, as in `np.arange`.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from autocolor.arrays import Numbers, chunks

AT_ONCE: Final = 1 << 15


def join(leads: Numbers, one: Numbers, other: Numbers) -> None:
    """Join each of some things to another; `leads` is changed in place."""
    while len(one):
        # Leave out the pairs whose groups are joined by now.
        one, other = _lowest(leads, np.concatenate([one, other])).reshape(2, -1)
        apart = np.flatnonzero(one != other)
        one, other = np.take(one, apart), np.take(other, apart)
        # Lead from the lowest of one group to that of the other. Where several pairs lead from the same
        # thing the lowest goal is taken, and the others try again.
        np.minimum.at(leads, np.maximum(one, other), np.minimum(one, other))


def group_numbers(leads: Numbers) -> Numbers:
    """The number of each thing's group, counted from 0 in the order of their lowest."""
    numbers = np.cumsum(leads == np.arange(len(leads)))
    numbers -= 1
    groups = np.empty_like(leads)
    for part in chunks(len(leads), AT_ONCE):
        some = np.arange(part.start, part.stop)
        groups[some] = numbers[_lowest(leads, some)]
    return groups


def _lowest(leads: Numbers, things: Numbers) -> Numbers:
    """The lowest of the groups of some things; from now on `leads` takes them there directly."""
    lower = np.take(leads, things)
    while True:
        lowest = np.take(leads, lower)
        if (lowest == lower).all():
            return lowest
        leads[things] = lower = lowest
