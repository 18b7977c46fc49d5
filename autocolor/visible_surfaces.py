"""Watkins' scan-line algorithm for all lines at once: which polygon is seen at each pixel, and where.

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

import numpy as np
import numpy.typing as npt

from autocolor.depth import DepthScale, depth_scale
from autocolor.edges import DOWN_SIDE, UP_SIDE, Edges, edges_of_side
from autocolor.mesh import Mesh
from autocolor.projection import Projection, projection
from autocolor.seen import Seen
from autocolor.segments import seen_of_spans
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
    scale = depth_scale(projected)
    front = np.zeros(lines * elements, np.int64)
    # Number the spans from 1, for 0 is where nothing is seen.
    down_tops, up_tops, beyond = [np.zeros(1, np.int32)], [np.zeros(1, np.int32)], 1
    for first in range(0, projected.corners.shape[1], POLYGONS_AT_ONCE):
        spans = spans_of_polygons(projected, scale, first, first + POLYGONS_AT_ONCE)
        keep_front_most(front, spans, beyond)
        down_tops.append(spans.down_top)
        up_tops.append(spans.up_top)
        beyond += len(spans.count)
    span_at_pixel = front & (scale.span_limit - 1)
    return seen_of_spans(
        span_at_pixel,
        np.concatenate(down_tops),
        np.concatenate(up_tops),
        projected,
        mesh,
        view,
        surface_numbers,
        one_sided,
    )


@dataclass(frozen=True, eq=False)
class Spans:
    """What lies between two edges of a polygon on a line; every array is (spans,).

    The span's pixels are `first_pixel`, flat and line by line, and those after it, `count` in all. The depth
    key is `start` + k `step` at pixel k of the span, int64. `down_top` and `up_top` are the tops of the edges
    that bound it, on the side where the polygon runs down the raster and on the other.
    """

    first_pixel: Numbers
    count: Numbers
    start: npt.NDArray[np.int64]
    step: npt.NDArray[np.int64]
    down_top: npt.NDArray[np.int32]
    up_top: npt.NDArray[np.int32]


def spans_of_polygons(projected: Projection, scale: DepthScale, first: int, beyond: int) -> Spans:
    """The spans of the polygons from `first` to before `beyond`, by polygon and line.

    Those that hold no pixel's center are left out.
    """
    # Cut the edges; the rows of both sides are the same polygons and lines.
    line, down_across, down_depth, down_top = _cuts(edges_of_side(projected, DOWN_SIDE, first, beyond))
    _, up_across, up_depth, up_top = _cuts(edges_of_side(projected, UP_SIDE, first, beyond))

    # Keep the spans that hold a pixel's center: left <= center < right.
    begin = _first_center(np.minimum(down_across, up_across), projected.elements)
    end = _first_center(np.maximum(down_across, up_across), projected.elements)
    kept = np.flatnonzero(end > begin)
    begin, down_across, down_depth = begin[kept], down_across[kept], down_depth[kept]

    # Step the depth from the first of them on.
    step = (up_depth[kept] - down_depth) / (up_across[kept] - down_across)
    start = down_depth + (begin + 0.5 - down_across) * step
    return Spans(
        line[kept] * projected.elements + begin,
        end[kept] - begin,
        scale.keys(start),
        scale.keys(step),
        down_top[kept],
        up_top[kept],
    )


def _cuts(cut: Edges) -> tuple[Numbers, Floats, Floats, npt.NDArray[np.int32]]:
    """Where the lines cut the edges of one side: the line, the place across, the inverse depth, the top."""
    start = np.repeat(np.cumsum(cut.count) - cut.count, cut.count)
    step = np.arange(len(start)) - start
    line = np.repeat(cut.first_line, cut.count) + step
    across = np.repeat(cut.across, cut.count) + step * np.repeat(cut.across_step, cut.count)
    inverse_depth = np.repeat(cut.inverse_depth, cut.count)
    inverse_depth += step * np.repeat(cut.inverse_depth_step, cut.count)
    return line, across, inverse_depth, np.repeat(cut.top.astype(np.int32), cut.count)


def _first_center(across: Floats, elements: int) -> Numbers:
    """The first element whose center is at or right of a place, 0 to `elements`."""
    return np.clip(np.ceil(across - 0.5), 0, elements).astype(np.intp)


def keep_front_most(front: npt.NDArray[np.int64], spans: Spans, first_number: int) -> None:
    """Keep in `front`, (lines * elements,), the largest depth key of each pixel with the span's number.

    So the nearest span is kept, and the last of those that are equally near.
    """
    beyond = np.cumsum(spans.count)
    begin = beyond - spans.count
    keys = spans.start + np.arange(first_number, first_number + len(begin))
    # What a running sum must add from the last fragment of a span to the first of the next.
    key_jump, pixel_jump = keys.copy(), spans.first_pixel.copy()
    key_jump[1:] -= keys[:-1] + (spans.count[:-1] - 1) * spans.step[:-1]
    pixel_jump[1:] -= spans.first_pixel[:-1] + spans.count[:-1] - 1
    cut = 0
    while cut < len(beyond):
        # Take the spans of about as many fragments as the caches hold.
        base = int(begin[cut])
        taken = slice(cut, max(cut + 1, int(np.searchsorted(beyond, base + FRAGMENTS_AT_ONCE))))
        cut = taken.stop
        heads = begin[taken] - base
        # Step along all of them in one running sum, which in whole numbers is exact.
        key = np.repeat(spans.step[taken], spans.count[taken])
        key[heads] = key_jump[taken]
        key[0] = keys[taken.start]
        pixel = np.ones(len(key), np.intp)
        pixel[heads] = pixel_jump[taken]
        pixel[0] = spans.first_pixel[taken.start]
        np.maximum.at(front, np.cumsum(pixel, out=pixel), np.cumsum(key, out=key))
