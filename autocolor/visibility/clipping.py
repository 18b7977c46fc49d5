"""Clipping polygons at the near plane: only what lies beyond it is kept."""

from __future__ import annotations

import dataclasses

import numpy as np

from autocolor.arrays import Floats, Indices
from autocolor.visibility.camera_space import CameraPolygons


def clipped_at_near_plane(polygons: CameraPolygons) -> CameraPolygons:
    """The polygons with no corner nearer than the near plane; clipping adds nodes and normals.

    A clipped edge is always followed from its lower to its higher node number, and clipped once for all
    polygons that share it, so that they still share it afterwards.
    """
    positions, near = polygons.positions, polygons.near
    if positions[2].min(initial=near) >= near:
        return polygons
    before = (positions[2] < near).take(polygons.corners)
    all_before = before[0] & before[1] & before[2] & before[3]
    some_before = before[0] | before[1] | before[2] | before[3]
    kept, crossing = np.flatnonzero(~some_before), np.flatnonzero(some_before & ~all_before)

    clipped = _Clipped(polygons)
    for column in crossing.tolist():
        clipped.add(column)

    normals = polygons.normals
    if clipped.new_positions:
        positions = np.column_stack([positions, *clipped.new_positions])
        normals = np.column_stack([normals, *clipped.new_normals])
    columns = np.concatenate([kept, np.array(clipped.columns, np.intp)])
    # Keep the order of the polygon table: of equally near polygons the later one is visible.
    order = np.argsort(columns, kind="stable")
    return dataclasses.replace(
        polygons,
        positions=positions,
        normals=normals,
        corners=_merged(polygons.corners, kept, clipped.corners, order),
        corner_normals=_merged(polygons.corner_normals, kept, clipped.corner_normals, order),
        polygon_numbers=polygons.polygon_numbers[columns[order]],
    )


class _Clipped:
    """Clipped polygons, and the nodes and normals that clipping adds.

    `corners` and `corner_normals` hold four numbers for each polygon that clipping leaves, and `columns` the
    polygon that it is a part of.
    """

    def __init__(self, polygons: CameraPolygons) -> None:
        self._polygons = polygons
        self._node_of_edge: dict[tuple[int, int], int] = {}
        self.new_positions: list[Floats] = []
        self.new_normals: list[Floats] = []
        self.corners: list[list[int]] = []
        self.corner_normals: list[list[int]] = []
        self.columns: list[int] = []

    def add(self, column: int) -> None:
        """Clip the polygon in a column, and divide what is left into polygons of four corners."""
        polygons, near = self._polygons, self._polygons.near
        nodes, rows = polygons.corners[:, column].tolist(), polygons.corner_normals[:, column].tolist()
        depths = polygons.positions[2, polygons.corners[:, column]].tolist()
        left_nodes: list[int] = []
        left_rows: list[int] = []
        # Begin where the polygon comes out of the near plane, whichever corner is written first.
        steps = [(corner, (corner + 1) % 4) for corner in range(4)]
        begin = min(
            (step for step in steps if depths[step[0]] < near <= depths[step[1]]),
            key=lambda step: polygons.positions[:, [nodes[step[1]], nodes[step[0]]]].T.tolist(),
        )[0]
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
        # Divide a polygon of five or six corners into a quad and what remains.
        for first in range(1, len(left_nodes) - 1, 2):
            picked = [0, first, first + 1, min(first + 2, len(left_nodes) - 1)]
            self.corners.append([left_nodes[corner] for corner in picked])
            self.corner_normals.append([left_rows[corner] for corner in picked])
            self.columns.append(column)

    def _node_on_edge(self, low: int, high: int, fraction: float) -> int:
        """The number of the node where an edge meets the near plane, the same for all its polygons."""
        positions = self._polygons.positions
        if (low, high) not in self._node_of_edge:
            self._node_of_edge[low, high] = positions.shape[1] + len(self.new_positions)
            position = positions[:, low] + fraction * (positions[:, high] - positions[:, low])
            position[2] = self._polygons.near
            self.new_positions.append(position)
        return self._node_of_edge[low, high]

    def _normal_between(self, low: int, high: int, fraction: float) -> int:
        """The number of a new normal, interpolated between two."""
        normals = self._polygons.normals
        self.new_normals.append(normals[:, low] + fraction * (normals[:, high] - normals[:, low]))
        return int(normals.shape[1]) + len(self.new_normals) - 1


def _merged(table: Indices, kept: Indices, clipped: list[list[int]], order: Indices) -> Indices:
    """The columns of the kept polygons and those of the clipped ones, in an order."""
    columns = np.array(clipped, np.intp).reshape(-1, 4).T
    return np.take(np.concatenate([np.take(table, kept, axis=1), columns], axis=1), order, axis=1)
