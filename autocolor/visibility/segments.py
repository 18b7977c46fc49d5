"""Segments: the extents of polygons on scan lines, with their depth keys."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from autocolor.arrays import Indices, Numbers
from autocolor.visibility.depth import DepthScale, numbers_of_polygons, plane_keys
from autocolor.visibility.extents import extents_of_polygons
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
    extents = extents_of_polygons(projected, polygons)
    start, step = scale.keys(extents.start), scale.keys(extents.step)
    planes = None if scale.planes is None else scale.planes.take(polygons)
    if planes is not None and planes.max(initial=-1) >= 0:
        # Let the polygons of a shared plane have its depth.
        plane = planes.take(extents.row)
        shared = np.flatnonzero(plane >= 0)
        start[shared], step[shared] = plane_keys(
            projected, scale, plane[shared], extents.line[shared], extents.first[shared]
        )
    return Segments(
        numbers_of_polygons(projected, polygons).take(extents.row),
        extents.line * projected.elements + extents.first,
        extents.count,
        start,
        step,
    )
