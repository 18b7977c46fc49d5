"""Polygons in camera space: transformed, and clipped at the near plane.

Camera space has its origin at the eye and the axes of the view: right, down and forward.
"""

from __future__ import annotations

import dataclasses
import itertools
import math
from dataclasses import dataclass
from typing import Final

import numpy as np

from autocolor.arrays import Booleans, Floats, Indices, Real, RealArray, Singles, chunks
from autocolor.checks import Vector
from autocolor.scene.geometry.diagonals import NO_DIAGONAL, Diagonals
from autocolor.scene.mesh import Mesh
from autocolor.scene.view import View

NEAR: Final = 1e-6
"""Assumed: the depth of the near plane if the object reaches behind the eye.

It is a fraction of the depth of the farthest corner. Everything nearer vanishes.
"""

LEAST_NEAR: Final = 1e-9
"""Assumed: the least depth of the near plane, in units.

An object wholly before the eye is clipped only here, however small it is. At smaller depths a crossing would
be rounded by more than a thousandth of a pixel.
"""

LEAST_UNIT: Final = 2.0**-800
"""Assumed: the least unit of a view, far below the size of any object. The coordinates of the farthest light
stay finite in it."""

PIECES: Final = {
    0: ((0, 1, 2), (2, 3, 0)),
    1: ((1, 2, 3), (3, 0, 1)),
    NO_DIAGONAL: ((0, 1, 2, 3),),
}
"""The corners of the pieces into which a diagonal cuts a polygon."""

POINTS_AT_ONCE: Final = 1 << 14


@dataclass(frozen=True, eq=False)
class CameraPolygons:
    """Nodes and polygons in camera space, measured in `unit`, a power of two near the size of the view.

    `positions` is (3, nodes) float64, `normals` (3, normals) float32. `corners` and `corner_normals` are (4,
    polygons) intp: the node and the normal at each corner. `polygon_numbers` are rows of the mesh's polygon
    table. The near plane is at depth `near`; `nearest` is the least depth of a node of the mesh. `is_cut`,
    (polygons,), tells which polygons are pieces of triangles that were cut from quads; None if there are no
    such polygons.
    """

    unit: float
    near: float
    nearest: float
    positions: Floats
    normals: Singles
    corners: Indices
    corner_normals: Indices
    polygon_numbers: Indices
    is_cut: Booleans | None = None


def camera_space(mesh: Mesh, view: View) -> CameraPolygons:
    """All polygons of the mesh in the camera space of a view."""
    unit, near = unit_and_near(mesh, view)
    positions = rotated(view.axes / unit, mesh.coordinates.T, view.eye)
    nearest = float(positions[2].min(initial=np.inf))
    if nearest < near:
        near = near_of(near, float(positions[2].take(mesh.node_numbers.T).min(initial=near)))
    return CameraPolygons(
        unit,
        near,
        nearest,
        positions,
        rotated(view.axes, mesh.normals.vectors.T),
        mesh.node_numbers.T,
        mesh.normals.numbers.T,
        np.arange(len(mesh.node_numbers)),
    )


def unit_and_near(mesh: Mesh, view: View) -> tuple[float, float]:
    """The unit of a view of a mesh, and the depth of the near plane if the mesh reaches behind it."""
    box = (
        np.array(list(itertools.product(*np.stack(mesh.bounds, axis=1)))) - np.array(view.eye)
    ) @ view.axes.T
    unit = max(2.0 ** math.frexp(float(np.abs(box).max()))[1], LEAST_UNIT)
    return unit, max(NEAR * float(box[:, 2].max()) / unit, LEAST_NEAR)


def near_of(near: float, nearest_corner: float) -> float:
    """The depth of the near plane, given the depth of the nearest corner of all polygons.

    If all corners lie before the eye, nothing beyond LEAST_NEAR is clipped.
    """
    return max(nearest_corner, LEAST_NEAR) if nearest_corner > 0 else near


def rotated(axes: Floats, points: RealArray[Real], origin: Vector = (0.0, 0.0, 0.0)) -> RealArray[Real]:
    """The coordinates of points, (3, n), relative to an origin and along other axes, the rows of a matrix.

    Measured and rejected: a matrix product of so few rows takes as long, and up to thirty times as long while
    another process uses the second processor, because its threads wait for each other.
    """
    out = np.empty_like(points)
    axes = axes.astype(points.dtype)
    for chunk in chunks(points.shape[1], POINTS_AT_ONCE):
        relative = [row[chunk] - start for row, start in zip(points, origin, strict=True)]
        for axis, row in zip(axes, out[:, chunk], strict=True):
            np.multiply(relative[0], axis[0], out=row)
            row += relative[1] * axis[1]
            row += relative[2] * axis[2]
    return out


