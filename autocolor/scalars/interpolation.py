"""Interpolation: numbers at the visible points, by the weights of the corners of their polygons."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Final, NamedTuple

import numpy as np

from autocolor.arrays import (
    Bytes,
    Floats,
    Indices,
    Real,
    RealArray,
    Singles,
    chunks_of_runs,
    cross,
    dot,
    normalized,
)
from autocolor.scene.geometry.diagonals import NO_DIAGONAL
from autocolor.scene.mesh import Mesh
from autocolor.scene.scene import INVARIANT
from autocolor.visibility.visible_points import POINT, VisiblePoints

POINTS_AT_ONCE: Final = 1 << 14

ROUNDING: Final = 1e-9
"""How much a straight corner may turn inward by rounding, as a fraction of the largest turn."""


class WeightedPoints(NamedTuple):
    """A chunk of the visible points, the slice `pixels`, with the weights of the corners of their polygons.

    `polygons` and `counts` are as in `polygon_runs`; `weights` is (4, n). If quads are two triangles,
    `triangles`, (3, polygons), has the corners of a triangle in each polygon, and `weights` is (3, n).
    """

    pixels: slice
    polygons: Indices
    counts: Indices
    weights: Singles
    triangles: Indices | None

    def interpolated(self, corner_values: Floats) -> Singles:
        """Values at the points, (n,), interpolated from the corners of the polygons, (4, polygons).

        NaN is a missing value. A polygon with a missing corner has no value at any point.
        """
        # The weights are rounded. Weigh the differences from the first corner: a constant stays constant.
        if self.triangles is not None:
            missing = np.isnan(corner_values).any(axis=0)
            corner_values = np.take_along_axis(corner_values, self.triangles, axis=0)
            corner_values[:, missing] = np.nan
        first = corner_values[0].astype(np.float32)
        values = np.repeat(first, self.counts)
        for weight, difference in zip(self.weights[1:], corner_values[1:] - first, strict=True):
            part = np.repeat(difference.astype(np.float32), self.counts)
            part *= weight
            values += part
        return values


def polygon_runs(points: VisiblePoints) -> tuple[Indices, Indices]:
    """The polygons of the runs of visible points that see the same polygon, and the points in each run.

    Both are (runs,) intp, in the order of the points; polygons are rows of the polygon table.
    """
    polygons = points.span_polygons
    heads = np.flatnonzero(np.diff(polygons, prepend=-1))
    counts = np.add.reduceat(points.span_lengths, heads) if len(heads) else heads
    return polygons[heads], counts


def weighted_points(mesh: Mesh, points: VisiblePoints) -> Iterator[WeightedPoints]:
    """The visible points in chunks, with the weights of the corners of their polygons.

    The corners are transformed to camera space, which is less work than all points to the world.
    """
    polygons, counts = polygon_runs(points)
    if points.interpolation == INVARIANT:
        # A span lies in one triangle, a run may lie in two.
        polygons, counts = points.span_polygons, points.span_lengths
    coordinate_rows, node_rows = mesh.coordinates.T, mesh.node_numbers.T
    eye, origin = np.array(points.view.eye)[:, None], points.origin[:, None]
    for part, pixels in chunks_of_runs(counts, POINTS_AT_ONCE):
        nodes = np.take(node_rows, polygons[part], axis=1)
        world = np.take(coordinate_rows, nodes.ravel(), axis=1) - eye
        corners = (points.view.axes @ world / points.unit - origin).reshape(3, 4, -1)
        within = points.rows[POINT, pixels]
        if points.interpolation == INVARIANT:
            middles = np.cumsum(counts[part]) - 1 - counts[part] // 2
            starts = mesh.diagonals.starts.take(polygons[part])
            triangles = triangles_at(corners, starts, np.take(within, middles, axis=1))
            weights = triangle_weights(
                np.take_along_axis(corners, triangles[None], axis=1), counts[part], within
            )
        else:
            triangles, weights = None, corner_weights(corners, counts[part], within)
        yield WeightedPoints(pixels, polygons[part], counts[part], weights, triangles)


def interpolated(mesh: Mesh, points: VisiblePoints, corner_values: Callable[[Indices], Floats]) -> Singles:
    """Values at the visible points, (n,) float32, interpolated from the corners of their polygons.

    `corner_values` returns the values at the corners of some rows of the polygon table, (4, polygons).
    """
    values = np.empty(len(points.pixels), np.float32)
    for chunk in weighted_points(mesh, points):
        values[chunk.pixels] = chunk.interpolated(corner_values(chunk.polygons))
    return values


def triangles_at(corners: Floats, starts: Bytes, points: Singles) -> Indices:
    """The corners, (3, polygons), of the triangle that contains a point of each polygon.

    `corners` is (3, 4, polygons), and `starts`, (polygons,), is as in `Diagonals`.
    """
    first = np.where(starts == NO_DIAGONAL, 0, starts).astype(np.intp)
    column = np.arange(len(first))
    start, second, end, fourth = (corners[:, (first + turn) & 3, column] for turn in range(4))
    diagonal = end - start
    inward = cross(cross(diagonal, fourth - second), diagonal)
    is_beyond = (dot(inward, points - start) > 0) & (starts != NO_DIAGONAL)
    triangles: Indices = (first + 2 * is_beyond + np.arange(3)[:, None]) & 3
    return triangles


# The weights of corners.
#
# Assumed: in a triangle the weights are the barycentric coordinates. If the scene's interpolation is
# invariant, a quad is two triangles. If it follows the scan lines, the weights in a convex quad are the
# generalized barycentric coordinates of Wachspress, which reproduce linear functions; a quad with a notch is
# split there into two triangles. Weights are never negative and add up to 1, so a value is never beyond the
# values of the corners. A warped quad counts as its projection along the normal of its diagonals. A quad that
# crosses itself, or a polygon without area, has weights that are merely not negative.
#
# Numbers that all points of a polygon share are computed once a polygon, in float64, and repeated row by row.
# Measured: repeating several rows at once takes three times as long.


def corner_weights(corners: Floats, counts: Indices, points: RealArray[Real]) -> RealArray[Real]:
    """The weights of the four corners at each point, (4, points); each column adds up to 1.

    `corners` is (3, 4, polygons), and a triangle repeats a corner. `points`, (3, points), are sorted by
    polygon; `counts`, (polygons,), has the number of points in each. The weights are of the points' type.
    """
    weights = np.zeros((4, points.shape[1]), points.dtype)
    # A side without length makes a triangle; usually it is the side between the last two corners.
    no_side = (corners == np.roll(corners, -1, axis=1)).all(axis=0)
    if no_side[2].all():
        _weigh_in_triangles(corners[:, :3], counts, points, weights)
        return _adding_up_to_1(weights)
    # Measured: if some are triangles, weighing them twice takes less time than dividing the polygons.
    _weigh_in_quads(corners, counts, points, weights)
    triangles = np.flatnonzero(no_side.any(axis=0))
    if len(triangles):
        three = (no_side[:, triangles].argmax(axis=0) + np.arange(2, 5)[:, None]) % 4
        columns = np.flatnonzero(np.repeat(no_side.any(axis=0), counts))
        within = np.zeros((3, len(columns)), points.dtype)
        counts = counts[triangles]
        _weigh_in_triangles(corners[:, three, triangles], counts, np.take(points, columns, axis=1), within)
        weights[:, columns] = 0
        weights[np.repeat(three, counts, axis=1), columns] = within
    return _adding_up_to_1(weights)


def triangle_weights(corners: Floats, counts: Indices, points: RealArray[Real]) -> RealArray[Real]:
    """The weights of the corners of triangles, (3, 3, triangles), at each point, (3, points).

    `counts` and `points` are as in `corner_weights`.
    """
    weights = np.empty((3, points.shape[1]), points.dtype)
    _weigh_in_triangles(corners, counts, points, weights)
    return _adding_up_to_1(weights)


def _adding_up_to_1(weights: RealArray[Real]) -> RealArray[Real]:
    """The weights, in their own array, divided by their sums; all equal where the sum is 0."""
    sums: RealArray[Real] = weights[0] + weights[1]
    for weight in weights[2:]:
        sums += weight
    if not sums.all():
        nothing = np.flatnonzero(sums == 0)
        weights[:, nothing], sums[nothing] = 1 / len(weights), 1.0
    weights /= sums
    return weights


def _weigh_in_triangles(
    corners: Floats, counts: Indices, points: RealArray[Real], weights: RealArray[Real]
) -> None:
    """Fill in the weights of the corners, (3, 3, triangles), at each point, up to a factor."""
    outline = _outline(corners, points.dtype)
    # Normalize, so that the areas in a sliver are not too small for float32.
    normals = normalized(cross(outline.sides[:, 0], outline.sides[:, 1]))
    # The weight of a corner is the area on the opposite side.
    weights[2], weights[0], weights[1] = _areas(outline, normals, counts, points)


def _weigh_in_quads(
    corners: Floats, counts: Indices, points: RealArray[Real], weights: RealArray[Real]
) -> None:
    """Fill in the weights of the corners, (3, 4, quads), at each point, up to a factor."""
    outline = _outline(corners, points.dtype)
    sides = outline.sides
    normals = normalized(cross(sides[:, 0] + sides[:, 1], sides[:, 1] + sides[:, 2]))
    areas = _areas(outline, normals, counts, points)
    # How much the outline turns at each corner: the area of the triangle with its two neighbors.
    turns = np.einsum("kp,kcp->cp", normals, cross(np.roll(sides, 1, axis=1), sides))
    for corner, turn in enumerate(turns):
        np.multiply(areas[(corner + 1) % 4], areas[(corner + 2) % 4], out=weights[corner])
        weights[corner] *= np.repeat(np.maximum(turn, 0).astype(points.dtype), counts)
    notched = turns.min(axis=0, initial=0) < -ROUNDING * turns.max(axis=0, initial=0)
    if notched.any():
        columns = np.flatnonzero(np.repeat(notched, counts))
        quads = np.repeat(np.arange(len(counts)), counts)[columns]
        weights[:, columns] = _weights_at_notches(
            np.take(corners, quads, axis=2), turns.argmin(axis=0)[quads], np.take(points, columns, axis=1)
        )


def _weights_at_notches(corners: Floats, notch: Indices, points: RealArray[Real]) -> RealArray[Real]:
    """The weights of the corners at one point in each quad; the quads are split at their corner `notch`."""
    column = np.arange(len(notch))
    turned = (notch + np.arange(4)[:, None]) % 4
    from_notch = corners[:, turned, column]
    diagonal = from_notch[:, 2] - from_notch[:, 0]
    normals = cross(diagonal, from_notch[:, 3] - from_notch[:, 1])
    beyond = np.einsum("ij,ij->j", cross(normals, diagonal), points - from_notch[:, 0]) > 0
    # The triangle on the point's side of the diagonal.
    three = np.where(beyond, [[0], [2], [3]], [[0], [1], [2]])
    weights = np.zeros((4, len(notch)), points.dtype)
    in_triangles = np.zeros((3, len(notch)), points.dtype)
    _weigh_in_triangles(from_notch[:, three, column], np.ones(len(notch), np.intp), points, in_triangles)
    weights[turned[three, column], column] = in_triangles
    return weights


class _Outline(NamedTuple):
    """The outlines of polygons: an origin near each polygon, its size, and corners and sides over the size.

    The origin has the type of the points, so that it is subtracted from them without rounding.
    """

    origin: Floats
    size: Floats
    starts: Floats
    sides: Floats


def _outline(corners: Floats, dtype: np.dtype[Real]) -> _Outline:
    origin = corners[:, 0].astype(dtype).astype(np.float64)
    size = np.ptp(corners, axis=1).max(axis=0)
    size[size == 0] = 1.0
    starts = (corners - origin[:, None]) / size
    return _Outline(origin, size, starts, (np.roll(corners, -1, axis=1) - corners) / size)


def _areas(
    outline: _Outline, normals: Floats, counts: Indices, points: RealArray[Real]
) -> list[RealArray[Real]]:
    """The area between each side and each point, at least 0, in a unit that all areas of a polygon share."""
    dtype = points.dtype
    relative = [
        row - np.repeat(origin.astype(dtype), counts)
        for row, origin in zip(points, outline.origin, strict=True)
    ]
    areas = []
    for side in range(outline.sides.shape[1]):
        inward = cross(normals, outline.sides[:, side])
        start = np.einsum("kp,kp->p", inward, outline.starts[:, side])
        area = np.repeat(-start.astype(dtype), counts)
        for row, along in zip(relative, inward / outline.size, strict=True):
            factor = np.repeat(along.astype(dtype), counts)
            factor *= row
            area += factor
        np.maximum(area, 0, out=area)
        areas.append(area)
    return areas
