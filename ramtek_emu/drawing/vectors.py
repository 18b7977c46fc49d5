"""Vectors: straight lines of pixels, one or thousands at once, with texture.

What is modeled: the pixels nearest to each line, both ends included; texture patterns; clipping at the memory
and at the write window. What is **not**: the order in which the pixels of a line are written.

Assumed: of two pixels equally near to the line, the pixel farther from the start, in the direction across the
line, is drawn. Bresenham's algorithm leaves the choice open, and no source says.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final, NamedTuple

import numpy as np

from ramtek_emu.arrays import Dots, Indices, Numbers
from ramtek_emu.memory.frame_buffer import FrameBuffer, WriteEnable
from ramtek_emu.memory.scan_orders import Point, Window

FEW_LINES: Final = 4
"""Up to this number of lines, calling `write_line` for each line is faster than array operations."""


class Ink(NamedTuple):
    """The words of a line: `word` for the ones of the texture, `background` for the zeros."""

    word: int
    background: int = 0
    texture: tuple[int, int] = (0xFFFF, 0)
    transparent: bool = False
    """Whether pixels at zeros of the texture stay unchanged."""

    @property
    def is_solid(self) -> bool:
        """Whether the texture has no zeros."""
        return self.texture[0] == 0xFFFF

    def is_one(self, numbers: Numbers) -> Dots:
        """The bits of the texture at pixels with these numbers along the line.

        Hardware: NCAR (sixteen bits, no pixel repeated); LONG (the low field is a bit's width less one).
        Assumed: the highest bit comes first, as in rasters. LONG REFLIB.C, an emulation that draws into a
        file, takes the lowest first, but its test of the bit is commented out.
        """
        pattern, repeat = self.texture
        bits = 15 - numbers // ((repeat & 0x0F) + 1) % 16
        return (pattern >> bits & 1).astype(np.bool_)


def write_lines(
    frame_buffer: FrameBuffer,
    starts: Numbers,
    ends: Numbers,
    ink: Ink,
    enable: WriteEnable,
    linked: bool = False,
) -> Iterator[int]:
    """Draw lines from the (n, 2) starts to the (n, 2) ends, in slices.

    After a slice the iterator yields how many lines are drawn; it draws the next slice when it is asked for
    more. A few lines are drawn in a single step. With `linked`, each line starts where the line before ends.

    Hardware: LONG REFLIB.C, an emulation (the texture continues from line to line of a call).
    Assumed: it continues in linked lines alone, and starts again with the next instruction; a vertex between
    two lines takes one bit.
    """
    inside = frame_buffer.window.intersection(enable.window)
    if inside.is_empty:
        return
    if len(starts) <= FEW_LINES and ink.is_solid:
        for start, end in zip(starts.tolist(), ends.tolist(), strict=True):
            write_line(frame_buffer, Point(*start), Point(*end), ink.word, enable, inside)
        return
    length = np.abs(ends - starts).max(axis=1)
    before = np.cumsum(length) - length
    for elements, lines, numbers, which in points(starts, ends, inside):
        if ink.is_solid:
            frame_buffer.write_points(elements, lines, ink.word, enable)
        else:
            ones = ink.is_one(numbers + before[which] if linked else numbers)
            if ink.transparent:
                frame_buffer.write_points(elements[ones], lines[ones], ink.word, enable)
            else:
                words = np.where(ones, np.uint16(ink.word), np.uint16(ink.background))
                frame_buffer.write_points(elements, lines, words, enable)
        if len(which):
            yield int(which[-1]) + 1


def write_line(
    frame_buffer: FrameBuffer, start: Point, end: Point, word: int, enable: WriteEnable, inside: Window
) -> None:
    """Draw one solid line. It takes fewer numpy calls than drawing many lines at once."""
    across, down = end.element - start.element, end.line - start.line
    if across == 0 or down == 0:
        box = Window(
            min(start.element, end.element),
            min(start.line, end.line),
            max(start.element, end.element),
            max(start.line, end.line),
        )
        frame_buffer.fill(box, word, enable)
        return
    steep = abs(down) > abs(across)
    major, minor = (down, across) if steep else (across, down)
    begin, low, high = (
        (start.line, inside.top, inside.bottom) if steep else (start.element, inside.left, inside.right)
    )
    length = abs(major)
    first, last = (low - begin, high - begin) if major > 0 else (begin - high, begin - low)
    numbers = np.arange(max(first, 0), min(last, length) + 1)
    offsets = (2 * abs(minor) * numbers + length) // (2 * length)
    along = begin + numbers if major > 0 else begin - numbers
    if steep:
        aside = start.element + offsets if across > 0 else start.element - offsets
        frame_buffer.write_points(aside, along, word, enable)
    else:
        aside = start.line + offsets if down > 0 else start.line - offsets
        frame_buffer.write_points(along, aside, word, enable)


def points(
    starts: Numbers, ends: Numbers, inside: Window
) -> Iterator[tuple[Numbers, Numbers, Numbers, Indices]]:
    """The points of lines inside a window: elements, lines, numbers along the line, and rows of the line."""
    offset = ends - starts
    size = np.abs(offset)
    length = size.max(axis=1)
    # (2 n |offset| + length) // (2 length) is n |offset| / length rounded, with halves away from the start.
    doubled, divisor, direction = 2 * size, 2 * np.maximum(length, 1), np.sign(offset)
    first, last = np.zeros_like(length), length
    limits: tuple[tuple[int, int], ...] = (inside.left, inside.right), (inside.top, inside.bottom)
    places = np.concatenate((starts, ends))
    if len(starts) and all(inside.holds(Point(*corner)) for corner in (places.min(0), places.max(0))):
        # Most hosts clip their lines, and this test takes a fifth of the time of clipping.
        limits = ()
    for axis, (low, high) in enumerate(limits):
        begin, toward, slope = starts[:, axis], direction[:, axis], doubled[:, axis]
        near, far = (low - begin) * toward, (high - begin) * toward
        near, far = np.minimum(near, far), np.maximum(near, far)
        # Find the numbers along the line where its distance is at least `near` and at most `far`.
        moving = np.maximum(slope, 1)
        enters = -((length - divisor * near) // moving)
        leaves = -((length - divisor * (far + 1)) // moving) - 1
        still = toward == 0
        beside = still & ((begin < low) | (begin > high))
        first = np.maximum(first, np.where(still, 0, enters))
        last = np.minimum(last, np.where(still, np.where(beside, -1, length), leaves))
    counts = np.maximum(last - first + 1, 0)
    for rows in slices(counts):
        which, numbers = numbered(counts[rows])
        which += rows.start
        numbers += first[which]
        over = divisor[which]
        half = over >> 1
        pair = []
        for axis in (0, 1):
            # Compute in place, because each temporary array costs page faults.
            place = doubled[which, axis]
            place *= numbers
            place += half
            place //= over
            place *= direction[which, axis]
            place += starts[which, axis]
            pair.append(place)
        yield pair[0], pair[1], numbers, which


MOST_POINTS: Final = 1 << 15
"""The number of points in a slice, or a whole row if it has more.

Limit: a bound on memory, and on the time between two pauses: a slice takes 1 to 2 ms.
"""


def slices(counts: Numbers) -> Iterator[slice]:
    """Cut lines or circles into slices of some thousands of points.

    A line or circle is a row, and `counts` are the points of each row.

    >>> list(slices(np.array([30000, 0, 3, 30000, 70000, 1])))
    [slice(0, 3, None), slice(3, 4, None), slice(4, 5, None), slice(5, 6, None)]
    """
    done = counts.cumsum()
    row = before = 0
    while row < len(counts):
        until = max(row + 1, int(np.searchsorted(done, before + MOST_POINTS, side="right")))
        yield slice(row, until)
        row, before = until, int(done[until - 1])


def numbered(counts: Numbers) -> tuple[Indices, Numbers]:
    """The row of each point, for rows of `counts` points, and its number in the row from 0.

    >>> [array.tolist() for array in numbered(np.array([2, 0, 3]))]
    [[0, 0, 2, 2, 2], [0, 1, 0, 1, 2]]
    """
    which = np.arange(len(counts)).repeat(counts)
    numbers = np.arange(len(which))
    numbers -= (counts.cumsum() - counts)[which]
    return which, numbers
