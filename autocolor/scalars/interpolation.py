"""The visible points in chunks, with the polygon that each is in and the weights of its corners."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Final, NamedTuple

import numpy as np

from autocolor.arrays import Floats, Indices, Singles, chunks_of_runs
from autocolor.scalars.corner_weights import corner_weights
from autocolor.scene.mesh import Mesh
from autocolor.visibility.visible_points import VisiblePoints

POINTS_AT_ONCE: Final = 1 << 14


class PolygonRuns(NamedTuple):
    """The polygons that the visible points see: rows of the polygon table, and how many points see each.

    Both are (runs,) intp, in the order of the points; neighbors differ.
    """

    polygons: Indices
    counts: Indices


class WeightedPoints(NamedTuple):
    """A chunk of visible points: its slice of them, its polygons, and the weights of the corners, (4, n)."""

    pixels: slice
    polygons: Indices
    counts: Indices
    weights: Floats

    def interpolated(self, corner_values: Floats) -> Floats:
        """Values at the points, (n,), of those at the corners of the polygons, (4, polygons).

        NaN is a missing value: a polygon with a corner that has none has none itself.
        """
        values: Floats = self.weights[0] * np.repeat(corner_values[0], self.counts)
        for weight, corner in zip(self.weights[1:], corner_values[1:], strict=True):
            values += weight * np.repeat(corner, self.counts)
        return values


def polygon_runs(points: VisiblePoints) -> PolygonRuns:
    """The polygons that the visible points see, one after the other."""
    polygons = points.span_polygons
    heads = np.flatnonzero(np.diff(polygons, prepend=-1))
    counts = np.add.reduceat(points.span_lengths, heads) if len(heads) else heads
    return PolygonRuns(polygons[heads], counts)


def weighted_points(mesh: Mesh, points: VisiblePoints) -> Iterator[WeightedPoints]:
    """The visible points in chunks, with the weights of the corners of the polygons that they are in."""
    polygons, counts = polygon_runs(points)
    coordinate_rows, node_rows = mesh.coordinates.T, mesh.node_numbers.T
    for part, pixels in chunks_of_runs(counts, POINTS_AT_ONCE):
        corners = np.take(coordinate_rows, np.take(node_rows, polygons[part], axis=1), axis=1)
        weights = corner_weights(corners, counts[part], points.world_rows(pixels))
        yield WeightedPoints(pixels, polygons[part], counts[part], weights)


def interpolated(mesh: Mesh, points: VisiblePoints, corner_values: Callable[[Indices], Floats]) -> Singles:
    """Values at the visible points, (n,) float32, of those at the corners of polygons.

    `corner_values` gives those of some rows of the polygon table, (4, polygons).
    """
    values = np.empty(len(points.pixels), np.float32)
    for chunk in weighted_points(mesh, points):
        values[chunk.pixels] = chunk.interpolated(corner_values(chunk.polygons))
    return values
