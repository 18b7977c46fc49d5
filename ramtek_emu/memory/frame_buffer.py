"""FrameBuffer: the words of the picture, behind a write mask and a write window.

What is modeled: planes, the write mask, clipping at the edges of the memory, the eight scan orders, a count
of the words written since power-on. What is **not**: the time that a write takes, memory outside the raster.

Bits for which there is no plane are dropped from words of the host, and refused in words from Python.
Hardware: LIN, JPL (mask, runs in a window); GM (ten planes).
Assumed: outside the memory every word reads as 0.
"""

from __future__ import annotations

from typing import Any, Final, NamedTuple

import numpy as np

from ramtek_emu.arrays import Dots, Numbers, Words
from ramtek_emu.checks import checked_number, checked_words
from ramtek_emu.configuration import GMR_9300, Configuration
from ramtek_emu.errors import WordsError
from ramtek_emu.memory.scan_orders import SCAN_ORDERS, Point, ScanBlock, ScanOrder, Window, blocks


class WriteEnable(NamedTuple):
    """The mask of the planes, and the window, that a write may change."""

    mask: int = 0xFFFF
    window: Window = Window(-0x8000, -0x8000, 0x7FFF, 0x7FFF)


EVERYTHING: Final = WriteEnable()
NORMAL_ORDER: Final = SCAN_ORDERS[0]


class FrameBuffer:
    """The picture memory: (lines, elements) words."""

    def __init__(self, configuration: Configuration = GMR_9300) -> None:
        self.planes = configuration.planes
        self.window = Window(0, 0, configuration.elements - 1, configuration.lines - 1)
        self.written = 0
        """The number of words written since power-on; it never decreases."""
        self._every_plane = configuration.largest_word
        self._words: Words = np.zeros((configuration.lines, configuration.elements), np.uint16)
        self._make_view()

    def _make_view(self) -> None:
        self.words: Words = self._words.view()
        """The words, (lines, elements) uint16; a read-only view that stays current."""
        self.words.flags.writeable = False

    def __getstate__(self) -> dict[str, object]:
        return {name: value for name, value in vars(self).items() if name != "words"}

    def __setstate__(self, state: dict[str, object]) -> None:
        vars(self).update(state)
        self._make_view()

    def __repr__(self) -> str:
        lines, elements = self._words.shape
        return f"FrameBuffer({elements} x {lines} words of {self.planes} bits, {self.written} written)"

    def state(self) -> dict[str, Any]:
        """The words; the array is this memory itself, so copy what you keep."""
        return {"words": self.words}

    def restore(self, state: dict[str, Any]) -> None:
        """Write the words of a state."""
        self._words[...] = state["words"]
        self.written += self._words.size

    def write(self, words: object, left: int = 0, top: int = 0) -> None:
        """Write a (lines, elements) array from Python; WordsError if a word or the window does not fit."""
        block = checked_words(words, self.planes)
        corner = (
            checked_number(place, "the words' corner", -0x8000, 0x7FFF, "move it", WordsError)
            for place in (left, top)
        )
        place = NORMAL_ORDER.block_window(Point(*corner), block.shape[1], block.shape[0])
        refuse_outside(place, self.window)
        self._store(place, NORMAL_ORDER, block, EVERYTHING)

    def fill(
        self, window: Window, word: int, enable: WriteEnable = EVERYTHING, dots: Dots | None = None
    ) -> None:
        """Fill a window with a word; with [line, element] `dots`, only pixels whose dot is true."""
        self._store(window, NORMAL_ORDER, np.uint16(word & 0xFFFF), enable, dots)

    def write_scan(
        self,
        window: Window,
        order: ScanOrder,
        start: Point,
        words: Words,
        enable: WriteEnable = EVERYTHING,
        dots: Dots | None = None,
    ) -> Point:
        """Write words along the scan of a window from `start` on; returns the point after the last word.

        With `dots`, only words whose dot is true are written.
        """
        along, runs = order.inner_and_outer(window)
        size = along * runs
        if size == 0:
            return start
        inner, outer = order.entry(window, start)
        count, rest = divmod(len(words), along)
        if dots is None and inner == rest == 0 and 0 <= outer < outer + count <= runs:
            # The common case: whole lines of the window, without going around it.
            corner = order.corner(window)
            entered = order.stepped(corner, 0, outer)
            self.write_block(entered, order, words.reshape(count, along), enable)
            return order.stepped(corner, 0, (outer + count) % runs)
        before = order.words_before(window, start)
        if 0 < before < len(words):
            head, tail = (None, None) if dots is None else (dots[:before], dots[before:])
            entered = self.write_scan(window, order, start, words[:before], enable, head)
            return self.write_scan(window, order, entered, words[before:], enable, tail)
        after = order.after(window, start, len(words))
        if dots is not None and len(words) > size and not before:
            words, dots = last_around(words, dots, size)
        # If the words go around the window several times, only the last time matters.
        skipped = 0 if before else max(0, len(words) - size)
        start = order.after(window, start, skipped)
        for block in blocks(window, order, start, len(words) - skipped):
            first = skipped + block.first
            part = slice(first, first + block.inner * block.outer)
            data = words[part].reshape(block.outer, block.inner)
            chosen = None if dots is None else dots[part].reshape(block.outer, block.inner)
            self.write_block(block.start, order, data, enable, chosen)
        return after

    def read_scan(self, window: Window, order: ScanOrder, start: Point, count: int) -> tuple[Words, Point]:
        """`count` words along the scan of a window from `start` on, and the point after the last word."""
        size = window.width * window.height
        if size == 0:
            return np.zeros(count, np.uint16), start
        before = order.words_before(window, start)
        if 0 < before < count:
            head, entered = self.read_scan(window, order, start, before)
            tail, after = self.read_scan(window, order, entered, count - before)
            return np.concatenate((head, tail)), after
        # Read once around the window; after that the words repeat.
        words = np.zeros(count if before else min(count, size), np.uint16)
        for block in blocks(window, order, start, len(words)):
            out = words[block.first : block.first + block.inner * block.outer]
            self._load(block, order, out.reshape(block.outer, block.inner))
        return np.resize(words, count), order.after(window, start, count)

    def write_block(
        self,
        start: Point,
        order: ScanOrder,
        block: Words,
        enable: WriteEnable = EVERYTHING,
        dots: Dots | None = None,
    ) -> None:
        """Write an [outer, inner] block from `start` on; with `dots`, only words whose dot is true."""
        place = order.block_window(start, block.shape[1], block.shape[0])
        self._store(place, order, block, enable, dots)

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
        memory = self._words.reshape(-1)
        masked = np.uint16(words & mask) if isinstance(words, int) else words & np.uint16(mask)
        if mask != self._every_plane:
            masked = memory[places] & np.uint16(~mask & 0xFFFF) | masked
        memory[places] = masked
        self.written += len(places)

    def _store(
        self,
        place: Window,
        order: ScanOrder,
        block: Words | np.uint16,
        enable: WriteEnable,
        dots: Dots | None = None,
    ) -> None:
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

    def _load(self, block: ScanBlock, order: ScanOrder, out: Words) -> None:
        place = order.block_window(block.start, block.inner, block.outer)
        clipped = place.intersection(self.window)
        if not clipped.is_empty:
            memory = self._words[clipped.top : clipped.bottom + 1, clipped.left : clipped.right + 1]
            out[part_of(place, clipped, order)] = order.oriented(memory)


