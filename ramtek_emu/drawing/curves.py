"""Curves: the pixels nearest to circles and conics.

What is modeled: outlines, one pixel wide. What is **not**: arcs (known by name only), pixels that are not
square (Assumed: a radius in elements is one in lines).
"""

from __future__ import annotations

from collections.abc import Generator, Iterator
from typing import Final

import numpy as np

from ramtek_emu.arrays import Numbers
from ramtek_emu.drawing.vectors import numbered, slices
from ramtek_emu.memory.frame_buffer import FrameBuffer, WriteEnable
from ramtek_emu.memory.scan_orders import Point

MOST_PIXELS: Final = 1 << 14
"""The largest number of pixels of a conic.

Assumed: a curve that nothing else stops ends here; a memory of 4096 x 4096, the largest, has that many pixels
at its edges.
"""


def write_circles(
    frame_buffer: FrameBuffer, centers: Numbers, radii: Numbers, word: int, enable: WriteEnable
) -> Iterator[int]:
    """Draw the outlines of circles around (n, 2) centers, in slices.

    After a slice the iterator yields how many circles are drawn; it draws the next slice when it is asked for
    more.

    Hardware: JPL rtekinc.h, NCAR (center, then the radius; in elements, by a comment of NCAR).
    Assumed: in each octant, at every step the pixel nearest to the circle; radius 0 is a point.
    """
    inside = frame_buffer.window.intersection(enable.window)
    if inside.is_empty:
        return
    reach = (radii * 0.7072).astype(np.int64)[:, np.newaxis] + 1
    # Along either axis, compute only the steps that lie within the memory.
    first = np.maximum(np.array((inside.left, inside.top)) - centers, -reach)
    last = np.minimum(np.array((inside.right, inside.bottom)) - centers, reach)
    counts = np.maximum(last - first + 1, 0)
    for rows in slices(counts.sum(axis=1)):
        # Number the steps along lines, then the steps across them.
        circles = rows.stop - rows.start
        which, numbers = numbered(counts[rows].T.reshape(-1))
        across = numbers + first[rows].T.reshape(-1)[which]
        # Take the whole numbers nearest to square roots. No root of a whole number is half way between two.
        squares = np.maximum(np.tile(radii[rows] ** 2, 2)[which] - across * across, 0)
        down = np.sqrt(squares).astype(np.int64)
        down += squares - down * down > down
        flat = np.abs(across) <= down
        which, across, down = which[flat], across[flat], down[flat]
        along = across + centers[rows].T.reshape(-1)[which]
        other = centers[rows, ::-1].T.reshape(-1)[which]
        turn = int(which.searchsorted(circles))
        for aside in (other + down, other - down):
            elements = np.concatenate((along[:turn], aside[turn:]))
            lines = np.concatenate((aside[:turn], along[turn:]))
            frame_buffer.write_points(elements, lines, word, enable)
        yield rows.stop


def conic_pixels(
    conic: tuple[int, ...], start: Point, stop: Point | None
) -> Generator[None, None, tuple[Numbers, Numbers]]:
    """Trace the pixels of a conic from `start` on, in order; returns their elements and their lines.

    `conic` holds a to e of 0 = a x^2 + b y^2 + c xy + d x + e y, with x and y counted from the start, and the
    largest number of pixels. Hardware: LIN libdoc (the equation, the two ways to stop).

    Assumed: on the screen, the side where the right-hand side of the equation is negative lies to the right
    of the trace: with positive a and b it runs clockwise, and with all signs changed the other way. The
    number of pixels includes the first. A stop that rounding put beside the curve is reached where the trace,
    after it was farther away, comes nearest to it within a pixel. A closed curve without a stop ends where it
    began.

    Measured: updating the value and the slopes from pixel to pixel takes two fifths of the time of computing
    them anew. The generator yields None after every 4096 pixels, which take 5 ms.
    """
    a, b, c, slope_x, slope_y, most = conic
    most = min(most, MOST_PIXELS) if most > 0 else MOST_PIXELS
    x, y = start
    value = 0
    distance = 0 if stop is None else (stop.element - x) ** 2 + (stop.line - y) ** 2
    places: list[tuple[int, int]] = [start]
    was_away = False
    while len(places) < most and (slope_x or slope_y):
        # Follow the curve with its inner side to the right, one pixel along and at most one aside.
        steep = abs(slope_x) > abs(slope_y)
        if steep:
            along, across, bend_along, bend_across = slope_y, slope_x, b, a
            sign, aside = (1 if across > 0 else -1), (1 if along < 0 else -1)
        else:
            along, across, bend_along, bend_across = slope_x, slope_y, a, b
            sign, aside = (1 if across < 0 else -1), (1 if along > 0 else -1)
        # Of three pixels, take the pixel where the right-hand side of the equation is nearest to 0.
        value += sign * along + bend_along
        turned = aside * (across + sign * c)
        shift, best = 0, value
        if abs(value + turned + bend_across) < abs(best):
            shift, best = aside, value + turned + bend_across
        if abs(value - turned + bend_across) < abs(best):
            shift, best = -aside, value - turned + bend_across
        value = best
        right, down = (shift, sign) if steep else (sign, shift)
        x += right
        y += down
        slope_x += 2 * a * right + c * down
        slope_y += 2 * b * down + c * right
        if stop is None:
            if (x, y) == start:
                break
        else:
            before, distance = distance, (x - stop.element) ** 2 + (y - stop.line) ** 2
            if was_away and before <= 2 and distance >= before:
                break
            was_away = was_away or before > 8
        places.append((x, y))
        if stop is not None and distance == 0:
            break
        if len(places) % 4096 == 0:
            yield
    elements, lines = np.array(places, np.int64).T
    # The trace ends where a coordinate leaves its register of 16 bits.
    left = (elements < -0x8000) | (elements > 0x7FFF) | (lines < -0x8000) | (lines > 0x7FFF)
    end = int(left.argmax()) if left.any() else len(left)
    return elements[:end], lines[:end]
