"""The lines of the object in the views of the light and view screen, computed once for a mesh.

All edges are drawn at once. Hidden edges are left out later, when there is time: finding them takes longer
than a page should. A stage, such as a floor, is drawn by its features alone.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final, NamedTuple

import numpy as np

from autocolor.arrays import Booleans, Floats, Indices, Singles, chunks, dot
from autocolor.immutable import Immutable, read_only
from autocolor.scene.defaults import framed
from autocolor.scene.geometry.normals import edge_keys, places_of_corners, polygon_normals
from autocolor.scene.mesh import Mesh
from autocolor.scene.scene import Scene
from autocolor.scene.surfaces import Part
from autocolor.scene.view import View
from autocolor.screens.cached import Cached
from autocolor.screens.light_and_view.orthographic_views import SIDES, OrthographicViews, ViewSide
from autocolor.visibility.camera import NEAR, rotated
from autocolor.visibility.projection import focal_length
from autocolor.visibility.visible_points import POINT, VisiblePoints
from autocolor.visibility.visible_surfaces import visible_surfaces
from autocolor.widgets.items import Area, between, clipped, drawn

# Leaving out hidden edges, by the depths of the visible points of a picture.
#
# Three points of an edge are compared with the farthest visible point at the pixels around them. Assumed: an
# edge is drawn as a whole or not at all.

FAR_FIELD: Final = 0.5
"""Assumed: degrees of view of an eye so far away that it sees the object as an orthographic view shows it."""

FINER: Final = 2
"""Assumed: pixels to an element of a view in the raster that finds its visible points."""

DEPTH: Final = POINT.start + 2
"""The row of the visible points' depths."""

TESTED: Final = (0.2, 0.5, 0.8)
"""Assumed: fractions of an edge at which its points are tested. Two of three points must be visible."""

BEHIND: Final = 4e-3
"""Assumed: how far behind a visible point another point still counts as visible, in radii of the object.

Looked at on two cars: a fourth of this and four times as much draw nearly the same edges.
"""


@dataclass(frozen=True, eq=False, repr=False)
class VisibleDepths(Immutable):
    """The depths of a picture's visible points: at each pixel, the farthest of the nine pixels around it.

    `farthest` is (lines, elements) float32, relative to `origin` in camera space and in `unit`; it is
    infinite at and beside the background. A point at most `behind` farther away counts as visible.
    """

    view: View
    unit: float
    origin: float
    behind: float
    farthest: Singles


def visible_depths(visible: VisiblePoints) -> VisibleDepths:
    """The depths of the visible points of a picture."""
    depths = np.full((visible.lines + 2, visible.elements + 2), np.inf, np.float32)
    inner = np.full(visible.lines * visible.elements, np.inf, np.float32)
    inner[visible.pixels] = visible.rows[DEPTH]
    depths[1:-1, 1:-1] = inner.reshape(visible.lines, visible.elements)
    across = np.maximum(np.maximum(depths[:, :-2], depths[:, 1:-1]), depths[:, 2:])
    farthest = np.maximum(np.maximum(across[:-2], across[1:-1]), across[2:])
    return VisibleDepths(
        visible.view,
        visible.unit,
        float(visible.origin[2]),
        BEHIND * visible.radius,
        read_only(farthest),
    )


def depths_toward(
    mesh: Mesh, side: ViewSide, part_numbers: Sequence[int] | None = None
) -> VisibleDepths | None:
    """The depths of the visible points in one of the three views; None without polygons.

    The object fills the picture of an eye far away. `part_numbers` leaves out all other parts, so that a
    stage hides nothing.
    """
    alone = mesh
    if part_numbers is not None:
        chosen = np.isin(mesh.part_numbers, list(part_numbers))
        if not chosen.all():
            alone = Mesh(
                mesh.coordinates, mesh.node_numbers[chosen], mesh.part_numbers[chosen], mesh.part_names
            )
    if not len(alone.node_numbers):
        return None
    width, height = FINER * side.area.width, FINER * side.area.height
    x, y, z = side.toward
    far = View(side.toward, direction=(-x, -y, -z), field_of_view=FAR_FIELD)
    view = framed(far, alone.used_coordinates, width / height)
    return visible_depths(visible_surfaces(alone, view, (1,) * len(mesh.part_names), height, width))


def without_hidden(edges: Indices, coordinates: Floats, depths: VisibleDepths) -> Indices:
    """The edges that are not hidden. `edges` is (n, 2) nodes, `coordinates` (nodes, 3)."""
    starts, ends = (np.take(coordinates.T, nodes, axis=1) for nodes in edges.T)
    visible = [_are_visible(starts + at * (ends - starts), depths) for at in TESTED]
    visible_edges: Indices = edges[np.sum(visible, axis=0) >= 2]
    return visible_edges


