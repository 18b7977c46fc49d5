"""The projection of polygons to the raster: polygons that may be visible, with the places of their nodes.

Both hidden-surface algorithms start from a projection, so that they calculate with the same numbers. The
paper does not describe its projection. This is a perspective projection onto square pixels, whose centers are
at half-integers; line 0 is at the top.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Final, NamedTuple

import numpy as np

from autocolor.arrays import (
    AnyArray,
    Booleans,
    Bytes,
    Floats,
    Indices,
    RasterPlaces,
    Singles,
    chunks,
    least_of_four,
    most_of_four,
    used_rows,
)
from autocolor.scene.geometry.diagonals import NO_DIAGONAL, Diagonals
from autocolor.scene.geometry.planes import SharedPlanes
from autocolor.scene.mesh import Mesh
from autocolor.scene.scene import INVARIANT, SCAN_LINE
from autocolor.scene.view import View
from autocolor.visibility.camera import (
    CameraPolygons,
    camera_space,
    clipped_at_near_plane,
    near_of,
    rotated,
    unit_and_near,
)

ROUNDING: Final = 1e-6
"""In pixels, far above the rounding of a crossing."""

PLANE_ROUNDING: Final = 1e-12
"""In units, far above the rounding of the distance of a plane from the eye."""

LARGEST_PLANE_ERROR: Final = 0.05
"""Assumed: how far a shared plane may be from the corners of its polygons, as a fraction of the plane's
distance from the eye.

If a plane is seen more nearly edge-on, its polygons have depths of their own, so that a decal may be torn or
hidden there. The eye is then within 20 times the rounding of the corners from the plane. Measured: from
2e-6 to 2e-3 above a ground of size 1, 27 decals of 2,061 were torn with 0.001, and 10 of 2,031 with 0.05; by
ray casting no more polygons were seen through others in front of them.
"""

LARGE: Final = 1 << 21
"""The number of polygons from which on a mesh is preselected, with a few bytes a node.

Measured: without preselection, a smaller mesh takes two thirds of the time and at most 150 MB.
"""

MOST_WARP: Final = 0.1
"""Assumed: the warp in pixels from which on a quad is cut before it is known what is visible.

Less warped quads are whole until then: where two surfaces pass through each other, and along a silhouette,
the border may be off by this much. Measured: 5 % of the quads of the coupe are cut before, and none of a
million quads of hills. If all are, the visible surfaces take a quarter longer than along scan lines.
"""

POLYGONS_AT_ONCE: Final = 1 << 15
NODES_AT_ONCE: Final = 1 << 14


class Raster(NamedTuple):
    """The lines and elements of a raster, and its focal length in pixels."""

    lines: int
    elements: int
    focal_length: float


class PlanesInView(NamedTuple):
    """Shared planes in camera space, and the polygons of a projection that lie in them.

    `normals`, (3, planes), are unit vectors. `distances`, (planes,), lead from the eye to the planes along
    the normals; the distance of a plane that is seen too nearly edge-on is infinite. `of_polygons`,
    (polygons,) intp, is the plane of each polygon, -1 for a polygon without a plane.
    """

    normals: Floats
    distances: Floats
    of_polygons: Indices


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
    cross the polygon. No corner of a polygon has an inverse depth above `nearest`. `planes` is None if no
    polygons share a plane. `diagonals`, (polygons,) uint8, has the corner where the diagonal of a quad
    begins, as in `Diagonals`; None if interpolation follows the scan lines. `interpolation` is the scene's.
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
    planes: PlanesInView | None
    diagonals: Bytes | None
    interpolation: str = SCAN_LINE

    @cached_property
    def middle(self) -> Floats:
        """The middle of the object's bounding box in camera space, in units."""
        low, high = self.mesh.bounds
        middle: Floats = self.view.axes @ ((low + high) / 2 - np.array(self.view.eye)) / self.unit
        return middle


