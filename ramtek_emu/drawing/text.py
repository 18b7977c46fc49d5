"""Text: characters in cells, with size, spacing and scan order.

What is modeled: whole cells, dots and the pixels between them; text turned by the scan order; the next line
at the edge of the window. What is **not**: size factors above 16.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from ramtek_emu.arrays import Dots
from ramtek_emu.memory.frame_buffer import FrameBuffer, WriteEnable
from ramtek_emu.memory.scan_orders import Point, ScanOrder, Window

LARGEST_CELL: Final = 16
"""The largest number of elements, and of lines, of a cell.

Assumed: a programmed character has 12 lines of 8 dots (LIN), so that four bits hold a dimension.
"""
MOST_ALONG: Final = 4096
"""How many words along the scan are drawn at once: a bound on memory, whatever the host asks for."""


@dataclass(frozen=True, kw_only=True)
class TextStyle:
    """How text is drawn: cell, spacing, size factors, words, and whether only the dots are written."""

    dimensions: tuple[int, int]
    spacing: tuple[int, int]
    size: tuple[int, int]
    foreground: int
    background: int
    transparent: bool

    @property
    def cell(self) -> tuple[int, int]:
        """The size of a cell along the scan and across it, in pixels."""
        along, across = (max(1, min(each, LARGEST_CELL)) for each in self.dimensions)
        return along * self.size[0], across * self.size[1]

    @property
    def step(self) -> tuple[int, int]:
        """The distance from a cell to the next, and from a line of text to the next, in pixels."""
        return self.cell[0] + self.spacing[0] * self.size[0], self.cell[1] + self.spacing[1] * self.size[1]

    def dots(self, shapes: Dots) -> Dots:
        """The shapes of characters, (n, lines, elements), scaled and side by side as [outer, inner] dots."""
        along, across = self.cell[0] // self.size[0], self.cell[1] // self.size[1]
        cells = np.zeros((len(shapes), across, along), np.bool_)
        part = shapes[:, :across, :along]
        cells[:, : part.shape[1], : part.shape[2]] = part
        cells = np.repeat(np.repeat(cells, self.size[1], axis=1), self.size[0], axis=2)
        return beside(cells, self.step[0])


def beside(cells: Dots, step: int) -> Dots:
    """Cells, (n, outer, inner), side by side at a distance of `step` pixels."""
    count, across, along = cells.shape
    if count == 1:
        single: Dots = cells[0]
        return single
    spaced = np.zeros((across, count, step), np.bool_)
    spaced[:, :, :along] = cells.transpose(1, 0, 2)
    side_by_side: Dots = spaced.reshape(across, count * step)
    return side_by_side[:, : (count - 1) * step + along]


def write_text(
    frame_buffer: FrameBuffer,
    shapes: Dots,
    codes: bytes,
    style: TextStyle,
    *,
    window: Window,
    order: ScanOrder,
    start: Point,
    enable: WriteEnable,
) -> Point:
    """Write characters along the scan of the window from `start` on; returns the place of the next cell.

    Hardware: BTL, LIN, JPL (whole cells, advance 7, line 9); NCAR (the scan order turns the letters); LIN
    (the dots between are background); JPL (its window begins at 1, 1 and its text anywhere, also before it).
    Assumed: a cell that would cross the edge of the window starts the next line of text, at the edge where
    the scan starts; after the last line, text continues at the corner where the scan starts, and of text that
    goes around the window many times only the last times are written; a cell larger than the window is
    written whole, since only the write window clips.
    """
    along, across = style.cell
    step, line_step = style.step
    width, height = order.inner_and_outer(window)
    if width and height:
        corner = order.corner(window)
        inner, outer = order.steps(window, start)
    else:
        corner, outer, inner = start, 0, 0
        width = height = 0x10000
    words = np.array((style.background, style.foreground), np.uint16)
    numbers = np.frombuffer(codes, np.uint8)
    while len(numbers):
        if inner > 0 and inner + along > width:
            inner, outer = 0, outer + line_step
        if outer > 0 and outer + across > height:
            outer = 0
        if not inner and not outer:
            around = cells(width, along, step) * cells(height, across, line_step)
            numbers = numbers[max(0, len(numbers) // around - 1) * around :]
        count = min(cells(width - inner, along, step), len(numbers), 1 + MOST_ALONG // step)
        first = order.stepped(corner, inner, outer)
        if (
            not order.block_window(first, (count - 1) * step + along, across)
            .intersection(frame_buffer.window)
            .is_empty
        ):
            dots = style.dots(shapes[numbers[:count]])
            whole = beside(np.ones((count, across, along), np.bool_), step) if step != along else None
            written = dots if style.transparent else whole
            frame_buffer.write_block(first, order, words[dots.view(np.uint8)], enable, written)
        inner += count * step
        numbers = numbers[count:]
    return order.stepped(corner, inner, outer)


def cells(extent: int, size: int, step: int) -> int:
    """How many cells of a size fit at a distance of `step`; at least one, since one is always written."""
    return 1 + max(0, extent - size) // step
