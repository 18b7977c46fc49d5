"""Silhouettes: the smooth edges of a mesh between a polygon that faces the viewer and one that does not.

The viewer is far away in a direction, as in the three views, or an eye.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from autocolor.arrays import Booleans, Floats, Indices
from autocolor.screens.light_and_view.mesh_edges import MeshEdges

EDGE_ON: Final = 1e-9
"""Assumed: a polygon seen under a smaller sine than this is edge-on, and does not face the viewer.

Rounding would decide about the sides of a cylinder that is looked at along its axis.
"""


def silhouette_toward(edges: MeshEdges, toward: Sequence[float]) -> Indices:
    """The nodes of the silhouette for a viewer far away, (n, 2); `toward` is the unit vector to that."""
    return _between(edges, _heights(edges.normals, toward) > EDGE_ON)


def silhouette_from(edges: MeshEdges, eye: Sequence[float]) -> Indices:
    """The nodes of the silhouette that an eye at a point sees, (n, 2)."""
    return _between(edges, _heights(edges.normals, eye) > edges.offsets)


def _heights(normals: Floats, vector: Sequence[float]) -> Floats:
    """The dot product of each normal, (3, n), with a vector."""
    x, y, z = vector
    heights: Floats = normals[0] * x
    heights += normals[1] * y
    heights += normals[2] * z
    return heights


def _between(edges: MeshEdges, facing: Booleans) -> Indices:
    """The smooth edges between a polygon that faces the viewer and one that does not.

    The front of one of two polygons of opposite winding continues the back of the other: a silhouette passes
    between them where both face the viewer, or neither does.
    """
    one, other = edges.polygons
    found = facing.take(one) ^ facing.take(other)
    found ^= edges.same_direction
    return np.take(edges.smooth, np.flatnonzero(found), axis=0)
