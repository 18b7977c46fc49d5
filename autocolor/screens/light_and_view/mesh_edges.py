"""The edges of a mesh that are drawn for it: those that every view shows, and those that may be a silhouette.

Found once for a mesh. Nodes at the same place count as one, so that parts which repeat their nodes still
meet. An edge is known by two nodes, as one of its polygons numbers them.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final, NamedTuple

import numpy as np

from autocolor.arrays import Booleans, Floats, Indices, dot
from autocolor.immutable import Immutable, read_only
from autocolor.scene.geometry.fans import places_of_corners
from autocolor.scene.geometry.planes.plane_cells import facet_normals
from autocolor.scene.geometry.planes.scaled_nodes import as_they_are
from autocolor.scene.mesh import Mesh

DRAWN_CREASE: Final = 30.0
"""Assumed: degrees; a larger angle between polygons is drawn as a crease.

Looked at on two cars in an area of 248 x 224: with 40 degrees, the crease angle of normals, the windows of a
car of one part are in pieces, and with 60 gone. A cylinder of 12 sides has no lines along it.
"""

MOST_FEATURES: Final = 1 << 15
"""Assumed: of a mesh that is all creases, such as a noisy scan, only the longest edges are drawn."""


@dataclass(frozen=True, eq=False, repr=False)
class MeshEdges(Immutable):
    """The edges of some polygons of a mesh, and the planes of these polygons.

    `coordinates`, (nodes, 3), are those of the mesh, and polygons are rows of its polygon table. `features`,
    (features, 2) intp, are the nodes of open edges, of creases and of edges between parts, and `smooth`,
    (edges, 2), those of all other edges. `polygons`, (2, edges), are those at both sides of a smooth edge,
    and `same_direction`, (edges,), tells where both run along it in the same direction, and so have opposite
    winding. A point lies in the plane of a polygon where its dot product with the normal, (3, polygons), is
    the offset, (polygons,).
    """

    coordinates: Floats
    features: Indices
    smooth: Indices
    polygons: Indices
    same_direction: Booleans
    normals: Floats
    offsets: Floats


class _Sides(NamedTuple):
    """The sides of polygons, sorted so that those of an edge are neighbors.

    Corner c of polygon p is c * polygons + p. `corners` and `forward` are (sides,): the corner that a side
    begins at, and whether it runs to a higher place. `starts` and `counts` are (edges,): the first side of
    each edge, and how many it has.
    """

    corners: Indices
    forward: Booleans
    starts: Indices
    counts: Indices


def mesh_edges(
    mesh: Mesh, part_numbers: Sequence[int] | None = None, crease_angle: float = DRAWN_CREASE
) -> MeshEdges:
    """The edges of the polygons of some parts of the mesh, or of all.

    An edge where polygons meet at more than `crease_angle`, 0 to 90 degrees, is a crease. Which way the
    polygons run does not matter. Where more than two meet, they are smooth if they lie in two planes that
    continue each other, as those of a sheet whose polygons are there twice, once for each face. Polygons
    without area have no edges. The lines of a stage are drawn apart: the features alone of its parts.
    """
    parts, coordinate_rows, node_rows = mesh.part_numbers, mesh.coordinates.T, mesh.node_numbers.T
    normals = facet_normals(as_they_are(coordinate_rows), node_rows)
    has_edges = (normals != 0).any(axis=0)
    if part_numbers is not None:
        has_edges &= np.isin(parts, list(part_numbers))
    sides = _sides(places_of_corners(coordinate_rows, node_rows), has_edges)
    polygons = sides.corners % max(len(parts), 1)
    first = np.repeat(sides.starts, sides.counts)

    # Compare each polygon of an edge with the first one: the cosine is 1 where it folds back onto the first,
    # and -1 where it continues it, whatever their winding.
    cosines = dot(np.take(normals, polygons.take(first), axis=1), np.take(normals, polygons, axis=1))
    np.negative(cosines, out=cosines, where=sides.forward != sides.forward.take(first))
    least_cosine = np.cos(np.radians(crease_angle)) - 1e-9
    continues, folds = cosines <= -least_cosine, cosines >= least_cosine
    same_part = parts.take(polygons) == parts.take(polygons.take(first))
    if len(first):
        smooth = np.logical_and.reduceat((continues | folds) & same_part, sides.starts)
        smooth &= np.logical_or.reduceat(continues, sides.starts)
    else:
        smooth = np.zeros(0, np.bool_)

    # Of each smooth edge, take the first polygon and one that continues it.
    edge = np.repeat(np.arange(len(sides.starts)), sides.counts)
    other = sides.starts.copy()
    other[edge[continues]] = np.flatnonzero(continues)
    pairs = np.stack([sides.starts[smooth], other[smooth]])
    corners = sides.corners.take(sides.starts)
    nodes = np.stack([node_rows.ravel()[corners], np.roll(node_rows, -1, axis=0).ravel()[corners]], axis=1)
    tables = (
        _longest(nodes[~smooth], mesh.coordinates),
        nodes[smooth],
        polygons[pairs],
        np.equal(*sides.forward[pairs]),
        normals,
        dot(normals, np.take(coordinate_rows, node_rows[0], axis=1)),
    )
    return MeshEdges(mesh.coordinates, *map(read_only, tables))


def _sides(places: Indices, has_edges: Booleans) -> _Sides:
    """The sides of some polygons; `places` is (4, polygons)."""
    ends = np.roll(places, -1, axis=0)
    corners = np.flatnonzero((places != ends) & has_edges)
    start, end = places.ravel()[corners], ends.ravel()[corners]
    keys = np.minimum(start, end) * (int(places.max(initial=0)) + 1) + np.maximum(start, end)
    order = np.argsort(keys, kind="stable")
    starts = np.flatnonzero(np.diff(keys[order], prepend=-1))
    return _Sides(corners[order], (start < end)[order], starts, np.diff(starts, append=len(corners)))


def _longest(edges: Indices, coordinates: Floats) -> Indices:
    """The MOST_FEATURES longest of edges, (n, 2), in their order."""
    if len(edges) <= MOST_FEATURES:
        return edges
    steps = np.abs(coordinates[edges[:, 0]] - coordinates[edges[:, 1]]).max(axis=1)
    return edges[np.sort(np.argsort(-steps, kind="stable")[:MOST_FEATURES])]
