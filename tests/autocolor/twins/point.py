"""The visible point at a pixel, by the scan line, in Python's floats: its polygon, the point, its normal.

Paper: "The Lighting Model". The normal is interpolated between the normals of the nodes, along the edges of
the polygon to the scan line and then along the scan line. So is the depth of the point. Departs: both are
interpolated on the surface, not in the picture. Where a scene asks for it, a quad is two triangles.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from autocolor.checks import Vector
from autocolor.scene.mesh import Mesh
from autocolor.scene.scene import INVARIANT, LINEAR, Scene
from autocolor.scene.surfaces import Reflectance
from autocolor.scene.view import View


@dataclass(frozen=True)
class Corner:
    """A corner of the polygon: its row of the node table, and the mesh's unit normal at it."""

    node: int
    coordinates: Vector
    normal: Vector


@dataclass(frozen=True)
class PointExplained:
    """The visible point: the rows of the tables that lead to it, and its vectors in object coordinates.

    `between` has the places, from 0, of the corners between which the point is interpolated: all corners of
    the polygon, or three corners of a quad. `reflectance` is the surface's. `normal` is the unit normal
    N; it is interpolated with the length `normal_length`, normalized, and turned to the eye if `is_turned`.
    `reflected_view` is R = 2 (N.V) N - V. `distance` leads from the eye to the point.
    """

    polygon: int
    corners: tuple[Corner, ...]
    between: tuple[int, ...]
    part: int
    part_name: str
    surface: int
    surface_name: str
    reflectance: Reflectance
    point: Vector
    distance: float
    normal: Vector
    normal_length: float
    is_turned: bool
    reflected_view: Vector


class Camera(NamedTuple):
    """A view and the lines and elements of a picture. Pixels are square, their centers at half-integers."""

    view: View
    lines: int
    elements: int
    is_linear: bool = False

    @property
    def focal_length(self) -> float:
        """The distance of the picture plane from the eye in pixels.

        The field of view is the vertical one of the largest picture of 4:3 that the picture holds.
        """
        return (
            min(self.lines, self.elements * 3 / 4) / 2 / math.tan(math.radians(self.view.field_of_view) / 2)
        )

    def in_camera(self, point: Vector) -> Vector:
        """A point of the world by how far it is to the right of the eye, below it, and ahead of it."""
        right, down, ahead = (dot(axis, minus(point, self.view.eye)) for axis in self.view.axes.tolist())
        return right, down, ahead

    def in_world(self, line: int, element: int, depth: float) -> Vector:
        """The point of the world at a depth on the ray through the center of a pixel."""
        across = (element + 0.5 - self.elements / 2) / self.focal_length
        below = (line + 0.5 - self.lines / 2) / self.focal_length
        right, down, forward = self.view.axes.tolist()
        ray = plus(plus(times(across, right), times(below, down)), forward)
        return plus(self.view.eye, times(depth, ray))


class Vertex(NamedTuple):
    """A corner of what is left of a polygon before the eye: its camera coordinates, and its normal."""

    place: Vector
    normal: Vector

    def toward(self, other: Vertex, fraction: float) -> Vertex:
        """The vertex at a fraction of the way to another."""
        return Vertex(
            between(self.place, other.place, fraction), between(self.normal, other.normal, fraction)
        )


class LinePoint(NamedTuple):
    """A place on a line of the picture: x in pixels, the inverse depth, and the interpolated normal."""

    x: float
    inverse_depth: float
    normal: Vector

    def toward(self, other: LinePoint, fraction: float, is_linear: bool) -> LinePoint:
        """The place at a fraction of the way to another in the picture.

        The inverse depth is linear in the picture. The normal is, too, if it `is_linear`; otherwise it is
        linear on the surface, where the fraction is the other's part of the inverse depth.
        """
        inverse_depth = (1 - fraction) * self.inverse_depth + fraction * other.inverse_depth
        on_surface = fraction if is_linear else fraction * other.inverse_depth / inverse_depth
        x = self.x + fraction * (other.x - self.x)
        return LinePoint(x, inverse_depth, between(self.normal, other.normal, on_surface))