def projection(
    mesh: Mesh, view: View, lines: int, elements: int, interpolation: str = SCAN_LINE
) -> Projection:
    """The polygons of the mesh that may be visible, each crossed at most twice by any line."""
    raster = Raster(lines, elements, focal_length(lines, elements, view.field_of_view))
    is_large = len(mesh.node_numbers) >= LARGE
    diagonals = mesh.diagonals if interpolation == INVARIANT else None
    camera = preselected(mesh, view, raster) if is_large else camera_space(mesh, view)
    camera = clipped_at_near_plane(camera, diagonals)
    nodes = on_raster(camera.positions, camera.near, raster)
    polygons = _polygons_on_raster(camera, nodes, raster, diagonals)

    planes = None
    if mesh.shared_planes is not None:
        planes = _planes_in_view(mesh.shared_planes, view, camera.unit, polygons.polygon_numbers)
        # Take the side from the plane: at a grazing angle rounding would give its polygons different sides.
        rows = np.flatnonzero(planes.of_polygons >= 0)
        turned = mesh.shared_planes.turned[polygons.polygon_numbers[rows]]
        polygons.from_behind[rows] = (planes.distances[planes.of_polygons[rows]] > 0) ^ turned

    nearest = max(1.0, 1.0 / max(camera.nearest, camera.near))
    if nearest * camera.near >= 1:
        # Nodes behind the near plane were put on it; no polygon uses them.
        nearest = float(nodes.inverse_depth[polygons.corners].max(initial=1.0))
    return Projection(
        mesh,
        view,
        lines,
        elements,
        camera.unit,
        raster.focal_length,
        *nodes,
        polygons.corners,
        polygons.corner_normals,
        camera.normals,
        polygons.polygon_numbers,
        polygons.from_behind,
        polygons.line_counts,
        nearest,
        planes,
        None if diagonals is None else polygons.diagonals,
        interpolation,
    )


def focal_length(lines: int, elements: int, field_of_view: float) -> float:
    """The focal length in pixels of a raster and a field of view in degrees.

    The field of view is the vertical one of a raster of 4:3 or wider. A narrower raster sees as far to the
    left and to the right as a raster of 4:3 (see `View.half_height`).

    The ray through the center of pixel (line, element) is ((element + 1/2 - elements / 2) / focal length,
    (line + 1/2 - lines / 2) / focal length, 1) in camera space.
    """
    return min(lines, elements * 480 / 640) / 2 / math.tan(math.radians(field_of_view) / 2)


class OnRaster(NamedTuple):
    """The places of nodes on a raster: the arrays of `Projection`, each (nodes,)."""

    x: Floats
    y: Floats
    inverse_depth: Floats
    first_line: Indices


def on_raster(positions: Floats, near: float, raster: Raster) -> OnRaster:
    """The places of nodes on the raster; nodes nearer than the near plane are put on the near plane.

    `positions`, (3, nodes), are in camera space.
    """
    count = positions.shape[1]
    x, y, inverse_depth = np.empty(count), np.empty(count), np.empty(count)
    first_line = np.empty(count, np.intp)
    for chunk in chunks(count, NODES_AT_ONCE):
        right, down, depth = positions[:, chunk]
        np.divide(1.0, np.maximum(depth, near), out=inverse_depth[chunk])
        scale = raster.focal_length * inverse_depth[chunk]
        np.add(right * scale, raster.elements / 2, out=x[chunk])
        np.add(down * scale, raster.lines / 2, out=y[chunk])
        first_line[chunk] = np.clip(np.ceil(y[chunk] - 0.5), 0, raster.lines)
    return OnRaster(x, y, inverse_depth, first_line)


def left_center(x: Floats) -> Floats:
    """The first element whose center may be at x or right of it, if a crossing is rounded to the left."""
    return np.ceil(x - (0.5 + ROUNDING))


def right_center(x: Floats) -> Floats:
    """The first element whose center is right of x, if a crossing is rounded to the right."""
    return np.ceil(x - (0.5 - ROUNDING))


class PolygonsOnRaster(NamedTuple):
    """Polygons that may be visible: as in `Projection`. A quad that `splits` must still be split."""

    corners: Indices
    corner_normals: Indices
    polygon_numbers: Indices
    from_behind: Booleans
    line_counts: Indices
    diagonals: Bytes
    splits: Booleans

    def some(self, columns: Indices) -> PolygonsOnRaster:
        """Some of the polygons, copied."""
        tables: list[AnyArray] = [np.take(table, columns, axis=-1) for table in self]
        return PolygonsOnRaster(*tables)


