"""The visible points: the polygon, the point and the normal at each pixel, in camera space, by surface.

Assumed: points are float32 around the middle of the whole object's bounding box, exact to a sixteen-millionth
of its size. Where a small thing is seen in front of a large one, this is too coarse, and points are float32
around the nearest visible point: see `visible_surfaces.nearest_point`.

If the object also reaches behind the eye, the near plane is the limit: what is nearer than `camera.NEAR` of
the farthest depth vanishes.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Final, NamedTuple

import numpy as np

from autocolor.arrays import Floats, Indices, Numbers, PartNumbers, Singles
from autocolor.checks import Vector, is_whole, shown
from autocolor.errors import UsageError
from autocolor.immutable import Immutable, read_only
from autocolor.scene.scene import SCAN_LINE, Scene
from autocolor.scene.view import View
from autocolor.visibility.projection import focal_length

PIXELS_AT_ONCE: Final = 1 << 17
"""The pixels of a chunk: as many as fit into the processor's caches with the arrays of a step."""

# Rows of `VisiblePoints.rows`: point P, normal N and reflected view R, each before its dot product with P.
POINT: Final = slice(0, 3)
NORMAL: Final = slice(4, 7)
REFLECTED_VIEW: Final = slice(8, 11)
POINT_SQUARED: Final = POINT.stop
ROW_COUNT: Final = 12


@dataclass(frozen=True, eq=False)
class VisiblePoints:
    """The visible points of a view: a point for each pixel that sees a polygon, sorted by surface.

    `pixels`, (n,) intp, are their flat places in the raster. They come in spans of neighbors that see the
    same polygon, and the spans of a polygon mostly follow each other: `span_polygons` are rows of the polygon
    table, `span_lengths` counts of pixels. `parts` has the part at each pixel.

    `rows` is (12, n) float32: the point in camera space around `origin`, the unit normal, and the view
    direction reflected at the normal, each with its dot product with the point, so that every cosine to a
    light is one matrix product. All lengths in camera space are in `unit`. `origin`, (3,), is the middle of
    the object, or the nearest visible point if `starts_nearest`. `interpolation` is the scene's; if it is
    INVARIANT, no span crosses the diagonal of a quad.
    """

    view: View
    lines: int
    elements: int
    unit: float
    origin: Floats
    pixels: Indices
    slices: tuple[SurfaceSlice, ...]
    span_polygons: Indices
    span_lengths: Indices
    rows: Singles
    parts: VisibleParts
    interpolation: str = SCAN_LINE
    starts_nearest: bool = False

    @cached_property
    def chunks(self) -> tuple[PointChunk, ...]:
        """All points in chunks to work on."""
        return point_chunks(self.slices)

    @cached_property
    def radius(self) -> float:
        """The largest distance of a point from the origin in units."""
        return float(np.sqrt(self.rows[POINT_SQUARED].max(initial=0.0)))

    @cached_property
    def largest_distance(self) -> Floats:
        """Four numbers whose product with (P, 1) is at least the distance of P from the origin, in units.

        The rounding of points is in proportion to it. Around the middle of the object it is the radius: a
        point there may be rounded like the distant start of its span. Around the nearest point, a point that
        is z deeper is at most z and half of the picture's diagonals at both depths away.
        """
        if not self.starts_nearest:
            return np.array([0, 0, 0, self.radius])
        focal = focal_length(self.lines, self.elements, self.view.field_of_view)
        diagonal = math.hypot(self.lines, self.elements) / focal
        return np.array([0, 0, 1 + diagonal / 2, diagonal * self.origin[2]])

    def camera_point(self, point: tuple[float, float, float]) -> Floats:
        """A point of the world in camera space, around the origin as in `rows`."""
        relative = np.array(point) - np.array(self.view.eye)
        in_camera: Floats = self.view.axes @ relative / self.unit - self.origin
        return in_camera

    def camera_direction(self, direction: tuple[float, float, float]) -> Floats:
        """A direction of the world in camera space."""
        in_camera: Floats = self.view.axes @ np.array(direction)
        return in_camera

    def world_coordinate(self, axis: int) -> Floats:
        """The four numbers whose product with (P, 1) is the point's world coordinate in units."""
        along = self.view.axes[:, axis]
        return np.append(along, self.view.eye[axis] / self.unit + along @ self.origin)

    @property
    def polygon_numbers(self) -> Indices:
        """Rows of the polygon table, (n,), in the order of `pixels`."""
        return np.repeat(self.span_polygons, self.span_lengths)

    @cached_property
    def normals(self) -> Singles:
        """The unit normals in camera space, (3, n) float32, in the order of `pixels`; read-only."""
        return read_only(self.rows[NORMAL])

    @property
    def depths(self) -> Floats:
        """The distances from the eye along the view direction, (n,), in the order of `pixels`."""
        depths: Floats = (self.rows[POINT][2].astype(np.float64) + self.origin[2]) * self.unit
        return depths

    @property
    def world_points(self) -> Floats:
        """The points in world coordinates, (n, 3), in the order of `pixels`."""
        in_camera = (self.rows[POINT].T.astype(np.float64) + self.origin) * self.unit
        points: Floats = in_camera @ self.view.axes + np.array(self.view.eye)
        return points

    @property
    def world_normals(self) -> Floats:
        """The unit normals in world axes, (n, 3), in the order of `pixels`."""
        normals: Floats = self.rows[NORMAL].T.astype(np.float64) @ self.view.axes
        return normals


