"""The lines of the object on the light and view screen: outlines, borders of parts and creases.

A depth picture has the depth and the part that are seen at each pixel of a view. An outline is where the
depth jumps from a pixel to the next, and a border is where the part changes. Creases are edges of the mesh;
the depths tell their visible pixels. So no line that the object hides is drawn.

The method is that of Saito and Takahashi, "Comprehensible Rendering of 3-D Shapes", SIGGRAPH 1990.
"""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np

from autocolor.arrays import AnyArray, Booleans, Floats, Indices, Words, chunks, dot, runs
from autocolor.immutable import read_only
from autocolor.scene.geometry.normals import (
    POLYGONS_AT_ONCE,
    corners_at_shared_edges,
    places_of_corners,
    polygon_normals,
)
from autocolor.scene.mesh import Mesh
from autocolor.scene.scene import Scene
from autocolor.scene.view import View
from autocolor.screens.cached import Cached
from autocolor.screens.light_and_view.orthographic_views import SIDES, OrthographicViews, ViewSide
from autocolor.visibility.camera import rotated
from autocolor.visibility.depth import depth_scale, polygons_of_numbers
from autocolor.visibility.projection import focal_length, projection
from autocolor.visibility.visible_points import VisiblePoints
from autocolor.visibility.visible_surfaces import depth_test
from autocolor.widgets.items import GRAY, HEIGHT, LIGHT_GRAY, NIGHT, SLATE, WIDTH, Area

NO_PART: Final = -1
STAGE: Final = -2
"""The numbers at pixels that see nothing, and that see any part of the stage."""


class DepthPicture(NamedTuple):
    """What is seen at each pixel of a view.

    `depths`, (lines, elements), are distances along the view direction, in units; infinite where nothing is
    seen. `parts`, (lines, elements) intp, are the part numbers there, STAGE or NO_PART.
    """

    view: View
    depths: Floats
    parts: Indices


# Depth pictures, by the scan lines and the depth test of the renderer.

FAR_FIELD: Final = 0.01
"""Assumed: degrees of view of an eye so far away that it sees the object as an orthographic view shows it.

Of an object that fills its view, no point is a fiftieth of a pixel off.
"""


def view_of_side(side: ViewSide, views: OrthographicViews) -> View:
    """The view of an eye far away, whose picture of the size of the area shows one of the three views."""
    distance = focal_length(side.area.height, side.area.width, FAR_FIELD) / views.scale
    toward = np.array(side.toward)
    x, y, z = (views.center + distance * toward).tolist()
    back, left, down = (0.0 - toward).tolist()
    return View((x, y, z), direction=(back, left, down), field_of_view=FAR_FIELD)


