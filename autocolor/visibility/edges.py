"""Edges of polygons, cut by the lines of the raster.

An edge is known by two numbers in the flat corners of a projection, its top and its bottom: number
c * polygons + p is corner c of polygon p. It is always followed from its top to its bottom, whichever way the
polygon runs, so that polygons which share an edge are cut at the very same places and leave no crack.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import Final, Literal

import numpy as np

from autocolor.arrays import Floats, Numbers
from autocolor.visibility.projection import Projection, least_of_four

Side = Literal[1, -1]

DOWN_SIDE: Final[Side] = 1
"""The edges along which a polygon, followed as it runs, goes down the raster."""

UP_SIDE: Final[Side] = -1
"""The edges along which it comes back up."""


@dataclass(frozen=True, eq=False)
class Edges:
    """Edges and how to step them from line to line; every array is (edges,).

    An edge crosses the `count` lines from `first_line`; `across` (pixels) and `inverse_depth` are its values
    at the center of the first, and the steps what each further line adds. `top` and `bottom` are numbers of
    its ends in the flat corners of the projection, `upper` and `lower` their nodes.
    """

    top: Numbers
    bottom: Numbers
    upper: Numbers
    lower: Numbers
    first_line: Numbers
    count: Numbers
    across: Floats
    across_step: Floats
    inverse_depth: Floats
    inverse_depth_step: Floats


def edges(projected: Projection, top: Numbers, bottom: Numbers) -> Edges:
    """The edges between corners; each must cross a line.

    Measured, here and wherever much is picked: `take` has two thirds of the time of an index.
    """
    corners = projected.corners.ravel()
    a, b = corners.take(top), corners.take(bottom)
    first_line = projected.first_line.take(a)
    down, across, inverse_depth = (
        table.take(a) for table in (projected.down, projected.across, projected.inverse_depth)
    )
    height = projected.down.take(b) - down
    below_top = first_line + 0.5 - down
    across_step = (projected.across.take(b) - across) / height
    inverse_depth_step = (projected.inverse_depth.take(b) - inverse_depth) / height
    return Edges(
        top,
        bottom,
        a,
        b,
        first_line,
        projected.first_line.take(b) - first_line,
        across + below_top * across_step,
        across_step,
        inverse_depth + below_top * inverse_depth_step,
        inverse_depth_step,
    )


def edges_of_sides(projected: Projection, columns: Numbers) -> tuple[Edges, Edges]:
    """The edges of the down side and of the up side of the polygons in some columns of the projection.

    They are in the order of the polygons, and those of one polygon from its top to its bottom, so that their
    lines follow each other without a gap. Edges that cross no line are left out.
    """
    lines = projected.first_line.take(projected.corners.take(columns, axis=1))
    count, polygons = len(columns), projected.corners.shape[1]
    # Walk round each polygon from its highest corner, as it runs.
    highest = least_of_four((lines << 2) + np.arange(4)[:, None]) & 3
    walk = (highest + np.arange(4)[:, None]) & 3
    walk *= count
    walk += np.arange(count)
    line = np.take(lines, walk)

    def side(turn: Side, corners: list[int]) -> Edges:
        falls = np.zeros((count, 4), np.bool_)
        for step, (upper, lower) in enumerate(pairwise(corners)):
            np.less(line[upper], line[lower], out=falls[:, step])
        found = np.flatnonzero(falls)
        polygon = found >> 2
        top, column = (highest[polygon] + turn * (found & 3)) & 3, columns[polygon]
        return edges(projected, top * polygons + column, ((top + turn) & 3) * polygons + column)

    return side(DOWN_SIDE, [0, 1, 2, 3]), side(UP_SIDE, [0, 3, 2, 1])


def other_end(projected: Projection, top: Numbers, side: Side) -> Numbers:
    """The bottom of each edge of a side whose top is given."""
    corner, column = np.divmod(top, projected.corners.shape[1])
    bottom: Numbers = ((corner + side) & 3) * projected.corners.shape[1] + column
    return bottom