def fill_point_products(rows: Singles) -> None:
    """Fill in the dot product of each vector in the rows with the point: the row after the vector."""
    vectors = rows.reshape(3, 4, -1)
    np.einsum("kij,ij->kj", vectors[:, :3], rows[POINT], out=vectors[:, 3])


@dataclass(frozen=True, eq=False, repr=False)
class VisibleParts(Immutable):
    """The part at each visible point, computed when it is first asked for.

    `names` are the names of all parts of the mesh, and `part_of_polygon` their rows, (polygons,). The points
    come in spans that see the same polygon: `span_polygons` are rows of the polygon table, and `span_lengths`
    counts of points.
    """

    names: tuple[str, ...]
    part_of_polygon: Indices
    span_polygons: Indices
    span_lengths: Indices

    def __post_init__(self) -> None:
        for array in (self.part_of_polygon, self.span_polygons, self.span_lengths):
            read_only(array)

    @classmethod
    def of_points(cls, names: tuple[str, ...], numbers: PartNumbers) -> VisibleParts:
        """The parts of points with these part numbers, (n,), from 1 on."""
        return cls(names, np.arange(len(names)), numbers.astype(np.intp) - 1, np.ones(len(numbers), np.intp))

    @cached_property
    def numbers(self) -> PartNumbers:
        """The part number at each point, (n,) int32: number k is names[k - 1]; read-only."""
        of_spans = (self.part_of_polygon.take(self.span_polygons) + 1).astype(np.int32)
        return read_only(np.repeat(of_spans, self.span_lengths))


@dataclass(frozen=True, eq=False)
class SurfaceSlice:
    """The pixels of a surface, from `start` to before `stop`."""

    surface_number: int
    start: int
    stop: int

    @property
    def pixels(self) -> slice:
        """The pixels as a slice."""
        return slice(self.start, self.stop)


@dataclass(frozen=True, eq=False)
class PointChunk:
    """Visible points that are worked on at once; `slices` are counted from the start of the chunk."""

    pixels: slice
    slices: tuple[SurfaceSlice, ...]


def surface_slices(counts: Numbers) -> tuple[SurfaceSlice, ...]:
    """The slices of pixels sorted by surface; `counts` has the number of pixels of each surface number."""
    stops = np.cumsum(counts)
    return tuple(
        SurfaceSlice(number, int(stops[number] - counts[number]), int(stops[number]))
        for number in np.flatnonzero(counts).tolist()
    )


