"""The polygons as the eye sees them: projected to the raster.

Both hidden-surface algorithms start from this value, so that they work on the same numbers. The paper does
not say how its picture plane is reached; the lens is a plain perspective one with square pixels whose
centers stand at half-integers, line 0 on top.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from autocolor.arrays import Flags, Floats, Numbers, Singles, chunks
from autocolor.scene.mesh import Mesh
from autocolor.scene.view import View
from autocolor.visibility.camera_space import CameraPolygons, camera_space

ROUNDING: Final = 1e-6
"""In pixels, far above what the cut of an edge is rounded by."""

POLYGONS_AT_ONCE: Final = 1 << 15
NODES_AT_ONCE: Final = 1 << 14


def focal_length(lines: int, field_of_view: float) -> float:
    """The focal length in pixels of a raster with a vertical field of view in degrees.

    The ray through the center of pixel (line, element) is ((element + 1/2 - elements / 2) / focal length,
    (line + 1/2 - lines / 2) / focal length, 1) in camera space.
    """
    return lines / 2 / math.tan(math.radians(field_of_view) / 2)


@dataclass(frozen=True, eq=False)
class Projection:
    """Nodes on the raster and the polygons that use them.

    Camera space is measured in `unit`, a power of two near the distance of the farthest corner of the
    object: so float32 holds a part of a watch and a mountain range alike, and to the same last bit.
    `across`, `down` (pixels) and `inverse_depth` are (nodes,) float64. `first_line` is (nodes,) intp: the
    first line whose center is at or below the node, so that an edge from a to b crosses the lines
    first_line[a] <= line < first_line[b]. `corners` and `corner_normals` are (4, polygons) intp, one
    column a polygon, numbers of nodes and of columns of `normals`, (3, normals) float32 in camera space.
    `polygon_numbers` are the rows of the mesh's polygon table, `from_behind` whether the eye sees the back.
    The crossings of polygons and lines are numbered polygon by polygon from the top down: those of polygon p
    from first_crossing[p] to before first_crossing[p + 1], (polygons + 1,) intp. No corner of a polygon has
    an inverse depth above `nearest`.
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
    normals: Singles
    polygon_numbers: Numbers
    from_behind: Flags
    first_crossing: Numbers
    nearest: float


def projection(mesh: Mesh, view: View, lines: int, elements: int) -> Projection:
    """The polygons of the mesh that may be seen, each crossed at most twice by any line."""
    camera = camera_space(mesh, view)

    across, down, inverse_depth, first_line = _on_raster(camera, view, lines, elements)

    # Find the polygons that may be seen.
    found = [
        _may_be_seen(camera, across, down, first_line, elements, some)
        for some in chunks(max(camera.corners.shape[1], 1), POLYGONS_AT_ONCE)
    ]
    corners = np.concatenate([each.corners for each in found], axis=1)
    corner_normals = np.concatenate([each.corner_normals for each in found], axis=1)
    polygon_numbers = np.concatenate([each.polygon_numbers for each in found])
    from_behind = np.concatenate([each.from_behind for each in found])
    crossings = np.concatenate([each.crossings for each in found])

    # Cut in two the quads that some lines cross four times.
    quads = np.flatnonzero(np.concatenate([each.zigzag for each in found]))
    if len(quads):
        corners, corner_normals, parents = _cut_in_two(quads, across, down, corners, corner_normals)
        polygon_numbers, from_behind = polygon_numbers[parents], from_behind[parents]
        first_lines = first_line[corners]
        crossings = most_of_four(first_lines) - least_of_four(first_lines)
    first_crossing = np.zeros(corners.shape[1] + 1, np.intp)
    np.cumsum(crossings, out=first_crossing[1:])
    nearest = float(inverse_depth.max(initial=1.0))
    if nearest * camera.near >= 1:
        # Nodes that are not before the eye stand at the near plane, where no polygon may reach.
        nearest = float(inverse_depth[corners].max(initial=1.0))
    return Projection(
        lines,
        elements,
        camera.unit,
        across,
        down,
        inverse_depth,
        first_line,
        corners,
        corner_normals,
        camera.normals,
        polygon_numbers,
        from_behind,
        first_crossing,
        nearest,
    )


