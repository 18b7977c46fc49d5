"""Splitting quads that some line crosses four times into two triangles."""

from __future__ import annotations

import numpy as np

from autocolor.arrays import Booleans, Floats, Indices


def split_quads(
    quads: Indices, x: Floats, y: Floats, positions: Floats, corners: Indices, corner_normals: Indices
) -> tuple[Indices, Indices, Indices]:
    """The polygons with some quads replaced by two triangles each, and the column that each came from.

    A quad is split along the diagonal that has one of the other two corners on either side, so that a dart is
    split at its notch; where that holds for both or for neither, along the shorter one in camera space.
    Nothing depends on the corner that is written first. The triangles take the place of their quad.
    """
    nodes = corners[:, quads]
    quad_x, quad_y = x[nodes], y[nodes]
    first, second = (_divides(np.roll(quad_x, -c, axis=0), np.roll(quad_y, -c, axis=0)) for c in (0, 1))
    places = positions[:, nodes]
    diagonals = places[:, :2] - places[:, 2:]
    # Compare the lengths, and of equal ones the ends; two diagonals with the same ends are the same.
    ends = np.sort(places.reshape(3, 2, 2, -1), axis=1)
    along_first = _before(
        np.concatenate([[~first], (diagonals[:, :1] ** 2).sum(axis=0), *ends[:, :, 0]]),
        np.concatenate([[~second], (diagonals[:, 1:] ** 2).sum(axis=0), *ends[:, :, 1]]),
    )
    # Let the triangle whose own corner is before that of the other come first.
    off = np.where(along_first, [[1], [3]], [[2], [0]])
    column = np.arange(len(quads))
    own, other = (places[:, corner, column] for corner in off)
    off = np.where(_before(other, own), off[::-1], off)
    parents = np.sort(np.concatenate([np.arange(corners.shape[1]), quads]))
    split_corners, split_normals = corners[:, parents], corner_normals[:, parents]
    for half in (0, 1):
        picked = (off[half] + np.array([[3], [0], [1], [1]])) & 3
        for table, source in ((split_corners, corners), (split_normals, corner_normals)):
            table[:, quads + column + half] = source[picked, quads]
    return split_corners, split_normals, parents


def _divides(x: Floats, y: Floats) -> Booleans:
    """Whether corners 1 and 3 of quads lie on either side of the diagonal from 0 to 2."""
    # Follow the diagonal from the same end, whichever corner is 0, so that rounding is the same.
    start = np.where(_before(np.stack([x[0], y[0]]), np.stack([x[2], y[2]])), 0, 2)
    column = np.arange(len(start))
    left, top = x[start, column], y[start, column]
    across, down = x[2 - start, column] - left, y[2 - start, column] - top
    one, other = (across * (y[corner] - top) - down * (x[corner] - left) for corner in (1, 3))
    either_side: Booleans = ((one < 0) & (other > 0)) | ((one > 0) & (other < 0))
    return either_side


def _before(one: Floats, other: Floats) -> Booleans:
    """Whether each column of `one`, (rows, n), is less than that of `other` in the first row that differs."""
    before = np.zeros(one.shape[1], np.bool_)
    for row, other_row in zip(reversed(one), reversed(other), strict=True):
        before = (row < other_row) | ((row == other_row) & before)
    return before
