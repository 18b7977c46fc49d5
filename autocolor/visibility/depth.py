"""Depth keys: the depth of a segment as whole numbers, which the hidden-surface algorithms compare.

A key is made in four steps:

1. A segment is the extent of a polygon on a line. Its inverse depth is linear along the line: a `start` and a
   `step` from pixel to pixel, as in `scan_lines.Extents`.
2. Both are multiplied by the `factor` of a `DepthScale` and rounded to whole numbers, once. Stepping adds no
   rounding: a running sum over all segments is exact, and the batch algorithm and the literal one find the
   same number at every pixel. A depth is off by at most half a unit for each pixel from the left end.
3. If polygons share a plane, all use the start and the step of the plane, a linear function of the raster.
   With depths of their own, the polygons would be nearer by turns, from pixel to pixel.
4. The low bits of a key hold the number of the polygon. So of equally near polygons the highest number is
   visible: a polygon that faces the eye if there is one, and of those the last in the polygon table, as a
   decal on its ground should be.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Final

import numpy as np

from autocolor.arrays import AnyArray, Booleans, Floats, Indices, Numbers, chunks_of_runs, most_of_four
from autocolor.visibility.projection import PlanesInView, Projection
from autocolor.visibility.scan_lines import extents_of_polygons

KEY_BITS: Final = 62
"""One less than the 63 bits of a positive number, because rounding may add to the nearest depth."""

LEAST_NUMBER_BITS: Final = 16
"""The fewest bits for polygon numbers. Depths then have at most 46 bits, which float64 holds exactly."""

PLANE_DEPTH_ROUNDING: Final = 1 << 10
"""In units of depth: twice the rounding in float64 of a plane's depth, which is below 2^62."""

CLOSE: Final = 1024.0
"""The inverse depth above which a corner is close to the eye."""

EXTENTS_AT_ONCE: Final = 1 << 16


@dataclass(frozen=True, eq=False)
class DepthScale:
    """How inverse depths become keys: `factor` is the whole number for the inverse depth 1.

    Keys are these whole numbers times `number_limit`, a power of two above the numbers of all polygons.
    `planes`, (polygons,) intp, is the shared plane that gives a polygon its depth, -1 for a polygon with its
    own depth; None if all have their own. `linear`, (3, planes), has A, B and C of each plane: its inverse
    depth at x, y (pixels) is A x + B y + C.
    """

    number_limit: int
    factor: float
    planes: Indices | None = None
    linear: Floats = field(default_factory=lambda: np.empty((3, 0)))

    def key(self, inverse_depth: float) -> int:
        """The key of an inverse depth, or of a difference of two.

        Halves are rounded to the even number, because a depth is no level that is displayed.
        """
        return round(inverse_depth * self.factor) * self.number_limit

    def keys(self, inverse_depth: Floats) -> Numbers:
        """The keys of inverse depths, or of their differences, without the number of a polygon.

        A difference beyond the largest key is clipped: it belongs to a segment of one pixel, which takes no
        step.
        """
        whole = np.rint(inverse_depth * self.factor)
        most = 2.0**KEY_BITS / self.number_limit
        return np.clip(whole, -most, most, out=whole).astype(np.int64) * self.number_limit

    def depths_of_planes(self, planes: Indices, x: AnyArray, y: AnyArray) -> Floats:
        """The inverse depths of shared planes at some places."""
        a, b, c = np.take(self.linear, planes, axis=1)
        inverse_depths: Floats = a * x + b * y + c
        return inverse_depths


def depth_scale(projected: Projection) -> DepthScale:
    """The scale that holds the nearest depth at the center of a pixel and the numbers of all polygons."""
    number_bits = max((2 * projected.corners.shape[1]).bit_length(), LEAST_NUMBER_BITS)
    factor = 2.0 ** (KEY_BITS - number_bits) / _nearest_at_pixels(projected)
    # The farthest corner has an inverse depth of about 1 or more: rounding must not make it negative.
    if projected.planes is None or plane_rounding(projected) > 0.5 * factor:
        return DepthScale(1 << number_bits, factor)
    linear = _inverse_depths_of_planes(projected, projected.planes)
    a, b, c = np.abs(linear) * factor
    fits = np.append(a * projected.elements + b * projected.lines + c < 2.0**KEY_BITS, False)
    planes = np.where(fits.take(projected.planes.of_polygons), projected.planes.of_polygons, -1)
    return DepthScale(1 << number_bits, factor, planes if planes.max(initial=-1) >= 0 else None, linear)


