"""The weights of a polygon's corners at points in it, by which numbers at the corners are interpolated.

Assumed: in a triangle they are the barycentric coordinates, and in a convex quad the generalized ones of
Wachspress, which are linear where the numbers at the four corners are. Nothing is divided but by the sum, and
no weight is negative, so a value is never beyond those of the corners. A quad with a notch is split at it
into two triangles. A warped quad counts as its projection along the normal of its diagonals, and a quad that
crosses itself, or a polygon without area, has weights that are merely not negative.
"""

from __future__ import annotations

import numpy as np

from autocolor.arrays import Floats, Indices, cross


def corner_weights(corners: Floats, counts: Indices, points: Floats) -> Floats:
    """The weights of the four corners at each point, (4, points); each column adds up to 1.

    `corners` is (3, 4, polygons), and a triangle repeats a corner; `points`, (3, points), has those in
    each polygon one after the other, as many as `counts`, (polygons,), says.
    """
    weights = np.zeros((4, points.shape[1]))
    # A side without length makes a triangle; it should be the one between the last two corners.
    no_side = (corners == np.roll(corners, -1, axis=1)).all(axis=0)
    triangles = no_side.any(axis=0)
    if not triangles.any():
        return _normalized(_weights_in_quads(corners, counts, points, weights))
    if no_side[2].all():
        weights[:3] = _weights_in_triangles(corners[:, :3], counts, points)
        return _normalized(weights)
    columns = np.flatnonzero(np.repeat(~triangles, counts))
    quads, within = np.compress(~triangles, corners, axis=2), np.take(points, columns, axis=1)
    weights[:, columns] = _weights_in_quads(quads, counts[~triangles], within, np.zeros((4, len(columns))))
    columns = np.flatnonzero(np.repeat(triangles, counts))
    counts, column = counts[triangles], np.arange(np.count_nonzero(triangles))
    three = (no_side[:, triangles].argmax(axis=0) + np.arange(2, 5)[:, None]) % 4
    in_triangles = np.compress(triangles, corners, axis=2)[:, three, column]
    weights[np.repeat(three, counts, axis=1), columns] = _weights_in_triangles(
        in_triangles, counts, np.take(points, columns, axis=1)
    )
    return _normalized(weights)


def _normalized(weights: Floats) -> Floats:
    """The weights, in their own array, divided by their sums; equal ones where the sum is 0."""
    sums: Floats = weights.sum(axis=0)
    nothing = np.flatnonzero(sums == 0)
    if len(nothing):
        weights[:, nothing], sums[nothing] = 0.25, 1.0
    weights /= sums
    return weights


def _weights_in_triangles(corners: Floats, counts: Indices, points: Floats) -> Floats:
    """The weights of three corners, (3, 3, triangles), at each point, (3, points), up to a factor."""
    origin, size, sides = _sides(corners)
    areas = _areas(sides, corners, origin, size, cross(sides[:, 0], sides[:, 1]), counts, points)
    # The weight of a corner is the area on the opposite side.
    return areas[[1, 2, 0]]


def _weights_in_quads(corners: Floats, counts: Indices, points: Floats, weights: Floats) -> Floats:
    """The weights of four corners, (3, 4, quads), at each point, (4, points), up to a factor."""
    origin, size, sides = _sides(corners)
    normals = cross(sides[:, 0] + sides[:, 1], sides[:, 1] + sides[:, 2])
    areas = _areas(sides, corners, origin, size, normals, counts, points)
    # How much the outline turns at each corner: the area of the triangle with its two neighbors.
    turns = np.einsum("kp,kcp->cp", normals, cross(np.roll(sides, 1, axis=1), sides))
    for corner, turn in enumerate(turns):
        np.multiply(areas[(corner + 1) % 4], areas[(corner + 2) % 4], out=weights[corner])
        weights[corner] *= np.repeat(np.maximum(turn, 0), counts)
    notched = turns.min(axis=0, initial=0) < 0
    if notched.any():
        columns = np.flatnonzero(np.repeat(notched, counts))
        quads = np.repeat(np.arange(len(counts)), counts)[columns]
        weights[:, columns] = _weights_at_notches(
            np.take(corners, quads, axis=2), turns.argmin(axis=0)[quads], points[:, columns]
        )
    return weights


def _weights_at_notches(corners: Floats, notch: Indices, points: Floats) -> Floats:
    """The weights of four corners at a point in each of some quads that are split at their corner `notch`."""
    column = np.arange(len(notch))
    turned = (notch + np.arange(4)[:, None]) % 4
    from_notch = corners[:, turned, column]
    diagonal = from_notch[:, 2] - from_notch[:, 0]
    normals = cross(diagonal, from_notch[:, 3] - from_notch[:, 1])
    beyond = np.einsum("ij,ij->j", cross(normals, diagonal), points - from_notch[:, 0]) > 0
    # The triangle on the point's side of the diagonal.
    three = np.where(beyond, [[0], [2], [3]], [[0], [1], [2]])
    weights = np.zeros((4, len(notch)))
    in_triangles = _weights_in_triangles(from_notch[:, three, column], np.ones(len(notch), np.intp), points)
    weights[turned[three, column], column] = in_triangles
    return weights


def _sides(corners: Floats) -> tuple[Floats, Floats, Floats]:
    """The first corners, the sizes of polygons, and the sides from each corner on in proportion to these."""
    size = np.ptp(corners, axis=1).max(axis=0)
    size[size == 0] = 1.0
    return corners[:, 0], size, (np.roll(corners, -1, axis=1) - corners) / size


def _areas(
    sides: Floats,
    corners: Floats,
    origin: Floats,
    size: Floats,
    normals: Floats,
    counts: Indices,
    points: Floats,
) -> Floats:
    """The area between each side and each point, (sides, points), in some unit of the polygon; at least 0."""
    relative = points - np.repeat(origin, counts, axis=1)
    areas = np.empty((sides.shape[1], points.shape[1]))
    for side, area in enumerate(areas):
        inward = cross(normals, sides[:, side])
        start = np.einsum("kp,kp->p", inward, (corners[:, side] - origin) / size)
        np.einsum("kn,kn->n", np.repeat(inward / size, counts, axis=1), relative, out=area)
        area -= np.repeat(start, counts)
        np.maximum(area, 0, out=area)
    return areas
