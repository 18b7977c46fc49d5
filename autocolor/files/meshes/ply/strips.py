"""Triangle strips of a PLY file, as the scanned models of the nineties have them."""

from __future__ import annotations

import numpy as np

from autocolor.arrays import Indices


def triangles_of_strips(numbers: Indices, counts: Indices) -> tuple[Indices, Indices]:
    """The corners and the corner counts of the triangles of strips.

    `numbers` are the corners of all strips, with -1 where a strip ends; `counts` are the lengths of the lists
    that they stood in, at whose ends strips end, too. Every corner from the third of a strip on makes a
    triangle with the two before it; every second one is turned, so that all wind alike. Triangles with equal
    corners are left out: they only lead on to the next.

    >>> triangles_of_strips(np.array([0, 1, 2, 3, -1, 4, 5, 6]), np.array([8]))[0].reshape(-1, 3).tolist()
    [[0, 1, 2], [2, 1, 3], [4, 5, 6]]
    """
    breaks = numbers < 0
    begins = np.zeros(len(numbers) + 1, np.bool_)
    begins[np.cumsum(counts) - counts] = True
    begins[1:] |= breaks
    begins = begins[:-1]
    # The place of each corner in its strip.
    places = np.arange(len(numbers))
    places -= np.maximum.accumulate(np.where(begins, places, 0))
    thirds = np.flatnonzero((places >= 2) & ~breaks)
    before, between, last = (numbers[thirds - back] for back in (2, 1, 0))
    turned = places[thirds] % 2 == 1
    triangles = np.stack([np.where(turned, between, before), np.where(turned, before, between), last], axis=1)
    differ = (before != between) & (between != last) & (last != before)
    kept = triangles[differ]
    return kept.ravel(), np.full(len(kept), 3, np.intp)
