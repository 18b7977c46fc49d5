"""Arrows on the screen: a shaft and a head that is the same size however long the shaft is."""

from __future__ import annotations

import math
from typing import Final

from autocolor.arrays import Floats
from autocolor.widgets.strokes import joined, together

HEAD: Final = 7.0
"""Assumed: the length of the head in elements; at most half of the arrow."""

HALF_WIDTH: Final = 0.45
"""Assumed: how far the head opens to each side, as a fraction of its length."""

SHORTEST: Final = 3.0
"""Assumed: an arrow that is shorter, in elements, has no head: it points at the viewer or away."""


def arrow(start: tuple[float, float], end: tuple[float, float]) -> Floats:
    """The strokes of an arrow from a position to another, (1 or 3, 4).

    >>> arrow((0, 0), (20, 0))[1:].round(2).tolist()
    [[13.0, 3.15, 20.0, 0.0], [20.0, 0.0, 13.0, -3.15]]
    """
    shaft = joined([start, end])
    length = math.hypot(end[0] - start[0], end[1] - start[1])
    if length < SHORTEST:
        return shaft
    x, y = (end[0] - start[0]) / length, (end[1] - start[1]) / length
    back = min(HEAD, length / 2)
    wide = HALF_WIDTH * back
    foot = end[0] - back * x, end[1] - back * y
    head = [(foot[0] - wide * y, foot[1] + wide * x), end, (foot[0] + wide * y, foot[1] - wide * x)]
    return together([shaft, joined(head)])
