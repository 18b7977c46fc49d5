"""Areas: windows that are filled, and the connected pixels around one pixel, for FILL.

Lines are split into runs of open pixels, and runs of neighboring lines that touch are linked. The area is all
runs that the links connect to the first run. So the size of the memory bounds the work, for any picture.

The work is cut into bands of lines and parts of the runs, with a pause after each.
"""

from __future__ import annotations

from collections.abc import Generator, Iterator
from functools import partial
from typing import Final

import numpy as np

from ramtek_emu.arrays import Dots, Indices
from ramtek_emu.memory.frame_buffer import FrameBuffer, WriteEnable
from ramtek_emu.memory.scan_orders import Point, Window

PIXELS_AT_ONCE: Final = 640 * 512
"""The number of pixels that are compared or written between two pauses.

Limit: a bound on the time between two pauses, 1 to 5 ms. A picture of 640 x 512 is filled at once.
"""
RUNS_AT_ONCE: Final = 1 << 15
"""The number of runs that are linked between two pauses. Limit: a bound on that time, 1 to 10 ms."""


def bands(window: Window) -> Iterator[Window]:
    """Cut a window into bands of whole lines with at most PIXELS_AT_ONCE pixels, or of one line."""
    lines = max(1, PIXELS_AT_ONCE // max(1, window.width))
    for top in range(window.top, window.bottom + 1, lines):
        yield window._replace(top=top, bottom=min(top + lines - 1, window.bottom))


def fill_window(
    frame_buffer: FrameBuffer, window: Window, word: int, enable: WriteEnable
) -> Iterator[None] | None:
    """Fill a window with a word; returns the pauses if it is large, None if it is filled."""
    if window.width * window.height <= PIXELS_AT_ONCE:
        frame_buffer.fill(window, word, enable)
        return None
    fill_band = partial(frame_buffer.fill, word=word, enable=enable)
    return map(fill_band, bands(window.intersection(frame_buffer.window)))


def fill_area(
    frame_buffer: FrameBuffer,
    window: Window,
    fenced: Dots,
    start: Point,
    word: int,
    enable: WriteEnable,
) -> Iterator[None]:
    """Fill the open pixels that are connected, up, down, left and right, to `start`, and pause at times.

    The window is within the memory and holds `start`; `fenced` are its open pixels, with a closed column on
    either side, so that every run begins and ends within its line.
    """
    line, element = start.line - window.top, start.element - window.left + 1
    if not fenced[line, element]:
        return
    width = fenced.shape[1]
    cut = [slice(band.top - window.top, band.bottom + 1 - window.top) for band in bands(window)]
    found: list[Indices] = []
    pairs: list[tuple[Indices, Indices]] = []
    count = seed = 0
    above = np.zeros(0, np.intp)
    for band in cut:
        # The edges are the first pixel of each run and the pixel after its last, in turns.
        pixels = fenced[band].reshape(-1)
        edges = np.flatnonzero(pixels[1:] != pixels[:-1]) + (1 + band.start * width)
        if band.start <= line < band.stop:
            seed = count + int(np.searchsorted(edges[::2], line * width + element, side="right")) - 1
        # Link the runs, those of the last line above the band too.
        begin = count - len(above) // 2
        both = np.concatenate((above, edges)).reshape(-1, 2)
        for first in range(0, len(both), RUNS_AT_ONCE):
            upper, lower = links(both, width, slice(first, first + RUNS_AT_ONCE))
            pairs.append((upper + begin, lower + begin))
            yield
        found.append(edges)
        count += len(edges) // 2
        above = edges[np.searchsorted(edges, (band.stop - 1) * width) :]
    labels = yield from connected(pairs, count)
    count = 0
    for lines, band, edges in zip(bands(window), cut, found, strict=True):
        runs = edges.reshape(-1, 2)
        chosen = labels[count : count + len(runs)] == labels[seed]
        count += len(runs)
        # Measured: for large areas of few runs, repeating takes a twentieth of the time of a sum along lines,
        # and `runs[chosen]` ten times as long as `compress`.
        inside = runs.compress(chosen, axis=0).reshape(-1)
        sizes = np.diff(inside, prepend=band.start * width, append=band.stop * width)
        is_filled = np.zeros(len(sizes), np.bool_)
        is_filled[1::2] = True
        filled = np.repeat(is_filled, sizes).reshape(-1, width)[:, 1:-1]
        frame_buffer.fill(lines, word, enable, filled)
        yield


def links(runs: Indices, width: int, part: slice) -> tuple[Indices, Indices]:
    """The pairs of runs that touch: the indices of the upper runs, out of a part, and of the lower runs.

    `runs` are the first pixel and the pixel after the last, (runs, 2).
    """
    starts, ends = runs.T.copy()
    first = np.searchsorted(ends, starts[part] + width, side="right")
    last = np.searchsorted(starts, ends[part] + width, side="left")
    counts = np.maximum(last - first, 0)
    upper = np.repeat(np.arange(*part.indices(len(runs))), counts)
    lower = np.arange(len(upper)) - np.repeat(np.cumsum(counts) - counts - first, counts)
    return upper, lower


def connected(pairs: list[tuple[Indices, Indices]], count: int) -> Generator[None, None, Indices]:
    """Label `count` runs, by union-find: runs that the pairs (upper, lower) connect get equal labels.

    The generator yields None at each pause, and returns the labels.
    """
    labels = np.arange(count)
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
            for first in range(0, count, RUNS_AT_ONCE):
                part = labels[first : first + RUNS_AT_ONCE]
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
