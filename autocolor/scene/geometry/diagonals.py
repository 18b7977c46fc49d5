"""The diagonal along which a quad is cut into two triangles, chosen in object space.

If a scene asks for `interpolation = "invariant"`, every quad is two triangles, the same in every view.

Assumed: the diagonal lies inside the quad. If both diagonals do, it is the shorter one, because the longer
one is more likely to cut across a bend. In regular meshes both are often equally long, and rounding must not
decide for each quad anew: then the diagonal leads through the corner with the lowest node number. Nothing
depends on the corner that is written first.
"""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np

from autocolor.arrays import Bytes, Floats, Indices, Singles, chunks, cross, dot, underflowing
from autocolor.immutable import read_only

NO_DIAGONAL: Final = 2
"""The start of the diagonal of a triangle, which has none."""

STRAIGHT: Final = 1e-6
"""Assumed: if the diagonals cross within this fraction of their lengths from an end, the corner there is
straight. The diagonal then leads through that corner."""

EQUAL: Final = 1e-6
"""Assumed: the squares of two lengths are equal within this fraction, as files have six digits and more."""

POLYGONS_AT_ONCE: Final = 1 << 14


class Diagonals(NamedTuple):
    """The diagonals of polygons.

    `starts`, (n,) uint8, is the corner where the diagonal begins: 0 for corners 0 and 2, 1 for corners 1 and
    3, NO_DIAGONAL for a triangle of the first three corners. `warps`, (n,) float32, is the distance between
    the lines of the two diagonals, 0 for a flat quad; it is infinite for a quad that is not convex.
    """

    starts: Bytes
    warps: Singles

    def some(self, polygons: Indices) -> Diagonals:
        """The diagonals of some of the polygons, copied."""
        return Diagonals(self.starts.take(polygons), self.warps.take(polygons))


@underflowing
def quad_diagonals(coordinates: Floats, node_numbers: Indices) -> Diagonals:
    """The diagonals of all polygons of a mesh, read-only.

    Measured: a million quads take 0.09 s, once, and five bytes each.
    """
    starts = np.empty(len(node_numbers), np.uint8)
    warps = np.empty(len(node_numbers), np.float32)
    for chunk in chunks(len(node_numbers), POLYGONS_AT_ONCE):
        nodes = node_numbers.T[:, chunk]
        starts[chunk], warps[chunk] = _of_polygons(np.take(coordinates.T, nodes, axis=1), nodes)
    return Diagonals(read_only(starts), read_only(warps))


def _of_polygons(corners: Floats, nodes: Indices) -> Diagonals:
    """The diagonals of polygons with these corners, (3, 4, n), and their node numbers, (4, n)."""
    size = np.ptp(corners, axis=1).max(axis=0)
    size[size == 0] = 1.0
    first, second, beside = (
        (corners[:, end] - corners[:, start]) / size for start, end in ((0, 2), (1, 3), (0, 1))
    )
    normals = cross(first, second)
    squares = dot(normals, normals)
    divisors = np.where(squares > 0, squares, 1.0)
    # Find where the diagonals cross, seen along their common normal, as fractions of the way along each.
    along_first = dot(cross(beside, second), normals) / divisors
    along_second = dot(cross(beside, first), normals) / divisors
    # A diagonal lies inside if it passes between the other two corners.
    first_inside, second_inside = (
        (fraction > STRAIGHT) & (fraction < 1 - STRAIGHT) for fraction in (along_second, along_first)
    )
    length, other_length = dot(first, first), dot(second, second)
    is_equal = np.abs(length - other_length) <= EQUAL * np.maximum(length, other_length)
    is_second = np.where(is_equal, nodes.argmin(axis=0) & 1 == 1, other_length < length)
    is_second = np.where(first_inside == second_inside, is_second, second_inside)
    warps = np.abs(dot(beside, normals)) / np.sqrt(divisors) * size
    warps[~(first_inside & second_inside)] = np.inf

    # If a triangle repeats its first or second corner, one of the two triangles at diagonal 0 has no area.
    sides = nodes == np.roll(nodes, -1, axis=0)
    is_triangle = sides.any(axis=0)
    warps[is_triangle] = 0.0
    starts = np.where(is_triangle, 0, is_second)
    starts[sides[2] | sides[3]] = NO_DIAGONAL
    with np.errstate(over="ignore"):
        return Diagonals(starts.astype(np.uint8), warps.astype(np.float32))
