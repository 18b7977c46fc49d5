"""Drawing: what the instructions do to words, apart from how they are sent.

What is modelled: text in cells with size, spacing and scan order; vectors with both ends.
"""

import numpy as np
from numpy.typing import NDArray

from .frame_buffer import FrameBuffer, Words, WriteEnable
from .scan_orders import Point, ScanOrder, Window

Dots = NDArray[np.bool_]


def cell(dots: Dots, dimensions: tuple[int, int], size: tuple[int, int]) -> Dots:
    """A character's dots fitted to a cell of (elements, lines), each dot repeated (across, down)."""
    elements, lines = (max(1, min(each, 64)) for each in dimensions)
    shape = np.zeros((lines, elements), np.bool_)
    part = dots[:lines, :elements]
    shape[: part.shape[0], : part.shape[1]] = part
    return np.kron(shape, np.ones((size[1], size[0]), np.bool_))


def write_text(
    frame_buffer: FrameBuffer,
    characters: Dots,
    codes: bytes,
    *,
    window: Window,
    order: ScanOrder,
    start: Point,
    dimensions: tuple[int, int],
    spacing: tuple[int, int],
    size: tuple[int, int],
    foreground: int,
    background: int,
    transparent: bool,
    enable: WriteEnable,
) -> Point:
    """Write characters from `start` on, along the scan of the window; the place of the next cell is returned.

    Hardware: BTL, LIN, JPL (whole cells, advance 7, line 9); NCAR (the scan order turns the letters); LIN
    (the dots between are background).
    Assumed: a cell that would pass the window's edge starts the next line of text at the edge where the scan
    starts; below the last line text goes on at the window's first corner; a cell larger than the window is
    written whole, since clipping is the write window's.
    """
    across, down = size
    first_dots = cell(characters[0], dimensions, size)
    lines, elements = first_dots.shape
    step, line_step = elements + spacing[0] * across, lines + spacing[1] * down
    along, runs = order.inner_and_outer(window)
    place = order.corner(window) if not window.holds(start) else start
    outer, inner = divmod(order.position(window, place), along) if along and runs else (0, 0)
    words = np.array((background, foreground), np.uint16)
    for code in codes:
        if inner and inner + elements > along:
            inner, outer = 0, outer + line_step
        if outer and outer + lines > runs:
            outer = 0
        dots = cell(characters[code], dimensions, size)
        block: Words = words[dots.astype(np.intp)]
        point = offset(order, place if not (along and runs) else order.corner(window), inner, outer)
        frame_buffer.write_block(point, order, block, enable, dots if transparent else None)
        inner += step
    return offset(order, place if not (along and runs) else order.corner(window), inner, outer)


def offset(order: ScanOrder, corner: Point, inner: int, outer: int) -> Point:
    """The point that lies some words along a scan and some runs further."""
    across, down = (outer, inner) if order.vertical else (inner, outer)
    return Point(
        corner.element + (-across if order.leftward else across),
        corner.line + (-down if order.upward else down),
    )


def write_vectors(
    frame_buffer: FrameBuffer, vertices: NDArray[np.int64], word: int, enable: WriteEnable
) -> None:
    """Draw the lines that link (n, 2) vertices, both ends of each.

    Assumed: of two points equally near to the line, the one farther from where it starts (Bresenham's
    choice is free there); no source says.
    """
    inside = frame_buffer.window.intersection(enable.window)
    for first in range(0, len(vertices) - 1, 64):
        part = vertices[first : first + 65]
        start, step = part[:-1], np.diff(part, axis=0)
        length = np.abs(step).max(axis=1)
        steep = np.abs(step[:, 1]) > np.abs(step[:, 0])
        rows = np.arange(len(start))
        major = steep.astype(np.intp)
        # Keep to the part of each line that the memory holds along its longer side.
        low = np.where(steep, inside.top, inside.left)
        high = np.where(steep, inside.bottom, inside.right)
        begin, sign = start[rows, major], np.sign(step[rows, major])
        near, far = (low - begin) * sign, (high - begin) * sign
        from_step = np.maximum(np.minimum(near, far), 0)
        to_step = np.minimum(np.maximum(near, far), length)
        still = sign == 0
        from_step[still], to_step[still] = 0, 0
        counts = np.maximum(to_step - from_step + 1, 0)
        which = np.repeat(rows, counts)
        number = np.arange(len(which)) - np.repeat(np.cumsum(counts) - counts - from_step, counts)
        run = np.maximum(length, 1)[which]
        delta = step[which]
        points = start[which] + np.sign(delta) * (
            (2 * number[:, None] * np.abs(delta) + run[:, None]) // (2 * run[:, None])
        )
        frame_buffer.write_points(points[:, 0], points[:, 1], word, enable)