def depth_picture(mesh: Mesh, view: View, lines: int, elements: int, numbers: Indices) -> DepthPicture:
    """The depth picture of a mesh in a view. The stage is seen only where the object is not.

    `numbers`, (parts,), are the numbers of the parts, or STAGE.
    """
    projected = projection(mesh, view, lines, elements)
    scale = depth_scale(projected)
    of_polygons = numbers.take(mesh.part_numbers.take(projected.polygon_numbers))
    keys, stage = np.zeros((2, lines * elements), np.int64)
    depth_test(keys, projected, scale, np.flatnonzero(of_polygons != STAGE))
    depth_test(stage, projected, scale, np.flatnonzero(of_polygons == STAGE))
    keys = np.where(keys > 0, keys, stage)
    seen = np.flatnonzero(keys)
    depths, parts = np.full(len(keys), np.inf), np.full(len(keys), NO_PART)
    depths[seen] = scale.factor * projected.unit / (keys[seen] // scale.number_limit)
    parts[seen] = of_polygons.take(polygons_of_numbers(projected, keys[seen] & (scale.number_limit - 1)))
    return DepthPicture(view, depths.reshape(lines, elements), parts.reshape(lines, elements))


def sampled(table: AnyArray, lines: int, elements: int) -> AnyArray:
    """A raster of another size: each value is that at the middle of its place."""
    rows, columns = (
        (2 * np.arange(size) + 1) * count // (2 * size)
        for size, count in zip((lines, elements), table.shape, strict=True)
    )
    # Twice `take` costs a seventh of indexing by both.
    small: AnyArray = table.take(rows, axis=0).take(columns, axis=1)
    return small


# Outlines and borders: pairs of neighboring pixels, and the pixel of each pair that is drawn. If it is always
# on the same side of a line, the line is one pixel wide and has no gaps.

JUMP: Final = 1.0
"""Assumed: a depth jumps by more than so many pixels, and so many slopes, beyond the steps beside it."""


def outlines_and_borders(picture: DepthPicture) -> tuple[Booleans, Booleans]:
    """The pixels of outlines, nearer than their neighbors, and those of borders between parts.

    Both are (lines, elements).
    """
    is_seen = picture.parts != NO_PART
    # The size of a pixel is the depth over the focal length.
    lines, elements = is_seen.shape
    focal = focal_length(lines, elements, picture.view.field_of_view)
    depths = picture.depths * (focal / picture.depths.min() if is_seen.any() else 1.0)
    # The stage lies behind the object, and has no lines but its outline.
    depths = np.where(picture.parts == STAGE, 2 * depths.max(where=is_seen, initial=0.0), depths)
    outlines, borders = np.zeros((2, *depths.shape), np.bool_)
    for turned in (np.asarray, np.transpose):
        rows, parts = np.ascontiguousarray(turned(depths)), np.ascontiguousarray(turned(picture.parts))
        jumps = _jumps(rows)
        differs = (parts[:, :-1] != parts[:, 1:]) & ~jumps
        for pixels, pairs, is_first in (
            (turned(outlines), jumps, rows[:, :-1] < rows[:, 1:]),
            (turned(borders), differs, parts[:, :-1] > parts[:, 1:]),
        ):
            pixels[:, :-1] |= pairs & is_first
            pixels[:, 1:] |= pairs & ~is_first
    return outlines, borders


def _jumps(depths: Floats) -> Booleans:
    """Whether the depth jumps from each pixel of a row to the next; `depths`, (rows, n), are in pixels.

    A step is no jump if the step before it or after it is about as large: the surface is only steep there.
    """
    with np.errstate(invalid="ignore"):
        steps = np.diff(depths, axis=1)
        around = np.pad(steps, ((0, 0), (1, 1)), constant_values=np.inf)
        before, after = around[:, :-2], around[:, 2:]
        slope = np.fmin(np.abs(before), np.abs(after))
        unexplained = np.fmin(np.abs(steps - before), np.abs(steps - after))
        jumps: Booleans = np.isinf(steps) | (unexplained > JUMP * (1 + slope))
    return jumps


# Creases: edges of the mesh, drawn at the pixels where the depth picture sees them.

DRAWN_CREASE: Final = 30.0
"""Assumed: degrees; a larger angle between polygons of a part is drawn as a crease.

Looked at on two cars in an area of 248 x 224: with 40 degrees, the crease angle of normals, the windows of a
car of one part are in pieces, and with 60 gone. A cylinder of 12 sides has no lines along it.
"""

BEHIND: Final = 0.5
"""Assumed: how far behind the farthest of nine neighboring pixels an edge still counts as seen, in pixels."""


def crease_edges(mesh: Mesh, numbers: Indices) -> Indices:
    """The two nodes of each crease of the object, (2, creases). The winding of polygons does not matter.

    `numbers` are as in `depth_picture`.
    """
    coordinate_rows, node_rows = mesh.coordinates.T, mesh.node_numbers.T
    normals = np.empty((3, node_rows.shape[1]))
    for chunk in chunks(node_rows.shape[1], POLYGONS_AT_ONCE):
        normals[:, chunk] = polygon_normals(np.take(coordinate_rows, node_rows[:, chunk], axis=1))
    # Polygons without area have no creases.
    are_drawn = (normals != 0).any(axis=0) & (numbers[mesh.part_numbers] != STAGE)
    least = np.cos(np.radians(DRAWN_CREASE)) - 1e-9
    places = places_of_corners(coordinate_rows, node_rows)
    creases = [np.empty((2, 0), np.intp)]
    for one, other in corners_at_shared_edges(places, mesh.part_numbers):
        cosines = dot(np.take(normals, one >> 2, axis=1), np.take(normals, other >> 2, axis=1))
        corners = one[(np.abs(cosines) < least) & are_drawn[one >> 2] & are_drawn[other >> 2]]
        polygons = corners >> 2
        creases.append(np.stack([node_rows[corners & 3, polygons], node_rows[(corners + 1) & 3, polygons]]))
    return np.concatenate(creases, axis=1)


def crease_pixels(picture: DepthPicture, coordinates: Floats, creases: Indices) -> Booleans:
    """The pixels at which a depth picture sees creases, (lines, elements); `coordinates` are (nodes, 3)."""
    view, depths, (lines, elements) = picture.view, picture.depths, picture.depths.shape
    size = np.array([[elements], [lines]])
    focal = focal_length(lines, elements, view.field_of_view)
    ends = [rotated(view.axes, np.take(coordinates.T, nodes, axis=1), view.eye) for nodes in creases]
    # Leave out the creases that pass the eye.
    before_eye = (ends[0][2] > 0) & (ends[1][2] > 0)
    # Screen x and y, and inverse depth, change along a crease in proportion to each other.
    start, end = (
        np.concatenate([each[:2] * (focal / each[2]) + size / 2, 1 / each[2:]])
        for each in (np.compress(before_eye, each, axis=1) for each in ends)
    )
    step = end - start
    # Find the shares of each crease at which it enters and leaves the picture.
    with np.errstate(divide="ignore", invalid="ignore"):
        borders = -start[:2] / step[:2], (size - start[:2]) / step[:2]
    enters = np.fmin(*borders).max(axis=0, initial=0.0)
    leaves = np.fmax(*borders).min(axis=0, initial=1.0)
    inside = enters < leaves
    start, step, enters, leaves = start[:, inside], step[:, inside], enters[inside], leaves[inside]

    # Place points along each crease, at most a pixel apart, and compare their depths with the picture's.
    count = np.ceil(np.abs(step[:2]).max(axis=0, initial=0.0) * (leaves - enters)).astype(np.int64) + 1
    along = (runs(np.zeros_like(count), count) + 0.5) / np.repeat(count, count)
    along = np.repeat(enters, count) + along * np.repeat(leaves - enters, count)
    x, y, inverse_depth = np.repeat(start, count, axis=1) + along * np.repeat(step, count, axis=1)
    places = y.astype(np.intp).clip(0, size[1] - 1) * size[0] + x.astype(np.intp).clip(0, size[0] - 1)
    farthest = around(np.maximum, depths, -np.inf).ravel().take(places)
    pixels = np.zeros(depths.shape, np.bool_)
    pixels.put(places[1 / inverse_depth <= farthest * (1 + BEHIND / focal)], True)
    pixels &= picture.parts != NO_PART
    return pixels


def around(most: np.ufunc, table: AnyArray, beside: float) -> AnyArray:
    """The sum or the largest, say, of the nine pixels around each pixel. `beside` is past the edges."""
    padded = np.pad(table, 1, constant_values=beside)
    across = most(most(padded[:, :-2], padded[:, 1:-1]), padded[:, 2:])
    of_nine: AnyArray = most(most(across[:-2], across[1:-1]), across[2:])
    return of_nine


# The words of the lines.


def line_words(picture: DepthPicture, mesh: Mesh, creases: Indices) -> Words:
    """The words of all lines of a depth picture, (lines, elements), with NIGHT between them."""
    outlines, borders = outlines_and_borders(picture)
    features = (borders | crease_pixels(picture, mesh.coordinates, creases)) & ~outlines
    # Beside an outline, keep only the ends of lines that lead to it, and within the object no single pixels.
    apart = features & ~around(np.logical_or, outlines, False)
    features &= around(np.logical_or, apart, False)
    is_lone = around(np.add, (outlines | features).astype(np.uint8), 0) == 1
    is_lone &= around(np.maximum, picture.depths, 0.0) < np.inf
    features &= ~is_lone
    outlines &= ~is_lone
    words = np.full(outlines.shape, NIGHT, np.uint16)
    words[features], words[outlines] = GRAY, LIGHT_GRAY
    words[outlines & (picture.parts == STAGE)] = SLATE
    return words


def moved(words: Words, side: ViewSide, before: OrthographicViews, views: OrthographicViews) -> Words:
    """The words of a view moved to other views, whose lines are not found yet.

    Pixels are left out or repeated.
    """
    shifted = np.pad(words, (0, 1), constant_values=NIGHT)
    for direction, (count, axis, sign) in enumerate(
        zip(words.shape, (side.up, side.right), (-1, 1), strict=True)
    ):
        middle, shift = (count - 1) / 2, sign * (views.center[axis] - before.center[axis]) * before.scale
        place = (np.arange(count) - middle) * (before.scale / views.scale) + shift + middle
        # The pixels from beyond the area have the last place.
        shifted = shifted.take(np.rint(place.clip(-1, count)).astype(np.intp) % (count + 1), axis=direction)
    return shifted


class ObjectLines:
    """The lines of the object of a scene; what did not change is not computed again."""

    def __init__(self) -> None:
        self._object: Cached[tuple[Indices, Indices]] = Cached()
        self._found: dict[ViewSide, tuple[OrthographicViews, Words]] = {}
        self._page: Cached[Words] = Cached()

    def page(self, scene: Scene, views: OrthographicViews) -> Words:
        """The words of the whole screen, read-only, with the lines that are found so far."""
        self._object_of(scene)

        def page() -> Words:
            words = np.full((HEIGHT, WIDTH), NIGHT, np.uint16)
            for side, (before, lines) in self._found.items():
                left, top, right, bottom = side.area
                words[top : bottom + 1, left : right + 1] = moved(lines, side, before, views)
            return read_only(words)

        return self._page.of(page, views, *self._found.values())

    def find_next(self, scene: Scene, views: OrthographicViews) -> bool:
        """Find the lines of the next of the three views; returns False if all are found."""
        numbers, creases = self._object_of(scene)
        for side in SIDES:
            if side not in self._found or self._found[side][0] != views:
                view, area = view_of_side(side, views), side.area
                picture = depth_picture(scene.mesh, view, area.height, area.width, numbers)
                self._found[side] = views, line_words(picture, scene.mesh, creases)
                return True
        return False

    def of_points(self, scene: Scene, points: VisiblePoints, area: Area) -> Words:
        """The words of the lines as the eye sees them, (lines, elements) of an area.

        The lines of a coarser picture are as coarse as the picture.
        """
        numbers, creases = self._object_of(scene)
        raster, size = (points.lines, points.elements), (area.height, area.width)
        depths, parts = np.full(raster, np.inf), np.full(raster, NO_PART)
        depths.put(points.pixels, points.depths)
        parts.put(points.pixels, numbers.take(points.parts.numbers - 1))
        small = (sampled(each, *map(min, raster, size)) for each in (depths, parts))
        picture = DepthPicture(points.view, *small)
        return sampled(line_words(picture, scene.mesh, creases), *size)

    def _object_of(self, scene: Scene) -> tuple[Indices, Indices]:
        """The numbers of the parts, and the creases. If all parts are stage, they are the object."""
        mesh = scene.mesh

        def compute() -> tuple[Indices, Indices]:
            self._found = {}
            is_stage = np.array([part.stage for part in scene.parts], np.bool_)
            is_stage &= not is_stage[list(mesh.parts_in_use)].all()
            # A stage that is made is a part after all others.
            numbers = np.append(np.where(is_stage, STAGE, np.arange(len(is_stage))), STAGE)
            return numbers, crease_edges(mesh, numbers)

        return self._object.of(compute, mesh, scene.parts)
