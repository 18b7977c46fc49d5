"""The visible segments of the lines, and from them what is seen at each pixel.

Paper: "The Lighting Model": the direction of the normal is computed from the node normals by bilinear
interpolation, along the edges and then along the span. Departs: on the screens of 1983 that was linear in
the picture; here it is right in perspective, by interpolating the normal times the inverse depth. Only the
direction matters, so the inverse depth never has to be divided out again.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from autocolor.edges import DOWN_SIDE, UP_SIDE, Side, other_end
from autocolor.mesh import Mesh
from autocolor.projection import Projection, focal_length
from autocolor.runs import runs
from autocolor.seen import (
    MIRROR,
    MIRROR_POINT,
    NORMAL,
    NORMAL_POINT,
    POINT,
    POINT_SQUARED,
    ROW_COUNT,
    Seen,
    surface_slices,
)
from autocolor.view import View

PIXELS_AT_ONCE = 1 << 14

# Rows of what is stepped along a segment: the point, the normal, the inverse depth.
POINTS, NORMALS, DEPTH, RAY = slice(0, 3), slice(3, 6), 6, slice(7, 10)
# Rows of where an edge is cut: the place across, the inverse depth, the normal times the inverse depth.
ACROSS, CUT_DEPTH, CUT_NORMAL = 0, 1, slice(2, 5)

Singles = npt.NDArray[np.float32]
Floats = npt.NDArray[np.float64]
Numbers = npt.NDArray[np.intp]


class Segments(NamedTuple):
    """Pixels beside each other that see the same span: the first, and the tops of the span's two edges."""

    first_pixel: Numbers
    down_top: Numbers
    up_top: Numbers


class Cut(NamedTuple):
    """Where edges are cut, in pixels; with the inverse depth there, and the normal, (3, edges) float32."""

    across: Floats
    inverse_depth: Floats
    normal: Singles


def seen_of_spans(
    span_at_pixel: npt.NDArray[np.int64],
    tops: npt.NDArray[np.int32],
    projected: Projection,
    mesh: Mesh,
    view: View,
    surface_numbers: tuple[int, ...],
    one_sided: frozenset[int],
) -> Seen:
    """What is seen, computed for the visible pixels only.

    `span_at_pixel` has the number of the span that is seen at each pixel, (lines * elements,), 0 for none.
    `tops` has, by those numbers, the tops of the two edges that bound each span: (2, numbers).
    """
    # Find the segments: pixels beside each other that see the same span.
    head = np.ones(len(span_at_pixel), np.bool_)
    np.not_equal(span_at_pixel[1:], span_at_pixel[:-1], out=head[1:])
    first_pixel = np.flatnonzero(head)
    count = np.diff(first_pixel, append=len(span_at_pixel))
    filled = np.flatnonzero(span_at_pixel[first_pixel])
    first_pixel, count = first_pixel[filled], count[filled]

    # Sort them by surface, so that each surface's D, S and N are numbers and not arrays.
    down_top, up_top = np.take(tops, span_at_pixel[first_pixel], axis=1).astype(np.intp)
    column = down_top % max(projected.corners.shape[1], 1)
    surface = np.array(surface_numbers, np.uint8)[mesh.part_numbers[projected.polygon_numbers[column]]]
    order = np.argsort(surface, kind="stable")
    first_pixel, count, column, surface = first_pixel[order], count[order], column[order], surface[order]

    # Make ready what is linear along them.
    low, high = mesh.bounds
    middle = view.axes @ ((low + high) / 2 - np.array(view.eye)) / projected.unit
    segments = Segments(first_pixel, down_top[order], up_top[order])
    start, step = _along_segments(segments, projected, view, middle)
    # Turn to the eye the normals of polygons that are seen from behind.
    turned = np.flatnonzero(projected.from_behind[column] & ~np.isin(surface, list(one_sided)))
    start[NORMALS, turned] *= -1
    step[NORMALS, turned] *= -1

    # Step along them.
    pixels, along = runs(first_pixel, count), runs(np.zeros_like(count), count).astype(np.float32)
    rows = np.empty((ROW_COUNT, len(pixels)), np.float32)
    ray_step = np.float32(1 / focal_length(projected.lines, view.field_of_view))
    beyond = np.cumsum(count)
    cut = 0
    while cut < len(beyond):
        base = int(beyond[cut] - count[cut])
        part = slice(cut, max(cut + 1, int(np.searchsorted(beyond, base + PIXELS_AT_ONCE))))
        cut = part.stop
        some = slice(base, int(beyond[cut - 1]))
        start_here, step_here = (np.repeat(table[:, part], count[part], axis=1) for table in (start, step))
        _fill(rows[:, some], start_here, step_here, along[some], ray_step)

    for table in (rows, pixels):
        table.flags.writeable = False
    return Seen(
        projected.lines,
        projected.elements,
        pixels,
        surface_slices(np.bincount(surface, count, 1).astype(np.int64)),
        projected.polygon_numbers[column],
        count,
        rows,
        view,
        projected.unit,
        middle,
    )