def _polygons_on_raster(
    camera: CameraPolygons, nodes: OnRaster, raster: Raster, diagonals: Diagonals | None
) -> PolygonsOnRaster:
    """The polygons that may be visible, without quads that some line crosses four times.

    With `diagonals`, there are no warped quads either.
    """
    parts = [
        _cover_pixels(camera, nodes, raster, diagonals, chunk)
        for chunk in chunks(max(camera.corners.shape[1], 1), POLYGONS_AT_ONCE)
    ]
    polygons = PolygonsOnRaster(*(np.concatenate(tables, axis=-1) for tables in zip(*parts, strict=True)))
    quads = np.flatnonzero(polygons.splits)
    if not len(quads):
        return polygons
    if diagonals is not None:
        return _cut_at_diagonals(polygons, quads, nodes)
    corners, corner_normals, parents = split_quads(
        quads, nodes.x, nodes.y, camera.positions, polygons.corners, polygons.corner_normals
    )
    lines = nodes.first_line[corners]
    return polygons.some(parents)._replace(
        corners=corners,
        corner_normals=corner_normals,
        line_counts=most_of_four(lines) - least_of_four(lines),
    )


def _cut_at_diagonals(polygons: PolygonsOnRaster, quads: Indices, nodes: OnRaster) -> PolygonsOnRaster:
    """The polygons with some quads cut along their diagonals. The triangles take the place of their quad."""
    parents = np.repeat(np.arange(len(polygons.splits)), 1 + polygons.splits)
    cut = polygons.some(parents)
    first = quads + np.arange(len(quads))
    start = polygons.diagonals[quads]
    for half, places in enumerate((first, first + 1)):
        picked = (start + np.array([[0], [1], [2], [2]]) + 2 * half) & 3
        corners = polygons.corners[picked, quads]
        cut.corners[:, places] = corners
        cut.corner_normals[:, places] = polygons.corner_normals[picked, quads]
        lines = nodes.first_line.take(corners)
        cut.line_counts[places] = most_of_four(lines) - least_of_four(lines)
        # Each triangle has a side of its own.
        cut.from_behind[places] = _are_from_behind(nodes.x.take(corners), nodes.y.take(corners))
    cut.diagonals[cut.splits] = NO_DIAGONAL
    # A triangle may lie between two lines.
    return cut.some(np.flatnonzero(cut.line_counts))


def _cover_pixels(
    camera: CameraPolygons, nodes: OnRaster, raster: Raster, diagonals: Diagonals | None, chunk: slice
) -> PolygonsOnRaster:
    """The polygons of a chunk that cross a line and may cover the center of a pixel."""
    corners = camera.corners[:, chunk]
    lines, x = nodes.first_line.take(corners), nodes.x.take(corners)
    line_counts = most_of_four(lines) - least_of_four(lines)
    # A crossing may be rounded to a little outside its edge.
    left, end = left_center(least_of_four(x)), right_center(most_of_four(x))
    columns = np.flatnonzero((line_counts > 0) & (left < end) & (end > 0) & (left < raster.elements))

    corners, x = np.take(corners, columns, axis=1), np.take(x, columns, axis=1)
    fall = np.diff(np.take(lines, columns, axis=1), axis=0)
    polygon_numbers = camera.polygon_numbers[chunk].take(columns)
    # The lines fall, rise and fall again, or the other way round, all around the quad.
    splits = (fall[0] * fall[1] < 0) & (fall[1] * fall[2] < 0) & ((fall[0] + fall[1] + fall[2]) * fall[2] > 0)
    starts = np.full(len(columns), NO_DIAGONAL, np.uint8)
    if diagonals is not None:
        starts, warps = diagonals.some(polygon_numbers)
        if camera.is_cut is not None:
            # The pieces of cut triangles are flat.
            pieces = np.flatnonzero(camera.is_cut[chunk].take(columns))
            is_triangle = corners[2, pieces] == corners[3, pieces]
            starts[pieces], warps[pieces] = np.where(is_triangle, NO_DIAGONAL, 0), 0
        # Find the quads whose warp may be seen, first by the nearest corner of all.
        most = MOST_WARP * camera.unit / raster.focal_length
        rows = np.flatnonzero(warps > most * max(camera.nearest, camera.near))
        nearest = most_of_four(nodes.inverse_depth.take(np.take(corners, rows, axis=1)))
        splits[rows[warps.take(rows) * nearest > most]] = True
    return PolygonsOnRaster(
        corners,
        np.take(camera.corner_normals[:, chunk], columns, axis=1),
        polygon_numbers,
        _are_from_behind(x, nodes.y.take(corners)),
        line_counts.take(columns),
        starts,
        splits,
    )


def _are_from_behind(x: Floats, y: Floats) -> Booleans:
    """Whether the eye sees the backs of polygons with corners at x, y on the raster, (4, polygons) each.

    The front runs counterclockwise, which is clockwise on the raster: y grows downward.
    """
    behind: Booleans = (x[2] - x[0]) * (y[3] - y[1]) - (x[3] - x[1]) * (y[2] - y[0]) > 0
    return behind