def point_at(scene: Scene, camera: Camera, polygon: int, line: int, element: int) -> PointExplained:
    """The point of a polygon, a row of the polygon table counted from 0, that is seen at a pixel."""
    camera = camera._replace(is_linear=scene.interpolation == LINEAR)
    mesh, part = scene.mesh, scene.parts[scene.mesh.part_numbers[polygon]]
    surface = next(row for row in scene.surfaces if row.name == part.surface)
    corners = [
        Corner(node + 1, vector_of(mesh.coordinates[node]), vector_of(mesh.normals.vectors[normal]))
        for node, normal in corner_rows(mesh, polygon)
    ]
    vertices = [Vertex(camera.in_camera(corner.coordinates), corner.normal) for corner in corners]
    near = near_plane(mesh, camera.view)
    groups = triangles_of(mesh, polygon) if scene.interpolation == INVARIANT else [range(len(corners))]
    pieces = [
        (tuple(group), piece, is_behind)
        for group in groups
        for piece, is_behind in pieces_of([vertices[place] for place in group], near, camera)
    ]
    found, is_behind, group = _found(pieces, vertices, camera, line, element)
    point = camera.in_world(line, element, 1 / found.inverse_depth)
    is_turned = is_behind and surface.two_sided
    normal = unit(times(-1 if is_turned else 1, found.normal))
    # The view direction V, from the point to the eye, reflected at the normal.
    to_eye = unit(minus(camera.view.eye, point))
    return PointExplained(
        polygon=polygon + 1,
        corners=tuple(corners),
        between=group,
        part=int(mesh.part_numbers[polygon]) + 1,
        part_name=part.name,
        surface=scene.surfaces.index(surface) + 1,
        surface_name=surface.name,
        reflectance=surface.reflectance,
        point=point,
        distance=math.dist(camera.view.eye, point),
        normal=normal,
        normal_length=length(found.normal),
        is_turned=is_turned,
        reflected_view=minus(times(2 * dot(normal, to_eye), normal), to_eye),
    )


def corner_rows(mesh: Mesh, polygon: int) -> list[tuple[int, int]]:
    """The node and the row of the mesh's normals at each corner of a polygon. A triangle repeats a node."""
    nodes, normals = mesh.node_numbers[polygon].tolist(), mesh.normals.numbers[polygon].tolist()
    rows = list(zip(nodes, normals, strict=True))
    corners = [row for row, before in zip(rows, [rows[-1], *rows[:-1]], strict=True) if row[0] != before[0]]
    return corners or rows[:1]


def triangles_of(mesh: Mesh, polygon: int) -> list[tuple[int, ...]]:
    """The places of the corners of both triangles of a quad; for a triangle, its own."""
    count, start = len(corner_rows(mesh, polygon)), int(mesh.diagonals.starts[polygon])
    if count < 4:
        return [tuple(range(count))]
    return [tuple((start + step) % 4 for step in steps) for steps in ((0, 1, 2), (2, 3, 0))]


Piece = tuple[tuple[int, ...], Sequence["Vertex"], bool]
"""The places of the corners that a piece is interpolated between, the piece, and whether its back is seen."""


def _found(
    pieces: Sequence[Piece], vertices: Sequence[Vertex], camera: Camera, line: int, element: int
) -> tuple[LinePoint, bool, tuple[int, ...]]:
    """The point on the scan line at the center of a pixel, whether its back is seen, and its corners' places.

    Of the pieces of a polygon, the nearest that covers the pixel is seen. If rounding put the pixel beside
    all of them, the piece is seen from which it is least far.
    """
    candidates = []
    # A line through a corner may cross no edge by rounding; then the lines a little below and above do.
    for aside in (0.0, 1e-6, -1e-6):
        for places, piece, is_behind in pieces:
            crossings = crossings_of(piece, camera, line + 0.5 + aside)
            if len(crossings) == 2 and crossings[0].x < crossings[1].x:
                left, right = crossings
                fraction = (element + 0.5 - left.x) / (right.x - left.x)
                outside = max(-fraction, fraction - 1, 0.0) * (right.x - left.x)
                at_pixel = left.toward(right, fraction, camera.is_linear)
                is_outside = outside if outside > 1e-6 else 0.0
                candidates.append((is_outside, -at_pixel.inverse_depth, is_behind, places, at_pixel))
        if candidates:
            break
    if not candidates:
        # A sliver that is thinner than a rounding: any of its points.
        x, _, inverse_depth = on_raster(vertices[0], camera)
        return LinePoint(x, abs(inverse_depth), vertices[0].normal), False, tuple(range(len(vertices)))
    *_, is_behind, places, at_pixel = min(candidates, key=lambda each: each[:2])
    return at_pixel, is_behind, places


def pieces_of(
    vertices: Sequence[Vertex], near: float, camera: Camera
) -> Iterator[tuple[Sequence[Vertex], bool]]:
    """The pieces of a polygon that the scan line interpolates, and whether the eye sees the back of each.

    A line crosses the edges of each piece at most twice.
    """
    for polygon in before_the_eye(vertices, near):
        is_behind = _is_seen_from_behind([on_raster(vertex, camera)[:2] for vertex in polygon])
        for piece in without_zigzag(polygon, camera):
            yield piece, is_behind


def on_raster(vertex: Vertex, camera: Camera) -> tuple[float, float, float]:
    """The x and y of a vertex in the picture, in pixels from its upper left, and the inverse depth."""
    right, down, depth = vertex.place
    scale = camera.focal_length / depth
    return scale * right + camera.elements / 2, scale * down + camera.lines / 2, 1 / depth


def crossings_of(piece: Sequence[Vertex], camera: Camera, y: float) -> list[LinePoint]:
    """Where a line of the picture crosses the edges of a polygon, from left to right."""
    crossings = []
    for one, other in zip(piece, [*piece[1:], piece[0]], strict=True):
        (x, top, inverse_depth), (other_x, bottom, other_inverse_depth) = (
            on_raster(vertex, camera) for vertex in (one, other)
        )
        if min(top, bottom) <= y < max(top, bottom):
            start = LinePoint(x, inverse_depth, one.normal)
            end = LinePoint(other_x, other_inverse_depth, other.normal)
            crossings.append(start.toward(end, (y - top) / (bottom - top), camera.is_linear))
    return sorted(crossings, key=lambda each: each.x)


