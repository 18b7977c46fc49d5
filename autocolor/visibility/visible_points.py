"""The visible points: the polygon, the point and the normal at each pixel, in camera space, by surface.

Assumed: points are float32 around the middle of the whole object's bounding box, exact to a sixteen-millionth
of its size. Lights on a thing of 0.001 units before a plate of 1,000 are off by some 2 % of the brightest.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Final

import numpy as np

from autocolor.arrays import Floats, Indices, Numbers, Singles
from autocolor.immutable import read_only
from autocolor.scene.view import View
from autocolor.visibility.visible_parts import VisibleParts

PIXELS_AT_ONCE: Final = 1 << 17
"""As many as the caches hold of the arrays that one step needs."""


# Rows of `VisiblePoints.rows`: point P, normal N and reflected view R, each before its dot product with P.
POINT: Final = slice(0, 3)
NORMAL: Final = slice(4, 7)
REFLECTED_VIEW: Final = slice(8, 11)
POINT_SQUARED: Final = POINT.stop
ROW_COUNT: Final = 12


def fill_point_products(rows: Singles) -> None:
    """Fill in the dot product of each vector in the rows with the point: the row after the vector."""
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
class PointChunk:
    """Visible points that are worked on at once; `slices` are counted from the start of the chunk."""

    pixels: slice
    slices: tuple[SurfaceSlice, ...]


def surface_slices(counts: Numbers) -> tuple[SurfaceSlice, ...]:
    """The slices of pixels sorted by surface; `counts` has the number of pixels of each surface number."""
    stops = np.cumsum(counts)
    return tuple(
        SurfaceSlice(number, int(stops[number] - counts[number]), int(stops[number]))
        for number in np.flatnonzero(counts).tolist()
    )


def point_chunks(slices: Sequence[SurfaceSlice]) -> tuple[PointChunk, ...]:
    """All pixels in chunks of about the same size, which end between two surfaces where that fits.

    The chunks depend only on the slices: so an edit computes a plane in the same steps as a fresh picture,
    and to the same bits.
    """
    total = slices[-1].stop if slices else 0
    count = -(-total // PIXELS_AT_ONCE)
    even_ends = [total * number // count for number in range(1, count + 1)]
    bounds = [0]
    for end, following in pairwise(even_ends):
        between = min((each.start for each in slices), key=lambda start: abs(start - end))
        fits = all(0 < size <= PIXELS_AT_ONCE for size in (between - bounds[-1], following - between))
        bounds.append(between if fits else end)
    bounds.extend(even_ends[-1:])
    return tuple(
        PointChunk(slice(start, stop), _within(slices, start, stop)) for start, stop in pairwise(bounds)
    )


def _within(slices: Sequence[SurfaceSlice], start: int, stop: int) -> tuple[SurfaceSlice, ...]:
    """The parts of slices from `start` to `stop`, counted from there."""
    return tuple(
        SurfaceSlice(each.surface_number, max(each.start, start) - start, min(each.stop, stop) - start)
        for each in slices
        if each.start < stop and each.stop > start
    )


@dataclass(frozen=True, eq=False)
class VisiblePoints:
    """The visible points of a view, one for each pixel that sees a polygon, sorted by surface.

    `pixels`, (n,) intp, are their flat places in the raster. They come in spans of neighbors that see the
    same polygon, and the spans of a polygon mostly follow each other: `span_polygons` are rows of the polygon
    table, `span_lengths` counts of pixels. `parts` tells the part at each of them.

    `rows` is (12, n) float32: the point in camera space around `middle`, the unit normal, and the view
    direction reflected at the normal, each with its dot product with the point, so that every cosine to a
    light is one matrix product. Lengths in camera space, those of `middle` included, are in `unit`.
    """

    view: View
    lines: int
    elements: int
    unit: float
    middle: Floats
    pixels: Indices
    slices: tuple[SurfaceSlice, ...]
    span_polygons: Indices
    span_lengths: Indices
    rows: Singles
    parts: VisibleParts

    @cached_property
    def chunks(self) -> tuple[PointChunk, ...]:
        """All points in chunks to work on."""
        return point_chunks(self.slices)

    @cached_property
    def radius(self) -> float:
        """The largest distance of a point from the middle in units; the points' rounding is in proportion."""
        return float(np.sqrt(self.rows[POINT_SQUARED].max(initial=0.0)))

    def camera_point(self, point: tuple[float, float, float]) -> Floats:
        """A point of the world in camera space, around the middle as in `rows`."""
        relative = np.array(point) - np.array(self.view.eye)
        in_camera: Floats = self.view.axes @ relative / self.unit - self.middle
        return in_camera

    def camera_direction(self, direction: tuple[float, float, float]) -> Floats:
        """A direction of the world in camera space."""
        in_camera: Floats = self.view.axes @ np.array(direction)
        return in_camera

    def world_coordinate(self, axis: int) -> Floats:
        """The four numbers whose product with (P, 1) is the point's world coordinate in units."""
        along = self.view.axes[:, axis]
        return np.append(along, self.view.eye[axis] / self.unit + along @ self.middle)

    @property
    def polygon_numbers(self) -> Indices:
        """Rows of the polygon table, (n,), in the order of `pixels`."""
        return np.repeat(self.span_polygons, self.span_lengths)

    @cached_property
    def normals(self) -> Singles:
        """The unit normals in camera space, (3, n) float32, in the order of `pixels`; read-only."""
        return read_only(self.rows[NORMAL])

    @property
    def world_points(self) -> Floats:
        """The points in world coordinates, (n, 3), in the order of `pixels`."""
        in_camera = (self.rows[POINT].T.astype(np.float64) + self.middle) * self.unit
        points: Floats = in_camera @ self.view.axes + np.array(self.view.eye)
        return points

    @property
    def world_normals(self) -> Floats:
        """The unit normals in world axes, (n, 3), in the order of `pixels`."""
        normals: Floats = self.rows[NORMAL].T.astype(np.float64) @ self.view.axes
        return normals