def point_chunks(slices: Sequence[SurfaceSlice]) -> tuple[PointChunk, ...]:
    """All pixels in chunks of about the same size. If possible, a chunk ends between two surfaces.

    The chunks depend only on the slices. So an edit computes a plane in the same steps as a fresh picture,
    and to the same bits.
    """
    total = slices[-1].stop if slices else 0
    count = -(-total // PIXELS_AT_ONCE)
    even_ends = [total * number // count for number in range(1, count + 1)]
    bounds = [0]
    for end, following in pairwise(even_ends):
        between = min((each.start for each in slices), key=lambda start: abs(start - end))
        fits = all(0 < size <= PIXELS_AT_ONCE for size in (between - bounds[-1], following - between))
        bounds.append(between if fits else end)
    bounds.extend(even_ends[-1:])
    return tuple(
        PointChunk(slice(start, stop), _within(slices, start, stop)) for start, stop in pairwise(bounds)
    )


def _within(slices: Sequence[SurfaceSlice], start: int, stop: int) -> tuple[SurfaceSlice, ...]:
    """The slices between `start` and `stop`, cut at both and counted from `start`."""
    return tuple(
        SurfaceSlice(each.surface_number, max(each.start, start) - start, min(each.stop, stop) - start)
        for each in slices
        if each.start < stop and each.stop > start
    )


class Seen(NamedTuple):
    """The visible point at a pixel, in names and coordinates of the scene.

    `surface` and `part` are names, and `polygon` is a row of the polygon table. `point` is P, in object
    coordinates; `normal` is the unit normal N that is used for shading, turned to the eye where the surface
    is two-sided; `reflected_view` is the unit vector R = 2 (N.V) N - V, where V is the direction from P to
    the eye. N is zero where the normals of the corners cancel.
    """

    surface: str
    part: str
    polygon: int
    point: Vector
    normal: Vector
    reflected_view: Vector


@dataclass(frozen=True, eq=False)
class Sight:
    """The visible points of a scene on a display, which shows each of them as `block` x `block` pixels."""

    scene: Scene
    points: VisiblePoints
    block: int = 1

    def place_at(self, line: int, element: int) -> int | None:
        """The place of a pixel among the visible points; None on the background.

        Raises UsageError if there is no such line or element.
        """
        points, block = self.points, self.block
        for what, number, count in (("line", line, points.lines), ("element", element, points.elements)):
            if not is_whole(number, 0, count * block - 1):
                article = "an" if what == "element" else "a"
                raise UsageError(
                    f"{article} {what} must be 0 to {count * block - 1}, not {shown(number)}; choose another"
                )
        places = np.flatnonzero(points.pixels == line // block * points.elements + element // block)
        return int(places[0]) if len(places) else None

    def pixels_of(self, pixels: Indices) -> Indices:
        """The lines and elements, (n, 2), of the middle of the blocks at flat places in the raster, (n,)."""
        blocks = np.stack(np.divmod(pixels, self.points.elements), axis=1)
        return blocks * self.block + self.block // 2


def seen_at(sight: Sight, line: int, element: int) -> Seen | None:
    """The visible point at a pixel; None on the background. All pixels of a block see the same point.

    Screens call it at each movement of the pointer. Measured on the coupe: 0.1 ms, most of it for finding the
    pixel among the visible points; a raster of their places would take 1.2 MB for each picture. Raises
    UsageError if there is no such line or element.
    """
    place = sight.place_at(line, element)
    if place is None:
        return None
    scene, points = sight.scene.staged, sight.points
    span = np.searchsorted(np.cumsum(points.span_lengths), place, side="right")
    polygon = int(points.span_polygons[span])
    part = scene.parts[scene.mesh.part_numbers[polygon]]

    # Convert the point and the normal to world axes.
    axes = points.view.axes
    from_eye = (points.rows[POINT, place] + points.origin) @ axes
    point = from_eye * points.unit + np.array(points.view.eye)
    normal = points.rows[NORMAL, place].astype(np.float64) @ axes
    # Normalize the normal in float64, unless it is zero.
    normal /= np.linalg.norm(normal) or 1.0
    # Reflect the view direction at the normal.
    ray = from_eye / np.linalg.norm(from_eye)
    reflected = ray - 2 * (normal @ ray) * normal
    return Seen(
        part.surface, part.name, polygon, *(tuple(each.tolist()) for each in (point, normal, reflected))
    )