def _on_raster(
    camera: CameraPolygons, view: View, lines: int, elements: int
) -> tuple[Floats, Floats, Floats, Numbers]:
    """Of each node the place across and down, the inverse depth, and the first line at or below it."""
    count = camera.places.shape[1]
    across, down, inverse_depth = np.empty(count), np.empty(count), np.empty(count)
    first_line = np.empty(count, np.intp)
    focal = focal_length(lines, view.field_of_view)
    for some in chunks(count, NODES_AT_ONCE):
        x, y, depth = camera.places[:, some]
        np.divide(1.0, np.maximum(depth, camera.near), out=inverse_depth[some])
        scale = focal * inverse_depth[some]
        np.add(x * scale, elements / 2, out=across[some])
        np.add(y * scale, lines / 2, out=down[some])
        first_line[some] = np.clip(np.ceil(down[some] - 0.5), 0, lines)
    return across, down, inverse_depth, first_line


class Polygons(NamedTuple):
    """Polygons that may be seen: as in a projection, and how many lines they cross.

    Of those that `zigzag` some lines cross four edges.
    """

    corners: Numbers
    corner_normals: Numbers
    polygon_numbers: Numbers
    from_behind: Flags
    crossings: Numbers
    zigzag: Flags


def _may_be_seen(
    camera: CameraPolygons, across: Floats, down: Floats, first_line: Numbers, elements: int, some: slice
) -> Polygons:
    """Those of some polygons that cross a line and reach over the center of a pixel."""
    corners = camera.corners[:, some]
    lines, x = first_line.take(corners), across.take(corners)
    crossings = most_of_four(lines) - least_of_four(lines)
    # A cut may round a little beyond its edge's ends.
    left = np.ceil(least_of_four(x) - (0.5 + ROUNDING))
    beyond = np.ceil(most_of_four(x) - (0.5 - ROUNDING))
    kept = np.flatnonzero((crossings > 0) & (left < beyond) & (beyond > 0) & (left < elements))

    corners, x = np.take(corners, kept, axis=1), np.take(x, kept, axis=1)
    y = down.take(corners)
    fall = np.diff(np.take(lines, kept, axis=1), axis=0)
    return Polygons(
        corners,
        np.take(camera.corner_normals[:, some], kept, axis=1),
        camera.polygon_numbers[some].take(kept),
        # Clockwise on the raster (lines grow downward) is counterclockwise from the outside: the front.
        (x[2] - x[0]) * (y[3] - y[1]) - (x[3] - x[1]) * (y[2] - y[0]) > 0,
        crossings.take(kept),
        (fall[0] * fall[1] < 0) & (fall[1] * fall[2] < 0) & ((fall[0] + fall[1] + fall[2]) * fall[2] > 0),
    )


def least_of_four(rows: NDArray[Any] | Sequence[NDArray[Any]]) -> NDArray[Any]:
    """The least of four rows; measured: a tenth of the time of a reduction over the short axis."""
    least: NDArray[Any] = np.minimum(np.minimum(rows[0], rows[1]), np.minimum(rows[2], rows[3]))
    return least


def most_of_four(rows: NDArray[Any]) -> NDArray[Any]:
    """The most of four rows."""
    most: NDArray[Any] = np.maximum(np.maximum(rows[0], rows[1]), np.maximum(rows[2], rows[3]))
    return most


def _cut_in_two(
    quads: Numbers, across: Floats, down: Floats, corners: Numbers, corner_normals: Numbers
) -> tuple[Numbers, Numbers, Numbers]:
    """The polygons with each of some quads replaced by two triangles, and the column each came from.

    The cut runs from corner 0 to corner 2 where the other two lie on either side of it, else from 1 to 3, so
    that a dart is cut at its notch. The triangles stand together in the place of their quad.
    """
    x, y = across[corners[:, quads]], down[corners[:, quads]]
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
