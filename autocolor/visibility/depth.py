"""Depth as a whole number: the keys that the hidden-surface algorithms compare.

The inverse depth is linear along a scan line. Its first value and its step are rounded to whole numbers once,
and stepping adds no rounding: a running sum over all segments is exact, and the batch algorithm and the
literal one find the same number at every pixel. A key is off by at most half a unit for each pixel from the
left end of its segment.

The low bits of a key, below the depth, hold the number of the polygon, so that of equally near polygons the
one with the highest number is visible: one that faces the eye if there is any, and of those the last one of
the polygon table.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from autocolor.arrays import Floats, Indices, Numbers, chunks_of_runs, least_of_four, most_of_four
from autocolor.visibility.projection import Projection
from autocolor.visibility.scan_lines import extents_of_polygons

KEY_BITS: Final = 62
"""One less than the 63 bits of a positive number, because rounding may add to the nearest depth."""

CLOSE: Final = 1024.0
"""Corners of a larger inverse depth are close to the eye."""

EXTENTS_AT_ONCE: Final = 1 << 16

MOST_ROUNDED: Final = 1 << 10
"""In units: a plane's depth below 2^62 is exact to 2^9 of them in float64."""

LEAST_NUMBER_BITS: Final = 16
"""So many that float64 holds every depth, at most 46 bits, exactly, with some to spare."""


@dataclass(frozen=True, eq=False)
class DepthScale:
    """Keys are whole multiples of `number_limit`; the inverse depth 1 is `factor` of them.

    `number_limit` is a power of two above the numbers of all polygons. `planes`, (polygons,) intp, is the
    shared plane of which each polygon has the depth, -1 for none; None if all have none.
    """

    number_limit: int
    factor: float
    planes: Indices | None = None

    def key(self, inverse_depth: float) -> int:
        """The key of an inverse depth, or of a difference of two.

        Halves are rounded to the even number; this is no level that is displayed, and as exact either way.
        """
        return round(inverse_depth * self.factor) * self.number_limit

    def keys(self, inverse_depth: Floats) -> Numbers:
        """The keys of inverse depths, or of differences of them; the number of a polygon can be added.

        A difference beyond the largest key can only belong to a segment of one pixel, which takes no step.
        """
        whole = np.rint(inverse_depth * self.factor)
        most = 2.0**KEY_BITS / self.number_limit
        return np.clip(whole, -most, most, out=whole).astype(np.int64) * self.number_limit


def depth_scale(projected: Projection) -> DepthScale:
    """The scale that holds the nearest depth at the center of a pixel and the numbers of all polygons."""
    number_bits = max((2 * projected.corners.shape[1]).bit_length(), LEAST_NUMBER_BITS)
    factor = 2.0 ** (KEY_BITS - number_bits) / _nearest_at_pixels(projected)
    return DepthScale(1 << number_bits, factor, _planes_that_fit(projected, factor))


