"""Curves: circles and conics as the pixels nearest to them.

What is modeled: outlines, one pixel wide. What is **not**: arcs (known by name only), pixels that are not
square (Assumed: a radius in elements is one in lines).
"""

from __future__ import annotations

from typing import Final

import numpy as np

from ramtek_emu.arrays import Numbers
from ramtek_emu.memory.frame_buffer import FrameBuffer, WriteEnable
from ramtek_emu.memory.scan_orders import Point

MOST_PIXELS: Final = 1 << 14
"""The largest number of pixels of a conic.

Assumed: a curve that nothing else stops ends here; a memory of 4096 x 4096, the largest, has that many pixels
at its edges.
"""


def write_circle(
    frame_buffer: FrameBuffer, center: Point, radius: int, word: int, enable: WriteEnable
) -> None:
    """Draw the outline of a circle.

    Hardware: NCAR (disabled code: center, then the radius in elements).
    Assumed: in each octant, at every step the pixel nearest to the circle; radius 0 is a point.
    """
    inside = frame_buffer.window.intersection(enable.window)
    steps = []
    for transposed in (False, True):
        # Compute only the steps that lie within the memory.
        middle = center.line if transposed else center.element
        low, high = (inside.top, inside.bottom) if transposed else (inside.left, inside.right)
        reach = int(radius * 0.7072) + 1
        across = np.arange(max(low - middle, -reach), min(high - middle, reach) + 1)
        down = nearest_root(radius * radius - across * across)
        across, down = across[np.abs(across) <= down], down[np.abs(across) <= down]
        across, down = np.concatenate((across, across)), np.concatenate((down, -down))
        steps.append((down, across) if transposed else (across, down))
    elements, lines = (np.concatenate([each[axis] for each in steps]) for axis in (0, 1))
    frame_buffer.write_points(center.element + elements, center.line + lines, word, enable)


def nearest_root(squares: Numbers) -> Numbers:
    """The whole numbers nearest to the square roots; no root of a whole number lies half way between two."""
    root = np.sqrt(np.maximum(squares, 0)).astype(np.int64)
    return root + (squares - root * root > root)


def conic_pixels(conic: tuple[int, ...], start: Point, stop: Point | None) -> tuple[Numbers, Numbers]:
    """The elements and lines of the pixels of a conic, in order, from the start on.

    `conic` holds a to e of 0 = a x^2 + b y^2 + c xy + d x + e y, with x and y counted from the start, and the
    largest number of pixels. Hardware: LIN libdoc (the equation, the two ways to stop).

    Assumed: on the screen, the side where the right-hand side of the equation is negative lies to the right
    of the trace: with positive a and b it runs clockwise, and with all signs changed the other way. The
    number of pixels includes the first. A stop that rounding put beside the curve is reached where the trace,
    after it was farther away, comes nearest to it within a pixel. A closed curve without a stop ends where it
    began.
    """
    a, b, c, d, e, most = conic
    most = min(most, MOST_PIXELS) if most > 0 else MOST_PIXELS
    target = (0, 0) if stop is None else (stop.element - start.element, stop.line - start.line)
    x = y = 0
    pixels = [(0, 0)]
    was_away = False
    while len(pixels) < most:
        slope_x, slope_y = 2 * a * x + c * y + d, 2 * b * y + c * x + e
        # Follow the curve with its inner side to the right.
        along_x, along_y = -slope_y, slope_x
        if along_x == 0 and along_y == 0:
            break
        steep = abs(along_y) > abs(along_x)
        sign = 1 if (along_y if steep else along_x) > 0 else -1
        aside = 1 if (along_x if steep else along_y) > 0 else -1
        best, next_x, next_y = -1, x, y
        for shift in (0, aside, -aside):
            new_x, new_y = (x + shift, y + sign) if steep else (x + sign, y + shift)
            away = abs(a * new_x * new_x + b * new_y * new_y + c * new_x * new_y + d * new_x + e * new_y)
            if best < 0 or away < best:
                best, next_x, next_y = away, new_x, new_y
        now = (x - target[0]) ** 2 + (y - target[1]) ** 2
        then = (next_x - target[0]) ** 2 + (next_y - target[1]) ** 2
        if was_away and now <= 2 and then >= now and stop is not None:
            break
        was_away = was_away or now > 8
        x, y = next_x, next_y
        if not -0x8000 <= start.element + x <= 0x7FFF or not -0x8000 <= start.line + y <= 0x7FFF:
            break
        if stop is None and then == 0:
            break
        pixels.append((x, y))
        if then == 0:
            break
    offsets = np.array(pixels, np.int64)
    return start.element + offsets[:, 0], start.line + offsets[:, 1]
