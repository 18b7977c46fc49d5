"""Extents: which pixels of a scan line a polygon covers, and its inverse depth along them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from autocolor.arrays import Floats, Indices, runs
from autocolor.visibility.edges import Edges, edges_of_sides
from autocolor.visibility.projection import Projection


@dataclass(frozen=True, eq=False)
class Extents:
    """Extents of polygons on lines, each with the center of a pixel; every array is (extents,).

    `row` is that of the polygon among those that were asked for. An extent covers `count` elements of its
    `line` from `first` on. The inverse depth is `start` at the center of the first, and changes by `step` to
    the next.
    """

    row: Indices
    line: Indices
    first: Indices
    count: Indices
    start: Floats
    step: Floats


def extents_of_polygons(projected: Projection, polygons: Indices) -> Extents:
    """The extents of some polygons of the projection, in the order of polygons and lines."""
    # Let the lines cross the edges; both sides have the same polygons and lines in the same order.
    down_edges, up_edges = edges_of_sides(projected, polygons)
    down_x, down_depth = _crossings(down_edges)
    up_x, up_depth = _crossings(up_edges)
    line = runs(down_edges.first_line, down_edges.count)
    row = np.repeat(np.arange(len(polygons)), projected.line_counts.take(polygons))

    # Pair the crossings, and keep the pairs that cover the center of a pixel: left <= center < right.
    first = _first_center(np.minimum(down_x, up_x), projected.elements)
    end = _first_center(np.maximum(down_x, up_x), projected.elements)
    kept = np.flatnonzero(end > first)
    first, end = first.take(kept), end.take(kept)
    down_x, up_x = down_x.take(kept), up_x.take(kept)
    down_depth, up_depth = down_depth.take(kept), up_depth.take(kept)

    # Step the depth from the left whichever way the polygon runs, so that coincident polygons of opposite
    # winding are equally near.
    step = (up_depth - down_depth) / (up_x - down_x)
    start = np.where(down_x <= up_x, down_depth, up_depth)
    start += (first + 0.5 - np.minimum(down_x, up_x)) * step
    return Extents(row.take(kept), line.take(kept), first, end - first, start, step)


def _crossings(edges: Edges) -> tuple[Floats, Floats]:
    """Where the lines cross the edges of one side: the screen x and the inverse depth."""
    lines_below = runs(np.zeros_like(edges.count), edges.count).astype(np.float64)
    x = lines_below * np.repeat(edges.x_step, edges.count)
    x += np.repeat(edges.x, edges.count)
    inverse_depth = lines_below * np.repeat(edges.inverse_depth_step, edges.count)
    inverse_depth += np.repeat(edges.inverse_depth, edges.count)
    return x, inverse_depth


def _first_center(x: Floats, elements: int) -> Indices:
    """The first element whose center is at x or right of it, 0 to `elements`."""
    return np.clip(np.ceil(x - 0.5), 0, elements).astype(np.intp)
