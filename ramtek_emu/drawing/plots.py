"""Plots: bars between a base line and the values of data, for WPB.

All bars of a plot have the base line in common, so at each place along the scan they cover a single run of
pixels, from their least to their most. So the size of the memory bounds the work, for any data.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ramtek_emu.arrays import Numbers
from ramtek_emu.memory.frame_buffer import FrameBuffer, WriteEnable
from ramtek_emu.memory.scan_orders import Window


def write_bars(
    frame_buffer: FrameBuffer,
    places: Numbers,
    values: Numbers,
    *,
    width: int,
    base: int,
    vertical: bool,
    word: int,
    enable: WriteEnable,
) -> Iterator[None]:
    """Draw bars, and pause after 64 places.

    A bar covers `width` places from its least place on: elements, or lines if the scan is `vertical`. Across
    the scan it goes from the base line to its value, both included.
    """
    inside = frame_buffer.window.intersection(enable.window)
    low, high = (inside.top, inside.bottom) if vertical else (inside.left, inside.right)
    low -= width - 1
    seen = (places >= low) & (places <= high)
    if inside.is_empty or not seen.any():
        return
    # Find the least and the most of the bars that begin at each place.
    places, values = places[seen] - low, values[seen]
    least, most = np.full(high - low + 1, 0x8000), np.full(high - low + 1, -0x8001)
    np.minimum.at(least, places, np.minimum(values, base))
    np.maximum.at(most, places, np.maximum(values, base))
    # Widen every bar, by as much as it is already wide, and at last by the rest.
    wide = 1
    while wide < width:
        more = min(wide, width - wide)
        least[more:] = np.minimum(least[more:], least[:-more])
        most[more:] = np.maximum(most[more:], most[:-more])
        wide += more
    for row in np.flatnonzero(least <= most).tolist():
        place, begin, end = low + row, int(least[row]), int(most[row])
        run = Window(begin, place, end, place) if vertical else Window(place, begin, place, end)
        frame_buffer.fill(run, word, enable)
        if row % 64 == 0:
            yield