def refuse_outside(place: Window, memory: Window) -> None:
    """Refuse a window that does not lie wholly in the memory."""
    if place.intersection(memory) != place:
        raise WordsError(
            f"the words' window must lie within elements 0 to {memory.right} and lines 0 to {memory.bottom}, "
            f"not {place.left} to {place.right} and {place.top} to {place.bottom}; move it or cut it"
        )


def part_of(place: Window, clipped: Window, order: ScanOrder) -> tuple[slice, slice]:
    """The slices of an [outer, inner] block at `place` that cover `clipped`."""
    across = place.right - clipped.right if order.leftward else clipped.left - place.left
    down = place.bottom - clipped.bottom if order.upward else clipped.top - place.top
    elements, lines = slice(across, across + clipped.width), slice(down, down + clipped.height)
    return (elements, lines) if order.vertical else (lines, elements)


def last_around(words: Words, dots: Dots, size: int) -> tuple[Words, Dots]:
    """The words and dots that remain after going around a window of `size` words more than once."""
    around = -(-len(words) // size)
    rounds = np.zeros((around, size), np.uint16)
    rounds.reshape(-1)[: len(words)] = words
    written = np.zeros((around, size), np.bool_)
    written.reshape(-1)[: len(dots)] = dots
    last = around - 1 - written[::-1].argmax(axis=0)
    any_dot: Dots = np.logical_or.reduce(written, axis=0)
    return rounds[last, np.arange(size)], any_dot
