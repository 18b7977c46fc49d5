"""Text: characters in cells, with size, spacing and scan order.

What is modeled: whole cells, dots and the pixels between them; text turned by the scan order; the next line
at the edge of the window. What is **not**: size factors above 16.
"""

from __future__ import annotations

from collections.abc import Generator
from typing import Final

import numpy as np

from ramtek_emu.arrays import Dots
from ramtek_emu.memory.frame_buffer import FrameBuffer
from ramtek_emu.memory.parameters import Parameters
from ramtek_emu.memory.scan_orders import Point

LARGEST_CELL: Final = 16
"""The largest number of elements, and of lines, of a cell.

Assumed: a programmed character has 12 lines of 8 dots (LIN), so that four bits hold a dimension.
"""


def scaled(shapes: Dots, along: int, across: int, size: tuple[int, int]) -> Dots:
    """The shapes of characters, (n, lines, elements), cut to cells of these dots; each dot is repeated."""
    cells = shapes[:, :across, :along]
    if cells.shape[1:] != (across, along):
        part, cells = cells, np.zeros((len(shapes), across, along), np.bool_)
        cells[:, : part.shape[1], : part.shape[2]] = part
    return cells if size == (1, 1) else np.repeat(np.repeat(cells, size[1], axis=1), size[0], axis=2)


def beside(cells: Dots, step: int) -> Dots:
    """Cells, (n, outer, inner), side by side at a distance of `step` pixels."""
    count, across, along = cells.shape
    step = step if count > 1 else along
    spaced = np.zeros((across, count, step), np.bool_)
    spaced[:, :, :along] = cells.transpose(1, 0, 2)
    side_by_side: Dots = spaced.reshape(across, count * step)
    return side_by_side[:, : (count - 1) * step + along]


def write_text(
    frame_buffer: FrameBuffer,
    parameters: Parameters,
    shapes: Dots,
    codes: bytes,
    *,
    foreground: int,
    background: int,
    transparent: bool,
) -> Generator[None, None, Point]:
    """Write characters along the scan of the window; returns the point of the next cell.

    `shapes` are the dots of the 256 codes, (256, lines, elements). If `transparent`, only the dots are
    written, in the foreground, and not the pixels between them.

    The generator yields None between two lines of text.

    Hardware: BTL, LIN, JPL (whole cells, advance 7, line 9); NCAR (the scan order turns the letters); LIN
    (the dots between are background); JPL (its driver sets a window from 1, 1 on and starts text anywhere,
    also before that).
    Assumed: a cell that would cross the edge of the window starts the next line of text, at the edge where
    the scan starts. A line of text that would cross the far edge of the window is not begun: the rest of the
    text is dropped, and the operating point stays behind the last cell that was written. The first line is
    written from the start point on, even if that point lies outside the window. A cell larger than the window
    is written whole, since only the write window clips.
    """
    window, order, start = parameters.window, parameters.order, parameters.start
    if window.is_empty:
        window = order.block_window(start, 0x10000, 0x10000)
    # Compute the sizes of a cell and the distances of cells, along the scan and across it.
    size = 1 + (parameters.scale & 0x0F), 1 + (parameters.scale >> 8 & 0x0F)
    dots_along, dots_across = (min(max(1, dots), LARGEST_CELL) for dots in parameters.dimensions)
    along, across = dots_along * size[0], dots_across * size[1]
    step, line_step = along + parameters.spacing[0] * size[0], across + parameters.spacing[1] * size[1]
    corner = order.corner(window)
    width, height = order.inner_and_outer(window)
    inner, outer = order.steps(window, start)
    # Draw the cells that reach into the memory, line by line.
    memory = frame_buffer.window.intersection(parameters.write_window)
    low, low_line = order.steps(window, order.corner(memory))
    room, room_across = order.inner_and_outer(memory)
    words = np.array((background, foreground), np.uint16)
    numbers = np.frombuffer(codes, np.uint8)
    while True:
        cells = numbers[: cells_within(inner, width, along, step)]
        seen = reaching(inner, along, step, low, room)
        shown = cells[seen.start : seen.stop]
        if len(shown) and low_line - across < outer < low_line + room_across:
            dots = beside(scaled(shapes[shown], dots_along, dots_across, size), step)
            whole = beside(np.ones((len(shown), across, along), np.bool_), step) if step != along else None
            place = order.stepped(corner, inner + seen.start * step, outer)
            frame_buffer.write_block(
                order.block_window(place, *dots.shape),
                order,
                words.take(dots.view(np.uint8)),
                parameters.enable,
                dots if transparent else whole,
            )
        numbers = numbers[len(cells) :]
        if not len(numbers) or not cells_within(outer + line_step, height, across, line_step):
            return order.stepped(corner, inner + len(cells) * step, outer)
        inner, outer = 0, outer + line_step
        yield


def cells_within(first: int, extent: int, size: int, step: int) -> int:
    """The number of cells, from `first` on at a distance of `step`, that end within an extent.

    A cell that begins at the near edge, or before it, counts even if it is larger than the extent.
    """
    return max(0, 1 + (max(0, extent - size) - first) // step)


def reaching(first: int, size: int, step: int, low: int, extent: int) -> range:
    """The indices of the cells, from `first` on at a distance of `step`, that reach into an extent at `low`.

    >>> reaching(-10, 7, 8, 0, 20)
    range(1, 4)
    """
    begin = max(0, (low - first - size) // step + 1)
    return range(begin, max(begin, -((first - low - extent) // step)))
