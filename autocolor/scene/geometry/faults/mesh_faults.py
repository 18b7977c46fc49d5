"""The faults of a mesh: what may be wrong with it though it can be rendered, with the rows concerned.

The renderer draws them all. They matter to whoever made the mesh, and to programs that compute with it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from autocolor.arrays import Indices
from autocolor.immutable import read_only
from autocolor.scene.geometry.faults.edge_faults import edge_faults
from autocolor.scene.geometry.faults.holes import Hole, holes_of
from autocolor.scene.geometry.faults.quad_shapes import polygon_shapes
from autocolor.scene.geometry.faults.repeats import nodes_at_one_place, repeated_polygons
from autocolor.scene.mesh import Mesh
from autocolor.scene.scalars.mesh_scalars import NODE, POLYGON, MeshScalar

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
"""The kinds of faults, from the lightest to the gravest, and what they are. A kind's number is its place from
1 on."""

FAULT: Final = "fault"
"""The name of the scalar that tells the gravest fault of each polygon."""


@dataclass(frozen=True, eq=False)
class Fault:
    """All faults of one kind in a mesh.

    `rows` are the rows of what has it, which is an edge, a node or a polygon as `of` tells: (rows,), or
    (edges, 2) rows of nodes. `polygons` are the rows of the polygons concerned. Rows count from 0.
    """

    kind: str
    of: str
    rows: Indices
    polygons: Indices
    holes: tuple[Hole, ...] = ()

    @property
    def number(self) -> int:
        """The number of the kind, as the scalar has it."""
        return list(KINDS).index(self.kind) + 1


def mesh_faults(mesh: Mesh) -> tuple[Fault, ...]:
    """The faults of a mesh, in the order of KINDS; kinds of which there is none are left out."""
    coordinates, node_numbers = mesh.coordinates, mesh.node_numbers
    edges = edge_faults(node_numbers, len(coordinates))
    shapes = polygon_shapes(coordinates, node_numbers)
    unwelded = nodes_at_one_place(coordinates, node_numbers)
    is_unwelded = np.zeros(len(coordinates), np.bool_)
    is_unwelded[unwelded] = True
    unused = np.ones(len(coordinates), np.bool_)
    unused[node_numbers.T] = False
    repeated = repeated_polygons(node_numbers)
    found = {
        "border": Fault(
            "border",
            EDGE,
            edges.borders,
            edges.border_polygons,
            tuple(holes_of(coordinates, edges.borders)),
        ),
        "unwelded": Fault(
            "unwelded", NODE, unwelded, np.flatnonzero(is_unwelded[node_numbers.T].any(axis=0))
        ),
        "unused": Fault("unused", NODE, np.flatnonzero(unused), np.empty(0, np.intp)),
        "warped": Fault("warped", POLYGON, shapes.warped, shapes.warped),
        "concave": Fault("concave", POLYGON, shapes.concave, shapes.concave),
        "crossed": Fault("crossed", POLYGON, shapes.crossed, shapes.crossed),
        "turned": Fault("turned", EDGE, edges.turned, edges.turned_polygons),
        "repeated": Fault("repeated", POLYGON, repeated, repeated),
        "crowded": Fault("crowded", EDGE, edges.crowded, edges.crowded_polygons),
        "without area": Fault("without area", POLYGON, shapes.without_area, shapes.without_area),
    }
    return tuple(found[kind] for kind in KINDS if len(found[kind].rows))


def fault_scalar(mesh: Mesh, faults: Sequence[Fault]) -> MeshScalar:
    """The number of the gravest fault of each polygon of a mesh; 0 where it has none."""
    values = np.zeros(len(mesh.node_numbers))
    for fault in sorted(faults, key=lambda each: each.number):
        values[fault.polygons] = fault.number
    return MeshScalar(FAULT, read_only(values), POLYGON)
