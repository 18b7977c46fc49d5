"""Plots: bars between a base line and the values of data, for WPB.

All bars of a plot have the base line in common, so at each place along the scan they cover a single run of
pixels, from their least to their most. So the size of the memory bounds the work, for any data.
"""

from __future__ import annotations

from collections.abc import Generator

import numpy as np

from ramtek_emu.arrays import Numbers
from ramtek_emu.memory.frame_buffer import FrameBuffer
from ramtek_emu.memory.parameters import Parameters, signed
from ramtek_emu.memory.scan_orders import Point, Window


def write_bars(
    frame_buffer: FrameBuffer, parameters: Parameters, values: Numbers, word: int
) -> Generator[None, None, Point]:
    """Draw a bar for each value, (n,), with a word; returns the point where the next bar would begin.

    A bar covers as many places along the scan as the dimension says: elements, or lines if the scan is
    vertical. Across the scan it goes from the base line to its value, both included. A pixel of several bars
    is written once, and counts once. The generator yields None after 64 places.
    """
    order, width = parameters.order, max(1, parameters.dimensions[0])
    backward = order.upward if order.vertical else order.leftward
    step = -parameters.spacing[0] if backward else parameters.spacing[0]
    first = parameters.start.line if order.vertical else parameters.start.element
    places = (first + step * np.arange(len(values) + 1)).astype(np.int16).astype(np.int64)
    inside = frame_buffer.window.intersection(parameters.write_window)
    low, high = (inside.top, inside.bottom) if order.vertical else (inside.left, inside.right)
    # Find the least and the most of the bars that begin at each place, or so far before that they reach it.
    before = width - 1
    size = max(0, high - low + 1 + before)
    rows = places[:-1] - low + (0 if backward else before)
    seen = (rows >= 0) & (rows < size)
    least, most = np.full(size, 0x8000), np.full(size, -0x8001)
    base = signed(parameters.base_line)
    np.minimum.at(least, rows[seen], np.minimum(values[seen], base))
    np.maximum.at(most, rows[seen], np.maximum(values[seen], base))
    # Widen every bar, by as much as it is already wide, and at last by the rest.
    wide = 1
    while wide < width:
        more = min(wide, width - wide)
        least[more:] = np.minimum(least[more:], least[:-more])
        most[more:] = np.maximum(most[more:], most[:-more])
        wide += more
    least, most = least[before:], most[before:]
    for row in np.flatnonzero(least <= most).tolist():
        place, begin, end = low + row, int(least[row]), int(most[row])
        run = Window(begin, place, end, place) if order.vertical else Window(place, begin, place, end)
        frame_buffer.fill(run, word, parameters.enable)
        if row % 64 == 0:
            yield
    if not len(values):
        return parameters.start
    place, value = int(places[-1]), int(values[-1])
    return Point(value, place) if order.vertical else Point(place, value)
