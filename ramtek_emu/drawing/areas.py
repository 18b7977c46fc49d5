"""Areas: the connected pixels around one pixel, for FILL.

Lines are split into runs of open pixels, and runs of neighboring lines that touch are linked. The area is all
runs that the links connect to the first run. So the size of the memory bounds the work, for any picture.

A comb whose teeth are one pixel wide has the most runs: it takes 20 ms on a display of 640 x 480, and 80 ms
on a display of 1280 x 1024. So the functions are generators that pause between slices of the work, at least
every 5 ms and every 15 ms there. On 4096 x 4096, the largest display, a slice can take half a second.
"""

from __future__ import annotations

from collections.abc import Generator, Iterator
from typing import Final

import numpy as np

from ramtek_emu.arrays import Dots, Indices
from ramtek_emu.memory.scan_orders import Window

MOST_AT_ONCE: Final = 1 << 18
"""The number of pixels that are filled at once. Limit: a bound on the time between two pauses, 1 to 4 ms."""
MOST_RUNS: Final = 1 << 15
"""The number of runs that are linked at once. Limit: a bound on the time between two pauses, 1 to 2 ms."""


def bands(window: Window) -> Iterator[Window]:
    """Cut a window into bands of whole lines, of some hundred thousand pixels each."""
    lines = max(1, MOST_AT_ONCE // max(1, window.width))
    for top in range(window.top, window.bottom + 1, lines):
        yield window._replace(top=top, bottom=min(top + lines - 1, window.bottom))


def area(open_pixels: Dots, line: int, element: int) -> Generator[None, None, Dots]:
    """Find the open pixels that are connected, up, down, left and right, to the pixel at (line, element).

    The generator yields None at each pause, and returns the pixels as dots in the shape of `open_pixels`.
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
    yield
    pairs = []
    for begin in range(0, len(starts), MOST_RUNS):
        pairs.append(links(starts, ends, width, slice(begin, begin + MOST_RUNS)))
        yield
    upper, lower = (np.concatenate(runs) for runs in zip(*pairs, strict=True))
    labels = yield from connected(upper, lower, len(starts))
    first_run = int(np.searchsorted(starts, line * width + element + 1, side="right")) - 1
    chosen = labels == labels[first_run]
    yield
    # Measured: for large areas of few runs, repeating takes a twentieth of the time of a sum along the lines.
    runs = np.count_nonzero(chosen)
    cuts = np.zeros(2 * runs + 2, np.intp)
    cuts[1:-1:2], cuts[2::2], cuts[-1] = starts[chosen], ends[chosen], lines * width
    is_filled = np.zeros(2 * runs + 1, np.bool_)
    is_filled[1::2] = True
    filled = np.repeat(is_filled, np.diff(cuts)).reshape(lines, width)
    return filled[:, 1:-1]


def links(starts: Indices, ends: Indices, width: int, part: slice = slice(None)) -> tuple[Indices, Indices]:
    """The pairs of runs that touch: the indices of the upper runs, out of a part, and of the lower runs."""
    first = np.searchsorted(ends, starts[part] + width, side="right")
    last = np.searchsorted(starts, ends[part] + width, side="left")
    counts = np.maximum(last - first, 0)
    upper = np.repeat(np.arange(*part.indices(len(starts))), counts)
    lower = np.arange(len(upper)) - np.repeat(np.cumsum(counts) - counts - first, counts)
    return upper, lower


def connected(upper: Indices, lower: Indices, count: int) -> Generator[None, None, Indices]:
    """Label `count` runs, by union-find: runs that the pairs (upper, lower) connect get equal labels.

    The generator yields None at each pause, and returns the labels.
    """
    labels = np.arange(count)
    while True:
        # Link the larger root to the smaller one, then shorten every path to its root.
        least = np.minimum(labels[upper], labels[lower])
        before = labels.copy()
        np.minimum.at(labels, before[upper], least)
        np.minimum.at(labels, before[lower], least)
        while True:
            yield
            shorter = labels[labels]
            if (shorter == labels).all():
                break
            labels = shorter
        apart = labels[upper] != labels[lower]
        if not apart.any():
            return labels
        upper, lower = upper[apart], lower[apart]
