"""Watkins' scan-line algorithm for all lines at once: which polygon is seen at each pixel, and where.

Paper: "Introduction", [3, 21]. The steps are those of the literal algorithm in `watkins`, each done for all
lines before the next: edges are cut by the lines, the two cuts of a polygon on a line bound a span, and the
front-most span is kept at every pixel. The two see the same polygon at every pixel, and tests hold that.

Measured and rejected: sorting the fragments (argsort and reduceat 7 times, lexsort 37 times the time of
`np.maximum.at`), a loop over the lines (12 times), points in object space (twice the whole frame).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from autocolor.edges import edges
from autocolor.mesh import Mesh
from autocolor.projection import Projection, projection
from autocolor.seen import Seen, Winners, seen_of_winners
from autocolor.view import View

POLYGONS_AT_ONCE = 4096
FRAGMENTS_AT_ONCE = 1 << 16

Floats = npt.NDArray[np.float64]
Numbers = npt.NDArray[np.intp]


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
    front = np.zeros(lines * elements, np.int64)
    chunks: list[Spans] = []
    span_count = 0
    for first in range(0, projected.corners.shape[1], POLYGONS_AT_ONCE):
        spans = spans_of_polygons(projected, first, first + POLYGONS_AT_ONCE)
        keep_front_most(front, spans, span_count)
        chunks.append(spans)
        span_count += len(spans.count)
    winners = winning_spans(front, chunks, span_count)
    return seen_of_winners(winners, projected, mesh, view, surface_numbers, one_sided)


@dataclass(frozen=True, eq=False)
class Spans:
    """What lies between two edges of a polygon on a line; every array is (spans,).

    The span's pixels are `first_pixel`, flat and line by line, and those after it, `count` in all. The
    inverse depth is `start` + k `step` at pixel k of the span. `left_edge` and `right_edge` bound it.
    """

    first_pixel: Numbers
    count: Numbers
    start: npt.NDArray[np.float32]
    step: npt.NDArray[np.float32]
    left_edge: npt.NDArray[np.int32]
    right_edge: npt.NDArray[np.int32]


def spans_of_polygons(projected: Projection, first: int, beyond: int) -> Spans:
    """The spans of the polygons from `first` to before `beyond`, by polygon and line.

    Those that hold no pixel's center are left out.
    """
    first_lines = projected.first_line[projected.corners[:, first:beyond]]
    top_line, bottom_line = first_lines.min(axis=0), first_lines.max(axis=0)
    height = bottom_line - top_line
    # The cuts of (polygon, line) stand in row base[polygon] + line.
    base = np.cumsum(height) - height - top_line

    # Cut the edges: those that go down the raster are one side of a polygon, those that go up the other.
    following = np.roll(first_lines, -1, axis=0)
    down_side = _cuts(projected, first, first_lines < following, base, int(height.sum()))
    up_side = _cuts(projected, first, first_lines > following, base, int(height.sum()))

    # Pair the cuts to spans from left to right.
    line = np.arange(int(height.sum())) - np.repeat(base, height)
    swapped = down_side[0] > up_side[0]
    left, left_depth, left_edge = (
        np.where(swapped, up, down) for down, up in zip(down_side, up_side, strict=True)
    )
    right, right_depth, right_edge = (
        np.where(swapped, down, up) for down, up in zip(down_side, up_side, strict=True)
    )

    # Keep the spans that hold a pixel's center: left <= center < right.
    begin = np.clip(np.ceil(left - 0.5), 0, projected.elements).astype(np.intp)
    end = np.clip(np.ceil(right - 0.5), 0, projected.elements).astype(np.intp)
    kept = np.flatnonzero(end > begin)
    left, right, left_depth, begin = left[kept], right[kept], left_depth[kept], begin[kept]
    step = (right_depth[kept] - left_depth) / (right - left)
    start = left_depth + (begin + 0.5 - left) * step
    return Spans(
        line[kept] * projected.elements + begin,
        end[kept] - begin,
        start.astype(np.float32),
        step.astype(np.float32),
        left_edge[kept].astype(np.int32),
        right_edge[kept].astype(np.int32),
    )


def _cuts(
    projected: Projection, first: int, chosen: npt.NDArray[np.bool_], base: Numbers, rows: int
) -> tuple[Floats, Floats, Numbers]:
    """Where the lines cut the chosen edges of polygons from `first` on, by row.

    They are the place across, the inverse depth and the number of the edge.
    """
    corner, column = np.nonzero(chosen)
    edge = corner * projected.corners.shape[1] + first + column
    cut = edges(projected, edge)
    across, inverse_depth, edge_numbers = np.empty(rows), np.empty(rows), np.empty(rows, np.intp)

    # Step every edge from its first line to its last.
    before = np.repeat(np.cumsum(cut.count) - cut.count, cut.count)
    step = np.arange(len(before)) - before
    row = np.repeat(np.arange(len(edge)), cut.count)
    place = (base[column] + cut.first_line)[row] + step
    across[place] = cut.across[row] + step * cut.across_step[row]
    inverse_depth[place] = cut.inverse_depth[row] + step * cut.inverse_depth_step[row]
    edge_numbers[place] = edge[row]
    return across, inverse_depth, edge_numbers


def keep_front_most(front: npt.NDArray[np.int64], spans: Spans, first_number: int) -> None:
    """Keep in `front`, (lines * elements,), the largest key of each pixel; 0 where there is none.

    A key is the inverse depth over the number of the span. The bits of positive floats are ordered as the
    floats are, so the largest key is the nearest span, and the last of those that are equally near.
    """
    beyond = np.cumsum(spans.count)
    cut = 0
    while cut < len(beyond):
        # Take the spans of about as many fragments as the caches hold.
        taken = slice(
            cut,
            max(cut + 1, int(np.searchsorted(beyond, (beyond[cut - 1] if cut else 0) + FRAGMENTS_AT_ONCE))),
        )
        cut = taken.stop
        count = spans.count[taken]
        fragments = int(count.sum())
        along = np.arange(fragments) - np.repeat(np.cumsum(count) - count, count)
        nearness = np.repeat(spans.start[taken], count)
        nearness += along.astype(np.float32) * np.repeat(spans.step[taken], count)
        keys = nearness.view(np.int32).astype(np.int64)
        keys <<= 32
        keys |= np.repeat(np.arange(taken.start, taken.stop) + first_number, count)
        along += np.repeat(spans.first_pixel[taken], count)
        np.maximum.at(front, along, keys)


def winning_spans(front: npt.NDArray[np.int64], chunks: list[Spans], span_count: int) -> Winners:
    """The spans that are seen anywhere, and which of them is seen at each pixel."""
    pixels = np.flatnonzero(front)
    keys = front[pixels]
    span = keys & 0xFFFFFFFF
    won = np.zeros(span_count, np.bool_)
    won[span] = True
    spans = np.flatnonzero(won)
    number = np.empty(span_count, np.intp)
    number[spans] = np.arange(len(spans))

    def column(name: str) -> npt.NDArray[np.intp]:
        whole = np.concatenate([getattr(chunk, name) for chunk in chunks] or [np.empty(0, np.intp)])
        return whole[spans].astype(np.intp)

    return Winners(
        pixels,
        (keys >> 32).astype(np.int32).view(np.float32),
        number[span],
        column("first_pixel"),
        column("left_edge"),
        column("right_edge"),
    )
