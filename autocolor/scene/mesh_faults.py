"""The faults of a mesh, with the rows of the nodes and polygons that have them.

A mesh with faults can be rendered. They matter to the author of the mesh, and to programs that compute with
it.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import islice
from typing import Final

import numpy as np

from autocolor.arrays import (
    Booleans,
    Floats,
    Indices,
    chunks,
    cross,
    dot,
    lengths,
    runs,
    underflowing,
    used_rows,
)
from autocolor.immutable import read_only
from autocolor.scene.geometry.normals import edge_keys, group_numbers, places_of_nodes, unite
from autocolor.scene.mesh import Mesh
from autocolor.scene.scalar import NODE, POLYGON, MeshScalar

EDGE: Final = "edge"

KINDS: Final = {
    "border": "edges of one polygon alone, around holes and along rims",
    "unwelded": "nodes at the same place as another node",
    "unused": "nodes that no polygon uses",
    "warped": "quads that are not flat",
    "concave": "quads with a corner that points inwards",
    "crossed": "quads whose sides cross",
    "turned": "edges that two polygons run along in the same direction, so that one of them is turned over",
    "repeated": "polygons with the same nodes as another polygon",
    "crowded": "edges of more than two polygons",
    "without area": "polygons without area",
}
"""The kinds of faults and their descriptions, from the lightest to the gravest; numbers count from 1."""

FAULT: Final = "fault"
"""The name of the scalar whose values are the gravest faults of the polygons, by number."""

WARPED: Final = 0.01
"""Assumed: a quad is warped if the distance of its diagonals exceeds this fraction of its size."""

FLAT: Final = 1e-12
"""Assumed: a polygon has no area if twice its area is below this fraction of its squared size."""

POLYGONS_AT_ONCE: Final = 1 << 14
"""Polygons in a chunk, so that the arrays fit in the processor cache."""


@dataclass(frozen=True, eq=False)
class Fault:
    """All faults of one kind in a mesh.

    `of` is EDGE, NODE or POLYGON. `rows` are the rows of the nodes or polygons that have the fault, (rows,),
    or the rows of the two nodes of each edge, (edges, 2). `polygons` are the rows of all polygons concerned.
    """

    kind: str
    of: str
    rows: Indices
    polygons: Indices
    holes: tuple[Hole, ...] = ()

    @property
    def number(self) -> int:
        """The number of the kind, as in the scalar."""
        return list(KINDS).index(self.kind) + 1


@underflowing
def mesh_faults(mesh: Mesh) -> tuple[Fault, ...]:
    """The faults of a mesh, in the order of KINDS, without the kinds that it does not have."""
    faults = (*edge_faults(mesh), *node_faults(mesh), *polygon_faults(mesh))
    return tuple(sorted((fault for fault in faults if len(fault.rows)), key=lambda fault: fault.number))


def fault_scalar(mesh: Mesh, faults: Sequence[Fault]) -> MeshScalar:
    """The number of the gravest fault of each polygon of a mesh; 0 where it has none."""
    values = np.zeros(len(mesh.node_numbers))
    for fault in sorted(faults, key=lambda each: each.number):
        values[fault.polygons] = fault.number
    return MeshScalar(FAULT, read_only(values), POLYGON)


def edge_faults(mesh: Mesh) -> Iterator[Fault]:
    """The edges that are borders, turned or crowded.

    A border has one polygon, a shared edge two polygons, and a crowded edge three or more. If the polygons of
    a shared edge face the same side, they run along it in opposite directions. Along a turned edge both run
    in the same direction. Edges are compared by their nodes alone: nodes at the same place are not joined.
    """
    starts = np.ascontiguousarray(mesh.node_numbers.T)
    ends = np.roll(starts, -1, axis=0)
    # An edge from a node to itself closes a triangle: leave it out.
    corners = np.flatnonzero(starts.ravel() != ends.ravel())
    start, end = starts.ravel()[corners], ends.ravel()[corners]
    keys = edge_keys(start, end, len(mesh.coordinates))
    order = np.argsort(keys)
    firsts = np.flatnonzero(np.diff(keys[order], prepend=-1))
    counts = np.diff(firsts, append=len(order))
    runs_up = (start < end)[order]
    is_turned = (counts == 2) & (runs_up[firsts] == runs_up.take(firsts + 1, mode="clip"))
    for kind, chosen in (("border", counts == 1), ("turned", is_turned), ("crowded", counts > 2)):
        first, uses = order[firsts[chosen]], order[runs(firsts[chosen], counts[chosen])]
        edges = np.stack([start[first], end[first]], axis=1)
        holes = holes_of(mesh.coordinates, edges) if kind == "border" else ()
        yield Fault(kind, EDGE, edges, np.unique(corners[uses] % len(mesh.node_numbers)), tuple(holes))


@dataclass(frozen=True)
class Hole:
    """A closed loop of border edges, or the rim of an open surface.

    `edges` is the number of its edges and `length` their total length; `center` is the middle of its bounds,
    and `node` its lowest node. A loop that is not `is_closed` has branches, as where two holes share a node.
    """

    edges: int
    length: float
    center: tuple[float, ...]
    node: int
    is_closed: bool


def holes_of(coordinates: Floats, borders: Indices) -> list[Hole]:
    """The loops of border edges, (edges, 2) rows of nodes, the longest first."""
    if not len(borders):
        return []
    nodes, ends = np.unique(borders, return_inverse=True)
    ends = ends.reshape(-1, 2)
    parents = np.arange(len(nodes))
    unite(parents, ends[:, 0], ends[:, 1])
    groups = group_numbers(parents)
    order = np.argsort(groups, kind="stable")
    firsts = np.flatnonzero(np.diff(groups[order], prepend=-1))
    places = coordinates[nodes]
    low, high = (extreme.reduceat(places[order], firsts) for extreme in (np.minimum, np.maximum))
    # At each node of a closed loop two edges meet.
    is_open = np.logical_or.reduceat((np.bincount(ends.ravel()) != 2)[order], firsts)
    group = groups[ends[:, 0]]
    length = np.bincount(group, lengths((places[ends[:, 0]] - places[ends[:, 1]]).T))
    columns = (np.bincount(group), length, low / 2 + high / 2, nodes[order[firsts]], ~is_open)
    longest = np.argsort(-length, kind="stable")
    rows = zip(*(column[longest].tolist() for column in columns), strict=True)
    return [Hole(edges, long, tuple(center), *rest) for edges, long, center, *rest in rows]


def node_faults(mesh: Mesh) -> Iterator[Fault]:
    """The nodes at the place of another node, both used by polygons, and the nodes that no polygon uses."""
    is_used = used_rows(mesh.node_numbers.T, len(mesh.coordinates))
    is_unwelded = np.zeros(len(is_used), np.bool_)
    places = places_of_nodes(mesh.coordinates.T)
    if places is not None:
        is_unwelded = is_used & (np.bincount(places[is_used], minlength=len(places))[places] > 1)
    polygons = np.flatnonzero(is_unwelded[mesh.node_numbers.T].any(axis=0))
    yield Fault("unwelded", NODE, np.flatnonzero(is_unwelded), polygons)
    yield Fault("unused", NODE, np.flatnonzero(~is_used), np.empty(0, np.intp))


@underflowing
def polygon_faults(mesh: Mesh) -> Iterator[Fault]:
    """The quads that are warped, concave or crossed, and the polygons without area or with a twin."""
    shapes = np.empty((4, len(mesh.node_numbers)), np.bool_)
    for chunk in chunks(shapes.shape[1], POLYGONS_AT_ONCE):
        rows = mesh.node_numbers[chunk]
        corners = np.ascontiguousarray(mesh.coordinates[rows].T)
        shapes[:, chunk] = _shapes(corners, rows[:, 2] != rows[:, 3])
    for kind, mask in zip(("warped", "concave", "crossed", "without area"), shapes, strict=True):
        yield Fault(kind, POLYGON, np.flatnonzero(mask), np.flatnonzero(mask))
    repeated = repeated_polygons(mesh.node_numbers)
    yield Fault("repeated", POLYGON, repeated, repeated)


def quad_shapes(mesh: Mesh) -> dict[str, int]:
    """Counts of quads: all, and those of each shape; a concave or crossed quad may also be warped."""
    # The shapes are the first three faults; the search for repeated polygons is left out.
    shapes = islice(polygon_faults(mesh), 3)
    quads = len(mesh.node_numbers) - mesh.triangle_count
    return {"quads": quads, **{shape.kind: len(shape.rows) for shape in shapes}}


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

    # A corner that turns against the normal is reflex; two reflex corners make a bow-tie.
    edges = np.roll(corners, -1, axis=1) - corners
    turned = np.zeros(corners.shape[2], np.intp)
    for corner in range(4):
        turned += dot(cross(edges[:, corner - 1], edges[:, corner]), normals) < -1e-9

    # A polygon has no area if neither diagonal divides off a triangle with area.
    halves = ((0, 1, 2), (0, 2, 3), (0, 1, 3), (1, 2, 3))
    has_area = np.zeros(corners.shape[2], np.bool_)
    for first, second, third in halves:
        one, other = corners[:, second] - corners[:, first], corners[:, third] - corners[:, first]
        has_area |= lengths(cross(one, other)) >= FLAT
    quads = is_quad & has_area
    return quads & (apart > WARPED), quads & (turned == 1), quads & ((turned > 1) | ~has_normal), ~has_area


def repeated_polygons(node_numbers: Indices) -> Indices:
    """The rows of polygons that have the same nodes as another polygon, in any order; ascending."""
    nodes = np.array(node_numbers)
    # A triangle repeats its last node: leave it out.
    nodes[nodes[:, 2] == nodes[:, 3], 3] = -1
    nodes.sort(axis=1)
    order = np.lexsort(nodes.T)
    is_repeated = np.zeros(len(order) + 1, np.bool_)
    is_repeated[1:-1] = (nodes[order[1:]] == nodes[order[:-1]]).all(axis=1)
    return np.sort(order[is_repeated[1:] | is_repeated[:-1]])
