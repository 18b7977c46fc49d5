"""The polygons projected to the raster.

Both hidden-surface algorithms start from a projection, so that they calculate with the same numbers. The
paper does not describe its projection; this is a perspective one with square pixels whose centers are at
half-integers, line 0 on top.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Final, NamedTuple

import numpy as np

from autocolor.arrays import AnyArray, Booleans, Floats, Indices, Singles, chunks
from autocolor.scene.mesh import Mesh
from autocolor.scene.view import View
from autocolor.visibility.camera_space import CameraPolygons, camera_space
from autocolor.visibility.clipping import clipped_at_near_plane
from autocolor.visibility.plane_depths import PlanesOnRaster, planes_on_raster
from autocolor.visibility.splitting import split_quads

ROUNDING: Final = 1e-6
"""In pixels, far above the rounding of a crossing."""

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
    """The nodes of a mesh on the raster of a view, and the polygons that may be visible.

    Camera space is measured in `unit`, a power of two near the distance of the object's farthest corner: so
    float32 holds a part of a watch as exactly as a mountain range, and both give the same bits.
    `focal_length` is in pixels.

    `x`, `y` (pixels) and `inverse_depth` are (nodes,) float64. `first_line`, (nodes,) intp, is the first line
    whose center is at or below the node, so that an edge from a to b crosses the lines first_line[a] <= line
    < first_line[b].

    `corners` and `corner_normals` are (4, polygons) intp: the node at each corner, and its column of
    `normals`, (3, normals) float32 in camera space. `polygon_numbers` are rows of the mesh's polygon table,
    `from_behind` tells whether the eye sees the back, and `line_counts`, (polygons,) intp, how many lines
    cross the polygon. No corner of a polygon has an inverse depth above `nearest`. `planes` are those that
    polygons share.
    """

    mesh: Mesh
    view: View
    lines: int
    elements: int
    unit: float
    focal_length: float
    x: Floats
    y: Floats
    inverse_depth: Floats
    first_line: Indices
    corners: Indices
    corner_normals: Indices
    normals: Singles
    polygon_numbers: Indices
    from_behind: Booleans
    line_counts: Indices
    nearest: float
    planes: PlanesOnRaster

    @cached_property
    def middle(self) -> Floats:
        """The middle of the object's bounding box in camera space, in units."""
        low, high = self.mesh.bounds
        middle: Floats = self.view.axes @ ((low + high) / 2 - np.array(self.view.eye)) / self.unit
        return middle


def projection(mesh: Mesh, view: View, lines: int, elements: int) -> Projection:
    """The polygons of the mesh that may be visible, each crossed at most twice by any line."""
    camera = clipped_at_near_plane(camera_space(mesh, view))
    focal = focal_length(lines, view.field_of_view)
    x, y, inverse_depth, first_line = _on_raster(camera, focal, lines, elements)

    # Keep the polygons that may be visible.
    found = [
        _may_be_visible(camera, x, y, first_line, elements, chunk)
        for chunk in chunks(max(camera.corners.shape[1], 1), POLYGONS_AT_ONCE)
    ]
    corners = np.concatenate([each.corners for each in found], axis=1)
    corner_normals = np.concatenate([each.corner_normals for each in found], axis=1)
    polygon_numbers = np.concatenate([each.polygon_numbers for each in found])
    from_behind = np.concatenate([each.from_behind for each in found])
    line_counts = np.concatenate([each.line_counts for each in found])

    # Split the quads that some line crosses four times.
    quads = np.flatnonzero(np.concatenate([each.zigzag for each in found]))
    if len(quads):
        corners, corner_normals, parents = split_quads(quads, x, y, camera.positions, corners, corner_normals)
        polygon_numbers, from_behind = polygon_numbers[parents], from_behind[parents]
        first_lines = first_line[corners]
        line_counts = most_of_four(first_lines) - least_of_four(first_lines)
    planes, in_planes, behind = planes_on_raster(
        mesh.shared_planes, camera, view.eye, view.axes, focal, (lines, elements), polygon_numbers
    )
    from_behind[in_planes] = behind
    nearest = float(inverse_depth.max(initial=1.0))
    if nearest * camera.near >= 1:
        # Nodes behind the near plane were put on it; no polygon uses them.
        nearest = float(inverse_depth[corners].max(initial=1.0))
    return Projection(
        mesh,
        view,
        lines,
        elements,
        camera.unit,
        focal,
        x,
        y,
        inverse_depth,
        first_line,
        corners,
        corner_normals,
        camera.normals,
        polygon_numbers,
        from_behind,
        line_counts,
        nearest,
        planes,
    )


