"""The polygons of a large mesh that may be visible, found with a few bytes a node.

Of ten million polygons a picture shows a few hundred thousand; most others lie between two lines or between
two pixel centers. So each node is first put on the raster in small whole numbers alone, and only the nodes
of the polygons that may be visible are then put into camera space, to the same bits.

Measured: ten million quads take 60 MB for a moment instead of 760, and less time, too.
"""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np

from autocolor.arrays import Booleans, Indices, RasterPlaces, chunks, least_of_four, most_of_four
from autocolor.scene.geometry.used_rows import used_rows
from autocolor.scene.mesh import Mesh
from autocolor.scene.view import View
from autocolor.visibility.camera_space import CameraPolygons, near_of, rotated, unit_and_near
from autocolor.visibility.raster import Raster, left_center, on_raster, right_center

POLYGONS_AT_ONCE: Final = 1 << 15
NODES_AT_ONCE: Final = 1 << 14


class NodePlaces(NamedTuple):
    """Where the nodes of a mesh lie among the lines and the pixel centers, each (nodes,).

    A polygon has a line if its corners differ in `line`, and may have a pixel center if the least `left` is
    below the most `right`. `before` tells which nodes are nearer than the near plane; None if there are none.
    `nearest` is the least depth.
    """

    line: RasterPlaces
    left: RasterPlaces
    right: RasterPlaces
    before: Booleans | None
    nearest: float


def preselected(mesh: Mesh, view: View, raster: Raster) -> CameraPolygons:
    """The polygons of a mesh that may be visible or cross the near plane, in camera space.

    Their nodes and normals are renumbered in the order of the mesh's; nothing but a picture of the other
    polygons is lost.
    """
    unit, near = unit_and_near(mesh, view)
    places = _node_places(mesh, view, raster, unit, near)
    if places.nearest < near:
        near = near_of(near, _nearest_corner(mesh, view, unit, near))
        places = _node_places(mesh, view, raster, unit, near)
    found = [
        _may_be_visible(places, mesh.node_numbers.T[:, chunk]) + chunk.start
        for chunk in chunks(len(mesh.node_numbers), POLYGONS_AT_ONCE)
    ]
    polygons, nearest = np.concatenate([np.empty(0, np.intp), *found]), places.nearest
    # Give the memory of the places back before more is needed.
    del places, found
    nodes, corners = _renumbered(np.take(mesh.node_numbers.T, polygons, axis=1), len(mesh.coordinates))
    normals = mesh.normals
    used, corner_normals = _renumbered(np.take(normals.numbers.T, polygons, axis=1), len(normals.vectors))
    return CameraPolygons(
        unit,
        near,
        nearest,
        rotated(view.axes / unit, np.take(mesh.coordinates.T, nodes, axis=1), view.eye),
        rotated(view.axes, np.take(normals.vectors.T, used, axis=1)),
        corners,
        corner_normals,
        polygons,
    )


def _node_places(mesh: Mesh, view: View, raster: Raster, unit: float, near: float) -> NodePlaces:
    """Where the nodes lie, chunk by chunk."""
    count = len(mesh.coordinates)
    line, left, right = np.empty(count, np.int16), np.empty(count, np.int16), np.empty(count, np.int16)
    before, nearest = np.zeros(count, np.bool_), np.inf
    for chunk in chunks(count, NODES_AT_ONCE):
        positions = rotated(view.axes / unit, mesh.coordinates.T[:, chunk], view.eye)
        np.less(positions[2], near, out=before[chunk])
        nearest = min(nearest, float(positions[2].min()))
        x, _, _, line[chunk] = on_raster(positions, near, raster)
        left[chunk] = np.clip(left_center(x), 0, raster.elements)
        right[chunk] = np.clip(right_center(x), 0, raster.elements)
    return NodePlaces(line, left, right, before if nearest < near else None, nearest)


def _nearest_corner(mesh: Mesh, view: View, unit: float, near: float) -> float:
    """The least depth of a node that a polygon uses, at most `near`."""
    used = used_rows(mesh.node_numbers.T, len(mesh.coordinates))
    for chunk in chunks(len(used), NODES_AT_ONCE):
        depth = rotated(view.axes / unit, mesh.coordinates.T[:, chunk], view.eye)[2]
        near = float(depth.min(initial=near, where=used[chunk]))
    return near


def _may_be_visible(places: NodePlaces, corners: Indices) -> Indices:
    """The columns of the corners, (4, polygons), of polygons that may be visible or cross the near plane."""
    line = places.line.take(corners)
    kept = least_of_four(line) < most_of_four(line)
    crossing: Booleans | None = None
    if places.before is not None:
        before = places.before.take(corners)
        some = before[0] | before[1] | before[2] | before[3]
        crossing = some & ~(before[0] & before[1] & before[2] & before[3])
        kept &= ~some
    columns = np.flatnonzero(kept)
    corners = np.take(corners, columns, axis=1)
    columns = columns[least_of_four(places.left.take(corners)) < most_of_four(places.right.take(corners))]
    return columns if crossing is None else np.sort(np.append(columns, np.flatnonzero(crossing)))


def _renumbered(numbers: Indices, count: int) -> tuple[Indices, Indices]:
    """Which of `count` rows some numbers use, ascending, and the numbers counted among those alone."""
    used = used_rows(numbers, count)
    places = np.cumsum(used, dtype=np.int32 if count < 1 << 31 else np.int64)
    renumbered = places.take(numbers).astype(np.intp)
    renumbered -= 1
    return np.flatnonzero(used), renumbered