def _are_visible(points: Floats, depths: VisibleDepths) -> Booleans:
    """Whether points, (3, n), are visible; a point outside of the picture counts as visible."""
    lines, elements = depths.farthest.shape
    x, y, depth = rotated(depths.view.axes / depths.unit, points, depths.view.eye)
    before = depth > 0
    scale = focal_length(lines, elements, depths.view.field_of_view) / np.where(before, depth, 1.0)
    element, line = np.floor(x * scale + elements / 2), np.floor(y * scale + lines / 2)
    inside = before & (element >= 0) & (element < elements) & (line >= 0) & (line < lines)
    visible = np.ones(len(depth), np.bool_)
    rows = np.flatnonzero(inside)
    farthest = depths.farthest[line[rows].astype(np.intp), element[rows].astype(np.intp)]
    visible[rows] = depth[rows] - depths.origin <= farthest + depths.behind
    return visible


# The edges of a mesh: features, which every view shows, and smooth edges, which may be a silhouette.
#
# They are computed once for a mesh. Nodes at the same place count as one node, so that parts which repeat
# their nodes still meet. An edge is a pair of node numbers of its first polygon.

DRAWN_CREASE: Final = 30.0
"""Assumed: degrees; a larger angle between polygons is drawn as a crease.

Looked at on two cars in an area of 248 x 224: with 40 degrees, the crease angle of normals, the windows of a
car of one part are in pieces, and with 60 gone. A cylinder of 12 sides has no lines along it.
"""

POLYGONS_AT_ONCE: Final = 1 << 13

MOST_FEATURES: Final = 1 << 15
"""Assumed: a mesh with more features, such as a noisy scan, is drawn by its longest features alone."""


@dataclass(frozen=True, eq=False, repr=False)
class MeshEdges(Immutable):
    """The edges of some polygons of a mesh, and the planes of these polygons.

    `coordinates`, (nodes, 3), is the mesh's, and polygons are rows of its polygon table. `features`,
    (features, 2) intp, has the nodes of open edges, of creases and of edges between parts; `smooth`,
    (edges, 2), has the nodes of all other edges. `polygons`, (2, edges), are the two polygons at a smooth
    edge. `same_direction`, (edges,), is whether both run along the edge in the same direction, and so have
    opposite winding. A point is in the plane of a polygon if its dot product with the normal, (3, polygons),
    is the offset, (polygons,).
    """

    coordinates: Floats
    features: Indices
    smooth: Indices
    polygons: Indices
    same_direction: Booleans
    normals: Floats
    offsets: Floats


class _Sides(NamedTuple):
    """The sides of polygons, sorted so that all sides of an edge follow each other.

    Corner c of polygon p is c * polygons + p. `corners` and `forward` are (sides,): the corner that a side
    begins at, and whether it runs to a higher place. `starts` and `counts` are (edges,): the first side of
    each edge, and how many it has.
    """

    corners: Indices
    forward: Booleans
    starts: Indices
    counts: Indices


def mesh_edges(
    mesh: Mesh, part_numbers: Sequence[int] | None = None, crease_angle: float = DRAWN_CREASE
) -> MeshEdges:
    """The edges of the polygons of some parts of the mesh, or of all parts.

    An edge where polygons meet at more than `crease_angle`, 0 to 90 degrees, is a crease. The winding
    of polygons does not matter. An edge of more than two polygons is smooth if they lie in two planes that
    continue each other, as in a sheet with two polygons at every place, one for each face. Polygons without
    area have no edges.
    """
    parts, coordinate_rows, node_rows = mesh.part_numbers, mesh.coordinates.T, mesh.node_numbers.T
    normals = np.empty((3, node_rows.shape[1]))
    for chunk in chunks(node_rows.shape[1], POLYGONS_AT_ONCE):
        normals[:, chunk] = polygon_normals(np.take(coordinate_rows, node_rows[:, chunk], axis=1))
    has_edges = (normals != 0).any(axis=0)
    if part_numbers is not None:
        has_edges &= np.isin(parts, list(part_numbers))
    sides = _sides(places_of_corners(coordinate_rows, node_rows), has_edges)
    polygons = sides.corners % max(len(parts), 1)
    first = np.repeat(sides.starts, sides.counts)

    # Compare each polygon of an edge with the edge's first polygon: the cosine is 1 where it folds back onto
    # the first, and -1 where it continues the first, whatever their winding.
    cosines = dot(np.take(normals, polygons.take(first), axis=1), np.take(normals, polygons, axis=1))
    np.negative(cosines, out=cosines, where=sides.forward != sides.forward.take(first))
    least_cosine = np.cos(np.radians(crease_angle)) - 1e-9
    continues, folds = cosines <= -least_cosine, cosines >= least_cosine
    same_part = parts.take(polygons) == parts.take(polygons.take(first))
    if len(first):
        smooth = np.logical_and.reduceat((continues | folds) & same_part, sides.starts)
        smooth &= np.logical_or.reduceat(continues, sides.starts)
    else:
        smooth = np.zeros(0, np.bool_)

    # Take the first polygon of each smooth edge, and a polygon that continues it.
    edge = np.repeat(np.arange(len(sides.starts)), sides.counts)
    other = sides.starts.copy()
    other[edge[continues]] = np.flatnonzero(continues)
    pairs = np.stack([sides.starts[smooth], other[smooth]])
    corners = sides.corners.take(sides.starts)
    nodes = np.stack([node_rows.ravel()[corners], np.roll(node_rows, -1, axis=0).ravel()[corners]], axis=1)
    tables = (
        _longest(nodes[~smooth], mesh.coordinates),
        nodes[smooth],
        polygons[pairs],
        np.equal(*sides.forward[pairs]),
        normals,
        dot(normals, np.take(coordinate_rows, node_rows[0], axis=1)),
    )
    return MeshEdges(mesh.coordinates, *map(read_only, tables))