def split_quads(
    quads: Indices, x: Floats, y: Floats, positions: Floats, corners: Indices, corner_normals: Indices
) -> tuple[Indices, Indices, Indices]:
    """The corners and normals of polygons with some quads split in two triangles, and the former columns.

    A quad is split along the diagonal that divides its other two corners, so that a dart is split at its
    notch; if both diagonals do or neither does, along the shorter one in camera space. Nothing depends on the
    corner that is written first. The triangles take the place of their quad.
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
    # Put the triangle first whose own corner is lexicographically lower.
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
    """Whether columns of `one`, (rows, n), come before those of `other` in lexicographic order."""
    before = np.zeros(one.shape[1], np.bool_)
    for row, other_row in zip(reversed(one), reversed(other), strict=True):
        before = (row < other_row) | ((row == other_row) & before)
    return before


def _planes_in_view(shared: SharedPlanes, view: View, unit: float, polygon_numbers: Indices) -> PlanesInView:
    """The shared planes in the camera space of a view, for these rows of the polygon table."""
    normals = rotated(view.axes, shared.normals)
    distances = (normals * rotated(view.axes / unit, shared.points, view.eye)).sum(axis=0)
    in_use = np.abs(distances) * LARGEST_PLANE_ERROR > np.maximum(shared.distances / unit, PLANE_ROUNDING)
    planes = shared.plane_of_polygon.take(polygon_numbers)
    planes[~np.append(in_use, False)[planes]] = -1
    return PlanesInView(normals, np.where(in_use, distances, np.inf), planes)


# Preselection. Of ten million polygons a picture shows a few hundred thousand; most others lie between two
# lines or between two pixel centers. So the nodes of a large mesh are first put on the raster in small whole
# numbers. Only the nodes of the polygons that may be visible are then put into camera space, to the same
# bits.
#
# Measured: ten million quads take 209 MB beyond their tables instead of 868, and 0.69 of the time.


class NodePlaces(NamedTuple):
    """The places of the nodes of a mesh among the lines and the pixel centers; every array is (nodes,).

    A polygon crosses a line if its corners differ in `line`. It may cover a pixel center if the least `left`
    is below the most `right`. `before` tells which nodes are nearer than the near plane; None if all lie
    beyond. `nearest` is the least depth.
    """

    line: RasterPlaces
    left: RasterPlaces
    right: RasterPlaces
    before: Booleans | None
    nearest: float


def preselected(mesh: Mesh, view: View, raster: Raster) -> CameraPolygons:
    """The polygons of a mesh that may be visible or cross the near plane, in camera space.

    Their nodes and normals are renumbered in the order of the mesh. No other polygon can be visible.
    """
    unit, near = unit_and_near(mesh, view)
    places = _node_places(mesh, view, raster, unit, near)
    if places.nearest < near:
        near = near_of(near, _nearest_corner(mesh, view, unit, near))
        places = _node_places(mesh, view, raster, unit, near)
    parts = [
        _may_be_visible(places, mesh.node_numbers.T[:, chunk]) + chunk.start
        for chunk in chunks(len(mesh.node_numbers), POLYGONS_AT_ONCE)
    ]
    polygons, nearest = np.concatenate([np.empty(0, np.intp), *parts]), places.nearest
    # Give the memory of the places back before more is needed.
    del places, parts
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
    """The places of the nodes, computed in chunks."""
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
    has_line = least_of_four(line) < most_of_four(line)
    crossing: Booleans | None = None
    if places.before is not None:
        before = places.before.take(corners)
        some = before[0] | before[1] | before[2] | before[3]
        crossing = some & ~(before[0] & before[1] & before[2] & before[3])
        has_line &= ~some
    columns = np.flatnonzero(has_line)
    corners = np.take(corners, columns, axis=1)
    columns = columns[least_of_four(places.left.take(corners)) < most_of_four(places.right.take(corners))]
    return columns if crossing is None else np.sort(np.append(columns, np.flatnonzero(crossing)))


def _renumbered(numbers: Indices, count: int) -> tuple[Indices, Indices]:
    """The rows, of `count`, that some numbers use, ascending, and the numbers counted among these rows."""
    used = used_rows(numbers, count)
    places = np.cumsum(used, dtype=np.int32 if count < 1 << 31 else np.int64)
    renumbered = places.take(numbers).astype(np.intp)
    renumbered -= 1
    return np.flatnonzero(used), renumbered
