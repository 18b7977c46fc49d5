"""The polygons as the eye sees them: in camera space, cut at the near plane, and projected to the raster.

Both hidden-surface algorithms start from this value, so that they work on the same numbers. The paper does
not say how its picture plane is reached; the lens is a plain perspective one with square pixels whose
centers stand at half-integers, line 0 on top.
"""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
import numpy.typing as npt

from autocolor.checks import Vector
from autocolor.tables import Mesh
from autocolor.view import View

NEAR = 1e-4
"""Assumed: the near plane, as a fraction of the depth of the object's farthest corner."""

LEAST_NEAR = 1e-12
"""Assumed: the near plane, in units, where even that corner is hardly before the eye."""

ROUNDING = 1e-6
"""In pixels, far above what the cut of an edge is rounded by."""

POLYGONS_AT_ONCE = 1 << 15

LEAST_UNIT = 2.0**-800
"""Assumed: far below the size of any object, and still a divisor for the farthest light."""

Floats = npt.NDArray[np.float64]
Numbers = npt.NDArray[np.intp]


@dataclass(frozen=True, eq=False)
class Lens:
    """The ray through each pixel's center, (across, down, 1) in camera space, and the focal length in pixels.

    `across`, `down` and `inverse_length` (of the ray) are (lines * elements,) float32, line by line; they do
    not depend on where the eye is.
    """

    focal_length: float
    across: npt.NDArray[np.float32]
    down: npt.NDArray[np.float32]
    inverse_length: npt.NDArray[np.float32]


@lru_cache(maxsize=4)
def lens(lines: int, elements: int, field_of_view: float) -> Lens:
    """The lens of a raster with a vertical field of view in degrees."""
    focal_length = lines / 2 / math.tan(math.radians(field_of_view) / 2)
    across, down = np.meshgrid(
        (np.arange(elements) + 0.5 - elements / 2) / focal_length,
        (np.arange(lines) + 0.5 - lines / 2) / focal_length,
    )
    inverse_length = 1 / np.sqrt(across * across + down * down + 1)
    rays = (table.ravel().astype(np.float32) for table in (across, down, inverse_length))
    return Lens(focal_length, *rays)


@dataclass(frozen=True, eq=False)
class Projection:
    """Nodes on the raster and the polygons that use them.

    Camera space is measured in `unit`, a power of two near the distance of the farthest corner of the
    object: so float32 holds a part of a watch and a mountain range alike, and to the same last bit.
    `across`, `down` (pixels) and `inverse_depth` are (nodes,) float64. `first_line` is (nodes,) intp: the
    first line whose center is at or below the node, so that an edge from a to b crosses the lines
    first_line[a] <= line < first_line[b]. `corners` and `corner_normals` are (4, polygons) intp, one
    column a polygon, numbers of nodes and of columns of `normals`, (3, normals) float64 in camera space.
    `polygon_numbers` are the rows of the mesh's polygon table, `from_behind` whether the eye sees the back.
    """

    lines: int
    elements: int
    unit: float
    across: Floats
    down: Floats
    inverse_depth: Floats
    first_line: Numbers
    corners: Numbers
    corner_normals: Numbers
    normals: Floats
    polygon_numbers: Numbers
    from_behind: npt.NDArray[np.bool_]


