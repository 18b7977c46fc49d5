"""FrameBuffer: the words of the picture, behind a write mask and a write window.

What is modeled: planes, the write mask, clipping at the edges of the memory, the eight scan orders, a count
of the words written since power-on. What is **not**: the time that a write takes, memory outside the raster.

Bits for which there is no plane are dropped.
Hardware: LIN, JPL (mask, runs in a window); GM (ten planes).
Assumed: outside the memory every word reads as 0.
"""

from __future__ import annotations

from typing import Any, Final, NamedTuple

import numpy as np

from ramtek_emu.arrays import Dots, Numbers, Words
from ramtek_emu.configuration import GMR_9300, Configuration
from ramtek_emu.memory.scan_orders import SCAN_ORDERS, Point, ScanOrder, Window, blocks


class WriteEnable(NamedTuple):
    """The mask of the planes, and the window, that a write may change."""

    mask: int = 0xFFFF
    window: Window = Window(-0x8000, -0x8000, 0x7FFF, 0x7FFF)


EVERYTHING: Final = WriteEnable()
NORMAL_ORDER: Final = SCAN_ORDERS[0]


class FrameBuffer:
    """The picture memory: (lines, elements) words."""

    def __init__(self, configuration: Configuration = GMR_9300) -> None:
        self.window = Window(0, 0, configuration.elements - 1, configuration.lines - 1)
        self.written = 0
        """The number of words written since power-on; it never decreases."""
        self._every_plane = configuration.largest_word
        self._words: Words = np.zeros((configuration.lines, configuration.elements), np.uint16)
        self.words: Words = self._words.view()
        """The words, (lines, elements) uint16; a read-only view that stays current."""
        self.words.flags.writeable = False
        self.touched: Dots | None = None
        """(lines, elements) dots that writes make true, also where words stay the same; None for no dots."""

    def state(self) -> dict[str, Any]:
        """The words, (lines, elements) uint16."""
        return {"words": self._words.copy()}

    def restore(self, state: dict[str, Any]) -> None:
        """Write the words of a state."""
        self._words[...] = state["words"]
        self.written += self._words.size

    def fill(
        self, window: Window, word: int, enable: WriteEnable = EVERYTHING, dots: Dots | None = None
    ) -> None:
        """Fill a window with a word; with [line, element] `dots`, only pixels whose dot is true."""
        self.write_block(window, NORMAL_ORDER, np.uint16(word & 0xFFFF), enable, dots)

    def write_scan(
        self,
        window: Window,
        order: ScanOrder,
        start: Point,
        words: Words,
        enable: WriteEnable = EVERYTHING,
        dots: Dots | None = None,
        pairs: bool = False,
    ) -> Point:
        """Write words along the scan of a window from `start` on; returns the point after the last word.

        With `dots`, only words whose dot is true are written. With `pairs`, the words are pixels in pairs.
        """
        if window.is_empty:
            return start
        if len(words) > 2 * window.width * window.height:
            words, dots = self._last_turn(window, order, start, words, enable, dots, pairs)
        parts, after = blocks(window, order, start, len(words), pairs)
        for place, shape, part in parts:
            block_dots = None if dots is None else dots[part].reshape(shape)
            self.write_block(place, order, words[part].reshape(shape), enable, block_dots)
        return after

    def _last_turn(
        self,
        window: Window,
        order: ScanOrder,
        start: Point,
        words: Words,
        enable: WriteEnable,
        dots: Dots | None,
        pairs: bool,
    ) -> tuple[Words, Dots | None]:
        """Words and dots with a single turn around the window for all whole turns; counts the others."""
        first, size = order.words_around(window, start, pairs)
        count = (len(words) - first) // size
        if count < 1:
            return words, dots
        end = first + count * size
        dots = np.ones(len(words), np.bool_) if dots is None else dots
        turns = dots[first:end].reshape(count, size)
        is_written = turns.any(axis=0)
        if enable.mask & self._every_plane:
            runs = order.inner_and_outer(window)[1]
            place = order.block_window(order.corner(window), runs, size // runs)
            seen = place.intersection(self.window).intersection(enable.window)
            overwritten = (turns.sum(axis=0) - is_written).reshape(runs, -1)
            self.written += int(overwritten[part_of(place, seen, order)].sum())
        last = words[first:end].reshape(count, size)[count - 1 - turns[::-1].argmax(axis=0), np.arange(size)]
        return (
            np.concatenate((words[:first], last, words[end:])),
            np.concatenate((dots[:first], is_written, dots[end:])),
        )

    def read_scan(
        self, window: Window, order: ScanOrder, start: Point, count: int, pairs: bool = False
    ) -> tuple[Words, Point]:
        """`count` words along the scan of a window from `start` on, and the point after the last word.

        With `pairs`, the words are pixels in pairs.
        """
        if window.is_empty:
            return np.zeros(count, np.uint16), start
        # From the corner on, the words repeat with every turn around the window: read the first turn alone.
        first, size = order.words_around(window, start, pairs)
        repeated = max(0, count - first - size) // size * size
        words = np.zeros(count - repeated, np.uint16)
        parts, after = blocks(window, order, start, len(words), pairs)
        for place, shape, part in parts:
            seen = place.intersection(self.window)
            if not seen.is_empty:
                memory = self._words[seen.top : seen.bottom + 1, seen.left : seen.right + 1]
                words[part].reshape(shape)[part_of(place, seen, order)] = order.oriented(memory)
        if repeated:
            words = np.concatenate((words[:first], np.resize(words[first : first + size], count - first)))
        return words, after

    def write_points(
        self,
        elements: Numbers,
        lines: Numbers,
        words: int | Words,
        enable: WriteEnable = EVERYTHING,
    ) -> None:
        """Write points with one word, or with an array of words; the last of equal points wins."""
        inside = enable.window.intersection(self.window)
        mask = enable.mask & self._every_plane
        if inside.is_empty or not mask or not len(elements):
            return
        seen = (elements >= inside.left) & (elements <= inside.right)
        seen &= (lines >= inside.top) & (lines <= inside.bottom)
        places = lines * self._words.shape[1] + elements
        if not seen.all():
            places = places[seen]
            words = words if isinstance(words, int) else words[seen]
        if self.touched is not None:
            self.touched.reshape(-1)[places] = True
        memory = self._words.reshape(-1)
        masked = np.uint16(words & mask) if isinstance(words, int) else words & np.uint16(mask)
        if mask != self._every_plane:
            masked = memory[places] & np.uint16(~mask & 0xFFFF) | masked
        memory[places] = masked
        self.written += len(places)

    def write_block(
        self,
        place: Window,
        order: ScanOrder,
        block: Words | np.uint16,
        enable: WriteEnable = EVERYTHING,
        dots: Dots | None = None,
    ) -> None:
        """Write an [outer, inner] block, or a single word everywhere, to a window of its size.

        With [outer, inner] `dots`, only words whose dot is true are written.
        """
        clipped = place.intersection(self.window).intersection(enable.window)
        mask = enable.mask & self._every_plane
        if clipped.is_empty or not mask:
            return
        memory = order.oriented(
            self._words[clipped.top : clipped.bottom + 1, clipped.left : clipped.right + 1]
        )
        if clipped != place:
            part = part_of(place, clipped, order)
            block = block[part] if isinstance(block, np.ndarray) else block
            dots = None if dots is None else dots[part]
        if self.touched is not None:
            touched = self.touched[clipped.top : clipped.bottom + 1, clipped.left : clipped.right + 1]
            order.oriented(touched)[...] |= True if dots is None else dots
        if mask == self._every_plane and dots is None:
            # The common case: one pass that copies the words without the bits beyond the planes.
            if isinstance(block, np.ndarray):
                np.bitwise_and(block, np.uint16(mask), out=memory)
            else:
                memory[...] = block & np.uint16(mask)
            self.written += memory.size
            return
        mixed = block & np.uint16(mask)
        if mask != self._every_plane:
            mixed = (memory & np.uint16(~mask & 0xFFFF)) | mixed
        np.copyto(memory, mixed, where=True if dots is None else dots)
        self.written += memory.size if dots is None else int(np.count_nonzero(dots))


def part_of(place: Window, clipped: Window, order: ScanOrder) -> tuple[slice, slice]:
    """The slices of an [outer, inner] block at `place` that cover `clipped`."""
    across = place.right - clipped.right if order.leftward else clipped.left - place.left
    down = place.bottom - clipped.bottom if order.upward else clipped.top - place.top
    elements, lines = slice(across, across + clipped.width), slice(down, down + clipped.height)
    return (elements, lines) if order.vertical else (lines, elements)