def near_plane(mesh: Mesh, view: View) -> float:
    """The depth of the near plane: a millionth of the depth of the farthest corner of the mesh's bounds."""
    low, high = (bound.tolist() for bound in mesh.bounds)
    forward = view.axes[2].tolist()
    depths = [
        dot(forward, minus((x, y, z), view.eye))
        for x in (low[0], high[0])
        for y in (low[1], high[1])
        for z in (low[2], high[2])
    ]
    return 1e-6 * max(depths)


def before_the_eye(vertices: Sequence[Vertex], near: float) -> list[list[Vertex]]:
    """What is left of a polygon beyond the near plane: polygons of three or four corners.

    The rest begins where an edge comes out of the near plane.
    """
    if all(vertex.place[2] >= near for vertex in vertices):
        return [list(vertices)]
    edges = list(zip(vertices, [*vertices[1:], vertices[0]], strict=True))
    coming_out = [
        number for number, (one, other) in enumerate(edges) if one.place[2] < near <= other.place[2]
    ]
    if not coming_out:
        return []
    first = min(coming_out, key=lambda number: (edges[number][1].place, edges[number][0].place))
    rest: list[Vertex] = []
    for one, other in edges[first:] + edges[:first]:
        if one.place[2] >= near:
            rest.append(one)
        if (one.place[2] < near) != (other.place[2] < near):
            rest.append(one.toward(other, (near - one.place[2]) / (other.place[2] - one.place[2])))
    # Two polygons of what has five or six corners.
    return [[rest[0], *rest[number : number + 3]] for number in range(1, len(rest) - 1, 2)]


def without_zigzag(quad: list[Vertex], camera: Camera) -> list[list[Vertex]]:
    """The quad, or two triangles of a quad around which the lines fall, rise, fall and rise.

    A line would cross such a quad four times. It is cut along the diagonal that divides its other corners in
    the picture; if both diagonals do or neither does, along the shorter one.
    """
    places = [on_raster(vertex, camera)[:2] for vertex in quad]
    lines = [min(max(math.ceil(y - 0.5), 0), camera.lines) for _, y in places]
    falls = [(after > line) - (after < line) for line, after in pairwise([*lines, lines[0]])]
    if len(quad) < 4 or falls[0] == 0 or falls != [falls[0], -falls[0], falls[0], -falls[0]]:
        return [quad]
    keys = []
    for start in (0, 1):
        one, beside, end, other = (places[(start + step) % 4] for step in range(4))
        is_dividing = _turn(one, end, beside) * _turn(one, end, other) < 0
        keys.append((not is_dividing, math.dist(quad[start].place, quad[start + 2].place)))
    start = 0 if keys[0] <= keys[1] else 1
    a, b, c, d = (quad[(start + step) % 4] for step in range(4))
    return [[a, b, c], [a, c, d]]


def _turn(a: tuple[float, float], b: tuple[float, float], c: tuple[float, float]) -> float:
    """How far c lies to the side of the line from a to b in the picture."""
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def _is_seen_from_behind(places: Sequence[tuple[float, float]]) -> bool:
    """Whether a polygon runs counterclockwise on the raster, where y grows downward; its front does not."""
    return math.fsum(_turn(places[0], a, b) for a, b in pairwise(places[1:])) > 0


# Vectors.


def plus(a: Sequence[float], b: Sequence[float]) -> Vector:
    """The sum of two vectors."""
    x, y, z = (one + other for one, other in zip(a, b, strict=True))
    return x, y, z


def minus(a: Sequence[float], b: Sequence[float]) -> Vector:
    """The vector from b to a."""
    x, y, z = (one - other for one, other in zip(a, b, strict=True))
    return x, y, z


def times(factor: float, a: Sequence[float]) -> Vector:
    """The vector times a number."""
    x, y, z = (factor * each for each in a)
    return x, y, z


def between(a: Sequence[float], b: Sequence[float], fraction: float) -> Vector:
    """The vector at a fraction of the way from a to b."""
    x, y, z = (one + fraction * (other - one) for one, other in zip(a, b, strict=True))
    return x, y, z


def dot(a: Sequence[float], b: Sequence[float]) -> float:
    """The sum of the products of components."""
    return math.fsum(one * other for one, other in zip(a, b, strict=True))


def cross(a: Sequence[float], b: Sequence[float]) -> Vector:
    """The cross product."""
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def length(a: Sequence[float]) -> float:
    """The length of a vector."""
    return math.hypot(*a)


def unit(a: Sequence[float]) -> Vector:
    """The unit vector; zero stays zero."""
    return times(1 / (length(a) or 1.0), a)


def vector_of(row: Any) -> Vector:
    """A row of an array, (3,), as a vector."""
    x, y, z = np.asarray(row, np.float64).tolist()
    return x, y, z