def projection(mesh: Mesh, view: View, lines: int, elements: int) -> Projection:
    """The polygons of the mesh that may be seen, each crossed at most twice by any line."""
    axes, eye = view.axes, np.array(view.eye)
    box = (np.array(list(itertools.product(*np.stack(mesh.bounds, axis=1)))) - eye) @ axes.T
    unit = max(2.0 ** math.frexp(float(np.abs(box).max()))[1], LEAST_UNIT)
    places = rotated(axes / unit, mesh.coordinate_rows, view.eye)
    normals = rotated(axes, mesh.normal_rows)
    corners, corner_normals = mesh.columns, mesh.normal_columns
    polygon_numbers = np.arange(corners.shape[1])

    # Cut at the near plane what reaches through it, and drop what is behind it.
    depth = places[2]
    near = max(NEAR * float(box[:, 2].max()) / unit, LEAST_NEAR)
    if depth.min(initial=near) < near:
        places, normals, corners, corner_normals, polygon_numbers = _cut_at_near_plane(
            near, places, normals, corners, corner_normals, polygon_numbers
        )

    # Project.
    inverse_depth = 1.0 / np.maximum(places[2], near)
    scale = lens(lines, elements, view.field_of_view).focal_length * inverse_depth
    across = places[0] * scale + elements / 2
    down = places[1] * scale + lines / 2
    first_line = np.clip(np.ceil(down - 0.5), 0, lines).astype(np.intp)

    kept = _seen_at_all(first_line, across, corners, elements)
    corners, corner_normals = np.take(corners, kept, axis=1), np.take(corner_normals, kept, axis=1)
    polygon_numbers, first_lines = polygon_numbers[kept], first_line[corners]

    # Clockwise on the raster (lines grow downward) is counterclockwise from the outside: the front.
    x, y = across[corners], down[corners]
    from_behind = (x[2] - x[0]) * (y[3] - y[1]) - (x[3] - x[1]) * (y[2] - y[0]) > 0

    # Cut in two the quads that some lines cross four times.
    rising = np.diff(first_lines, axis=0, append=first_lines[:1])
    zigzag = np.flatnonzero(
        (rising[0] * rising[1] < 0) & (rising[1] * rising[2] < 0) & (rising[2] * rising[3] < 0)
    )
    if len(zigzag):
        corners, corner_normals, parents = _cut_in_two(zigzag, x, y, corners, corner_normals)
        polygon_numbers, from_behind = polygon_numbers[parents], from_behind[parents]
    return Projection(
        lines,
        elements,
        unit,
        across,
        down,
        inverse_depth,
        first_line,
        corners,
        corner_normals,
        normals,
        polygon_numbers,
        from_behind,
    )


def rotated(axes: Floats, rows: Floats, origin: Vector = (0.0, 0.0, 0.0)) -> Floats:
    """Points (3, n) around an origin, in other axes.

    Measured: a matrix product of so few rows takes as long alone, and up to thirty times as long when another
    process has the second processor, for its threads wait for each other.
    """
    turned = np.empty(rows.shape)
    moved = [row - start for row, start in zip(rows, origin, strict=True)]
    for axis, out in zip(axes, turned, strict=True):
        np.multiply(moved[0], axis[0], out=out)
        out += moved[1] * axis[1]
        out += moved[2] * axis[2]
    return turned


def _seen_at_all(first_line: Numbers, across: Floats, corners: Numbers, elements: int) -> Numbers:
    """The columns of the polygons that cross a line and reach over the center of a pixel of the picture."""
    kept = []
    for first in range(0, corners.shape[1], POLYGONS_AT_ONCE):
        some = corners[:, first : first + POLYGONS_AT_ONCE]
        first_lines, acrosses = first_line[some], across[some]
        # A cut may round a little beyond its edge's ends.
        left = np.ceil(_least(acrosses) - (0.5 + ROUNDING))
        beyond = np.ceil(_most(acrosses) - (0.5 - ROUNDING))
        crosses = _least(first_lines) < _most(first_lines)
        kept.append(np.flatnonzero(crosses & (left < beyond) & (beyond > 0) & (left < elements)) + first)
    return np.concatenate(kept) if kept else np.empty(0, np.intp)


def _least(rows: npt.NDArray[Any]) -> npt.NDArray[Any]:
    """The least of four rows; measured: a tenth of the time of a reduction over the short axis."""
    least: npt.NDArray[Any] = np.minimum(np.minimum(rows[0], rows[1]), np.minimum(rows[2], rows[3]))
    return least


