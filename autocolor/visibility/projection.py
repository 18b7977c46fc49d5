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

from autocolor.arrays import (
    Booleans,
    Floats,
    Indices,
    RasterPlaces,
    Singles,
    chunks,
    least_of_four,
    most_of_four,
)
from autocolor.scene.geometry.normals import used_rows
from autocolor.scene.geometry.planes import SharedPlanes
from autocolor.scene.mesh import Mesh
from autocolor.scene.view import View
from autocolor.visibility.camera import (
    CameraPolygons,
    Raster,
    camera_space,
    clipped_at_near_plane,
    left_center,
    near_of,
    on_raster,
    right_center,
    rotated,
    unit_and_near,
)

# -------------------- plane_depths
# The depth of polygons that share a plane: one linear function of the raster for all of them.
#
# The depth of other polygons is rounded from the left end of each segment on, so that of two in one plane
# now one and now the other would be nearer. The polygons of a shared plane have the same depth at a pixel,
# and the last of them is visible, as a decal on its ground should be.

MOST_OFF: Final = 0.05
"""Assumed: how far a plane's depth may be from that of its polygons' corners, as a fraction.

A plane that is seen so nearly edge-on that they differ by more is not used; its polygons keep their own
depths, so that a decal may be torn or hidden there: the eye is then within 20 times the rounding of the
corners from the plane. Where they differ by less the plane itself is no farther from its corners than they
are rounded. Measured: from 2e-6 to 2e-3 above a ground of size 1, 27 decals of 2,061 were torn with 0.001,
and 10 of 2,031 with 0.05; by ray casting no more polygons were seen that are behind others.
"""

ROUNDING: Final = 1e-12
"""In units, far above the rounding of the distance of a plane from the eye."""


class PlanesOnRaster(NamedTuple):
    """Shared planes on the raster, and the polygons of a projection that lie in them.

    The inverse depth of each plane at x, y (pixels) is A x + B y + C of `linear`, (3, planes). `columns`,
    (polygons,) intp, is the plane of each polygon, -1 for none.
    """

    linear: Floats
    columns: Indices

    def inverse_depth(self, planes: Indices, x: Floats, y: Floats) -> Floats:
        """The inverse depth of planes at some places."""
        a, b, c = np.take(self.linear, planes, axis=1)
        inverse_depth: Floats = a * x + b * y + c
        return inverse_depth


NO_PLANES: Final = PlanesOnRaster(np.empty((3, 0)), np.empty(0, np.intp))


def planes_on_raster(
    shared: SharedPlanes | None,
    camera: CameraPolygons,
    origin: tuple[float, float, float],
    axes: Floats,
    raster: Raster,
    polygon_numbers: Indices,
) -> tuple[PlanesOnRaster, Indices, Booleans]:
    """The planes on the raster; the polygons in them, and whether each is seen from behind."""
    if shared is None:
        return NO_PLANES, np.empty(0, np.intp), np.empty(0, np.bool_)
    normals = rotated(axes, shared.normals)
    offsets = (normals * rotated(axes / camera.unit, shared.points, origin)).sum(axis=0)
    used = np.abs(offsets) * MOST_OFF > np.maximum(shared.distances / camera.unit, ROUNDING)
    # The inverse depth is proportional to the product of the normal and the ray.
    a, b, c = normals / np.where(used, offsets, 1.0)
    a, b = a / raster.focal_length, b / raster.focal_length
    linear = np.stack([a, b, c - a * (raster.elements / 2) - b * (raster.lines / 2)])
    columns = shared.plane_of_polygon.take(polygon_numbers)
    polygons = np.flatnonzero(columns >= 0)
    polygons = polygons[used[columns[polygons]]]
    found = np.full_like(columns, -1)
    found[polygons] = columns[polygons]
    # Tell the side from the plane: at a grazing angle each polygon would be rounded to its own.
    behind = (offsets[found[polygons]] > 0) ^ shared.turned[polygon_numbers[polygons]]
    return PlanesOnRaster(linear, found), polygons, behind


# -------------------- preselection
# The polygons of a large mesh that may be visible, found with a few bytes a node.
#
# Of ten million polygons a picture shows a few hundred thousand; most others lie between two lines or
# between two pixel centers. So each node is first put on the raster in small whole numbers alone, and only
# the nodes of the polygons that may be visible are then put into camera space, to the same bits.
#
# Measured: ten million quads take 60 MB for a moment instead of 760, and less time, too.

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


# -------------------- splitting
# Splitting quads that some line crosses four times into two triangles.


def split_quads(
    quads: Indices, x: Floats, y: Floats, positions: Floats, corners: Indices, corner_normals: Indices
) -> tuple[Indices, Indices, Indices]:
    """The polygons with some quads replaced by two triangles each, and the column that each came from.

    A quad is split along the diagonal that has one of the other two corners on either side, so that a dart is
    split at its notch; where that holds for both or for neither, along the shorter one in camera space.
    Nothing depends on the corner that is written first. The triangles take the place of their quad.
    """
    nodes = corners[:, quads]
    quad_x, quad_y = x[nodes], y[nodes]
    first, second = (_divides(np.roll(quad_x, -c, axis=0), np.roll(quad_y, -c, axis=0)) for c in (0, 1))
    places = positions[:, nodes]
    diagonals = places[:, :2] - places[:, 2:]
    # Compare the lengths, and of equal ones the ends; two diagonals with the same ends are the same.
    ends = np.sort(places.reshape(3, 2, 2, -1), axis=1)
    along_first = _before(
        np.concatenate([[~first], (diagonals[:, :1] ** 2).sum(axis=0), *ends[:, :, 0]]),
        np.concatenate([[~second], (diagonals[:, 1:] ** 2).sum(axis=0), *ends[:, :, 1]]),
    )
    # Let the triangle whose own corner is before that of the other come first.
    off = np.where(along_first, [[1], [3]], [[2], [0]])
    column = np.arange(len(quads))
    own, other = (places[:, corner, column] for corner in off)
    off = np.where(_before(other, own), off[::-1], off)
    parents = np.sort(np.concatenate([np.arange(corners.shape[1]), quads]))
    split_corners, split_normals = corners[:, parents], corner_normals[:, parents]
    for half in (0, 1):
        picked = (off[half] + np.array([[3], [0], [1], [1]])) & 3
        for table, source in ((split_corners, corners), (split_normals, corner_normals)):
            table[:, quads + column + half] = source[picked, quads]
    return split_corners, split_normals, parents


def _divides(x: Floats, y: Floats) -> Booleans:
    """Whether corners 1 and 3 of quads lie on either side of the diagonal from 0 to 2."""
    # Follow the diagonal from the same end, whichever corner is 0, so that rounding is the same.
    start = np.where(_before(np.stack([x[0], y[0]]), np.stack([x[2], y[2]])), 0, 2)
    column = np.arange(len(start))
    left, top = x[start, column], y[start, column]
    across, down = x[2 - start, column] - left, y[2 - start, column] - top
    one, other = (across * (y[corner] - top) - down * (x[corner] - left) for corner in (1, 3))
    either_side: Booleans = ((one < 0) & (other > 0)) | ((one > 0) & (other < 0))
    return either_side


def _before(one: Floats, other: Floats) -> Booleans:
    """Whether each column of `one`, (rows, n), is less than that of `other` in the first row that differs."""
    before = np.zeros(one.shape[1], np.bool_)
    for row, other_row in zip(reversed(one), reversed(other), strict=True):
        before = (row < other_row) | ((row == other_row) & before)
    return before


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
        _may_be_visible_2(camera, x, y, first_line, elements, chunk)
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


def _may_be_visible_2(
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
