"""Edges of polygons, where scan lines cross them, and the extents of polygons between the crossings.

An edge is identified by the corners at its top and its bottom, numbers in the flat corners of a projection:
number c * polygons + p is corner c of polygon p. It is always followed from top to bottom, whichever way the
polygon runs, so that polygons that share an edge have the same crossings and leave no crack.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import Final, Literal

import numpy as np

from autocolor.arrays import Floats, Indices, least_of_four, runs
from autocolor.visibility.projection import Projection

Side = Literal[1, -1]

DOWN_SIDE: Final[Side] = 1
"""The edges that lead down the raster as the polygon runs."""

UP_SIDE: Final[Side] = -1
"""The edges that lead back up."""

TOP_CORNERS: Final = {
    side: np.array(
        [sum(c for c in range(4) if w >> c & 1 and not w >> (c + side & 3) & 1) for w in range(16)]
    )
    for side in (DOWN_SIDE, UP_SIDE)
}
"""The top corner of the edge that a line crosses, for each side of a polygon.

The index is the sum of 2^c over the corners c that lie at or above the line.
"""


@dataclass(frozen=True, eq=False)
class Edges:
    """Edges and how to step them from line to line; every array is (edges,).

    An edge crosses the `count` lines from `first_line`; `x` (pixels) and `inverse_depth` are its values at
    the center of the first line, and the steps are added for each further line. `top` and `bottom` are
    corners, `top_node` and `bottom_node` the nodes there.
    """

    top: Indices
    bottom: Indices
    top_node: Indices
    bottom_node: Indices
    first_line: Indices
    count: Indices
    x: Floats
    x_step: Floats
    inverse_depth: Floats
    inverse_depth_step: Floats


def edges(projected: Projection, top: Indices, bottom: Indices) -> Edges:
    """The edges between corners; each must cross a line.

    Measured, here and wherever many elements are picked: `take` takes two thirds of the time of an index.
    """
    corners = projected.corners.ravel()
    a, b = corners.take(top), corners.take(bottom)
    first_line = projected.first_line.take(a)
    x, y, inverse_depth = (table.take(a) for table in (projected.x, projected.y, projected.inverse_depth))
    height = projected.y.take(b) - y
    below_top = first_line + 0.5 - y
    x_step = (projected.x.take(b) - x) / height
    inverse_depth_step = (projected.inverse_depth.take(b) - inverse_depth) / height
    return Edges(
        top,
        bottom,
        a,
        b,
        first_line,
        projected.first_line.take(b) - first_line,
        x + below_top * x_step,
        x_step,
        inverse_depth + below_top * inverse_depth_step,
        inverse_depth_step,
    )


def edges_of_sides(projected: Projection, polygons: Indices) -> tuple[Edges, Edges]:
    """The edges of the down side and of the up side of some polygons of the projection.

    They are in the order of the polygons, and within a polygon from top to bottom, so that each side has
    every line of the polygon once and in order. Edges that cross no line are left out.
    """
    lines = projected.first_line.take(projected.corners.take(polygons, axis=1))
    count, all_polygons = len(polygons), projected.corners.shape[1]
    # Walk around each polygon from its highest corner, the way it runs.
    highest = least_of_four((lines << 2) + np.arange(4)[:, None]) & 3
    walk = (highest + np.arange(4)[:, None]) & 3
    walk *= count
    walk += np.arange(count)
    line = np.take(lines, walk)

    def side(turn: Side, corners: list[int]) -> Edges:
        descends = np.zeros((count, 4), np.bool_)
        for step, (upper, lower) in enumerate(pairwise(corners)):
            np.less(line[upper], line[lower], out=descends[:, step])
        places = np.flatnonzero(descends)
        row = places >> 2
        top, polygon = (highest[row] + turn * (places & 3)) & 3, polygons[row]
        return edges(projected, top * all_polygons + polygon, ((top + turn) & 3) * all_polygons + polygon)

    return side(DOWN_SIDE, [0, 1, 2, 3]), side(UP_SIDE, [0, 3, 2, 1])


def edges_on_lines(
    projected: Projection, polygons: Indices, lines: Indices, side: Side
) -> tuple[Indices, Indices]:
    """The top and the bottom corner of the edge of a side that crosses a line of each polygon.

    Each polygon must cross its line.
    """
    count = projected.corners.shape[1]
    # Look up the top corner by the corners that lie at or above the line.
    corners = np.take(projected.corners, polygons, axis=1)
    above = projected.first_line.take(corners) <= lines
    way = np.packbits(above, axis=0, bitorder="little")[0]
    top = TOP_CORNERS[side].take(way)
    return top * count + polygons, ((top + side) & 3) * count + polygons


@dataclass(frozen=True, eq=False)
class Extents:
    """Extents of polygons on lines; every array is (extents,), and every extent covers the center of a pixel.

    `row` is the place of the polygon among the given polygons. An extent covers `count` elements of its
    `line` from `first` on. The inverse depth is `start` at the center of the first element, and changes by
    `step` to the next.
    """

    row: Indices
    line: Indices
    first: Indices
    count: Indices
    start: Floats
    step: Floats


def extents_of_polygons(projected: Projection, polygons: Indices) -> Extents:
    """The extents of some polygons of the projection, in the order of polygons and lines."""
    # Find the crossings; both sides have the same polygons and lines in the same order.
    down_edges, up_edges = edges_of_sides(projected, polygons)
    down_x, down_depth = _crossings(down_edges)
    up_x, up_depth = _crossings(up_edges)
    line = runs(down_edges.first_line, down_edges.count)
    row = np.repeat(np.arange(len(polygons)), projected.line_counts.take(polygons))

    # Pair the crossings, and select the pairs that cover the center of a pixel: left <= center < right.
    first = _first_center(np.minimum(down_x, up_x), projected.elements)
    end = _first_center(np.maximum(down_x, up_x), projected.elements)
    pairs = np.flatnonzero(end > first)
    first, end = first.take(pairs), end.take(pairs)
    down_x, up_x = down_x.take(pairs), up_x.take(pairs)
    down_depth, up_depth = down_depth.take(pairs), up_depth.take(pairs)

    # Step the depth from the left whichever way the polygon runs, so that coincident polygons of opposite
    # winding are equally near.
    step = (up_depth - down_depth) / (up_x - down_x)
    start = np.where(down_x <= up_x, down_depth, up_depth)
    start += (first + 0.5 - np.minimum(down_x, up_x)) * step
    return Extents(row.take(pairs), line.take(pairs), first, end - first, start, step)


def _crossings(edges: Edges) -> tuple[Floats, Floats]:
    """The screen x and the inverse depth where lines cross the edges of a side, (crossings,) each."""
    lines_below = runs(np.zeros_like(edges.count), edges.count).astype(np.float64)
    x = lines_below * np.repeat(edges.x_step, edges.count)
    x += np.repeat(edges.x, edges.count)
    inverse_depth = lines_below * np.repeat(edges.inverse_depth_step, edges.count)
    inverse_depth += np.repeat(edges.inverse_depth, edges.count)
    return x, inverse_depth


def _first_center(x: Floats, elements: int) -> Indices:
    """The first element whose center is at x or right of it, 0 to `elements`."""
    return np.clip(np.ceil(x - 0.5), 0, elements).astype(np.intp)