def _most(rows: npt.NDArray[Any]) -> npt.NDArray[Any]:
    """The most of four rows."""
    most: npt.NDArray[Any] = np.maximum(np.maximum(rows[0], rows[1]), np.maximum(rows[2], rows[3]))
    return most


def _cut_in_two(
    quads: Numbers, x: Floats, y: Floats, corners: Numbers, corner_normals: Numbers
) -> tuple[Numbers, Numbers, Numbers]:
    """The polygons with each of some quads replaced by two triangles, and the column each came from.

    The cut runs from corner 0 to corner 2 where the other two lie on either side of it, else from 1 to 3, so
    that a dart is cut at its notch. The triangles stand together in the place of their quad.
    """
    x, y = x[:, quads], y[:, quads]
    side = [
        (x[2] - x[0]) * (y[corner] - y[0]) - (y[2] - y[0]) * (x[corner] - x[0]) for corner in (1, 3)
    ]  # fmt: skip
    from_zero = side[0] * side[1] < 0
    orders = np.where(from_zero, [[0], [1], [2], [0], [2], [3]], [[1], [2], [3], [1], [3], [0]])
    parents = np.sort(np.concatenate([np.arange(corners.shape[1]), quads]))
    first = quads + np.arange(len(quads))
    cut_corners, cut_normals = corners[:, parents], corner_normals[:, parents]
    for row, (half, corner) in zip(orders, [(h, c) for h in (0, 1) for c in (0, 1, 2)], strict=True):
        cut_corners[corner, first + half] = corners[row, quads]
        cut_normals[corner, first + half] = corner_normals[row, quads]
    for table in (cut_corners, cut_normals):
        table[3, first] = table[2, first]
        table[3, first + 1] = table[2, first + 1]
    return cut_corners, cut_normals, parents


def _cut_at_near_plane(
    near: float,
    places: Floats,
    normals: Floats,
    corners: Numbers,
    corner_normals: Numbers,
    polygon_numbers: Numbers,
) -> tuple[Floats, Floats, Numbers, Numbers, Numbers]:
    """The polygons with what lies before the near plane cut off, with the nodes that the cuts made.

    An edge is cut from its lower to its higher node number, once for all polygons that share it, so that
    they still share it afterwards.
    """
    before = (places[2] < near)[corners]
    whole = np.flatnonzero(~before.any(axis=0))
    through = np.flatnonzero(before.any(axis=0) & ~before.all(axis=0))
    node_of_edge: dict[tuple[int, int], int] = {}
    new_places: list[Floats] = []
    new_normals: list[Floats] = []
    new_rows: list[tuple[list[int], list[int], int]] = []

    for column in through.tolist():
        nodes, rows = corners[:, column].tolist(), corner_normals[:, column].tolist()
        cut_nodes: list[int] = []
        cut_rows: list[int] = []
        for corner in range(4):
            a, b = nodes[corner], nodes[(corner + 1) % 4]
            if not before[corner, column]:
                cut_nodes.append(a)
                cut_rows.append(rows[corner])
            if before[corner, column] != before[(corner + 1) % 4, column]:
                low, high = min(a, b), max(a, b)
                way = (near - places[2, low]) / (places[2, high] - places[2, low])
                if (low, high) not in node_of_edge:
                    node_of_edge[low, high] = places.shape[1] + len(new_places)
                    place = places[:, low] + way * (places[:, high] - places[:, low])
                    place[2] = near
                    new_places.append(place)
                cut_nodes.append(node_of_edge[low, high])
                cut_rows.append(normals.shape[1] + len(new_normals))
                low_row, high_row = rows[corner], rows[(corner + 1) % 4]
                if low != a:
                    low_row, high_row = high_row, low_row
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
    corners = np.concatenate([corners[:, whole], cut_corners], axis=1)
    corner_normals = np.concatenate([corner_normals[:, whole], cut_normals], axis=1)
    # Keep the order of the polygon table, which settles ties.
    order = np.argsort(columns, kind="stable")
    return places, normals, corners[:, order], corner_normals[:, order], polygon_numbers[columns[order]]