def _nearest_at_pixels(projected: Projection) -> float:
    """An inverse depth that no polygon exceeds at the center of a pixel.

    A corner outside of the picture may be so near the eye that its inverse depth would leave no bits for
    distant polygons. So if corners are close, the pixels of their polygons are examined.
    """
    if projected.nearest <= CLOSE:
        return projected.nearest
    close = np.flatnonzero(most_of_four(projected.inverse_depth[projected.corners]) > CLOSE)
    nearest = CLOSE
    for chunk, _ in chunks_of_runs(projected.line_counts.take(close), EXTENTS_AT_ONCE):
        extents = extents_of_polygons(projected, close[chunk])
        last = extents.start + (extents.count - 1) * extents.step
        nearest = max(nearest, float(np.maximum(extents.start, last).max(initial=0.0)))
    return min(nearest, projected.nearest)


def _inverse_depths_of_planes(projected: Projection, planes: PlanesInView) -> Floats:
    """The factors A, B and C of each plane: its inverse depth is normal times ray, over the distance."""
    a, b, c = planes.normals / planes.distances
    a, b = a / projected.focal_length, b / projected.focal_length
    return np.stack([a, b, c - a * (projected.elements / 2) - b * (projected.lines / 2)])


def plane_keys(
    projected: Projection, scale: DepthScale, planes: Indices, lines: Indices, elements: Indices
) -> tuple[Numbers, Numbers]:
    """The keys of shared planes at pixels, and their steps from pixel to pixel.

    All polygons of a plane have the same keys, because they are stepped from the middle of the line wherever
    a segment begins. A sum that overflows on the way comes back, because int64 wraps around.
    """
    middle = projected.elements // 2
    at_middle = scale.depths_of_planes(planes, np.full(len(lines), middle + 0.5), lines + 0.5)
    start = np.rint(at_middle * scale.factor).astype(np.int64)
    step = np.rint(scale.linear[0].take(planes) * scale.factor).astype(np.int64)
    start += (elements - middle) * step
    return start * scale.number_limit, step * scale.number_limit


def plane_rounding(projected: Projection) -> int:
    """The largest error of a shared plane's rounded depth: half a unit of depth a pixel, and more."""
    return projected.elements + PLANE_DEPTH_ROUNDING


def numbers_of_polygons(projected: Projection, polygons: Indices) -> Numbers:
    """The numbers of some polygons of the projection in depth keys.

    They count from 1; the polygons that face the eye come after all others.
    """
    numbers: Numbers = polygons + np.where(
        projected.from_behind.take(polygons), 1, 1 + projected.corners.shape[1]
    )
    return numbers


def polygons_of_numbers(projected: Projection, numbers: Numbers) -> Indices:
    """The polygons of the projection with these numbers: the inverse of `numbers_of_polygons`."""
    polygons = numbers - 1
    polygons[polygons >= projected.corners.shape[1]] -= projected.corners.shape[1]
    return polygons


@dataclass(frozen=True, eq=False)
class Segments:
    """Segments that cover the center of a pixel; every array is (segments,).

    `number` is the number of the polygon in depth keys. A segment covers `count` pixels from `first_pixel`
    on, a flat place in the raster. Its depth key is `start` + k `step` at its pixel k, int64.
    """

    number: Numbers
    first_pixel: Indices
    count: Indices
    start: Numbers
    step: Numbers

    def some(self, rows: Booleans) -> Segments:
        """Some of the segments."""
        return Segments(*(column[rows] for column in vars(self).values()))


def segments_of_polygons(projected: Projection, scale: DepthScale, polygons: Indices) -> Segments:
    """The segments of some polygons of the projection, in the order of polygons and lines."""
    extents = extents_of_polygons(projected, polygons)
    start, step = scale.keys(extents.start), scale.keys(extents.step)
    planes = None if scale.planes is None else scale.planes.take(polygons)
    if planes is not None and planes.max(initial=-1) >= 0:
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
