"""What is seen at each pixel, stepped along the visible segments: point, normal, mirrored ray."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

from autocolor.arrays import Integers, Singles, chunks_of_runs, dot, runs
from autocolor.scene.mesh import Mesh
from autocolor.scene.view import View
from autocolor.visibility.projection import Projection, focal_length
from autocolor.visibility.visible_points import (
    MIRROR,
    NORMAL,
    POINT,
    ROW_COUNT,
    Seen,
    keep_products,
    surface_slices,
)
from autocolor.visibility.visible_spans import (
    DEPTH,
    NORMALS,
    POINTS,
    RAY,
    Segments,
    along_segments,
    visible_segments,
)

PIXELS_AT_ONCE: Final = 1 << 14


def seen_of_spans(
    span_at_pixel: Integers,
    tops: NDArray[np.int32],
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
    rows = np.empty((ROW_COUNT, len(pixels)), np.float32)
    ray_step = np.float32(1 / focal_length(projected.lines, view.field_of_view))
    for part, some in chunks_of_runs(count, PIXELS_AT_ONCE):
        start_here, step_here = (np.repeat(table[:, part], count[part], axis=1) for table in (start, step))
        along = pixels[some] - np.repeat(segments.first_pixel[part], count[part])
        _fill(rows[:, some], start_here, step_here, along.astype(np.float32), ray_step)

    for table in (rows, pixels):
        table.flags.writeable = False
    return Seen(
        projected.lines,
        projected.elements,
        pixels,
        surface_slices(_pixels_of_surfaces(segments)),
        segments.polygon,
        count,
        rows,
        view,
        projected.unit,
        middle,
    )


def _pixels_of_surfaces(segments: Segments) -> Integers:
    """How many pixels each surface number has, from 0 on; the segments are sorted by it."""
    # One number more, for the last surface ends where the next one would begin.
    numbers = np.arange(int(segments.surface.max(initial=0)) + 2)
    beyond = np.append(0, np.cumsum(segments.count))
    return np.diff(beyond[np.searchsorted(segments.surface, numbers)])


def _fill(rows: Singles, start: Singles, step: Singles, along: Singles, ray_step: np.float32) -> None:
    """Fill the rows of some pixels from what is linear along their segments."""
    # Place the point and the normal: they go along the segment as `along` over the inverse depth does.
    inverse_depth = step[DEPTH] * along
    inverse_depth += start[DEPTH]
    way = np.divide(along, inverse_depth, out=inverse_depth)
    normal = rows[NORMAL]
    for out, linear in ((rows[POINT], POINTS), (normal, NORMALS)):
        step[linear] *= way
        np.add(start[linear], step[linear], out=out)
    # Make the normal a unit vector.
    length = np.sqrt(dot(normal, normal))
    # A polygon without area has a normal of 0, and keeps it.
    length += np.float32(1e-30)
    normal /= length
    # Make the ray a unit vector.
    ray = start[RAY]
    ray[0] += along * ray_step
    np.sqrt(dot(ray, ray), out=length)
    ray /= length
    # Mirror the ray to the eye: M = 2 (N.V) N - V, where V is the ray the other way round.
    facing = dot(normal, ray)
    facing *= np.float32(-2)
    np.multiply(normal, facing, out=rows[MIRROR])
    rows[MIRROR] += ray
    keep_products(rows)