def _sides(places: Indices, has_edges: Booleans) -> _Sides:
    """The sides of some polygons; `places` is (4, polygons)."""
    ends = np.roll(places, -1, axis=0)
    corners = np.flatnonzero((places != ends) & has_edges)
    start, end = places.ravel()[corners], ends.ravel()[corners]
    keys = edge_keys(start, end, int(places.max(initial=0)) + 1)
    order = np.argsort(keys, kind="stable")
    starts = np.flatnonzero(np.diff(keys[order], prepend=-1))
    return _Sides(corners[order], (start < end)[order], starts, np.diff(starts, append=len(corners)))


def _longest(edges: Indices, coordinates: Floats) -> Indices:
    """The longest edges of (n, 2), at most MOST_FEATURES, in their order."""
    if len(edges) <= MOST_FEATURES:
        return edges
    steps = np.abs(coordinates[edges[:, 0]] - coordinates[edges[:, 1]]).max(axis=1)
    return edges[np.sort(np.argsort(-steps, kind="stable")[:MOST_FEATURES])]


# The strokes of DISPLAY VIEW: the edges of the mesh as the eye sees them, small, in an area.
#
# Paper: Figure 5, "A small mesh image of the current view can be generated by selecting DISPLAY VIEW".


def perspective_strokes(coordinates: Floats, edges: Indices, view: View, area: Area) -> Floats:
    """The strokes of edges in the picture of a view that fills an area, (strokes, 4).

    `coordinates` is (nodes, 3), `edges` (n, 2) the nodes that each edge joins. The picture has the lines and
    elements of the area. Edges are clipped at a near plane first, NEAR as a fraction of the depth of the
    farthest node, and their strokes by the area.
    """
    camera = rotated(view.axes, coordinates.T, view.eye)
    starts, ends = np.take(camera, edges[:, 0], axis=1), np.take(camera, edges[:, 1], axis=1)
    farthest = float(max(starts[2].max(initial=0.0), ends[2].max(initial=0.0)))
    near = NEAR * farthest or 1.0
    starts, ends = _beyond(near, starts, ends)
    focal = focal_length(area.height, area.width, view.field_of_view)
    middle = np.array(area.middle)
    return clipped(between(*(middle + (focal * points[:2] / points[2]).T for points in (starts, ends))), area)


def _beyond(near: float, starts: Floats, ends: Floats) -> tuple[Floats, Floats]:
    """The parts beyond the near plane of lines from starts to ends, (3, n) in camera space."""
    before = np.flatnonzero((starts[2] >= near) | (ends[2] >= near))
    starts, ends = starts[:, before], ends[:, before]
    step = ends - starts
    divisor = np.where(step[2] == 0, 1.0, step[2])
    crossings = starts + (near - starts[2]) / divisor * step
    crossings[2] = near
    return np.where(starts[2] < near, crossings, starts), np.where(ends[2] < near, crossings, ends)


# Silhouettes: the smooth edges of a mesh between a polygon that faces the viewer and a polygon that does not.
#
# The viewer is far away in a direction, as in the three views, or an eye.

EDGE_ON: Final = 1e-9
"""Assumed: a polygon seen under a smaller sine than this is edge-on, and does not face the viewer.

Otherwise rounding would decide about the sides of a cylinder seen along its axis.
"""


def silhouette_toward(edges: MeshEdges, toward: Sequence[float]) -> Indices:
    """The nodes of the silhouette for a viewer far away, (n, 2); `toward` is the unit vector to it."""
    return _between(edges, _heights(edges.normals, toward) > EDGE_ON)


