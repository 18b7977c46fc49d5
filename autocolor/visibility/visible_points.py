"""What is seen: for each pixel the polygon, the point and the normal, in camera space, surface by surface."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Final

import numpy as np

from autocolor.arrays import Floats, Integers, Numbers, Singles
from autocolor.scene.view import View

PIXELS_AT_ONCE: Final = 1 << 17
"""As many as the caches hold of the arrays that one step needs."""


# Rows of `Seen.rows`: the point P, the normal N and the eye's mirrored ray M, each before its product with P.
POINT: Final = slice(0, 3)
NORMAL: Final = slice(4, 7)
MIRROR: Final = slice(8, 11)
POINT_SQUARED: Final = POINT.stop
ROW_COUNT: Final = 12


def keep_products(rows: Singles) -> None:
    """Write the products with the point into rows whose vectors are there, each after its vector."""
    vectors = rows.reshape(3, 4, -1)
    np.einsum("kij,ij->kj", vectors[:, :3], rows[POINT], out=vectors[:, 3])


@dataclass(frozen=True, eq=False)
class SurfaceSlice:
    """The pixels `start` to `stop`, all of one surface."""

    surface_number: int
    start: int
    stop: int

    @property
    def pixels(self) -> slice:
        """The pixels as a slice."""
        return slice(self.start, self.stop)


@dataclass(frozen=True, eq=False)
class Share:
    """Pixels of what is seen that are worked on at once, and those of each surface, counted in the share."""

    pixels: slice
    slices: tuple[SurfaceSlice, ...]


def surface_slices(counts: Integers) -> tuple[SurfaceSlice, ...]:
    """The slices of pixels sorted by surface; `counts` has how many are of each surface number."""
    stops = np.cumsum(counts)
    return tuple(
        SurfaceSlice(number, int(stops[number] - counts[number]), int(stops[number]))
        for number in np.flatnonzero(counts).tolist()
    )


def shares(slices: Sequence[SurfaceSlice]) -> tuple[Share, ...]:
    """All pixels in shares of about the same size, cut between two surfaces where that does.

    How they are cut depends on nothing but the slices: what is computed again is then computed in the same
    steps, and comes to the same last bit.
    """
    total = slices[-1].stop if slices else 0
    count = -(-total // PIXELS_AT_ONCE)
    cuts = [total * number // count for number in range(1, count + 1)]
    bounds = [0]
    for cut, following in pairwise(cuts):
        between = min((each.start for each in slices), key=lambda start: abs(start - cut))
        fits = all(0 < size <= PIXELS_AT_ONCE for size in (between - bounds[-1], following - between))
        bounds.append(between if fits else cut)
    bounds.extend(cuts[-1:])
    return tuple(Share(slice(start, stop), _within(slices, start, stop)) for start, stop in pairwise(bounds))


def _within(slices: Sequence[SurfaceSlice], start: int, stop: int) -> tuple[SurfaceSlice, ...]:
    """The parts of slices from `start` to `stop`, counted from there."""
    return tuple(
        SurfaceSlice(each.surface_number, max(each.start, start) - start, min(each.stop, stop) - start)
        for each in slices
        if each.start < stop and each.stop > start
    )


@dataclass(frozen=True, eq=False)
class Seen:
    """The visible pixels, sorted by surface; within one, those of a polygon mostly stand together.

    `pixels` are their flat places in the raster, (n,) intp. They come in segments, pixels beside each other
    that see the same polygon: `segment_polygons` are rows of the polygon table, `segment_lengths` how many
    pixels each has. `rows` is (12, n) float32 and has what the reflected light is computed from: a point in
    camera space around `middle`, the unit normal, and the ray to the eye mirrored at the normal, each with
    its product with the point, so that every cosine to a light is one matrix product. Lengths in camera
    space, `middle` among them, are in `unit`.
    """

    lines: int
    elements: int
    pixels: Numbers
    slices: tuple[SurfaceSlice, ...]
    segment_polygons: Numbers
    segment_lengths: Numbers
    rows: Singles
    view: View
    unit: float
    middle: Floats

    @cached_property
    def shares(self) -> tuple[Share, ...]:
        """All pixels, in shares to work on."""
        return shares(self.slices)

    @cached_property
    def reach(self) -> float:
        """The largest distance of a point from the middle in units; the points' rounding is in proportion."""
        return float(np.sqrt(self.rows[POINT_SQUARED].max(initial=0.0)))

    def camera_point(self, point: tuple[float, float, float]) -> Floats:
        """A point of the world as the rows of points are: in camera space, around the middle."""
        away = np.array(point) - np.array(self.view.eye)
        placed: Floats = self.view.axes @ away / self.unit - self.middle
        return placed

    def camera_direction(self, direction: tuple[float, float, float]) -> Floats:
        """A direction of the world in camera space."""
        turned: Floats = self.view.axes @ np.array(direction)
        return turned

    def world_coordinate(self, axis: int) -> Floats:
        """The four numbers whose product with a point and 1 is the point's world coordinate in units."""
        along = self.view.axes[:, axis]
        return np.append(along, self.view.eye[axis] / self.unit + along @ self.middle)

    @property
    def polygon_numbers(self) -> Numbers:
        """Rows of the polygon table, (n,), in the order of `pixels`."""
        return np.repeat(self.segment_polygons, self.segment_lengths)

    @property
    def points(self) -> Floats:
        """The points in world coordinates, (n, 3), in the order of `pixels`."""
        placed = (self.rows[POINT].T.astype(np.float64) + self.middle) * self.unit
        points: Floats = placed @ self.view.axes + np.array(self.view.eye)
        return points

    @property
    def normals(self) -> Floats:
        """The unit normals in world axes, (n, 3), in the order of `pixels`."""
        normals: Floats = self.rows[NORMAL].T.astype(np.float64) @ self.view.axes
        return normals