def _nearest_at_pixels(projected: Projection) -> float:
    """An inverse depth that no polygon exceeds at the center of a pixel.

    A corner may be so near the eye that no depth would be left for what is far away, but outside of the
    picture: then look at the pixels of the nearest polygons.
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


def _planes_that_fit(projected: Projection, factor: float) -> Indices | None:
    """The shared plane of each polygon if its depths are whole numbers that a key can hold, else -1."""
    # The farthest corner has an inverse depth of about 1 or more: what is rounded must not make it negative.
    if plane_rounding(projected) > 0.5 * factor or not len(projected.planes.columns):
        return None
    a, b, c = np.abs(projected.planes.linear) * factor
    fits = np.append(a * projected.elements + b * projected.lines + c < 2.0**KEY_BITS, False)
    columns = projected.planes.columns
    planes = np.where(fits.take(columns), columns, -1)
    return planes if planes.max(initial=-1) >= 0 else None


def plane_rounding(projected: Projection) -> int:
    """By how many units the rounded depth of a shared plane may be off: by half a unit a pixel, and more."""
    return projected.elements + MOST_ROUNDED


def plane_keys(
    projected: Projection, scale: DepthScale, planes: Indices, lines: Indices, elements: Indices
) -> tuple[Numbers, Numbers]:
    """The keys of shared planes at pixels, and their steps from pixel to pixel.

    All polygons of a plane have the same there, because they are stepped from the middle of the line wherever
    a segment begins. What overflows on the way comes back, because int64 wraps around.
    """
    a, b, c = np.take(projected.planes.linear, planes, axis=1)
    middle = projected.elements // 2
    start = np.rint((a * (middle + 0.5) + b * (lines + 0.5) + c) * scale.factor).astype(np.int64)
    step = np.rint(a * scale.factor).astype(np.int64)
    start += (elements - middle) * step
    return start * scale.number_limit, step * scale.number_limit


def numbers_of_polygons(projected: Projection, polygons: Indices) -> Numbers:
    """The numbers that keys have for some polygons of the projection.

    They are counted from 1; those of the polygons that face the eye come after those of all others.
    """
    numbers: Numbers = polygons + np.where(
        projected.from_behind.take(polygons), 1, 1 + projected.corners.shape[1]
    )
    return numbers


def polygons_of_numbers(projected: Projection, numbers: Numbers) -> Indices:
    """The polygons of the projection that have some numbers, none of them 0."""
    polygons = numbers - 1
    polygons[polygons >= projected.corners.shape[1]] -= projected.corners.shape[1]
    return polygons


# -------------------- culling
# Occlusion culling: polygons that are hidden as a whole, found before the depth test.
#
# The raster is divided into tiles, each with the depth key of its farthest pixel. A polygon that fits into
# two by two tiles, and is farther than all four everywhere, can't be seen.
#
# Measured: it finds half of the coupe's polygons that are seen from behind, and the visible surfaces of
# five meshes take a twenty-fifth to a twelfth less time. Tiles of several sizes find no more.

FITTING: Final = 0.9
"""The fraction of the polygons that are to be no larger than a tile."""


def not_occluded(
    depth_buffer: Numbers, projected: Projection, scale: DepthScale, polygons: Indices
) -> Indices:
    """Those of some polygons of the projection that may be nearer than what the depth buffer holds."""
    if not len(polygons):
        return polygons
    # Find the bounding box of each polygon in pixels.
    corners = np.take(projected.corners, polygons, axis=1)
    lines, x = projected.first_line[corners], projected.x[corners]
    top, bottom = least_of_four(lines), most_of_four(lines) - 1
    left = np.clip(least_of_four(x) - 1, 0, projected.elements - 1).astype(np.intp)
    right = np.clip(most_of_four(x) + 1, 0, projected.elements - 1).astype(np.intp)

    # Choose the size of the tiles, and look up the farthest of the four that each box is in.
    extent = np.maximum(bottom - top, right - left) + 1
    rank = int(FITTING * (len(extent) - 1))
    size = int(np.partition(extent, rank)[rank])
    raster = depth_buffer.reshape(projected.lines, projected.elements)
    farthest = _least_of_rows(np.ascontiguousarray(_least_of_rows(raster, size).T), size)
    above, below, first, last = top // size, bottom // size, left // size, right // size
    behind = least_of_four(
        [farthest[first, above], farthest[last, above], farthest[first, below], farthest[last, below]]
    )

    # Compare with the nearest corner. Because the step of a segment is rounded, each pixel may come half
    # a unit nearer.
    nearest = scale.keys(most_of_four(projected.inverse_depth[corners]))
    nearest += (extent // 2 + 2) * scale.number_limit
    if scale.planes is not None:
        plane = scale.planes.take(polygons)
        row = np.flatnonzero(plane >= 0)
        at_corners = corners[:, row]
        depths = projected.planes.inverse_depth(plane[row], projected.x[at_corners], projected.y[at_corners])
        nearest[row] = scale.keys(most_of_four(depths)) + plane_rounding(projected) * scale.number_limit
    kept: Indices = polygons[(extent > size) | (nearest >= behind)]
    return kept


def _least_of_rows(keys: Numbers, size: int) -> Numbers:
    """The least keys of each `size` rows, and of the rows that are left over."""
    whole = len(keys) // size * size
    least: Numbers = keys[:whole].reshape(-1, size, keys.shape[1]).min(axis=1)
    return least if whole == len(keys) else np.concatenate([least, keys[whole:].min(axis=0, keepdims=True)])


# -------------------- segments
# Segments: the extents of polygons on scan lines, with their depth keys.


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
