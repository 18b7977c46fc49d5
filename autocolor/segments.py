"""The visible segments of the lines, and from them what is seen at each pixel.

Paper: "The Lighting Model": the direction of the normal is computed from the node normals by bilinear
interpolation, along the edges and then along the span. Departs: on the screens of 1983 that was linear in
the picture; here it is right in perspective, by interpolating the normal times the inverse depth. Only the
direction matters, so the inverse depth never has to be divided out again.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from autocolor.edges import DOWN_SIDE, UP_SIDE, Side, other_end
from autocolor.mesh import Mesh
from autocolor.projection import Projection, lens
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
POINTS, NORMALS, DEPTH = slice(0, 3), slice(3, 6), 6
# Rows of where an edge is cut: the place across, the inverse depth, the normal times the inverse depth.
ACROSS, CUT_DEPTH, CUT_NORMAL = 0, 1, slice(2, 5)

Singles = npt.NDArray[np.float32]
Floats = npt.NDArray[np.float64]
Numbers = npt.NDArray[np.intp]


def seen_of_spans(
    span_at_pixel: npt.NDArray[np.int64],
    down_tops: npt.NDArray[np.int32],
    up_tops: npt.NDArray[np.int32],
    projected: Projection,
    mesh: Mesh,
    view: View,
    surface_numbers: tuple[int, ...],
    one_sided: frozenset[int],
) -> Seen:
    """What is seen, computed for the visible pixels only.

    `span_at_pixel` has the number of the span that is seen at each pixel, (lines * elements,), 0 for none.
    `down_tops` and `up_tops` have, by those numbers, the tops of the two edges that bound each span.
    """
    # Find the segments: pixels beside each other that see the same span.
    head = np.ones(len(span_at_pixel), np.bool_)
    np.not_equal(span_at_pixel[1:], span_at_pixel[:-1], out=head[1:])
    first_pixel = np.flatnonzero(head)
    count = np.diff(first_pixel, append=len(span_at_pixel))
    filled = np.flatnonzero(span_at_pixel[first_pixel])
    first_pixel, count = first_pixel[filled], count[filled]

    # Sort them by surface, so that each surface's D, S and N are numbers and not arrays.
    column = down_tops[span_at_pixel[first_pixel]] % max(projected.corners.shape[1], 1)
    surface = np.array(surface_numbers, np.uint8)[mesh.part_numbers[projected.polygon_numbers[column]]]
    order = np.argsort(surface, kind="stable")
    first_pixel, count, column, surface = first_pixel[order], count[order], column[order], surface[order]
    span, polygon = span_at_pixel[first_pixel], projected.polygon_numbers[column]
    begin = np.cumsum(count) - count

    # Make ready what is linear along them.
    low, high = mesh.bounds
    middle = view.axes @ ((low + high) / 2 - np.array(view.eye)) / projected.unit
    start, step = _along_segments(first_pixel, down_tops[span], up_tops[span], projected, view, middle)
    # Turn to the eye the normals of polygons that are seen from behind.
    turned = projected.from_behind[column] & ~np.isin(surface, list(one_sided))
    start[NORMALS, turned] *= -1
    step[NORMALS, turned] *= -1

    # Step along them.
    pixels = np.repeat(first_pixel - begin, count)
    pixels += np.arange(len(pixels))
    rows = np.empty((ROW_COUNT, len(pixels)), np.float32)
    unit_rays = lens(projected.lines, projected.elements, view.field_of_view).unit_rays
    counting = np.arange(PIXELS_AT_ONCE + projected.elements, dtype=np.float32)
    cut = 0
    while cut < len(begin):
        taken = slice(cut, int(np.searchsorted(begin, begin[cut] + PIXELS_AT_ONCE)))
        cut = taken.stop
        some, base = count[taken], begin[taken.start]
        part = slice(int(base), int(begin[cut - 1] + count[cut - 1]))
        _fill(
            rows[:, part],
            np.repeat(start[:, taken], some, axis=1),
            np.repeat(step[:, taken], some, axis=1),
            counting[: part.stop - part.start] - np.repeat((begin[taken] - base).astype(np.float32), some),
            np.take(unit_rays, pixels[part], axis=1),
        )

    for table in (rows, pixels):
        table.flags.writeable = False
    return Seen(
        projected.lines,
        projected.elements,
        pixels,
        surface_slices(np.bincount(surface, count, 1).astype(np.int64)),
        polygon,
        count,
        rows,
        view,
        projected.unit,
        middle,
    )


def _fill(rows: Singles, start: Singles, step: Singles, along: Singles, ray: Singles) -> None:
    """Fill the rows of some pixels from what is linear along their segments, and the rays through them."""
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
    np.maximum(length, np.float32(1e-30), out=length)
    normal *= np.reciprocal(length, out=length)
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
    first_pixel: Numbers,
    down_top: npt.NDArray[np.int32],
    up_top: npt.NDArray[np.int32],
    projected: Projection,
    view: View,
    middle: Floats,
) -> tuple[Singles, Singles]:
    """What is stepped along each segment: its value at the first pixel, and what each further pixel adds.

    Both are (7, segments) float32: the point around the middle, which is stepped in proportion to the
    inverse depth; the normal times the inverse depth, to a scale; and the inverse depth itself. The
    differences are taken here in float64, so that a point is as exact from afar as from near.
    """
    line, element = np.divmod(first_pixel, projected.elements)
    down = _at_cuts(projected, down_top.astype(np.intp), DOWN_SIDE, line)
    up = _at_cuts(projected, up_top.astype(np.intp), UP_SIDE, line)
    # Both depth and normal are linear from the one cut to the other.
    slope = (up - down) / (up[ACROSS] - down[ACROSS])
    value = down + slope * (element + 0.5 - down[ACROSS])
    start, step = np.empty((7, len(line)), np.float32), np.empty((7, len(line)), np.float32)
    depth, depth_step = value[CUT_DEPTH], slope[CUT_DEPTH]
    start[DEPTH], step[DEPTH] = depth, depth_step
    # Bring the normals to about the size of 1, so that float32 holds them however far the object is.
    size = np.abs(down[CUT_NORMAL]).sum(axis=0) + np.abs(up[CUT_NORMAL]).sum(axis=0)
    size[size == 0] = 1
    start[NORMALS], step[NORMALS] = value[CUT_NORMAL] / size, slope[CUT_NORMAL] / size

    # The point is the ray over the inverse depth; one pixel further the ray is `ray_step` more.
    focal_length = lens(projected.lines, projected.elements, view.field_of_view).focal_length
    ray = (
        (element + 0.5 - projected.elements / 2) / focal_length,
        (line + 0.5 - projected.lines / 2) / focal_length,
        1.0,
    )
    for axis, ray_step in enumerate((1 / focal_length, 0.0, 0.0)):
        place = ray[axis] / depth
        start[axis] = place - middle[axis]
        step[axis] = ray_step - place * depth_step
    return start, step


def _at_cuts(projected: Projection, top: Numbers, side: Side, line: Numbers) -> Floats:
    """Where each edge is cut by its line: (5, segments).

    They are the place across, the inverse depth, and the normal times the inverse depth.
    """
    bottom = other_end(projected, top, side)
    corners, normals = projected.corners.ravel(), projected.corner_normals.ravel()
    a, b = corners[top], corners[bottom]
    way = (line + 0.5 - projected.down[a]) / (projected.down[b] - projected.down[a])
    depth_a, depth_b = projected.inverse_depth[a], projected.inverse_depth[b]
    cut = np.empty((5, len(line)))
    across = projected.across[a]
    cut[ACROSS] = across + way * (projected.across[b] - across)
    cut[CUT_DEPTH] = depth_a + way * (depth_b - depth_a)
    # Measured: `take` along the second axis has a quarter of the time of an index there.
    cut[CUT_NORMAL] = (1 - way) * depth_a * np.take(projected.normals, normals[top], axis=1)
    cut[CUT_NORMAL] += way * depth_b * np.take(projected.normals, normals[bottom], axis=1)
    return cut
