"""Curvature: how much the surface bends at each node normal.

Assumed: at each normal a quadric is fitted to the nodes next to it in the polygons that share the normal, by
least squares: h = p x + q y - (a x x + 2 b x y + c y y) / 2, where x and y are in the tangent plane and h is
along the normal. So there is no curvature across a crease, and the curvature of a surface does not depend on
the density of its nodes. Every neighbor counts the same, near or far, and the normals of the neighbors count
a little, too: they decide where there are few neighbors. Mean curvature is positive where the surface bends
away from its normal: a sphere of radius r that faces outward has 1/r.

Assumed: at the rim of a fan, with neighbors on one side only, the curvature is the mean of the neighbors
around which the surface is closed, if there are any.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from autocolor.arrays import Floats, Indices, Singles, chunks_of_runs, cross, dot, underflowing
from autocolor.immutable import Immutable, read_only
from autocolor.scene.geometry.normals import NodeNormals

CORNERS_AT_ONCE: Final = 1 << 14

NORMAL_WEIGHT: Final = 0.01
"""Assumed: the weight of a neighbor's normal, where its place has the weight 1."""

RIDGE: Final = 1e-9
"""Added to the diagonal of the equations, so that an unknown becomes 0 if no neighbor decides it."""

UNKNOWNS: Final = 5
"""The slopes p and q, and a, b and c."""

LEAST_SQUARE: Final = 1e-150
"""The least squared length of an edge that counts; float64 can hold the inverse of its square."""


@dataclass(frozen=True, eq=False, repr=False)
class Curvatures(Immutable):
    """Mean and Gaussian curvature at each row of `NodeNormals.vectors`, (normals,) float64, read-only.

    They are in the inverse of the world unit, and in its square.
    """

    mean: Floats
    gaussian: Floats


@underflowing
def curvatures(coordinates: Floats, node_numbers: Indices, normals: NodeNormals) -> Curvatures:
    """The curvatures at the normals of a mesh; 0 where a normal has no polygon with area.

    Arguments are as in `Mesh`. The equations are solved in chunks, with 5 more numbers a polygon.
    """
    numbers = np.ascontiguousarray(normals.numbers.T)
    node_rows, coordinate_rows = np.ascontiguousarray(node_numbers.T), np.ascontiguousarray(coordinates.T)
    own, polygons = numbers.ravel(), numbers.shape[1]
    order = np.argsort(own, kind="stable")
    counts = np.bincount(own, minlength=len(normals.vectors))
    values = np.empty((2, len(counts)))
    for rows, places in chunks_of_runs(counts, CORNERS_AT_ONCE):
        # The corners of a chunk of normals, and the three other corners of their polygons.
        corner, polygon = np.divmod(order[places], polygons)
        around = (corner + np.arange(4)[:, None]) % 4 * polygons + polygon
        equations = _equations(coordinate_rows, normals.vectors.T, node_rows.take(around), own.take(around))
        count = rows.stop - rows.start
        local = np.repeat(np.arange(count), counts[rows])
        sums: Floats = np.stack([np.bincount(local, row, count) for row in equations])
        values[:, rows] = _curvatures_of(_solved(sums))
    _take_from_closed(values, numbers)
    return Curvatures(read_only(values[0]), read_only(values[1]))


