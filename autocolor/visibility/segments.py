"""Segments: the extent of a polygon on a scan line, between two of its edges."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from autocolor.arrays import Floats, Indices, Numbers, runs
from autocolor.visibility.depth import DepthScale, numbers_of_polygons, plane_keys
from autocolor.visibility.edges import Edges, edges_of_sides
from autocolor.visibility.projection import Projection


@dataclass(frozen=True, eq=False)
class Segments:
    """Segments that cover the center of a pixel; every array is (segments,).

    `number` is that of the polygon, as keys have it. A segment covers `count` pixels from `first_pixel` on, a
    flat place in the raster. Its depth key is `start` + k `step` at its pixel k, int64.
    """

    number: Numbers
    first_pixel: Indices
    count: Indices
    start: Numbers
    step: Numbers


def segments_of_polygons(projected: Projection, scale: DepthScale, polygons: Indices) -> Segments:
    """The segments of some polygons of the projection, in the order of polygons and lines."""
    # Let the lines cross the edges; both sides have the same polygons and lines in the same order.
    down_edges, up_edges = edges_of_sides(projected, polygons)
    down_x, down_depth = _crossings(down_edges)
    up_x, up_depth = _crossings(up_edges)
    line = runs(down_edges.first_line, down_edges.count)
    number = np.repeat(numbers_of_polygons(projected, polygons), projected.line_counts.take(polygons))

    # Pair the crossings to segments, and keep those that cover the center of a pixel: left <= center < right.
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
    found = Segments(
        number.take(kept),
        line.take(kept) * projected.elements + first,
        end - first,
        scale.keys(start),
        scale.keys(step),
    )
    planes = None if scale.planes is None else scale.planes.take(polygons)
    if planes is not None and planes.max(initial=-1) >= 0:
        # Let the polygons of a shared plane have its depth.
        plane = np.repeat(planes, projected.line_counts.take(polygons)).take(kept)
        row = np.flatnonzero(plane >= 0)
        found.start[row], found.step[row] = plane_keys(
            projected, scale, plane[row], line.take(kept[row]), first[row]
        )
    return found


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
