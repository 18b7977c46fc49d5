"""Counting the quads of a mesh that are warped, concave or crossed; the renderer accepts them all."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from autocolor.scene.mesh import Mesh

WARPED: Final = 0.01
"""Assumed: a quad is warped if the distance of its diagonals exceeds this fraction of its size."""


@dataclass(frozen=True)
class QuadShapes:
    """Counts of quads: all, non-planar ones, ones with one reflex corner, and bow-ties."""

    quads: int
    warped: int
    concave: int
    crossed: int


def quad_shapes(mesh: Mesh) -> QuadShapes:
    """The counts for a mesh; a concave or crossed quad may also count as warped."""
    quads = mesh.node_numbers[mesh.node_numbers[:, 2] != mesh.node_numbers[:, 3]]
    corners = mesh.coordinates[quads]
    size = np.ptp(corners, axis=1).max(axis=1)
    size[size == 0] = 1.0
    corners = (corners - corners[:, :1]) / size[:, None, None]

    # The normal is the cross product of the diagonals.
    normals = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
    lengths = np.linalg.norm(normals, axis=1)
    flat = lengths < 1e-12
    normals /= np.where(flat, 1.0, lengths)[:, None]
    apart = np.abs(((corners[:, 1] - corners[:, 0]) * normals).sum(axis=1))

    # A corner that turns against the normal is reflex; two of them make a bow-tie.
    edges = np.roll(corners, -1, axis=1) - corners
    turns = (np.cross(np.roll(edges, 1, axis=1), edges) * normals[:, None]).sum(axis=2)
    against = (turns < -1e-9).sum(axis=1)
    return QuadShapes(
        len(quads),
        int((apart > WARPED).sum()),
        int((against == 1).sum()),
        int(((against > 1) | flat).sum()),
    )