def silhouette_from(edges: MeshEdges, eye: Sequence[float]) -> Indices:
    """The nodes of the silhouette that an eye at a point sees, (n, 2)."""
    return _between(edges, _heights(edges.normals, eye) > edges.offsets)


def _heights(normals: Floats, vector: Sequence[float]) -> Floats:
    """The dot product of each normal, (3, n), with a vector."""
    x, y, z = vector
    heights: Floats = normals[0] * x
    heights += normals[1] * y
    heights += normals[2] * z
    return heights


def _between(edges: MeshEdges, facing: Booleans) -> Indices:
    """The smooth edges between a polygon that faces the viewer and a polygon that does not.

    If two polygons have opposite winding, the front of one continues the back of the other: a silhouette
    passes between them if both face the viewer, or neither does.
    """
    one, other = edges.polygons
    differs = facing.take(one) ^ facing.take(other)
    differs ^= edges.same_direction
    return np.take(edges.smooth, np.flatnonzero(differs), axis=0)


class ObjectStrokes(NamedTuple):
    """The strokes of an object in a view from pixel to pixel, each (n, 4).

    `stage` are the features of the stage's parts; features and silhouette are the object's own.
    """

    stage: Floats
    features: Floats
    silhouette: Floats


class _MeshLines(NamedTuple):
    """The edges of a mesh with its parts; `of_side` has the features and the silhouette in each view."""

    mesh: Mesh
    parts: tuple[Part, ...]
    object_numbers: list[int]
    edges: MeshEdges
    stage: Indices
    of_side: dict[str, tuple[Indices, Indices]]
    is_without_hidden: set[str]


class ObjectLines:
    """The lines of the object of a scene, computed once for a mesh."""

    def __init__(self) -> None:
        self._mesh_lines: _MeshLines | None = None
        self._strokes: dict[str, Cached[ObjectStrokes]] = {side.name: Cached() for side in SIDES}

    def of_side(self, scene: Scene, views: OrthographicViews, side: ViewSide) -> ObjectStrokes:
        """The lines in one of the three views, the same as before if nothing changed."""
        lines, coordinates = self._of(scene), scene.mesh.coordinates
        edges = lines.of_side[side.name]

        def strokes() -> ObjectStrokes:
            return _drawn(*(views.strokes(side, coordinates, each) for each in (lines.stage, *edges)))

        return self._strokes[side.name].of(strokes, edges, views)

    def leave_out_hidden(self, scene: Scene) -> bool:
        """Leave out the hidden edges of the next view; returns False if all views are done."""
        lines = self._of(scene)
        left = [side for side in SIDES if side.name not in lines.is_without_hidden]
        if not left:
            return False
        side, coordinates = left[0], scene.mesh.coordinates
        lines.is_without_hidden.add(side.name)
        depths = depths_toward(scene.mesh, side, lines.object_numbers)
        if depths is not None:
            features, silhouette = lines.of_side[side.name]
            lines.of_side[side.name] = (
                without_hidden(features, coordinates, depths),
                without_hidden(silhouette, coordinates, depths),
            )
        return True

    def of_eye(self, scene: Scene, area: Area, visible: VisibleDepths | None = None) -> ObjectStrokes:
        """The lines as the eye sees them, in an area of the shape of the picture.

        Given the visible depths of the picture, hidden lines are left out.
        """
        lines = self._of(scene)
        coordinates, view = scene.mesh.coordinates, scene.view
        edges = [lines.stage, lines.edges.features, silhouette_from(lines.edges, view.eye)]
        if visible is not None:
            edges = [without_hidden(each, coordinates, visible) for each in edges]
        return _drawn(*(perspective_strokes(coordinates, each, view, area) for each in edges))

    def _of(self, scene: Scene) -> _MeshLines:
        lines = self._mesh_lines
        if lines is None or lines.mesh is not scene.mesh or lines.parts != scene.parts:
            used = list(scene.mesh.parts_in_use)
            numbers = [number for number in used if not scene.parts[number].stage] or used
            stage = [number for number in used if number not in numbers]
            edges = mesh_edges(scene.mesh, numbers)
            outline = mesh_edges(scene.mesh, stage).features if stage else np.empty((0, 2), np.intp)
            of_side = {side.name: (edges.features, silhouette_toward(edges, side.toward)) for side in SIDES}
            lines = _MeshLines(scene.mesh, scene.parts, numbers, edges, outline, of_side, set())
            self._mesh_lines = lines
        return lines


def _drawn(*strokes: Floats) -> ObjectStrokes:
    return ObjectStrokes(*(drawn(each).astype(np.float64) for each in strokes))
