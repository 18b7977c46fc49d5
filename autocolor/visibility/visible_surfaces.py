"""Watkins' scan-line algorithm for all lines at once: which polygon is seen at each pixel.

Paper: "Introduction", [3, 21]. The steps are those of the literal algorithm in `watkins`, each done for all
lines before the next: edges are cut by the lines, the two cuts of a polygon on a line bound a span, and the
front-most span is kept at every pixel. The two see the same polygon at every pixel, and tests hold that.

Measured and rejected: sorting the fragments (argsort and reduceat 7 times, lexsort 37 times the time of
`np.maximum.at`), a loop over the lines (12 times), points in object space (twice the whole frame), depths as
floats (twice the passes over the fragments), scattering the cuts to their rows (twice the time of walking
round the polygons in the order of the rows).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from autocolor.arrays import Floats, Integers, Numbers, chunks, chunks_of_runs, runs
from autocolor.scene.mesh import Mesh
from autocolor.scene.view import View
from autocolor.visibility.culling import not_hidden
from autocolor.visibility.depth import DepthScale, depth_scale
from autocolor.visibility.edges import Edges, edges_of_sides
from autocolor.visibility.interpolation import seen_of_spans
from autocolor.visibility.projection import Projection, projection
from autocolor.visibility.visible_points import Seen

POLYGONS_AT_ONCE: Final = 1 << 15
FRAGMENTS_AT_ONCE: Final = 1 << 16


def visible_surfaces(
    mesh: Mesh,
    view: View,
    surface_numbers: tuple[int, ...],
    lines: int = 480,
    elements: int = 640,
    one_sided: frozenset[int] = frozenset(),
) -> Seen:
    """What is seen at each pixel.

    `surface_numbers` has the surface number of each part of the mesh; `one_sided` are the surface numbers
    whose normals do not turn to the eye on polygons seen from behind.
    """
    projected = projection(mesh, view, lines, elements)
    scale = depth_scale(projected)
    front = np.zeros(lines * elements, np.int64)
    tops = np.zeros((2, scale.span_limit), np.int32)
    # Most polygons that are seen from behind are hidden by those that are not.
    keep_front_most(front, tops, projected, scale, np.flatnonzero(~projected.from_behind))
    behind = not_hidden(front, projected, scale, np.flatnonzero(projected.from_behind))
    keep_front_most(front, tops, projected, scale, behind)
    # Of the keys keep the numbers of the spans.
    front &= scale.span_limit - 1
    return seen_of_spans(front, tops, projected, mesh, view, surface_numbers, one_sided)


def keep_front_most(
    front: Integers,
    tops: NDArray[np.int32],
    projected: Projection,
    scale: DepthScale,
    columns: Numbers,
) -> None:
    """Keep in `front`, (lines * elements,), the largest depth key of each pixel with the span's number.

    The polygons are those in the columns of the projection. Keys and numbers of spans leave the nearest span
    at each pixel, and of those that are equally near the last. `tops` gets, by the numbers of the spans, the
    tops of their edges on the down side and on the up side.
    """
    for some in chunks(len(columns), POLYGONS_AT_ONCE):
        spans = spans_of_polygons(projected, scale, columns[some])
        tops[0][spans.number] = spans.down_top
        tops[1][spans.number] = spans.up_top
        # Step the keys over the pixels of each span, and keep the largest at each pixel.
        keys = spans.start + spans.number
        for part, _ in chunks_of_runs(spans.count, FRAGMENTS_AT_ONCE):
            count = spans.count[part]
            pixel = runs(spans.first_pixel[part], count)
            np.maximum.at(front, pixel, runs(keys[part], count, spans.step[part]))


@dataclass(frozen=True, eq=False)
class Spans:
    """What lies between two edges of a polygon on a line; every array is (spans,).

    A span's `number` is that of its crossing of polygon and line, counted from 1. Its pixels are
    `first_pixel`, flat and line by line, and those after it, `count` in all. The depth key is `start` + k
    `step` at pixel k of the span, int64. `down_top` and `up_top` are the tops of the edges that bound it, on
    the side where the polygon runs down the raster and on the other.
    """

    number: Numbers
    first_pixel: Numbers
    count: Numbers
    start: Integers
    step: Integers
    down_top: NDArray[np.int32]
    up_top: NDArray[np.int32]


def spans_of_polygons(projected: Projection, scale: DepthScale, columns: Numbers) -> Spans:
    """The spans of the polygons in some columns of the projection, by polygon and line.

    Those that hold no pixel's center are left out.
    """
    # Cut the edges; the rows of both sides are the same polygons and lines.
    down_edges, up_edges = edges_of_sides(projected, columns)
    down_across, down_depth, down_top = _cuts(down_edges)
    up_across, up_depth, up_top = _cuts(up_edges)
    line = runs(down_edges.first_line, down_edges.count)
    first_crossing = projected.first_crossing[columns]
    number = runs(first_crossing + 1, projected.first_crossing[columns + 1] - first_crossing)

    # Pair the cuts to spans, and keep those that hold a pixel's center: left <= center < right.
    begin = _first_center(np.minimum(down_across, up_across), projected.elements)
    end = _first_center(np.maximum(down_across, up_across), projected.elements)
    kept = np.flatnonzero(end > begin)
    begin, end = begin.take(kept), end.take(kept)
    down_across, up_across = down_across.take(kept), up_across.take(kept)
    down_depth, up_depth = down_depth.take(kept), up_depth.take(kept)

    # Step the depth from the left, whichever way the polygon runs, so that twins are equally near.
    step = (up_depth - down_depth) / (up_across - down_across)
    start = np.where(down_across <= up_across, down_depth, up_depth)
    start += (begin + 0.5 - np.minimum(down_across, up_across)) * step
    return Spans(
        number.take(kept),
        line.take(kept) * projected.elements + begin,
        end - begin,
        scale.keys(start),
        scale.keys(step),
        down_top.take(kept),
        up_top.take(kept),
    )


def _cuts(cut: Edges) -> tuple[Floats, Floats, NDArray[np.int32]]:
    """Where the lines cut the edges of one side: the place across, the inverse depth, the edge's top."""
    step = runs(np.zeros_like(cut.count), cut.count).astype(np.float64)
    across = step * np.repeat(cut.across_step, cut.count)
    across += np.repeat(cut.across, cut.count)
    inverse_depth = step * np.repeat(cut.inverse_depth_step, cut.count)
    inverse_depth += np.repeat(cut.inverse_depth, cut.count)
    return across, inverse_depth, np.repeat(cut.top.astype(np.int32), cut.count)


def _first_center(across: Floats, elements: int) -> Numbers:
    """The first element whose center is at or right of a place, 0 to `elements`."""
    return np.clip(np.ceil(across - 0.5), 0, elements).astype(np.intp)
