"""The faults of a mesh, with the rows of the nodes and polygons that have them.

A mesh with faults can be rendered. They matter to the author of the mesh, and to programs that compute with
it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from autocolor.arrays import (
    AnyArray,
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
from autocolor.scene.geometry.normals import MIXER, edge_keys, group_numbers, unite
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
    coordinates, node_numbers = mesh.coordinates, mesh.node_numbers
    edges = edge_faults(node_numbers, len(coordinates))
    shapes = polygon_shapes(coordinates, node_numbers)
    unwelded = nodes_at_one_place(coordinates, node_numbers)
    is_unwelded = np.zeros(len(coordinates), np.bool_)
    is_unwelded[unwelded] = True
    unused = np.flatnonzero(~used_rows(node_numbers.T, len(coordinates)))
    repeated = repeated_polygons(node_numbers)
    holes = tuple(holes_of(coordinates, edges.borders))
    faults = (
        Fault("border", EDGE, edges.borders, edges.border_polygons, holes),
        Fault("unwelded", NODE, unwelded, np.flatnonzero(is_unwelded[node_numbers.T].any(axis=0))),
        Fault("unused", NODE, unused, np.empty(0, np.intp)),
        Fault("warped", POLYGON, shapes.warped, shapes.warped),
        Fault("concave", POLYGON, shapes.concave, shapes.concave),
        Fault("crossed", POLYGON, shapes.crossed, shapes.crossed),
        Fault("turned", EDGE, edges.turned, edges.turned_polygons),
        Fault("repeated", POLYGON, repeated, repeated),
        Fault("crowded", EDGE, edges.crowded, edges.crowded_polygons),
        Fault("without area", POLYGON, shapes.without_area, shapes.without_area),
    )
    return tuple(fault for fault in faults if len(fault.rows))


def fault_scalar(mesh: Mesh, faults: Sequence[Fault]) -> MeshScalar:
    """The number of the gravest fault of each polygon of a mesh; 0 where it has none."""
    values = np.zeros(len(mesh.node_numbers))
    for fault in sorted(faults, key=lambda each: each.number):
        values[fault.polygons] = fault.number
    return MeshScalar(FAULT, read_only(values), POLYGON)


@dataclass(frozen=True, eq=False)
class EdgeFaults:
    """Edges, (edges, 2) rows of nodes, and the rows of the polygons that have them, ascending.

    A border has one polygon, a shared edge two polygons, and a crowded edge three or more. If the polygons of
    a shared edge face the same side, they run along it in opposite directions. Along a turned edge both run
    in the same direction. Edges are compared by their nodes alone: nodes at the same place are not joined.
    """

    borders: Indices
    border_polygons: Indices
    turned: Indices
    turned_polygons: Indices
    crowded: Indices
    crowded_polygons: Indices


def edge_faults(node_numbers: Indices, node_count: int) -> EdgeFaults:
    """The edges of a polygon table, (polygons, 4), that are borders, turned or crowded."""
    starts = np.ascontiguousarray(node_numbers.T)
    ends = np.roll(starts, -1, axis=0)
    # An edge from a node to itself closes a triangle: leave it out.
    places = np.flatnonzero(starts.ravel() != ends.ravel())
    start, end = starts.ravel()[places], ends.ravel()[places]
    keys = edge_keys(start, end, node_count)
    order = np.argsort(keys)
    is_first = np.diff(keys[order], prepend=-1) != 0
    firsts = np.flatnonzero(is_first)
    counts = np.diff(firsts, append=len(order))
    pairs = firsts[counts == 2]
    runs_up = (start < end)[order]
    turned = pairs[runs_up[pairs] == runs_up[pairs + 1]]
    crowded = counts > 2

    def edges(at: Indices) -> Indices:
        return np.stack([start[order[at]], end[order[at]]], axis=1)

    def polygons(at: Indices) -> Indices:
        return np.unique(places[order[at]] % len(node_numbers))

    borders = firsts[counts == 1]
    return EdgeFaults(
        edges(borders),
        polygons(borders),
        edges(turned),
        polygons(np.concatenate([turned, turned + 1])),
        edges(firsts[crowded]),
        polygons(runs(firsts[crowded], counts[crowded])),
    )


@dataclass(frozen=True)
class Hole:
    """A closed loop of border edges, or the rim of an open surface.

    `edges` is the number of its edges and `length` their total length; `center` is the middle of its bounds,
    and `node` its lowest node. A loop that is not `is_closed` has branches, as where two holes share a node.
    """

    edges: int
    length: float
    center: tuple[float, float, float]
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
    group_of_node = group_numbers(parents)
    group = group_of_node[ends[:, 0]]
    count = int(group_of_node.max()) + 1
    places = coordinates[nodes]
    edge_counts = np.bincount(group, minlength=count)
    long = np.bincount(group, lengths((places[ends[:, 0]] - places[ends[:, 1]]).T), minlength=count)
    # At each node of a closed loop two edges meet.
    branches = np.bincount(ends.ravel(), minlength=len(nodes)) != 2
    is_open = np.bincount(group_of_node, branches, minlength=count) > 0
    low, high = np.full((count, 3), np.inf), np.full((count, 3), -np.inf)
    np.minimum.at(low, group_of_node, places)
    np.maximum.at(high, group_of_node, places)
    first = np.full(count, len(coordinates))
    np.minimum.at(first, group_of_node, nodes)
    centers = (low / 2 + high / 2).tolist()
    return [
        Hole(
            int(edge_counts[row]),
            float(long[row]),
            tuple(centers[row]),
            int(first[row]),
            not bool(is_open[row]),
        )
        for row in np.argsort(-long, kind="stable").tolist()
    ]


@dataclass(frozen=True)
class QuadShapes:
    """Counts of quads: all, quads that are not flat, quads with one reflex corner, and bow-ties."""

    quads: int
    warped: int
    concave: int
    crossed: int


@dataclass(frozen=True, eq=False)
class Shapes:
    """The rows of the polygons of each shape; a polygon may have several."""

    warped: Indices
    concave: Indices
    crossed: Indices
    without_area: Indices


def quad_shapes(mesh: Mesh) -> QuadShapes:
    """The counts for a mesh; a concave or crossed quad may also count as warped."""
    shapes = polygon_shapes(mesh.coordinates, mesh.node_numbers)
    quads = len(mesh.node_numbers) - mesh.triangle_count
    return QuadShapes(quads, len(shapes.warped), len(shapes.concave), len(shapes.crossed))


@underflowing
def polygon_shapes(coordinates: Floats, node_numbers: Indices) -> Shapes:
    """The rows of warped, concave and crossed quads, and of polygons without area."""
    rows_of_shapes: tuple[list[Indices], ...] = ([], [], [], [])
    for chunk in chunks(len(node_numbers), POLYGONS_AT_ONCE):
        rows = node_numbers[chunk]
        shapes = _shapes(np.ascontiguousarray(coordinates[rows].T), rows[:, 2] != rows[:, 3])
        for parts, mask in zip(rows_of_shapes, shapes, strict=True):
            parts.append(np.flatnonzero(mask) + chunk.start)
    none = np.empty(0, np.intp)
    return Shapes(*(np.concatenate([none, *parts]) for parts in rows_of_shapes))


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
    return repeated_rows(nodes)


def nodes_at_one_place(coordinates: Floats, node_numbers: Indices) -> Indices:
    """The rows of used nodes that have the same place as another used node, ascending."""
    rows = np.flatnonzero(used_rows(node_numbers.T, len(coordinates)))
    # Adding zero makes -0.0 and 0.0 the same bits.
    places = np.ascontiguousarray(coordinates[rows] + 0.0)
    repeated: Indices = rows[repeated_rows(places.view(np.int64).reshape(len(rows), 3))]
    return repeated


def repeated_rows(table: AnyArray) -> Indices:
    """The rows of a table of whole numbers, (rows, columns), that equal another row, ascending."""
    if not len(table):
        return np.empty(0, np.intp)
    # Equal rows have equal sums of their mixed columns: compare only the rows with equal sums.
    sums = np.zeros(len(table), np.uint64)
    for column in table.astype(np.int64, copy=False).T:
        sums = (sums ^ np.ascontiguousarray(column).view(np.uint64)) * MIXER
        sums ^= sums >> np.uint64(29)
    order = np.argsort(sums, kind="stable")
    is_next_equal = sums[order[1:]] == sums[order[:-1]]
    candidates = order[np.append(is_next_equal, False) | np.append([False], is_next_equal)]
    if not len(candidates):
        return np.empty(0, np.intp)
    rows = table[candidates]
    by_value = np.lexsort(rows.T)
    is_same = (rows[by_value[1:]] == rows[by_value[:-1]]).all(axis=1)
    repeats = by_value[np.append(is_same, False) | np.append([False], is_same)]
    return np.sort(candidates[repeats])
