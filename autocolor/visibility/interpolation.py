"""Point, normal and reflected view at each visible pixel, stepped along the visible spans."""

from __future__ import annotations

from typing import Final

import numpy as np

from autocolor.arrays import Numbers, Singles, chunks_of_runs, dot, runs
from autocolor.visibility.projection import Projection
from autocolor.visibility.visible_parts import VisibleParts
from autocolor.visibility.visible_points import (
    NORMAL,
    POINT,
    REFLECTED_VIEW,
    ROW_COUNT,
    VisiblePoints,
    fill_point_products,
    surface_slices,
)
from autocolor.visibility.visible_spans import (
    DEPTH,
    NORMALS,
    POINTS,
    RAY,
    VisibleSpans,
    along_spans,
    visible_spans,
)

PIXELS_AT_ONCE: Final = 1 << 14


def interpolated_points(
    projected: Projection,
    number_at_pixel: Numbers,
    surface_numbers: tuple[int, ...],
    one_sided: frozenset[int],
) -> VisiblePoints:
    """What is visible at each pixel, given the number of the polygon there as in `visible_spans`.

    `surface_numbers` and `one_sided` are those of `visible_surfaces`.
    """
    spans = visible_spans(projected, number_at_pixel, surface_numbers)
    start, step = along_spans(projected, spans)
    # Turn the normals of polygons seen from behind to the eye.
    behind = projected.from_behind[spans.polygon]
    turned = np.flatnonzero(behind & ~np.isin(spans.surface, list(one_sided)))
    start[NORMALS, turned] *= -1
    step[NORMALS, turned] *= -1

    # Step along the spans.
    count = spans.count
    pixels = runs(spans.first_pixel, count)
    rows = np.empty((ROW_COUNT, len(pixels)), np.float32)
    ray_step = np.float32(1 / projected.focal_length)
    for part, chunk in chunks_of_runs(count, PIXELS_AT_ONCE):
        start_here, step_here = (np.repeat(table[:, part], count[part], axis=1) for table in (start, step))
        along = pixels[chunk] - np.repeat(spans.first_pixel[part], count[part])
        _fill(rows[:, chunk], start_here, step_here, along.astype(np.float32), ray_step)

    for table in (rows, pixels):
        table.flags.writeable = False
    return VisiblePoints(
        projected.view,
        projected.lines,
        projected.elements,
        projected.unit,
        projected.middle,
        pixels,
        surface_slices(_pixels_of_surfaces(spans)),
        spans.polygon_number,
        count,
        rows,
        VisibleParts(projected.mesh.part_names, projected.mesh.part_numbers, spans.polygon_number, count),
    )


def _pixels_of_surfaces(spans: VisibleSpans) -> Numbers:
    """The number of visible pixels of each surface, by surface number; the spans are sorted by surface."""
    # One number more than there are surfaces: the last one ends where the next would begin.
    numbers = np.arange(int(spans.surface.max(initial=0)) + 2)
    ends = np.append(0, np.cumsum(spans.count))
    return np.diff(ends[np.searchsorted(spans.surface, numbers)])


def _fill(rows: Singles, start: Singles, step: Singles, along: Singles, ray_step: np.float32) -> None:
    """Fill in the rows of some pixels, each `along` pixels from the start of its span."""
    # Interpolate point and normal, which change in proportion to `along` over the inverse depth.
    inverse_depth = step[DEPTH] * along
    inverse_depth += start[DEPTH]
    distance = np.divide(along, inverse_depth, out=inverse_depth)
    normal = rows[NORMAL]
    for out, linear in ((rows[POINT], POINTS), (normal, NORMALS)):
        step[linear] *= distance
        np.add(start[linear], step[linear], out=out)
    # Normalize the normal.
    length = np.sqrt(dot(normal, normal))
    # A polygon without area has a normal of 0, and keeps it.
    length += np.float32(1e-30)
    normal /= length
    # Normalize the ray.
    ray = start[RAY]
    ray[0] += along * ray_step
    np.sqrt(dot(ray, ray), out=length)
    ray /= length
    # Reflect the view direction at the normal: R = 2 (N.V) N - V, where V is the reversed ray.
    facing = dot(normal, ray)
    facing *= np.float32(-2)
    np.multiply(normal, facing, out=rows[REFLECTED_VIEW])
    rows[REFLECTED_VIEW] += ray
    fill_point_products(rows)
