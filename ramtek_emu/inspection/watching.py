"""Memories of a display that note their writes: words of the frame buffer, entries of the lookup table."""

from __future__ import annotations

import numpy as np

from ramtek_emu.arrays import Dots, Numbers, Words
from ramtek_emu.display import Ramtek9300
from ramtek_emu.memory.frame_buffer import EVERYTHING, FrameBuffer, WriteEnable, inside_of, part_of
from ramtek_emu.memory.lookup_table import LookupTable
from ramtek_emu.memory.scan_orders import ScanOrder, Window


class WatchedFrameBuffer(FrameBuffer):
    """A frame buffer that notes writes to a window of the memory, also of words that stay the same."""

    _watched: Window | None = None
    _touched: Dots

    def watch(self, window: Window) -> Dots:
        """Note all writes to a window from now on; returns (lines, elements) dots that become true."""
        self._watched = window.intersection(self.window)
        self._touched = np.zeros((self._watched.height, self._watched.width), np.bool_)
        return self._touched

    def write_points(
        self,
        elements: Numbers,
        lines: Numbers,
        words: int | Words,
        enable: WriteEnable = EVERYTHING,
    ) -> None:
        """Write points, and note those in the watched window."""
        if self._watched is not None and enable.mask & self._every_plane:
            inside = self._watched.intersection(enable.window)
            seen = inside_of(inside, elements, lines)
            self._touched[lines[seen] - self._watched.top, elements[seen] - self._watched.left] = True
        super().write_points(elements, lines, words, enable)

    def _store(
        self,
        place: Window,
        order: ScanOrder,
        block: Words | np.uint16,
        enable: WriteEnable,
        dots: Dots | None = None,
    ) -> None:
        if self._watched is not None and enable.mask & self._every_plane:
            first, last = self._watched[:2], self._watched[2:]
            # Measured: two calls of `intersection` would take a tenth of a replay of short instructions.
            left, top = max(first[0], place[0], enable.window[0]), max(first[1], place[1], enable.window[1])
            right, bottom = min(last[0], place[2], enable.window[2]), min(last[1], place[3], enable.window[3])
            if left <= right and top <= bottom:
                touched = self._touched[
                    top - first[1] : bottom + 1 - first[1], left - first[0] : right + 1 - first[0]
                ]
                if dots is None:
                    touched[...] = True
                else:
                    part = part_of(place, Window(left, top, right, bottom), order)
                    order.oriented(touched)[...] |= dots[part]
        super()._store(place, order, block, enable, dots)


class WatchedLookupTable(LookupTable):
    """A lookup table that notes which entries are written, also if their colors stay the same."""

    _touched: Dots

    def watch(self) -> Dots:
        """Note all writes from now on; returns (entries,) dots that become true."""
        self._touched = np.zeros(self.size, np.bool_)
        return self._touched

    def _note(self, first: int, end: int, words: int) -> None:
        if words:
            self._touched[first:end] = True
        super()._note(first, end, words)


# Other parts of a display refer to its memories, so that another object cannot take their place.


def watched(display: Ramtek9300) -> WatchedFrameBuffer:
    """The frame buffer of a display, which can be watched from now on; nothing else of it changes."""
    display.frame_buffer.__class__ = WatchedFrameBuffer
    assert isinstance(display.frame_buffer, WatchedFrameBuffer)
    return display.frame_buffer


def watched_table(display: Ramtek9300) -> WatchedLookupTable:
    """The lookup table of a display, which can be watched from now on; nothing else of it changes."""
    display.lookup_table.__class__ = WatchedLookupTable
    assert isinstance(display.lookup_table, WatchedLookupTable)
    return display.lookup_table
