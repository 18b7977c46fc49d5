"""Areas: the connected pixels around one pixel, for FILL.

Lines are split into runs of open pixels, and runs of neighboring lines that touch are linked. The area is all
runs that the links connect to the first run. So the size of the memory bounds the work, for any picture.

A comb whose teeth are one pixel wide has the most runs: a quarter of a second on a display of 1280 x 1024.
So the functions are generators that pause after MOST_PIXELS pixels or MOST_RUNS runs.
"""

from __future__ import annotations

from collections.abc import Generator, Iterable, Iterator
from itertools import pairwise
from typing import Final

import numpy as np

from ramtek_emu.arrays import Dots, Indices

MOST_PIXELS: Final = 1 << 19
MOST_RUNS: Final = 1 << 16
"""Limits: the pixels, and the runs, between two pauses of a few milliseconds."""

Links = tuple[Indices, Indices]
"""Pairs of runs that touch: the indices of the upper runs, and of the lower runs."""
Strip = tuple[slice, Dots]
"""Some lines, and the (lines, elements) dots of an area on them."""


def area(open_pixels: Dots, line: int, element: int) -> Generator[None, None, Iterator[Strip]]:
    """Find the open pixels that are connected, up, down, left and right, to the pixel at (line, element).

    The generator yields None at each pause, and returns an iterator of strips from the top to the bottom.
    """
    if not open_pixels[line, element]:
        return iter(())
    lines, elements = open_pixels.shape
    at_once = max(1, MOST_PIXELS // elements)
    width = elements + 2
    strips = []
    for first in range(0, lines, at_once):
        strips.append(runs_of(open_pixels[first : first + at_once], first * width))
        yield
    count = sum(len(starts) for starts, _ in strips)
    starts = yield from joined((starts for starts, _ in strips), count)
    ends = yield from joined((ends for _, ends in strips), count)
    pairs = []
    for part in parts(count):
        pairs.append(links(starts, ends, width, part))
        yield
    labels = yield from connected(pairs, count)
    own = labels[np.searchsorted(starts, line * width + element + 1, side="right") - 1]
    return strips_of(starts, ends, labels == own, (lines, elements), at_once)


def runs_of(open_pixels: Dots, place: int) -> tuple[Indices, Indices]:
    """The starts and ends of the runs of some lines; the first line begins at `place`.

    A closed column is added on either side, so that every run begins and ends within its line.
    """
    fenced = np.zeros((len(open_pixels), open_pixels.shape[1] + 2), np.int8)
    fenced[:, 1:-1] = open_pixels
    edges = np.diff(fenced.reshape(-1))
    return np.flatnonzero(edges == 1) + place + 1, np.flatnonzero(edges == -1) + place + 1


def strips_of(
    starts: Indices, ends: Indices, chosen: Dots, shape: tuple[int, int], at_once: int
) -> Iterator[Strip]:
    """The pixels of the chosen runs of (lines, elements) pixels, `at_once` lines at a time."""
    lines, elements = shape
    width = elements + 2
    tops = np.append(np.arange(0, lines, at_once), lines)
    for (top, bottom), (first, last) in zip(
        pairwise(tops.tolist()), pairwise(np.searchsorted(starts, tops * width).tolist()), strict=True
    ):
        # Measured: for large areas of few runs, repeating takes a twentieth of a sum along the lines.
        runs = np.flatnonzero(chosen[first:last]) + first
        cuts = np.zeros(2 * len(runs) + 2, np.intp)
        cuts[1:-1:2], cuts[2:-1:2], cuts[-1] = starts[runs], ends[runs], bottom * width
        cuts[0] = top * width
        is_filled = np.zeros(2 * len(runs) + 1, np.bool_)
        is_filled[1::2] = True
        filled = np.repeat(is_filled, np.diff(cuts)).reshape(bottom - top, width)
        yield slice(top, bottom), filled[:, 1:-1]


def parts(count: int) -> Iterator[slice]:
    """Slices of at most MOST_RUNS that cover `count` runs or links."""
    return (slice(begin, min(begin + MOST_RUNS, count)) for begin in range(0, count, MOST_RUNS))


def joined(pieces: Iterable[Indices], count: int) -> Generator[None, None, Indices]:
    """Pieces with `count` items as a single array. It pauses, since the first use of memory takes long."""
    whole = np.empty(count, np.intp)
    place = 0
    for piece in pieces:
        whole[place : place + len(piece)] = piece
        place += len(piece)
        yield
    return whole


def links(starts: Indices, ends: Indices, width: int, part: slice) -> Links:
    """The links of the runs of a part to runs of the next line."""
    first = np.searchsorted(ends, starts[part] + width, side="right")
    last = np.searchsorted(starts, ends[part] + width, side="left")
    counts = np.maximum(last - first, 0)
    upper = np.repeat(np.arange(part.start, part.stop), counts)
    lower = np.arange(len(upper)) - np.repeat(np.cumsum(counts) - counts - first, counts)
    return upper, lower


def connected(pairs: list[Links], count: int) -> Generator[None, None, Indices]:
    """Label `count` runs, by union-find: runs that links connect get equal labels.

    The generator yields None at each pause, and returns the labels.
    """
    labels = yield from joined((np.arange(part.start, part.stop) for part in parts(count)), count)
    while True:
        # Link the larger root to the smaller one.
        before = yield from joined((labels[part] for part in parts(count)), count)
        for upper, lower in pairs:
            upper, lower = before[upper], before[lower]
            least = np.minimum(upper, lower)
            np.minimum.at(labels, upper, least)
            np.minimum.at(labels, lower, least)
            yield
        # Shorten every path to its root.
        is_short = False
        while not is_short:
            is_short = True
            for part in parts(count):
                shorter = labels[labels[part]]
                is_short &= np.array_equal(shorter, labels[part])
                labels[part] = shorter
                yield
        apart = []
        for upper, lower in pairs:
            differ = labels[upper] != labels[lower]
            if differ.any():
                apart.append((upper[differ], lower[differ]))
            yield
        if not apart:
            return labels
        pairs = apart
