"""The visible segments of the lines, and what is linear along them.

Paper: "The Lighting Model": the direction of the normal is computed from the node normals by bilinear
interpolation, along the edges and then along the span. Departs: on the screens of 1983 that was linear in
the picture; here it is right in perspective: halfway on the surface between two nodes, and not halfway in the
picture, the normal is halfway between theirs.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from autocolor.arrays import Bytes, Floats, Integers, Numbers, Singles, chunks
from autocolor.scene.mesh import Mesh
from autocolor.scene.view import View
from autocolor.visibility.edges import DOWN_SIDE, UP_SIDE, Side, edges, other_end
from autocolor.visibility.projection import Projection, focal_length

# Rows of what is stepped along a segment: the point, the normal, the inverse depth, the ray.
POINTS: Final = slice(0, 3)
NORMALS: Final = slice(3, 6)
DEPTH: Final = 6
RAY: Final = slice(7, 10)

SEGMENTS_AT_ONCE: Final = 1 << 14


@dataclass(frozen=True, eq=False)
class Segments:
    """Pixels beside each other that see the same polygon, sorted by surface.

    Within a surface they are in the order of the polygons, so that what is looked up for one lies near what
    the next one needs; but where several see one span, all but the last of them stand at the end.

    The pixels of a segment are `first_pixel`, flat in the raster, and those after it, `count` in all.
    `polygon` are rows of the polygon table, `surface` numbers. `down_top` and `up_top` are the tops of the
    edges between which the polygon is seen, `column` its column in the projection.
    """

    first_pixel: Numbers
    count: Numbers
    column: Numbers
    polygon: Numbers
    surface: Bytes
    down_top: Numbers
    up_top: Numbers


class Cut(NamedTuple):
    """Where edges are cut, in pixels; with the inverse depth there, and the normal, (3, edges) float32."""

    across: Floats
    inverse_depth: Floats
    normal: Singles


def visible_segments(
    span_at_pixel: Integers,
    tops: NDArray[np.int32],
    projected: Projection,
    mesh: Mesh,
    surface_numbers: tuple[int, ...],
) -> Segments:
    """The segments that are seen.

    `span_at_pixel` has the number of the span that is seen at each pixel, (lines * elements,), 0 for none.
    `tops` has, by those numbers, the tops of the two edges that bound each span: (2, numbers).
    """
    head = np.ones(len(span_at_pixel), np.bool_)
    np.not_equal(span_at_pixel[1:], span_at_pixel[:-1], out=head[1:])
    first_pixel = np.flatnonzero(head)
    count = np.diff(first_pixel, append=len(span_at_pixel))
    span = span_at_pixel.take(first_pixel)
    by_span = _by_span(span, tops.shape[1])
    first_pixel, count = first_pixel.take(by_span), count.take(by_span)
    down_top, up_top = np.take(tops, span.take(by_span), axis=1).astype(np.intp)

    # Sort them by surface, so that each surface's D, S and N are numbers and not arrays.
    column = down_top % max(projected.corners.shape[1], 1)
    polygon = projected.polygon_numbers[column]
    surface = np.array(surface_numbers, np.uint8)[mesh.part_numbers[polygon]]
    order = np.argsort(surface, kind="stable")
    return Segments(
        first_pixel.take(order),
        count.take(order),
        column.take(order),
        polygon.take(order),
        surface.take(order),
        down_top.take(order),
        up_top.take(order),
    )


def _by_span(span: Integers, span_limit: int) -> Numbers:
    """The segments that see a span, in the order of the spans' numbers, which go polygon by polygon.

    Measured: with a million polygons it saves half of the time of `along_segments`; of that a sort would take
    back most.
    """
    # Number the segments from 1, for 0 is none; where several see one span its last one stays.
    segment = np.arange(1, len(span) + 1, dtype=np.int32)
    segment_of_span = np.zeros(span_limit, np.int32)
    segment_of_span[span] = segment
    segment_of_span[0] = 0
    last_ones = segment_of_span.take(np.flatnonzero(segment_of_span != 0))
    others = segment.compress((segment_of_span.take(span) != segment) & (span != 0))
    return np.concatenate([last_ones, others]).astype(np.intp) - 1


def along_segments(
    segments: Segments, projected: Projection, view: View, middle: Floats
) -> tuple[Singles, Singles]:
    """What is stepped along each segment: its value at the first pixel, and what each further pixel adds.

    The values are (10, segments) float32: the point around the middle and the normal, whose steps count in
    proportion to the depth; the inverse depth; and the ray, whose step is the same for all. The steps are
    (7, segments). The differences are taken here in float64, so that a point is as exact from afar as from
    near.
    """
    count = len(segments.count)
    start, step = np.empty((10, count), np.float32), np.empty((7, count), np.float32)
    focal = focal_length(projected.lines, view.field_of_view)
    for part in chunks(count, SEGMENTS_AT_ONCE):
        _fill_along(start[:, part], step[:, part], segments, part, projected, focal, middle)
    return start, step


def _fill_along(
    start: Singles,
    step: Singles,
    segments: Segments,
    part: slice,
    projected: Projection,
    focal: float,
    middle: Floats,
) -> None:
    """Fill the values and the steps of some of the segments."""
    line, element = np.divmod(segments.first_pixel[part], projected.elements)
    down = _cut(projected, segments.down_top[part], DOWN_SIDE, line)
    up = _cut(projected, segments.up_top[part], UP_SIDE, line)
    # The inverse depth is linear from the one cut to the other.
    width, offset = up.across - down.across, element + 0.5 - down.across
    depth_step = (up.inverse_depth - down.inverse_depth) / width
    inverse_depth = down.inverse_depth + depth_step * offset
    start[DEPTH], step[DEPTH] = inverse_depth, depth_step
    # The normal is not: it goes from the one cut to the other as fast as the points of the surface do.
    weight = offset / width * up.inverse_depth / inverse_depth
    rate = ((1 - weight) * up.inverse_depth + weight * down.inverse_depth) / width
    difference = up.normal - down.normal
    np.multiply(difference, rate.astype(np.float32), out=step[NORMALS])
    difference *= weight.astype(np.float32)
    np.add(down.normal, difference, out=start[NORMALS])

    # The point is the ray over the inverse depth; one pixel further the ray is `ray_step` more.
    ray = ((element + 0.5 - projected.elements / 2) / focal, (line + 0.5 - projected.lines / 2) / focal, 1.0)
    depth = 1 / inverse_depth
    for axis, ray_step in enumerate((1 / focal, 0.0, 0.0)):
        place = ray[axis] * depth
        start[axis] = place - middle[axis]
        step[axis] = ray_step - place * depth_step
        start[RAY.start + axis] = ray[axis]


def _cut(projected: Projection, top: Numbers, side: Side, line: Numbers) -> Cut:
    """Where each edge is cut by its line."""
    bottom = other_end(projected, top, side)
    edge = edges(projected, top, bottom)
    # The very numbers that the spans were made of: where a polygon is seen edge-on, others may not be a span.
    lines_below = line - edge.first_line
    across = edge.across + lines_below * edge.across_step
    inverse_depth = edge.inverse_depth + lines_below * edge.inverse_depth_step
    # Interpolate the normal right in perspective: weighted by the inverse depths of the ends.
    a, b, normals = edge.upper, edge.lower, projected.corner_normals.ravel()
    upper_place = projected.down.take(a)
    share = (line + 0.5 - upper_place) / (projected.down.take(b) - upper_place)
    top_weight, bottom_weight = (
        (1 - share) * projected.inverse_depth.take(a),
        share * projected.inverse_depth.take(b),
    )
    weight = (bottom_weight / (top_weight + bottom_weight)).astype(np.float32)
    # Measured: `take` along the second axis has a quarter of the time of an index there.
    normal = np.take(projected.normals, normals[top], axis=1)
    normal += weight * (np.take(projected.normals, normals[bottom], axis=1) - normal)
    return Cut(across, inverse_depth, normal)
