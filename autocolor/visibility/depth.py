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

from autocolor.arrays import Floats, Indices, Numbers, chunks_of_runs, most_of_four
from autocolor.visibility.extents import extents_of_polygons
from autocolor.visibility.projection import Projection

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
