"""Areas: windows that are filled, and the connected pixels around one pixel, for FILL.

Lines are split into runs of open pixels, and runs of neighboring lines that touch are linked. The area is all
runs that the links connect to the first run. So the size of the memory bounds the work, for any picture.

The work is cut into bands of lines and parts of the runs, with a pause after each.
"""

from __future__ import annotations

from collections.abc import Generator, Iterator
from typing import Final

import numpy as np

from ramtek_emu.arrays import Dots, Indices
from ramtek_emu.memory.frame_buffer import FrameBuffer, WriteEnable
from ramtek_emu.memory.scan_orders import Point, Window

MOST_AT_ONCE: Final = 1 << 17
"""The number of pixels, or of runs, that an instruction draws or compares between two pauses.

Limit: a bound on the time between two pauses, 1 to 10 ms.
"""


def bands(window: Window) -> Iterator[Window]:
    """Cut a window into bands of whole lines with at most MOST_AT_ONCE pixels, or of one line."""
    lines = max(1, MOST_AT_ONCE // max(1, window.width))
    for top in range(window.top, window.bottom + 1, lines):
        yield window._replace(top=top, bottom=min(top + lines - 1, window.bottom))


def fill_window(
    frame_buffer: FrameBuffer, window: Window, word: int, enable: WriteEnable
) -> Iterator[None] | None:
    """Fill a window with a word; returns the pauses if it is large, None if it is filled."""
    # Filling is quick, and a picture of 640 x 480 is erased often.
    if window.width * window.height <= 4 * MOST_AT_ONCE:
        frame_buffer.fill(window, word, enable)
        return None
    return _fill_in_bands(frame_buffer, window.intersection(frame_buffer.window), word, enable)


def _fill_in_bands(
    frame_buffer: FrameBuffer, window: Window, word: int, enable: WriteEnable
) -> Iterator[None]:
    for band in bands(window):
        frame_buffer.fill(band, word, enable)
        yield


def fill_area(
    frame_buffer: FrameBuffer,
    window: Window,
    open_pixels: Dots,
    start: Point,
    word: int,
    enable: WriteEnable,
) -> Iterator[None]:
    """Fill the open pixels that are connected, up, down, left and right, to `start`, and pause at times.

    The window is within the memory and holds `start`; `open_pixels` are its (lines, elements).
    """
    line, element = start.line - window.top, start.element - window.left
    if not open_pixels[line, element]:
        return
    width = window.width + 2
    cut = [slice(band.top - window.top, band.bottom + 1 - window.top) for band in bands(window)]
    found: list[tuple[Indices, Indices]] = []
    pairs: list[tuple[Indices, Indices]] = []
    count = seed = 0
    above = np.zeros(0, np.intp), np.zeros(0, np.intp)
    for band in cut:
        # Add a closed column on either side, so that every run begins and ends within its line.
        fenced = np.zeros((band.stop - band.start, width), np.int8)
        fenced[:, 1:-1] = open_pixels[band]
        edges = np.diff(fenced.reshape(-1))
        starts, ends = (np.flatnonzero(edges == edge) + 1 + band.start * width for edge in (1, -1))
        if band.start <= line < band.stop:
            seed = count + int(np.searchsorted(starts, line * width + element + 1, side="right")) - 1
        # Link the runs, those of the last line above the band too.
        begin = count - len(above[0])
        upper, lower = links(np.concatenate((above[0], starts)), np.concatenate((above[1], ends)), width)
        pairs.append((upper + begin, lower + begin))
        found.append((starts, ends))
        count += len(starts)
        last = np.searchsorted(starts, (band.stop - 1) * width)
        above = starts[last:], ends[last:]
        yield
    labels = yield from connected(pairs, count)
    count = 0
    for lines, band, (starts, ends) in zip(bands(window), cut, found, strict=True):
        chosen = labels[count : count + len(starts)] == labels[seed]
        count += len(starts)
        # Measured: for large areas of few runs, repeating takes a twentieth of the time of a sum along lines.
        runs = np.count_nonzero(chosen)
        cuts = np.zeros(2 * runs + 2, np.intp)
        cuts[1:-1:2], cuts[2::2] = starts[chosen] - band.start * width, ends[chosen] - band.start * width
        cuts[-1] = (band.stop - band.start) * width
        is_filled = np.zeros(2 * runs + 1, np.bool_)
        is_filled[1::2] = True
        filled = np.repeat(is_filled, np.diff(cuts)).reshape(-1, width)[:, 1:-1]
        frame_buffer.fill(lines, word, enable, filled)
        yield


def links(starts: Indices, ends: Indices, width: int) -> tuple[Indices, Indices]:
    """The pairs of runs that touch: the indices of the upper runs and of the lower runs."""
    first = np.searchsorted(ends, starts + width, side="right")
    last = np.searchsorted(starts, ends + width, side="left")
    counts = np.maximum(last - first, 0)
    upper = np.repeat(np.arange(len(starts)), counts)
    lower = np.arange(len(upper)) - np.repeat(np.cumsum(counts) - counts - first, counts)
    return upper, lower


def connected(pairs: list[tuple[Indices, Indices]], count: int) -> Generator[None, None, Indices]:
    """Label `count` runs, by union-find: runs that the pairs (upper, lower) connect get equal labels.

    The generator yields None at each pause, and returns the labels.
    """
    labels = np.empty(count, np.intp)
    for first in range(0, count, MOST_AT_ONCE):
        labels[first : first + MOST_AT_ONCE] = np.arange(first, min(first + MOST_AT_ONCE, count))
        yield
    while pairs:
        # Link the larger label to the smaller one, then shorten every path to its root.
        for upper, lower in pairs:
            above, below = labels[upper], labels[lower]
            np.minimum.at(labels, np.maximum(above, below), np.minimum(above, below))
            yield
        is_short = False
        while not is_short:
            is_short = True
            for first in range(0, count, MOST_AT_ONCE):
                part = labels[first : first + MOST_AT_ONCE]
                shorter = labels[part]
                is_short = is_short and bool((shorter == part).all())
                part[...] = shorter
                yield
        apart = []
        for upper, lower in pairs:
            different = labels[upper] != labels[lower]
            if different.any():
                apart.append((upper[different], lower[different]))
            yield
        pairs = apart
    return labels