def _equations(coordinate_rows: Floats, vector_rows: Singles, nodes: Indices, numbers: Indices) -> Floats:
    """The terms that each corner adds to the equations of its normal, (20, corners).

    They are the upper triangle of the matrix by rows, and the right side. `nodes` and `numbers` are the nodes
    and the normals at the corner and at the corners after, across and before, (4, corners).
    """
    normal = np.take(vector_rows, numbers[0], axis=1).astype(np.float64)
    across, upward = _tangents(normal)
    points = np.take(coordinate_rows, nodes, axis=1)
    sums = np.zeros((UNKNOWNS * (UNKNOWNS + 3) // 2, numbers.shape[1]))
    triangles = (points == np.roll(points, 1, axis=1)).all(axis=0).any(axis=0)
    for step, neighbor in enumerate(numbers[1:], start=1):
        edge = points[:, step] - points[:, 0]
        turn = np.take(vector_rows, neighbor, axis=1) - normal
        square = dot(edge, edge)
        counts = square > LEAST_SQUARE
        if step == 2:
            # The corner across in a triangle is a neighbor already.
            counts &= ~triangles
        square[~counts] = 1.0
        weight = counts / (square * square)
        of_normal = NORMAL_WEIGHT * counts / square
        x, y, height = dot(edge, across), dot(edge, upward), dot(edge, normal)
        # The rows of the equations: height, then how the normal turns along both tangents.
        quadratic = (x, y, -0.5 * x * x, -x * y, -0.5 * y * y)
        _add(sums, dict(enumerate(quadratic)), height, weight)
        _add(sums, {0: -1.0, 2: x, 3: y}, dot(turn, across), of_normal)
        _add(sums, {1: -1.0, 3: x, 4: y}, dot(turn, upward), of_normal)
    return sums


def _add(sums: Floats, factors: dict[int, Floats | float], right: Floats, weight: Floats) -> None:
    """Add a weighted equation, the sum of factors times unknowns = right, to the normal equations."""
    for first, factor in factors.items():
        weighted = weight * factor
        sums[first - UNKNOWNS] += weighted * right
        # Where the row of the triangle begins, less its first column.
        start = first * (2 * UNKNOWNS - first - 1) // 2
        for second, other in factors.items():
            if second >= first:
                sums[start + second] += weighted * other


def _solved(sums: Floats) -> Floats:
    """The unknowns, (5, n), of symmetrical equations as `_equations` adds them up: by elimination."""
    count = sums.shape[1]
    matrix = np.empty((UNKNOWNS, UNKNOWNS + 1, count))
    for place, (row, column) in enumerate(zip(*np.triu_indices(UNKNOWNS), strict=True)):
        matrix[row, column] = matrix[column, row] = sums[place]
    matrix[:, UNKNOWNS] = sums[-UNKNOWNS:]
    # Scale each unknown so that the diagonal is 1: then the size of the mesh does not matter.
    scale = np.sqrt(np.einsum("kkn->kn", matrix[:, :UNKNOWNS]))
    scale[scale == 0] = 1.0
    matrix /= scale[:, None]
    matrix[:, :UNKNOWNS] /= scale
    for pivot in range(UNKNOWNS):
        matrix[pivot, pivot] += RIDGE
    for pivot in range(UNKNOWNS):
        matrix[pivot, pivot + 1 :] /= matrix[pivot, pivot]
        for other in range(UNKNOWNS):
            if other != pivot:
                matrix[other, pivot + 1 :] -= matrix[other, pivot] * matrix[pivot, pivot + 1 :]
    unknowns: Floats = matrix[:, UNKNOWNS] / scale
    return unknowns


def _curvatures_of(unknowns: Floats) -> Floats:
    """Mean and Gaussian curvature, (2, n), of quadrics with the slopes p and q where they are taken."""
    p, q, a, b, c = unknowns
    square = 1 + p * p + q * q
    mean = ((1 + q * q) * a - 2 * p * q * b + (1 + p * p) * c) / (2 * square * np.sqrt(square))
    return np.stack([mean, (a * c - b * b) / (square * square)])


def _take_from_closed(values: Floats, numbers: Indices) -> None:
    """Give each normal of a fan with a rim the mean of the values of its neighbors with closed fans."""
    own, count = numbers.ravel(), values.shape[1]
    after, across, before = (np.roll(numbers, -step, axis=0).ravel() for step in (1, 2, 3))
    # Each edge within a fan leads to one corner after and to one before.
    closed = np.bincount(own, after - before, count) == 0
    if closed.all():
        return
    counts, sums = np.zeros(count), np.zeros((2, count))
    for neighbor in (after, across, before):
        weight = closed[neighbor].astype(np.float64)
        counts += np.bincount(own, weight, count)
        for sum_row, row in zip(sums, values, strict=True):
            sum_row += np.bincount(own, weight * row[neighbor], count)
    rims = np.flatnonzero(~closed & (counts > 0))
    values[:, rims] = sums[:, rims] / counts[rims]


def _tangents(normals: Floats) -> tuple[Floats, Floats]:
    """Two unit vectors at right angles to each unit normal, (3, n), and to each other."""
    least = np.abs(normals).argmin(axis=0)
    along = np.zeros_like(normals)
    along[least, np.arange(len(least))] = 1.0
    across = cross(normals, along)
    across /= np.sqrt(dot(across, across))
    return across, cross(normals, across)
