"""The polygons in camera space, with what lies before the near plane cut off.

Camera space has the eye at its origin and the axes of the view: right, down and forward.
"""

from __future__ import annotations

import dataclasses
import itertools
import math
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from autocolor.arrays import Floats, Numbers, Real, Singles, chunks
from autocolor.checks import Vector
from autocolor.scene.mesh import Mesh
from autocolor.scene.view import View

NEAR: Final = 1e-6
"""Assumed: the near plane, as a fraction of the depth of the object's farthest corner."""

LEAST_NEAR: Final = 1e-12
"""Assumed: the near plane, in units, where even that corner is hardly before the eye."""

LEAST_UNIT: Final = 2.0**-800
"""Assumed: far below the size of any object, and still a divisor for the farthest light."""

POINTS_AT_ONCE: Final = 1 << 14


@dataclass(frozen=True, eq=False)
class CameraPolygons:
    """Nodes and polygons in camera space, measured in `unit`, a power of two near the size of the view.

    `places` is (3, nodes) float64, `normals` (3, normals) float32. `corners` and `corner_normals` are (4,
    polygons) intp, one column a polygon, numbers of nodes and of normals. `polygon_numbers` are the rows of
    the mesh's polygon table. No corner is nearer than `near`.
    """

    unit: float
    near: float
    places: Floats
    normals: Singles
    corners: Numbers
    corner_normals: Numbers
    polygon_numbers: Numbers


def camera_space(mesh: Mesh, view: View) -> CameraPolygons:
    """The polygons of the mesh that lie at least partly before the eye."""
    axes, eye = view.axes, np.array(view.eye)
    box = (np.array(list(itertools.product(*np.stack(mesh.bounds, axis=1)))) - eye) @ axes.T
    unit = max(2.0 ** math.frexp(float(np.abs(box).max()))[1], LEAST_UNIT)
    polygons = CameraPolygons(
        unit,
        max(NEAR * float(box[:, 2].max()) / unit, LEAST_NEAR),
        rotated(axes / unit, mesh.coordinates.T, view.eye),
        rotated(axes, mesh.normals.vectors.T),
        mesh.node_numbers.T,
        mesh.normals.numbers.T,
        np.arange(len(mesh.node_numbers)),
    )
    reaches_through = polygons.places[2].min(initial=polygons.near) < polygons.near
    return cut_at_near_plane(polygons) if reaches_through else polygons


def rotated(axes: Floats, rows: NDArray[Real], origin: Vector = (0.0, 0.0, 0.0)) -> NDArray[Real]:
    """Points (3, n) around an origin, in other axes.

    Measured: a matrix product of so few rows takes as long alone, and up to thirty times as long when another
    process has the second processor, for its threads wait for each other.
    """
    turned = np.empty_like(rows)
    axes = axes.astype(rows.dtype)
    for part in chunks(rows.shape[1], POINTS_AT_ONCE):
        moved = [row[part] - start for row, start in zip(rows, origin, strict=True)]
        for axis, out in zip(axes, turned[:, part], strict=True):
            np.multiply(moved[0], axis[0], out=out)
            out += moved[1] * axis[1]
            out += moved[2] * axis[2]
    return turned


def cut_at_near_plane(polygons: CameraPolygons) -> CameraPolygons:
    """The polygons with what lies before the near plane cut off, with the nodes that the cuts made.

    An edge is cut from its lower to its higher node number, once for all polygons that share it, so that
    they still share it afterwards.
    """
    places, normals, near = polygons.places, polygons.normals, polygons.near
    corners, corner_normals = polygons.corners, polygons.corner_normals
    before = (places[2] < near).take(corners)
    cut_off = before[0] & before[1] & before[2] & before[3]
    touched = before[0] | before[1] | before[2] | before[3]
    whole, through = np.flatnonzero(~touched), np.flatnonzero(touched & ~cut_off)
    node_of_edge: dict[tuple[int, int], int] = {}
    new_places: list[Floats] = []
    new_normals: list[Floats] = []
    new_rows: list[tuple[list[int], list[int], int]] = []

    for column in through.tolist():
        nodes, rows = corners[:, column].tolist(), corner_normals[:, column].tolist()
        depths = places[2, corners[:, column]].tolist()
        cut_nodes: list[int] = []
        cut_rows: list[int] = []
        for corner, other in ((0, 1), (1, 2), (2, 3), (3, 0)):
            if depths[corner] >= near:
                cut_nodes.append(nodes[corner])
                cut_rows.append(rows[corner])
            if (depths[corner] < near) != (depths[other] < near):
                low, high = (corner, other) if nodes[corner] < nodes[other] else (other, corner)
                way = (near - depths[low]) / (depths[high] - depths[low])
                edge = nodes[low], nodes[high]
                if edge not in node_of_edge:
                    node_of_edge[edge] = places.shape[1] + len(new_places)
                    place = places[:, edge[0]] + way * (places[:, edge[1]] - places[:, edge[0]])
                    place[2] = near
                    new_places.append(place)
                cut_nodes.append(node_of_edge[edge])
                cut_rows.append(normals.shape[1] + len(new_normals))
                low_row, high_row = rows[low], rows[high]
                new_normals.append(normals[:, low_row] + way * (normals[:, high_row] - normals[:, low_row]))
        # Cut a polygon of five or six sides into a quad and what is left.
        for first in range(1, len(cut_nodes) - 1, 2):
            picked = [0, first, first + 1, min(first + 2, len(cut_nodes) - 1)]
            new_rows.append(
                ([cut_nodes[corner] for corner in picked], [cut_rows[corner] for corner in picked], column)
            )

    if new_places:
        places = np.column_stack([places, *new_places])
        normals = np.column_stack([normals, *new_normals])
    columns = np.concatenate([whole, np.array([column for _, _, column in new_rows], np.intp)])
    cut_corners = np.array([nodes for nodes, _, _ in new_rows], np.intp).reshape(-1, 4).T
    cut_normals = np.array([rows for _, rows, _ in new_rows], np.intp).reshape(-1, 4).T
    # Keep the order of the polygon table, which settles ties.
    order = np.argsort(columns, kind="stable")
    return dataclasses.replace(
        polygons,
        places=places,
        normals=normals,
        corners=_joined(corners, whole, cut_corners, order),
        corner_normals=_joined(corner_normals, whole, cut_normals, order),
        polygon_numbers=polygons.polygon_numbers[columns[order]],
    )


def _joined(table: Numbers, whole: Numbers, cut: Numbers, order: Numbers) -> Numbers:
    """The columns of the whole polygons and those of the cut ones, in an order."""
    joined = np.concatenate([np.take(table, whole, axis=1), cut], axis=1)
    return np.take(joined, order, axis=1)