def clipped_at_near_plane(polygons: CameraPolygons, diagonals: Diagonals | None = None) -> CameraPolygons:
    """The polygons clipped at the near plane. Clipping adds nodes and normals.

    Each edge is clipped once, from its lower to its higher node number. So polygons that share an edge share
    the clipped edge, too. With `diagonals`, quads that cross the near plane are cut into triangles first.
    """
    positions, near = polygons.positions, polygons.near
    if positions[2].min(initial=near) >= near:
        return polygons
    before = (positions[2] < near).take(polygons.corners)
    all_before = before[0] & before[1] & before[2] & before[3]
    some_before = before[0] | before[1] | before[2] | before[3]
    beyond, crossing = np.flatnonzero(~some_before), np.flatnonzero(some_before & ~all_before)

    clipped = _Clipped(polygons)
    starts = np.full(len(crossing), NO_DIAGONAL)
    if diagonals is not None:
        starts = diagonals.some(polygons.polygon_numbers[crossing]).starts
    for column, start in zip(crossing.tolist(), starts.tolist(), strict=True):
        for piece in PIECES[start]:
            clipped.add(column, piece)

    normals = polygons.normals
    if clipped.new_positions:
        positions = np.column_stack([positions, *clipped.new_positions])
        normals = np.column_stack([normals, *clipped.new_normals])
    columns = np.concatenate([beyond, np.array(clipped.columns, np.intp)])
    # Restore the order of the polygon table: of equally near polygons the later one is visible.
    order = np.argsort(columns, kind="stable")
    return dataclasses.replace(
        polygons,
        positions=positions,
        normals=normals,
        corners=_merged(polygons.corners, beyond, clipped.corners, order),
        corner_normals=_merged(polygons.corner_normals, beyond, clipped.corner_normals, order),
        polygon_numbers=polygons.polygon_numbers[columns[order]],
        is_cut=None if diagonals is None else order >= len(beyond),
    )


class _Clipped:
    """Clipped polygons, and the nodes and normals that clipping adds.

    `corners` and `corner_normals` have four numbers for each clipped polygon, `columns` the column of the
    whole polygon.
    """

    def __init__(self, polygons: CameraPolygons) -> None:
        self._polygons = polygons
        self._node_of_edge: dict[tuple[int, int], int] = {}
        self.new_positions: list[Floats] = []
        self.new_normals: list[Floats] = []
        self.corners: list[list[int]] = []
        self.corner_normals: list[list[int]] = []
        self.columns: list[int] = []

    def add(self, column: int, piece: tuple[int, ...]) -> None:
        """Clip some corners of the polygon in a column, and divide the rest into polygons of four corners."""
        polygons, near = self._polygons, self._polygons.near
        nodes, rows = polygons.corners[:, column].tolist(), polygons.corner_normals[:, column].tolist()
        depths = polygons.positions[2, polygons.corners[:, column]].tolist()
        left_nodes: list[int] = []
        left_rows: list[int] = []
        # Begin at the edge that comes out of the near plane, whichever corner is written first.
        steps = list(zip(piece, (*piece[1:], piece[0]), strict=True))
        begin = min(
            (at for at, (here, there) in enumerate(steps) if depths[here] < near <= depths[there]),
            key=lambda at: polygons.positions[:, [nodes[corner] for corner in steps[at][::-1]]].T.tolist(),
            default=0,
        )
        for corner, following in steps[begin:] + steps[:begin]:
            # A triangle repeats a node.
            if nodes[corner] == nodes[following]:
                continue
            if depths[corner] >= near:
                left_nodes.append(nodes[corner])
                left_rows.append(rows[corner])
            if (depths[corner] < near) != (depths[following] < near):
                low, high = (corner, following) if nodes[corner] < nodes[following] else (following, corner)
                fraction = (near - depths[low]) / (depths[high] - depths[low])
                left_nodes.append(self._node_on_edge(nodes[low], nodes[high], fraction))
                left_rows.append(self._normal_between(rows[low], rows[high], fraction))
        # Divide a polygon of five or six corners into two.
        for first in range(1, len(left_nodes) - 1, 2):
            picked = [0, first, first + 1, min(first + 2, len(left_nodes) - 1)]
            self.corners.append([left_nodes[corner] for corner in picked])
            self.corner_normals.append([left_rows[corner] for corner in picked])
            self.columns.append(column)

    def _node_on_edge(self, low: int, high: int, fraction: float) -> int:
        """The number of the node where an edge meets the near plane, equal for all polygons at the edge."""
        positions = self._polygons.positions
        if (low, high) not in self._node_of_edge:
            self._node_of_edge[low, high] = positions.shape[1] + len(self.new_positions)
            position = positions[:, low] + fraction * (positions[:, high] - positions[:, low])
            position[2] = self._polygons.near
            self.new_positions.append(position)
        return self._node_of_edge[low, high]

    def _normal_between(self, low: int, high: int, fraction: float) -> int:
        """The number of a new normal, interpolated between the normals of two corners."""
        normals = self._polygons.normals
        self.new_normals.append(normals[:, low] + fraction * (normals[:, high] - normals[:, low]))
        return int(normals.shape[1]) + len(self.new_normals) - 1


def _merged(table: Indices, beyond: Indices, clipped: list[list[int]], order: Indices) -> Indices:
    """The columns of a table `beyond` the near plane, and the clipped columns, in a given order."""
    columns = np.array(clipped, np.intp).reshape(-1, 4).T
    return np.take(np.concatenate([np.take(table, beyond, axis=1), columns], axis=1), order, axis=1)
