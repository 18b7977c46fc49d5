"""The polygons projected to the raster.

Both hidden-surface algorithms start from a projection, so that they calculate with the same numbers. The
paper does not describe its projection; this is a perspective one with square pixels whose centers are at
half-integers, line 0 on top.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Final, NamedTuple

import numpy as np

from autocolor.arrays import Booleans, Floats, Indices, Singles, chunks, least_of_four, most_of_four
from autocolor.scene.mesh import Mesh
from autocolor.scene.view import View
from autocolor.visibility.camera_space import CameraPolygons, camera_space
from autocolor.visibility.clipping import clipped_at_near_plane
from autocolor.visibility.plane_depths import PlanesOnRaster, planes_on_raster
from autocolor.visibility.preselection import preselected
from autocolor.visibility.raster import Raster, left_center, on_raster, right_center
from autocolor.visibility.splitting import split_quads

POLYGONS_AT_ONCE: Final = 1 << 15

LARGE: Final = 1 << 21
"""Polygons from which on those that may be visible are found first, with a few bytes a node.

Measured: fewer are projected at once in two thirds of the time, for at most 150 MB.
"""


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
    raster = Raster(lines, elements, focal_length(lines, view.field_of_view))
    is_large = len(mesh.node_numbers) >= LARGE
    camera = clipped_at_near_plane(preselected(mesh, view, raster) if is_large else camera_space(mesh, view))
    x, y, inverse_depth, first_line = on_raster(camera.positions, camera.near, raster)

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
        mesh.shared_planes, camera, view.eye, view.axes, raster, polygon_numbers
    )
    from_behind[in_planes] = behind
    nearest = max(1.0, 1.0 / max(camera.nearest, camera.near))
    if nearest * camera.near >= 1:
        # Nodes behind the near plane were put on it; no polygon uses them.
        nearest = float(inverse_depth[corners].max(initial=1.0))
    return Projection(
        mesh,
        view,
        lines,
        elements,
        camera.unit,
        raster.focal_length,
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
    left, end = left_center(least_of_four(corner_x)), right_center(most_of_four(corner_x))
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
