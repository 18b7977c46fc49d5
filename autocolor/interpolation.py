"""What is seen at each pixel, stepped along the visible segments: point, normal, mirrored ray."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from autocolor.mesh import Mesh
from autocolor.projection import Projection, focal_length
from autocolor.runs import batches, runs
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
from autocolor.segments import DEPTH, NORMALS, POINTS, RAY, along_segments, visible_segments
from autocolor.view import View

PIXELS_AT_ONCE = 1 << 14

Singles = npt.NDArray[np.float32]


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

    `span_at_pixel` and `tops` are those of `visible_segments`.
    """
    segments = visible_segments(span_at_pixel, tops, projected, mesh, surface_numbers)
    low, high = mesh.bounds
    middle = view.axes @ ((low + high) / 2 - np.array(view.eye)) / projected.unit
    start, step = along_segments(segments, projected, view, middle)
    # Turn to the eye the normals of polygons that are seen from behind.
    behind = projected.from_behind[segments.column]
    turned = np.flatnonzero(behind & ~np.isin(segments.surface, list(one_sided)))
    start[NORMALS, turned] *= -1
    step[NORMALS, turned] *= -1

    # Step along the segments.
    count = segments.count
    pixels = runs(segments.first_pixel, count)
    along = runs(np.zeros_like(count), count).astype(np.float32)
    rows = np.empty((ROW_COUNT, len(pixels)), np.float32)
    ray_step = np.float32(1 / focal_length(projected.lines, view.field_of_view))
    for part, some in batches(count, PIXELS_AT_ONCE):
        start_here, step_here = (np.repeat(table[:, part], count[part], axis=1) for table in (start, step))
        _fill(rows[:, some], start_here, step_here, along[some], ray_step)

    for table in (rows, pixels):
        table.flags.writeable = False
    return Seen(
        projected.lines,
        projected.elements,
        pixels,
        surface_slices(np.bincount(segments.surface, count, 1).astype(np.int64)),
        segments.polygon,
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
