"""The polygons that are warped, concave or crossed quads, or have no area; the renderer accepts them all."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from autocolor.arrays import Booleans, Floats, Indices, chunks, cross, dot, lengths
from autocolor.scene.mesh import Mesh

WARPED: Final = 0.01
"""Assumed: a quad is warped if the distance of its diagonals exceeds this fraction of its size."""

FLAT: Final = 1e-12
"""Assumed: a polygon has no area if twice its area is below this fraction of its squared size."""

AT_A_TIME: Final = 1 << 14
"""Quads to look at at once, so that the arrays fit in the processor cache."""


@dataclass(frozen=True)
class QuadShapes:
    """Counts of quads: all, non-planar ones, ones with one reflex corner, and bow-ties."""

    quads: int
    warped: int
    concave: int
    crossed: int


@dataclass(frozen=True, eq=False)
class Shapes:
    """The rows of polygons of each shape; one may be in several of them."""

    warped: Indices
    concave: Indices
    crossed: Indices
    without_area: Indices


def quad_shapes(mesh: Mesh) -> QuadShapes:
    """The counts for a mesh; a concave or crossed quad may also count as warped."""
    found = polygon_shapes(mesh.coordinates, mesh.node_numbers)
    quads = len(mesh.node_numbers) - mesh.triangle_count
    return QuadShapes(quads, len(found.warped), len(found.concave), len(found.crossed))


def polygon_shapes(coordinates: Floats, node_numbers: Indices) -> Shapes:
    """The rows of warped, concave and crossed quads, and of polygons without area."""
    found: tuple[list[Indices], ...] = ([], [], [], [])
    for chunk in chunks(len(node_numbers), AT_A_TIME):
        rows = node_numbers[chunk]
        shapes = _shapes(np.ascontiguousarray(coordinates[rows].T), rows[:, 2] != rows[:, 3])
        for each, mask in zip(found, shapes, strict=True):
            each.append(np.flatnonzero(mask) + chunk.start)
    none = np.empty(0, np.intp)
    return Shapes(*(np.concatenate([none, *each]) for each in found))


def _shapes(corners: Floats, is_quad: Booleans) -> tuple[Booleans, Booleans, Booleans, Booleans]:
    """Which polygons are warped, concave, crossed, and without area; `corners` is (3, 4, polygons)."""
    size = np.ptp(corners, axis=1).max(axis=0)
    size[size == 0] = 1.0
    corners = (corners - corners[:, :1]) / size

    # The normal is the cross product of the diagonals.
    normals = cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
    length = lengths(normals)
    has_normal = length >= FLAT
    normals /= np.where(has_normal, length, 1.0)
    apart = np.abs(dot(corners[:, 1] - corners[:, 0], normals))

    # A corner that turns against the normal is reflex; two of them make a bow-tie.
    edges = np.roll(corners, -1, axis=1) - corners
    turned = np.zeros(corners.shape[2], np.intp)
    for corner in range(4):
        turned += dot(cross(edges[:, corner - 1], edges[:, corner]), normals) < -1e-9

    # Neither diagonal divides a polygon without area into a triangle that has some.
    halves = ((0, 1, 2), (0, 2, 3), (0, 1, 3), (1, 2, 3))
    has_area = np.zeros(corners.shape[2], np.bool_)
    for first, second, third in halves:
        one, other = corners[:, second] - corners[:, first], corners[:, third] - corners[:, first]
        has_area |= lengths(cross(one, other)) >= FLAT
    quads = is_quad & has_area
    return quads & (apart > WARPED), quads & (turned == 1), quads & ((turned > 1) | ~has_normal), ~has_area