def _fill(rows: Singles, start: Singles, step: Singles, along: Singles, ray_step: np.float32) -> None:
    """Fill the rows of some pixels from what is linear along their segments."""
    # Place the point: it goes along the segment as `along` over the inverse depth does.
    inverse_depth = step[DEPTH] * along
    inverse_depth += start[DEPTH]
    np.divide(along, inverse_depth, out=inverse_depth)
    step[POINTS] *= inverse_depth
    np.add(start[POINTS], step[POINTS], out=rows[POINT])
    # Make the normal a unit vector.
    step[NORMALS] *= along
    normal = rows[NORMAL]
    np.add(start[NORMALS], step[NORMALS], out=normal)
    length = np.sqrt(_products(normal, normal))
    # A polygon without area has a normal of 0, and keeps it.
    length += np.float32(1e-30)
    normal *= np.reciprocal(length, out=length)
    # Make the ray a unit vector.
    ray = start[RAY]
    ray[0] += along * ray_step
    np.sqrt(_products(ray, ray), out=length)
    ray *= np.reciprocal(length, out=length)
    # Mirror the ray to the eye: M = 2 (N.V) N - V, where V is the ray the other way round.
    facing = _products(normal, ray)
    facing *= np.float32(-2)
    np.multiply(normal, facing, out=rows[MIRROR])
    rows[MIRROR] += ray
    # Keep the products with the point.
    for vector, product in ((POINT, POINT_SQUARED), (NORMAL, NORMAL_POINT), (MIRROR, MIRROR_POINT)):
        _products(rows[vector], rows[POINT], out=rows[product])


def _products(one: Singles, other: Singles, out: Singles | None = None) -> Singles:
    """The products of two rows of vectors, (3, n) each."""
    products: Singles = np.einsum("ij,ij->j", one, other, out=out)
    return products


def _along_segments(
    segments: Segments, projected: Projection, view: View, middle: Floats
) -> tuple[Singles, Singles]:
    """What is stepped along each segment: its value at the first pixel, and what each further pixel adds.

    The values are (10, segments) float32: the point around the middle, which is stepped in proportion to the
    depth; the normal times the inverse depth, to a scale; the inverse depth; and the ray, whose step is
    the same for all. The steps are (7, segments). The differences are taken here in float64, so that a point
    is as exact from afar as from near.
    """
    line, element = np.divmod(segments.first_pixel, projected.elements)
    down = _cut(projected, segments.down_top, DOWN_SIDE, line)
    up = _cut(projected, segments.up_top, UP_SIDE, line)
    # The inverse depth is linear from the one cut to the other.
    width, offset = up.across - down.across, element + 0.5 - down.across
    depth_step = (up.inverse_depth - down.inverse_depth) / width
    inverse_depth = down.inverse_depth + depth_step * offset
    start, step = np.empty((10, len(line)), np.float32), np.empty((7, len(line)), np.float32)
    start[DEPTH], step[DEPTH] = inverse_depth, depth_step
    # So is the normal times the inverse depth, here to a scale of about 1, which float32 holds from afar too.
    both = down.inverse_depth + up.inverse_depth
    for cut in (down, up):
        cut.normal[...] *= (cut.inverse_depth / both).astype(np.float32)
    np.divide(up.normal - down.normal, width.astype(np.float32), out=step[NORMALS])
    np.add(down.normal, step[NORMALS] * offset.astype(np.float32), out=start[NORMALS])

    # The point is the ray over the inverse depth; one pixel further the ray is `ray_step` more.
    focal = focal_length(projected.lines, view.field_of_view)
    ray = ((element + 0.5 - projected.elements / 2) / focal, (line + 0.5 - projected.lines / 2) / focal, 1.0)
    depth = 1 / inverse_depth
    for axis, ray_step in enumerate((1 / focal, 0.0, 0.0)):
        place = ray[axis] * depth
        start[axis] = place - middle[axis]
        step[axis] = ray_step - place * depth_step
        start[RAY.start + axis] = ray[axis]
    return start, step


def _cut(projected: Projection, top: Numbers, side: Side, line: Numbers) -> Cut:
    """Where each edge is cut by its line."""
    bottom = other_end(projected, top, side)
    corners, normals = projected.corners.ravel(), projected.corner_normals.ravel()
    a, b = corners[top], corners[bottom]
    across, inverse_depth, height = projected.across[a], projected.inverse_depth[a], projected.down[a]
    way = (line + 0.5 - height) / (projected.down[b] - height)
    bottom_depth = projected.inverse_depth[b]
    # Interpolate the normal right in perspective: weighted by the inverse depths.
    weight = way * bottom_depth / (way * bottom_depth + (1 - way) * inverse_depth)
    # Measured: `take` along the second axis has a quarter of the time of an index there.
    normal = np.take(projected.normals, normals[top], axis=1)
    normal += weight.astype(np.float32) * (np.take(projected.normals, normals[bottom], axis=1) - normal)
    return Cut(
        across + way * (projected.across[b] - across),
        inverse_depth + way * (bottom_depth - inverse_depth),
        normal,
    )
