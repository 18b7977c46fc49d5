"""Areas: the connected pixels around one pixel, for FILL.

Lines are split into runs of open pixels, and runs of neighboring lines that touch are linked. The area is all
runs that the links connect to the first run. So the size of the memory bounds the work, for any picture.
"""

from __future__ import annotations

import numpy as np

from ramtek_emu.arrays import Dots, Indices


def area(open_pixels: Dots, line: int, element: int) -> Dots:
    """The open pixels that are connected, up, down, left and right, to the pixel at (line, element).

    >>> area(np.array([[True, False, True], [True, True, False]]), 0, 0).astype(int).tolist()
    [[1, 0, 0], [1, 1, 0]]
    """
    lines, elements = open_pixels.shape
    if not open_pixels[line, element]:
        return np.zeros_like(open_pixels)
    # Add a closed column on either side, so that every run begins and ends within its line.
    fenced = np.zeros((lines, elements + 2), np.int8)
    fenced[:, 1:-1] = open_pixels
    edges = np.diff(fenced.reshape(-1))
    starts, ends = np.flatnonzero(edges == 1) + 1, np.flatnonzero(edges == -1) + 1
    width = elements + 2
    labels = connected(*links(starts, ends, width), len(starts))
    first_run = int(np.searchsorted(starts, line * width + element + 1, side="right")) - 1
    chosen = labels == labels[first_run]
    marks = np.zeros(lines * width + 1, np.int8)
    marks[starts[chosen]] = 1
    marks[ends[chosen]] = -1
    filled = np.cumsum(marks[:-1], dtype=np.int8).reshape(lines, width)
    return filled[:, 1:-1].astype(np.bool_)


def links(starts: Indices, ends: Indices, width: int) -> tuple[Indices, Indices]:
    """The pairs of runs that touch: the indices of the upper runs and of the lower runs."""
    first = np.searchsorted(ends, starts + width, side="right")
    last = np.searchsorted(starts, ends + width, side="left")
    counts = np.maximum(last - first, 0)
    upper = np.repeat(np.arange(len(starts)), counts)
    lower = np.arange(len(upper)) - np.repeat(np.cumsum(counts) - counts - first, counts)
    return upper, lower


def connected(upper: Indices, lower: Indices, count: int) -> Indices:
    """Labels of `count` runs, by union-find: runs that the pairs (upper, lower) connect get equal labels."""
    labels = np.arange(count)
    while True:
        # Link the larger root to the smaller one, then shorten every path to its root.
        least = np.minimum(labels[upper], labels[lower])
        before = labels.copy()
        np.minimum.at(labels, before[upper], least)
        np.minimum.at(labels, before[lower], least)
        while True:
            shorter = labels[labels]
            if (shorter == labels).all():
                break
            labels = shorter
        apart = labels[upper] != labels[lower]
        if not apart.any():
            return labels
        upper, lower = upper[apart], lower[apart]
