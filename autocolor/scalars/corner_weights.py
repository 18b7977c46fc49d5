"""The weights of a polygon's corners at points in it, by which numbers at the corners are interpolated.

Assumed: in a triangle they are the barycentric coordinates, and in a convex quad the generalized ones of
Wachspress, which are linear where the numbers at the four corners are. Nothing is divided but by the sum, and
no weight is negative, so a value is never beyond those of the corners. A quad with a notch is split at it
into two triangles. A warped quad counts as its projection along the normal of its diagonals, and a quad that
crosses itself, or a polygon without area, has weights that are merely not negative.

Measured: what is the same for all points of a polygon is computed for the polygon, in float64, and repeated
row by row. A repetition of several rows at once takes three times as long.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from autocolor.arrays import Booleans, Floats, Indices, Real, RealArray, cross


def corner_weights(corners: Floats, counts: Indices, points: RealArray[Real]) -> RealArray[Real]:
    """The weights of the four corners at each point, (4, points); each column adds up to 1.

    `corners` is (3, 4, polygons), and a triangle repeats a corner; `points`, (3, points), has those in each
    polygon one after the other, as many as `counts`, (polygons,), says. The weights are of their type.
    """
    weights = np.zeros((4, points.shape[1]), points.dtype)
    # A side without length makes a triangle; it should be the one between the last two corners.
    no_side = (corners == np.roll(corners, -1, axis=1)).all(axis=0)
    triangles = no_side.any(axis=0)
    if not triangles.any():
        _weigh_in_quads(corners, counts, points, weights)
    elif no_side[2].all():
        _weigh_in_triangles(corners[:, :3], counts, points, weights)
    else:
        _weigh_in_both(corners, counts, points, weights, no_side)
    return _normalized(weights)


def _normalized(weights: RealArray[Real]) -> RealArray[Real]:
    """The weights, in their own array, divided by their sums; equal ones where the sum is 0."""
    sums: RealArray[Real] = weights[0] + weights[1]
    for weight in weights[2:]:
        sums += weight
    if not sums.all():
        nothing = np.flatnonzero(sums == 0)
        weights[:, nothing], sums[nothing] = 0.25, 1.0
    weights /= sums
    return weights


def _weigh_in_both(
    corners: Floats, counts: Indices, points: RealArray[Real], weights: RealArray[Real], no_side: Booleans
) -> None:
    """Fill in the weights in triangles, which have `no_side` between two of their corners, and in quads."""
    triangles = no_side.any(axis=0)
    places = (no_side[:, triangles].argmax(axis=0) + np.arange(2, 5)[:, None]) % 4
    quad_places = np.repeat(np.arange(4)[:, None], np.count_nonzero(~triangles), axis=1)
    for chosen, at, weigh in (
        (triangles, places, _weigh_in_triangles),
        (~triangles, quad_places, _weigh_in_quads),
    ):
        columns = np.flatnonzero(np.repeat(chosen, counts))
        within = np.zeros((len(at), len(columns)), points.dtype)
        own = np.compress(chosen, corners, axis=2)[:, at, np.arange(at.shape[1])]
        weigh(own, counts[chosen], np.take(points, columns, axis=1), within)
        weights[np.repeat(at, counts[chosen], axis=1), columns] = within


def _weigh_in_triangles(
    corners: Floats, counts: Indices, points: RealArray[Real], weights: RealArray[Real]
) -> None:
    """Fill in the weights of the corners, (3, 3, triangles), at each point, up to a factor."""
    outline = _outline(corners, points.dtype)
    normals = cross(outline.sides[:, 0], outline.sides[:, 1])
    # The weight of a corner is the area on the opposite side.
    weights[2], weights[0], weights[1] = _areas(outline, normals, counts, points)


def _weigh_in_quads(
    corners: Floats, counts: Indices, points: RealArray[Real], weights: RealArray[Real]
) -> None:
    """Fill in the weights of the corners, (3, 4, quads), at each point, up to a factor."""
    outline = _outline(corners, points.dtype)
    sides = outline.sides
    normals = cross(sides[:, 0] + sides[:, 1], sides[:, 1] + sides[:, 2])
    areas = _areas(outline, normals, counts, points)
    # How much the outline turns at each corner: the area of the triangle with its two neighbors.
    turns = np.einsum("kp,kcp->cp", normals, cross(np.roll(sides, 1, axis=1), sides))
    for corner, turn in enumerate(turns):
        np.multiply(areas[(corner + 1) % 4], areas[(corner + 2) % 4], out=weights[corner])
        weights[corner] *= np.repeat(np.maximum(turn, 0).astype(points.dtype), counts)
    notched = turns.min(axis=0, initial=0) < 0
    if notched.any():
        columns = np.flatnonzero(np.repeat(notched, counts))
        quads = np.repeat(np.arange(len(counts)), counts)[columns]
        weights[:, columns] = _weights_at_notches(
            np.take(corners, quads, axis=2), turns.argmin(axis=0)[quads], np.take(points, columns, axis=1)
        )


def _weights_at_notches(corners: Floats, notch: Indices, points: RealArray[Real]) -> RealArray[Real]:
    """The weights of four corners at a point in each of some quads that are split at their corner `notch`."""
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
    """The outlines of polygons: an origin near each, and its size; corners and sides in that measure.

    The origin is of the type of the points, so that it is subtracted from them without rounding.
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
    """The area between each side and each point, in some unit of the polygon; at least 0."""
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