def _on_raster(
    camera: CameraPolygons, focal: float, lines: int, elements: int
) -> tuple[Floats, Floats, Floats, Indices]:
    """Of each node the screen x and y, the inverse depth, and the first line at or below it."""
    count = camera.positions.shape[1]
    x, y, inverse_depth = np.empty(count), np.empty(count), np.empty(count)
    first_line = np.empty(count, np.intp)
    for chunk in chunks(count, NODES_AT_ONCE):
        right, down, depth = camera.positions[:, chunk]
        np.divide(1.0, np.maximum(depth, camera.near), out=inverse_depth[chunk])
        scale = focal * inverse_depth[chunk]
        np.add(right * scale, elements / 2, out=x[chunk])
        np.add(down * scale, lines / 2, out=y[chunk])
        first_line[chunk] = np.clip(np.ceil(y[chunk] - 0.5), 0, lines)
    return x, y, inverse_depth, first_line


class Polygons(NamedTuple):
    """Polygons that may be visible: as in a projection, and how many lines they cross.

    The quads that `zigzag` are crossed four times by some line.
    """

    corners: Indices
    corner_normals: Indices
    polygon_numbers: Indices
    from_behind: Booleans
    line_counts: Indices
    zigzag: Booleans


def _may_be_visible(
    camera: CameraPolygons, x: Floats, y: Floats, first_line: Indices, elements: int, chunk: slice
) -> Polygons:
    """The polygons of a chunk that cross a line and may cover the center of a pixel."""
    corners = camera.corners[:, chunk]
    lines, corner_x = first_line.take(corners), x.take(corners)
    line_counts = most_of_four(lines) - least_of_four(lines)
    # A crossing may be rounded to a little outside its edge.
    left = np.ceil(least_of_four(corner_x) - (0.5 + ROUNDING))
    end = np.ceil(most_of_four(corner_x) - (0.5 - ROUNDING))
    kept = np.flatnonzero((line_counts > 0) & (left < end) & (end > 0) & (left < elements))

    corners, corner_x = np.take(corners, kept, axis=1), np.take(corner_x, kept, axis=1)
    corner_y = y.take(corners)
    fall = np.diff(np.take(lines, kept, axis=1), axis=0)
    return Polygons(
        corners,
        np.take(camera.corner_normals[:, chunk], kept, axis=1),
        camera.polygon_numbers[chunk].take(kept),
        # The front of a polygon runs counterclockwise, which is clockwise on the raster: y grows downward.
        (corner_x[2] - corner_x[0]) * (corner_y[3] - corner_y[1])
        - (corner_x[3] - corner_x[1]) * (corner_y[2] - corner_y[0])
        > 0,
        line_counts.take(kept),
        (fall[0] * fall[1] < 0) & (fall[1] * fall[2] < 0) & ((fall[0] + fall[1] + fall[2]) * fall[2] > 0),
    )


def least_of_four(rows: AnyArray | Sequence[AnyArray]) -> AnyArray:
    """The least of four rows; measured: a tenth of the time of a reduction over the short axis."""
    least: AnyArray = np.minimum(np.minimum(rows[0], rows[1]), np.minimum(rows[2], rows[3]))
    return least


def most_of_four(rows: AnyArray) -> AnyArray:
    """The most of four rows."""
    most: AnyArray = np.maximum(np.maximum(rows[0], rows[1]), np.maximum(rows[2], rows[3]))
    return most
