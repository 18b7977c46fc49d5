"""The creases that a picture shows: neighboring pixels that see two polygons which meet at an edge."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from autocolor import Mesh
from autocolor.arrays import Booleans, Floats, Indices, dot
from autocolor.scene.geometry.normals import places_of_corners, polygon_normals
from autocolor.visibility.visible_points import VisiblePoints

CREASED: Final = 20.0
"""In degrees: normals that differ by more are of two sides of a crease."""


@dataclass(frozen=True, eq=False)
class Creases:
    """Pairs of neighboring pixels on two sides of a crease, sorted by edge.

    `one` and `other` are their flat places in the raster, `edges` the edge of each pair, counted from 0.
    """

    one: Indices
    other: Indices
    edges: Indices

    @property
    def pairs_of_edge(self) -> Indices:
        """How many pairs each edge has."""
        return np.bincount(self.edges).astype(np.intp)


def visible_creases(mesh: Mesh, points: VisiblePoints) -> Creases:
    """The creases of a mesh among its visible points.

    A pair counts if its polygons share an edge, so that a silhouette before something else does not, and if
    both the polygons' normals and those that the pixels are lit by differ: an edge that is shaded smoothly
    is no crease.
    """
    one, other = _neighbors(points)
    polygons = points.polygon_numbers
    one, other = (places[polygons[one] != polygons[other]] for places in (one, other))
    edges = _shared_edges(mesh, polygons[one], polygons[other])
    creased = (edges >= 0) & _differ(mesh, points, one, other)
    one, other = one[creased], other[creased]
    _, numbers = np.unique(edges[creased], return_inverse=True)
    order = np.argsort(numbers, kind="stable")
    return Creases(points.pixels[one[order]], points.pixels[other[order]], numbers[order].astype(np.intp))


def _neighbors(points: VisiblePoints) -> tuple[Indices, Indices]:
    """The visible points that are beside or below each other, as two arrays of their numbers."""
    flat = np.full(points.lines * points.elements, -1, np.intp)
    flat[points.pixels] = np.arange(len(points.pixels))
    raster = flat.reshape(points.lines, points.elements)
    one = np.concatenate([raster[:, :-1].ravel(), raster[:-1].ravel()])
    other = np.concatenate([raster[:, 1:].ravel(), raster[1:].ravel()])
    seen = (one >= 0) & (other >= 0)
    return one[seen], other[seen]


def _shared_edges(mesh: Mesh, one: Indices, other: Indices) -> Indices:
    """A number of the edge that two polygons share, for each of many pairs of them; -1 where they share none.

    Nodes at the same place count as one.
    """
    start = places_of_corners(mesh.coordinates.T, mesh.node_numbers.T).T
    end = np.roll(start, -1, axis=1)
    of_polygon = np.minimum(start, end) * (int(start.max(initial=0)) + 1) + np.maximum(start, end)
    of_polygon[start == end] = -1
    edges = np.full(len(one), -1, np.intp)
    for column in range(4):
        mine = of_polygon[one, column]
        shared = (mine >= 0) & (of_polygon[other] == mine[:, None]).any(axis=1)
        edges[shared] = mine[shared]
    return edges


def _differ(mesh: Mesh, points: VisiblePoints, one: Indices, other: Indices) -> Booleans:
    """Whether both kinds of normals differ by more than CREASED, for pairs of visible points."""
    least = np.cos(np.radians(CREASED))
    shading = points.world_normals.T
    polygons = points.polygon_numbers
    flat = flat_normals(mesh)[:, polygons]
    # Both sides of a polygon can be seen; its pixels are lit by the normal of the side that is.
    flat *= np.where(dot(flat, shading) < 0, -1.0, 1.0)
    differ: Booleans = (_cosines(shading, one, other) < least) & (_cosines(flat, one, other) < least)
    return differ


def flat_normals(mesh: Mesh) -> Floats:
    """The unit normals of the polygons themselves, (3, polygons); zero for one without area."""
    return polygon_normals(np.take(mesh.coordinates.T, mesh.node_numbers.T, axis=1))


def _cosines(normals: Floats, one: Indices, other: Indices) -> Floats:
    """The cosines between the normals of pairs."""
    return dot(normals[:, one], normals[:, other])
