"""The visible points in chunks, with the polygon that each is in and the weights of its corners."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Final, NamedTuple

import numpy as np

from autocolor.arrays import Floats, Indices, Singles, chunks_of_runs
from autocolor.scalars.corner_weights import corner_weights
from autocolor.scene.mesh import Mesh
from autocolor.visibility.visible_points import POINT, VisiblePoints

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
    weights: Singles

    def interpolated(self, corner_values: Floats) -> Singles:
        """Values at the points, (n,), of those at the corners of the polygons, (4, polygons).

        NaN is a missing value: a polygon with a corner that has none has none itself.
        """
        # The weights are rounded: weigh differences from one corner, so that what is constant stays so.
        first = corner_values[0].astype(np.float32)
        values = np.repeat(first, self.counts)
        for weight, difference in zip(self.weights[1:], corner_values[1:] - first, strict=True):
            part = np.repeat(difference.astype(np.float32), self.counts)
            part *= weight
            values += part
        return values


def polygon_runs(points: VisiblePoints) -> PolygonRuns:
    """The polygons that the visible points see, one after the other."""
    polygons = points.span_polygons
    heads = np.flatnonzero(np.diff(polygons, prepend=-1))
    counts = np.add.reduceat(points.span_lengths, heads) if len(heads) else heads
    return PolygonRuns(polygons[heads], counts)


def weighted_points(mesh: Mesh, points: VisiblePoints) -> Iterator[WeightedPoints]:
    """The visible points in chunks, with the weights of the corners of the polygons that they are in.

    The corners are taken to where the points are, in camera space, and not the points to the world.
    """
    polygons, counts = polygon_runs(points)
    coordinate_rows, node_rows = mesh.coordinates.T, mesh.node_numbers.T
    eye, middle = np.array(points.view.eye)[:, None], points.middle[:, None]
    for part, pixels in chunks_of_runs(counts, POINTS_AT_ONCE):
        nodes = np.take(node_rows, polygons[part], axis=1)
        world = np.take(coordinate_rows, nodes.ravel(), axis=1) - eye
        corners = (points.view.axes @ world / points.unit - middle).reshape(3, 4, -1)
        weights = corner_weights(corners, counts[part], points.rows[POINT, pixels])
        yield WeightedPoints(pixels, polygons[part], counts[part], weights)


def interpolated(mesh: Mesh, points: VisiblePoints, corner_values: Callable[[Indices], Floats]) -> Singles:
    """Values at the visible points, (n,) float32, of those at the corners of polygons.

    `corner_values` gives those of some rows of the polygon table, (4, polygons).
    """
    values = np.empty(len(points.pixels), np.float32)
    for chunk in weighted_points(mesh, points):
        values[chunk.pixels] = chunk.interpolated(corner_values(chunk.polygons))
    return values
