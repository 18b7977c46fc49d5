"""Vectors: straight lines of pixels, one or thousands at once, with texture.

What is modeled: the pixels nearest to each line, both ends included; texture patterns; clipping at the memory
and at the write window. What is **not**: the order in which the pixels of a line are written.

Assumed: of two pixels equally near to the line, the one farther from the start in the direction across the
line (Bresenham's algorithm leaves the choice open); no source says.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final, NamedTuple

import numpy as np

from ramtek_emu.arrays import Dots, Indices, Numbers
from ramtek_emu.memory.frame_buffer import FrameBuffer, WriteEnable
from ramtek_emu.memory.scan_orders import Point, Window

MOST_POINTS: Final = 1 << 15
"""How many points are computed at once, or those of one line if they are more: a bound on memory."""
FEW: Final = 4
"""Up to this number, lines are drawn faster one by one."""


class Ink(NamedTuple):
    """What a line is written with: a word for the ones of the texture, and one for the zeros."""

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
        """The bits of the texture for pixels with these numbers along the line.

        Hardware: NCAR (sixteen bits, no pixel repeated); LONG (the low field is a bit's width less one).
        Assumed: the highest bit comes first.
        """
        pattern, repeat = self.texture
        bits = 15 - numbers // ((repeat & 0x0F) + 1) % 16
        return (pattern >> bits & 1).astype(np.bool_)


def write_linked(frame_buffer: FrameBuffer, vertices: Numbers, ink: Ink, enable: WriteEnable) -> None:
    """Draw the lines that link (n, 2) vertices.

    Assumed: the texture continues from line to line, and starts again with the next instruction.
    """
    write_lines(frame_buffer, vertices[:-1], vertices[1:], ink, enable, runs_on=True)


def write_lines(
    frame_buffer: FrameBuffer,
    starts: Numbers,
    ends: Numbers,
    ink: Ink,
    enable: WriteEnable,
    runs_on: bool = False,
) -> None:
    """Draw a line from each of the (n, 2) starts to its end."""
    inside = frame_buffer.window.intersection(enable.window)
    if inside.is_empty:
        return
    if len(starts) <= FEW and ink.is_solid:
        for start, end in zip(starts.tolist(), ends.tolist(), strict=True):
            write_line(frame_buffer, Point(*start), Point(*end), ink.word, enable, inside)
        return
    length = np.abs(ends - starts).max(axis=1)
    before = np.cumsum(length) - length
    for elements, lines, numbers, which in points(starts, ends, inside):
        if ink.is_solid:
            frame_buffer.write_points(elements, lines, ink.word, enable)
            continue
        if runs_on:
            numbers = numbers + before[which]
        ones = ink.is_one(numbers)
        if ink.transparent:
            frame_buffer.write_points(elements[ones], lines[ones], ink.word, enable)
        else:
            words = np.where(ones, np.uint16(ink.word), np.uint16(ink.background))
            frame_buffer.write_points(elements, lines, words, enable)


def write_line(
    frame_buffer: FrameBuffer, start: Point, end: Point, word: int, enable: WriteEnable, inside: Window
) -> None:
    """Draw one solid line, with fewer numpy calls than many lines at once take."""
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
    """The points of lines in order: elements, lines, the number along the line, and the row of the line.

    Of each line, only the points whose coordinate along its longer side is inside the window are computed.
    """
    step = ends - starts
    size = np.abs(step)
    length = size.max(axis=1)
    major = (size[:, 1] > size[:, 0]).astype(np.intp)
    rows = np.arange(len(starts))
    begin, sign = starts[rows, major], np.sign(step[rows, major])
    low = np.where(major, inside.top, inside.left)
    high = np.where(major, inside.bottom, inside.right)
    near, far = (low - begin) * sign, (high - begin) * sign
    first = np.maximum(np.minimum(near, far), 0)
    last = np.minimum(np.maximum(near, far), length)
    still = sign == 0
    first[still] = last[still] = 0
    counts = np.maximum(last - first + 1, 0)
    done = np.cumsum(counts)
    # (2 n |step| + length) // (2 length) is n |step| / length rounded, with halves away from the start.
    doubled, divisor, direction = 2 * size, 2 * np.maximum(length, 1), np.sign(step)
    row = 0
    while row < len(rows):
        before = int(done[row - 1]) if row else 0
        until = max(row + 1, int(np.searchsorted(done, before + MOST_POINTS, side="right")))
        part = slice(row, until)
        which = np.repeat(rows[part], counts[part])
        numbers = np.arange(before, before + len(which)) - (done - counts - first)[which]
        over = divisor[which]
        half = over >> 1
        elements, lines = (
            starts[which, axis] + direction[which, axis] * ((numbers * doubled[which, axis] + half) // over)
            for axis in (0, 1)
        )
        yield elements, lines, numbers, which
        row = until
