"""Strokes: straight lines on the screen, each from an element and line to another.

Strokes are (n, 4) float64: element and line of the start, element and line of the end.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from autocolor.arrays import Floats, Numbers
from autocolor.widgets.areas import Area

MOST_STROKES: Final = 1 << 14
"""Assumed: of a huge mesh, only so many strokes are drawn in a view, the longest.

An area of 248 x 224 has three times as many pixels; more strokes would fill it.
"""


def clipped(strokes: Floats, area: Area) -> Floats:
    """What of the strokes is in the area, between the centers of its outer pixels, (kept, 4).

    A stroke that is not in the area is left out; one that touches its border leaves a point.
    """
    # Most strokes of most screens are inside.
    if (strokes >= (*area[:2], *area[:2])).all() and (strokes <= (*area[2:], *area[2:])).all():
        return strokes
    start, end = strokes.T[:2], strokes.T[2:]
    step = end - start
    low = np.array([[area.left], [area.top]], np.float64)
    high = np.array([[area.right], [area.bottom]], np.float64)

    # Find the fractions at which each stroke enters and leaves between two borders. One that runs along a
    # pair of borders is between them all the way, or never.
    along = step == 0
    divisor = np.where(along, 1.0, step)
    with np.errstate(over="ignore"):
        at_low, at_high = (low - start) / divisor, (high - start) / divisor
    outside = (along & ((start < low) | (start > high))).any(axis=0)
    enters = np.where(along, 0.0, np.minimum(at_low, at_high)).max(axis=0, initial=0.0)
    leaves = np.where(along, 1.0, np.maximum(at_low, at_high)).min(axis=0, initial=1.0)
    kept = np.flatnonzero(~outside & (enters <= leaves))

    # Keep the ends that lie in the area as they are, and let no rounding lead outside of it.
    start, step, end = start[:, kept], step[:, kept], end[:, kept]
    enters, leaves = enters[kept], leaves[kept]
    starts = np.where(enters > 0, start + enters * step, start)
    ends = np.where(leaves < 1, start + leaves * step, end)
    return np.concatenate([np.clip(starts, low, high), np.clip(ends, low, high)]).T


def joined(positions: Floats | Sequence[tuple[float, float]]) -> Floats:
    """The strokes from each position of (n, 2) to the next, (n - 1, 4).

    >>> joined([(0, 0), (4, 0), (4, 3)]).tolist()
    [[0.0, 0.0, 4.0, 0.0], [4.0, 0.0, 4.0, 3.0]]
    """
    places = np.asarray(positions, np.float64).reshape(-1, 2)
    return np.concatenate([places[:-1], places[1:]], axis=1)


def between(starts: Floats, ends: Floats) -> Floats:
    """The strokes from positions to other positions, both (n, 2)."""
    return np.concatenate([starts, ends], axis=1)


def together(strokes: Sequence[Floats]) -> Floats:
    """All strokes of several arrays, (n, 4)."""
    return np.concatenate([np.empty((0, 4)), *strokes])


def drawn(strokes: Floats, most: int = MOST_STROKES) -> Numbers:
    """The strokes from pixel to pixel, (n, 4) int64, none twice; the `most` longest if there are more.

    The nearest pixel is taken, half up. What is shorter than a pixel is left out: without it the details of
    a mesh are less of a blot, and the ends of longer strokes cover most of it. If all are as short as that,
    a point of them is left.
    """
    pixels = np.floor(strokes + 0.5).astype(np.int64)
    # Write each stroke from its upper or left end.
    backward = (pixels[:, 3] < pixels[:, 1]) | (
        (pixels[:, 3] == pixels[:, 1]) & (pixels[:, 2] < pixels[:, 0])
    )
    pixels[backward] = pixels[backward][:, [2, 3, 0, 1]]
    steps = np.abs(pixels[:, 2:] - pixels[:, :2]).max(axis=1, initial=0)
    longer = pixels[steps > 0] if (steps > 0).any() else pixels[:1]
    if not len(longer):
        return longer
    distinct = _distinct(longer)
    if len(distinct) <= most:
        return distinct
    lengths = np.abs(distinct[:, 2:] - distinct[:, :2]).max(axis=1)
    return np.take(distinct, np.sort(np.argsort(-lengths, kind="stable")[:most]), axis=0)


def _distinct(pixels: Numbers) -> Numbers:
    """The rows without repetitions, in the order of their columns."""
    order = np.lexsort(pixels.T[::-1])
    rows = pixels[order]
    differs = np.ones(len(rows), np.bool_)
    differs[1:] = (rows[1:] != rows[:-1]).any(axis=1)
    return np.compress(differs, rows, axis=0)
