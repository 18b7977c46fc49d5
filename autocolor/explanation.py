"""Explanations: why a pixel looks as it does, from the rows of the tables to the color of an entry.

This is the paper for one pixel. Each step is computed apart from the renderer, by the plain formula, for one
point, in Python's floats. The renderer gives only facts of the whole picture: the polygon that is visible at
the pixel, the ranges of intensities, and the words of each surface. So an explanation also checks the
renderer: it must agree with the picture.

The steps, in this order: the corners of the polygon, the scan line, the point and its normal, the light
equation, the level, the word, the color.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass
from itertools import pairwise
from typing import Any, Final, NamedTuple

import numpy as np

from autocolor.arrays import Singles
from autocolor.checks import Color, Vector
from autocolor.mapping.bands import Bands
from autocolor.mapping.display_image import DisplayImage
from autocolor.mapping.intensity import WHOLE, has_extent, held_name, mapped_ranges
from autocolor.mapping.ranges import BACKGROUND
from autocolor.scene.color_scales import COLOR_SCALES, IN_TURN
from autocolor.scene.curves import CurvePoints
from autocolor.scene.following import detached
from autocolor.scene.kinds import ColorKind
from autocolor.scene.lights import Light
from autocolor.scene.mesh import Mesh
from autocolor.scene.reflection_models import (
    BlinnPhong,
    CookTorrance,
    Phong,
    ReflectionModel,
    SpecularGrowth,
)
from autocolor.scene.scalar import LARGEST_SCALAR, Scalar
from autocolor.scene.scene import Scene
from autocolor.scene.surfaces import Paint, Surface
from autocolor.scene.view import View
from autocolor.visibility.visible_points import Sight, seen_at

ON_THE_EDGE: Final = 1e-9
"""Assumed: a point this close to the edge of a control, as a fraction of the sizes, counts as on the edge.

A floor that lies in the plane of a flap is lit, whichever way its points are rounded."""

GRAZING: Final = 5e-7
"""Assumed: the largest cos(I) that parallel rays along a flat surface have by the rounding of its normals."""

ROUNDING: Final = 2.0**-20
"""The rounding of intensities and scalars in the picture, as a fraction of the largest."""


@dataclass(frozen=True)
class Corner:
    """A corner of the polygon: its row of the node table, and the mesh's unit normal at it."""

    node: int
    coordinates: Vector
    normal: Vector


@dataclass(frozen=True)
class PointExplained:
    """The visible point: the rows of the tables that lead to it, and its vectors in object coordinates.

    `normal` is the unit normal N, `is_turned` whether it is turned to the eye; it is interpolated with the
    length `normal_length` and then normalized. `reflected_view` is R = 2 (N.V) N - V. `distance` leads from
    the eye to the point.
    """

    polygon: int
    corners: tuple[Corner, ...]
    part: int
    part_name: str
    surface: int
    surface_name: str
    point: Vector
    distance: float
    normal: Vector
    normal_length: float
    is_turned: bool
    reflected_view: Vector


@dataclass(frozen=True)
class LightExplained:
    """The contribution of one light, which is `diffuse` + `specular`.

    `cos_incidence`, `cos_eye` and `cos_light` are the cosines of I, E and L; the last is None for a light
    without a direction. `controls` has the share that each control of the light leaves, 0 to 1, by its name.
    `specular_factor` is cos^N(E), or what takes its place under another reflection model.
    """

    light: int
    name: str
    intensity: float
    cos_incidence: float
    cos_eye: float
    cos_light: float | None
    controls: Mapping[str, float]
    specular_factor: float
    diffuse: float
    specular: float

    @property
    def share(self) -> float:
        """The share of the light that all controls leave, 0 to 1."""
        return math.prod(self.controls.values())

    @property
    def contribution(self) -> float:
        """The intensity that the light adds."""
        return self.diffuse + self.specular


@dataclass(frozen=True)
class ScalarExplained:
    """The value of the scalar, None where it is missing, and its band among the bands of the surface."""

    name: str
    value: float | None
    minimum: float
    maximum: float
    band: int
    bands: int
    shades: int
    band_color: Color


@dataclass(frozen=True)
class LevelExplained:
    """The level of the intensity within the range that is mapped, and the entry of that level.

    The range belongs to `range_of`, "surface" or "object". `fraction` is the intensity's fraction of the
    range, 0 to 1, and `mapped_fraction` the same after the mapping curve. The level is mapped_fraction
    (levels - 1) + `threshold`, rounded down; without dithering the threshold is a half. On a surface that a
    scalar colors, it is the level of a shade within the band. `light_share` is the weight of the light color
    in the entry, `brightness` the share of the color that the level leaves.
    """

    range_of: str
    is_held: bool
    minimum: float
    maximum: float
    fraction: float
    mapped_fraction: float
    threshold: float
    level: int
    levels: int
    first_word: int
    scalar: ScalarExplained | None
    object_color: Color
    light_color: Color
    light_share: float
    brightness: float


@dataclass(frozen=True)
class Explanation:
    """Why a pixel looks as it does. Rows of tables are counted from 1.

    `point` and `intensity` are None on the background. `lights` has all lights, those that contribute most
    first. `level` is None on the background, and where words stand for normals: then the entry has the light
    at the normal that stands for several, in place of the light at this point.
    """

    scene: str
    line: int
    element: int
    point: PointExplained | None
    ambient: float
    lights: tuple[LightExplained, ...]
    intensity: float | None
    level: LevelExplained | None
    word: int
    color: Color

    def to_plain(self) -> dict[str, Any]:
        """The explanation as dictionaries, lists and numbers, which JSON can hold."""
        return asdict(self)


def explain(sight: Sight, image: DisplayImage, line: int, element: int) -> Explanation:
    """Why a pixel of an image looks as it does. `sight` has the visible points of the image.

    Raises UsageError if there is no such line or element.
    """
    scene = image.scene
    seen = seen_at(sight, line, element)
    if seen is None:
        return Explanation(
            scene.name, line, element, None, scene.ambient, (), None, None, BACKGROUND, scene.background
        )
    raster = Raster(scene.view, sight.points.lines, sight.points.elements)
    at_pixel = line // sight.block, element // sight.block
    point = point_at(scene, raster, seen.polygon, *at_pixel)
    surface = scene.surfaces[point.surface - 1]
    lights = [
        light_at(light, number, scene, surface, point)
        for number, light in enumerate(scene.lights_in_world, start=1)
    ]
    lights.sort(key=lambda each: -each.contribution)
    intensity = scene.ambient + math.fsum(each.contribution for each in lights)
    if image.meaning == "normal":
        level, word = None, int(image.words[line, element])
        red, green, blue = image.entries[word].tolist()
        color = red, green, blue
    else:
        level = level_at(image, point, intensity, at_pixel)
        word, color = word_of(level), color_of(level)
    return Explanation(
        scene.name, line, element, point, scene.ambient, tuple(lights), intensity, level, word, color
    )


# The visible point.
#
# Paper: "The Lighting Model". The normal is interpolated between the normals of the nodes, along the edges of
# the polygon to the scan line and then along the scan line. So is the depth of the point. Departs: both are
# interpolated on the surface, not in the picture.


class Raster(NamedTuple):
    """A view and the lines and elements of a picture. Pixels are square, their centers at half-integers."""

    view: View
    lines: int
    elements: int

    @property
    def focal_length(self) -> float:
        """The distance of the picture plane from the eye in pixels."""
        return self.lines / 2 / math.tan(math.radians(self.view.field_of_view) / 2)

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


class Crossing(NamedTuple):
    """A place on a line of the picture: x in pixels, the inverse depth, and the interpolated normal."""

    x: float
    inverse_depth: float
    normal: Vector

    def toward(self, other: Crossing, fraction: float) -> Crossing:
        """The place at a fraction of the way to another in the picture.

        The inverse depth is linear in the picture. The normal is linear on the surface, where the fraction is
        the other's part of the inverse depth.
        """
        inverse_depth = (1 - fraction) * self.inverse_depth + fraction * other.inverse_depth
        on_surface = fraction * other.inverse_depth / inverse_depth
        x = self.x + fraction * (other.x - self.x)
        return Crossing(x, inverse_depth, between(self.normal, other.normal, on_surface))


def point_at(scene: Scene, raster: Raster, polygon: int, line: int, element: int) -> PointExplained:
    """The point of a polygon, a row of the polygon table counted from 0, that is seen at a pixel."""
    mesh, part = scene.mesh, scene.parts[scene.mesh.part_numbers[polygon]]
    surface = next(row for row in scene.surfaces if row.name == part.surface)
    corners = [
        Corner(node + 1, vector_of(mesh.coordinates[node]), vector_of(mesh.normals.vectors[normal]))
        for node, normal in rows_of_corners(mesh, polygon)
    ]
    found, is_behind = _found(corners, raster, mesh, line, element)
    point = raster.in_world(line, element, 1 / found.inverse_depth)
    is_turned = is_behind and surface.two_sided
    normal = unit(times(-1 if is_turned else 1, found.normal))
    # The view direction V, from the point to the eye, reflected at the normal.
    to_eye = unit(minus(raster.view.eye, point))
    return PointExplained(
        polygon + 1,
        tuple(corners),
        int(mesh.part_numbers[polygon]) + 1,
        part.name,
        scene.surfaces.index(surface) + 1,
        surface.name,
        point,
        math.dist(raster.view.eye, point),
        normal,
        length(found.normal),
        is_turned,
        minus(times(2 * dot(normal, to_eye), normal), to_eye),
    )


def rows_of_corners(mesh: Mesh, polygon: int) -> list[tuple[int, int]]:
    """The node and the row of the mesh's normals at each corner of a polygon. A triangle repeats a node."""
    nodes, normals = mesh.node_numbers[polygon].tolist(), mesh.normals.numbers[polygon].tolist()
    pairs = list(zip(nodes, normals, strict=True))
    return [
        pair for pair, before in zip(pairs, [pairs[-1], *pairs], strict=False) if pair[0] != before[0]
    ] or [pairs[0]]


def _found(
    corners: Sequence[Corner], raster: Raster, mesh: Mesh, line: int, element: int
) -> tuple[Crossing, bool]:
    """What the scan line finds at the center of a pixel, and whether the eye sees the back of the polygon.

    Of the pieces of a polygon, the nearest that covers the pixel is seen. If rounding put the pixel beside
    all of them, it is the least distant.
    """
    vertices = [Vertex(raster.in_camera(corner.coordinates), corner.normal) for corner in corners]
    candidates = []
    for aside in (0.0, 1e-6, -1e-6):
        for quad in before_the_eye(vertices, near_plane(mesh, raster.view)):
            is_behind = _is_seen_from_behind([on_raster(each, raster)[:2] for each in quad])
            for piece in without_zigzag(quad, raster):
                crossings = crossings_of(piece, raster, line + 0.5 + aside)
                if len(crossings) == 2 and crossings[0].x < crossings[1].x:
                    left, right = crossings
                    fraction = (element + 0.5 - left.x) / (right.x - left.x)
                    outside = max(-fraction, fraction - 1, 0.0) * (right.x - left.x)
                    at_pixel = left.toward(right, fraction)
                    candidates.append((outside > 1e-6, -at_pixel.inverse_depth, is_behind, at_pixel))
        if candidates:
            break
    if not candidates:
        # A sliver of less than a rounding.
        x, _, inverse_depth = on_raster(vertices[0], raster)
        return Crossing(x, abs(inverse_depth), vertices[0].normal), False
    *_, is_behind, at_pixel = min(candidates, key=lambda each: each[:2])
    return at_pixel, is_behind


def on_raster(vertex: Vertex, raster: Raster) -> tuple[float, float, float]:
    """The x and y of a vertex in the picture, in pixels from its upper left, and the inverse depth."""
    right, down, depth = vertex.place
    scale = raster.focal_length / depth
    return scale * right + raster.elements / 2, scale * down + raster.lines / 2, 1 / depth


def crossings_of(piece: Sequence[Vertex], raster: Raster, y: float) -> list[Crossing]:
    """Where a line of the picture crosses the edges of a polygon, from left to right."""
    crossings = []
    for one, other in zip(piece, [*piece[1:], piece[0]], strict=True):
        (x, top, inverse_depth), (other_x, bottom, other_inverse_depth) = (
            on_raster(vertex, raster) for vertex in (one, other)
        )
        if min(top, bottom) <= y < max(top, bottom):
            start = Crossing(x, inverse_depth, one.normal)
            end = Crossing(other_x, other_inverse_depth, other.normal)
            crossings.append(start.toward(end, (y - top) / (bottom - top)))
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


def without_zigzag(quad: list[Vertex], raster: Raster) -> list[list[Vertex]]:
    """The quad, or two triangles of a quad around which the lines fall, rise, fall and rise.

    A line would cross such a quad four times. It is cut along the diagonal that divides its other corners in
    the picture; if both diagonals do or neither does, along the shorter one.
    """
    places = [on_raster(vertex, raster)[:2] for vertex in quad]
    lines = [min(max(math.ceil(y - 0.5), 0), raster.lines) for _, y in places]
    falls = [(after > line) - (after < line) for line, after in pairwise([*lines, lines[0]])]
    if len(quad) < 4 or falls[0] == 0 or falls != [falls[0], -falls[0], falls[0], -falls[0]]:
        return [quad]
    keys = []
    for start in (0, 1):
        a, b, c, d = (places[(start + step) % 4] for step in range(4))
        is_dividing = _turn(a, c, b) * _turn(a, c, d) < 0
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


# The light equation.
#
# Paper: Figure 2 and "The Lighting Model": light(j) = intensity(j) x controls(j) x (D cos(I) + S cos^N(E)),
# where cos(I) > 0. The intensity at a point is the sum over all lights and the ambient term.


def light_at(light: Light, number: int, scene: Scene, surface: Surface, at: PointExplained) -> LightExplained:
    """The contribution of a light of the world, the row `number` of the light table, at a point."""
    to_light = direction_to(light, at.point)
    cos_incidence, cos_eye = dot(at.normal, to_light), dot(at.reflected_view, to_light)
    controls = controls_at(light, at.point, scene)
    if light.links.only_surfaces is not None or light.links.except_surfaces is not None:
        controls["surfaces"] = float(light.links.shines_on_surface(at.surface_name))
    if light.links.depend_on_parts:
        controls["parts"] = float(bool(light.links.lit_parts([at.part_name])))
    reflectance, factor = surface.reflectance, 0.0
    reaches = light.intensity * math.prod(controls.values())
    if cos_incidence > (GRAZING if light.at_infinity else 0.0):
        to_eye = unit(minus(scene.view.eye, at.point))
        factor = specular_factor(reflectance.model, to_light, at.normal, to_eye)
    else:
        reaches = 0.0
    return LightExplained(
        number,
        light.name,
        light.intensity,
        cos_incidence,
        cos_eye,
        None if light.axis is None else cos_light_of(light, at.point),
        controls,
        factor,
        reaches * reflectance.diffuse * cos_incidence if reaches else 0.0,
        reaches * reflectance.specular * factor,
    )


def direction_to(light: Light, point: Vector) -> Vector:
    """The unit vector from a point to a light; the rays of a light at infinity are parallel."""
    if light.at_infinity and light.axis is not None:
        return times(-1, light.axis)
    return unit(minus(light.position, point))


def cos_light_of(light: Light, point: Vector) -> float:
    """cos(L), between the light's direction and the ray from the light to a point."""
    assert light.axis is not None
    return 1.0 if light.at_infinity else -dot(light.axis, direction_to(light, point))


def controls_at(light: Light, point: Vector, scene: Scene) -> dict[str, float]:
    """The share that each control of a light of the world leaves at a point, 0 to 1, by its name.

    Paper: "Light Direction and Concentration", "Light Flaps and Cones".
    """
    shares = {} if light.on else {"switch": 0.0}
    if light.axis is not None:
        cos_light = cos_light_of(light, point)
        if light.concentration > 0:
            shares["concentration"] = max(cos_light, 0.0) ** light.concentration
        if light.cone_angle is not None:
            rim = math.cos(math.radians(light.cone_angle))
            inner = rim if light.inner_angle is None else math.cos(math.radians(light.inner_angle))
            shares["cone"] = edge_share(cos_light - rim, inner - rim, ON_THE_EDGE)
    low, high = (bound.tolist() for bound in scene.mesh.bounds)
    slack = ON_THE_EDGE * (math.dist(low, high) + length(low) + length(high))
    for axis, coordinate in zip("xyz", point, strict=True):
        flap = vars(light.flaps)[axis]
        if flap is not None and flap.on:
            inside = (coordinate - flap.minimum, flap.maximum - coordinate)
            shares[f"flap {axis}"] = math.prod(edge_share(end, flap.edge_width, slack) for end in inside)
    for half_space in light.half_spaces:
        if half_space.on:
            plane = detached(half_space, light)
            inside_plane = dot(minus(point, plane.point), unit(plane.direction))
            shares[f"half-space {half_space.name}"] = edge_share(inside_plane, plane.edge_width, slack)
    if light.falloff != "none" and light.reach is not None:
        left = max(1 - math.dist(light.position, point) / light.reach, 0.0)
        shares["falloff"] = left if light.falloff == "linear" else left * left
    return shares


def edge_share(inside: float, width: float, slack: float = 0.0) -> float:
    """The share that an edge leaves at a distance inside it: all from its width on, 3 t^2 - 2 t^3 before.

    A sharp edge counts as lit up to `slack` outside.
    """
    if inside >= width or (width == 0 and inside >= -slack):
        return 1.0
    fraction = max(inside, 0.0) / width if width else 0.0
    return 3 * fraction**2 - 2 * fraction**3


def specular_factor(model: ReflectionModel, light: Vector, normal: Vector, eye: Vector) -> float:
    """The factor in the place of cos^N(E) under a model, for unit vectors to the light and to the eye.

    The models are described in `scene.reflection_models`.
    """
    n_l, n_v = dot(normal, light), dot(normal, eye)
    half = unit(plus(light, eye))
    n_h, v_h = dot(normal, half), dot(eye, half)
    if isinstance(model, Phong):
        reflected = minus(times(2 * n_v, normal), eye)
        return specular_growth(model.growth, n_l) * max(dot(reflected, light), 0.0) ** model.exponent
    if isinstance(model, BlinnPhong):
        return specular_growth(model.growth, n_l) * max(n_h, 0.0) ** model.exponent
    assert isinstance(model, CookTorrance)
    m, f0 = model.roughness, model.normal_reflectance

    def beckmann(cosine: float) -> float:
        # Far from the normal nothing is left, and the tangent has no limit.
        tangent = math.tan(math.acos(min(max(cosine, 0.01), 1.0)))
        return math.exp(-((tangent / m) ** 2)) / (m * m * max(cosine, 0.01) ** 4)

    def fresnel(cosine: float) -> float:
        if f0 == 1:
            return 1.0
        index = (1 + math.sqrt(f0)) / (1 - math.sqrt(f0))
        # Fresnel's two equations, from the angles on both sides of the surface.
        outside = math.acos(min(cosine, 1.0))
        inside = math.asin(math.sin(outside) / index)
        across = (math.cos(outside) - index * math.cos(inside)) / (
            math.cos(outside) + index * math.cos(inside)
        )
        along = (math.cos(inside) - index * math.cos(outside)) / (
            math.cos(inside) + index * math.cos(outside)
        )
        return (across * across + along * along) / 2

    attenuation = max(min(1.0, 2 * n_h * n_v / v_h, 2 * n_h * n_l / v_h), 0.0) if v_h else 0.0
    # No silhouette is divided by less than three tenths.
    factor = fresnel(v_h) * beckmann(n_h) * attenuation / max(n_v, 0.3)
    return factor / (fresnel(1.0) * beckmann(1.0))


def specular_growth(growth: SpecularGrowth, cosine: float) -> float:
    """S at a cosine of the angle of incidence, as a multiple of its value at normal incidence."""
    cosine = min(max(cosine, 0.0), 1.0)
    if growth.fresnel_curve is not None:
        share = along_points(growth.fresnel_curve, math.degrees(math.acos(cosine)))
        return share / growth.fresnel_curve[0][1]
    f0 = growth.base_reflectance
    if growth.refractive_index is not None:
        f0 = ((growth.refractive_index - 1) / (growth.refractive_index + 1)) ** 2
    if f0 is None:
        return 1.0
    return (f0 + (1 - f0) * (1 - cosine) ** 5) / f0


def along_points(points: Sequence[tuple[float, float]], x: float) -> float:
    """The value at x of the line from point to point; beyond the ends, the value of the nearer end."""
    for (left, low), (right, high) in pairwise(points):
        if x <= right:
            return low + (high - low) * max(x - left, 0.0) / (right - left)
    return points[-1][1]


# The level, the word and the color.
#
# Paper: "The Lighting Model": the minimum and the maximum of a range become its lowest and highest level.
# "Light Source Color Blending", Figures 11 and 12: the word is the first word of the surface plus the level,
# and the entry blends the two colors of the surface.


def level_at(
    image: DisplayImage, at: PointExplained, intensity: float, at_pixel: tuple[int, int]
) -> LevelExplained:
    """The level of an intensity at a pixel of an image whose words stand for levels."""
    scene, picture = image.scene, image.mapped
    extents = mapped_ranges(picture, scene.scaling, scene.exposure)
    extent = extents[at.surface]
    low, high = (float(end * picture.scale) for end in extent)
    of_object = extent is extents[WHOLE]
    is_mapped = has_extent(extent)
    fraction = min(max((intensity - low) / (high - low), 0.0), 1.0) if is_mapped else 0.5
    if not is_mapped:
        mapped = 0.5
    elif scene.mapping == "equalize":
        own = [each.pixels for each in picture.slices if of_object or each.surface_number == at.surface]
        everything = np.concatenate([picture.relative[pixels] for pixels in own]) * picture.scale
        mapped = equalized(everything, low, high, intensity)
    else:
        mapped = curved(scene.mapping, fraction)
    first, levels = image.ranges[at.surface_name]
    surface = scene.surfaces[at.surface - 1]
    bands, scalar = image.bands.get(at.surface_name), None
    darkest = low / high if scene.contrast == "floor" and high > 0 else 0.0
    if bands is not None and scene.scalar is not None:
        scalar = scalar_at(scene, at, bands)
        levels = bands.shades
        darkest = darkest if scene.contrast == "floor" else 0.5
    threshold = ordered_threshold(*at_pixel) if scene.dither == "ordered" and is_mapped else 0.5
    level = math.floor(mapped * (levels - 1) + threshold)
    brightness = darkest + (1 - darkest) * level / (levels - 1) if levels > 1 else 1.0
    paint = surface.paint
    return LevelExplained(
        "object" if of_object else "surface",
        bool(held_name(scene.exposure, at.surface_name)),
        low,
        high,
        fraction,
        mapped,
        threshold,
        level,
        levels,
        first,
        scalar,
        paint.object_color,
        paint.light_color,
        0.0 if scalar is not None else light_share(paint, level, levels),
        brightness,
    )


def word_of(level: LevelExplained) -> int:
    """The word of a level: the first word of the surface, the bands below, and the level."""
    below = 0 if level.scalar is None else level.scalar.band * level.scalar.shades
    return level.first_word + below + level.level


def color_of(level: LevelExplained) -> Color:
    """The color of a level's entry: its colors mixed, darkened, and rounded half up."""
    if level.scalar is not None:
        mixed: Sequence[float] = level.scalar.band_color
    else:
        mixed = between(level.object_color, level.light_color, level.light_share)
    red, green, blue = (math.floor(level.brightness * part + 0.5 + 1e-9) for part in mixed)
    return red, green, blue


def light_share(paint: Paint, level: float, levels: int) -> float:
    """The weight of the light color at a level: N equal steps above the blend level."""
    begin = math.floor(paint.blend * (levels - 1) + 0.5)
    if level <= begin:
        return 0.0
    return (level - begin) / (levels - 1 - begin) * paint.light_percentage / 100


def curved(mapping: str | CurvePoints, fraction: float) -> float:
    """A fraction of the range after a mapping curve that depends on nothing else."""
    if not isinstance(mapping, str):
        return along_points(mapping, fraction)
    curves = {
        "linear": fraction,
        "gamma": fraction ** (1 / 2.2),
        "logarithm": math.log1p(15 * fraction) / math.log(16),
    }
    return curves[mapping]


def equalized(everything: Singles, low: float, high: float, intensity: float) -> float:
    """The share of all intensities above the minimum of a range that are at most as large as an intensity."""
    if intensity >= high:
        return 1.0
    rounding = ROUNDING * high
    above = everything[everything > low + rounding]
    # The maximum counts even if no intensity reaches it.
    is_reached = bool((above >= high - rounding).any())
    return float(np.count_nonzero(above <= intensity + rounding)) / (len(above) + (not is_reached))


def ordered_threshold(line: int, element: int) -> float:
    """The threshold of a pixel, 0 to 1, in the ordered dither of 8 x 8 pixels: Bayer's matrix, 1973."""
    number = 0
    for bit in range(3):
        below, right = line >> bit & 1, element >> bit & 1
        number = 4 * number + ((0, 2), (3, 1))[below][right]
    return (number + 0.5) / 64


# The scalar that colors a surface. See `scalars.computed` for what each scalar is.


def scalar_at(scene: Scene, at: PointExplained, bands: Bands) -> ScalarExplained:
    """The value of the scene's scalar at a point, and its band."""
    scalar = scene.scalar
    assert scalar is not None
    value = scalar_value(scene.mesh, scalar, at)
    number = band_of(value, bands)
    beyond = [scalar.below] * bands.has_below + [scalar.above] * bands.has_above
    colors = [*band_colors(scalar.scale, bands.bands), *beyond, *[scalar.missing] * bands.has_missing]
    color = colors[number]
    assert color is not None
    shown = None if math.isnan(value) else value
    return ScalarExplained(
        scalar.name, shown, bands.low, bands.high, number, bands.bands, bands.shades, color
    )


def scalar_value(mesh: Mesh, scalar: Scalar, at: PointExplained) -> float:
    """The value of a scalar at a point; NaN where it is missing."""
    polygon = at.polygon - 1
    of_mesh = {each.name: each for each in mesh.scalars}.get(scalar.name)
    if of_mesh is not None and of_mesh.of == "polygon":
        return float(of_mesh.values[polygon])
    weights = corner_weights([corner.coordinates for corner in at.corners], at.point)
    if of_mesh is not None:
        values = [float(of_mesh.values[corner.node - 1]) for corner in at.corners]
        return math.nan if any(map(math.isnan, values)) else dot(weights, values)
    if scalar.name in ("x", "y", "z"):
        return at.point["xyz".index(scalar.name)]
    direction = unit(scalar.direction)
    if scalar.name == "distance":
        return dot(direction, at.point)
    if scalar.name == "zebra":
        return zebra_phase(direction, at.reflected_view, scalar.stripes)
    if scalar.name in ("slope", "draft angle"):
        normals = [corner.normal for corner in at.corners]
        normal = [dot(weights, component) for component in zip(*normals, strict=True)]
        along = dot(normal, direction)
        across = length(minus(normal, times(along, direction)))
        upright = math.degrees(math.atan2(across, abs(along)))
        return upright if scalar.name == "slope" else math.degrees(math.atan2(along, across))
    bends = [curvature(scalar.name, mesh, row) for _, row in rows_of_corners(mesh, polygon)]
    return dot(weights, [min(max(each, -LARGEST_SCALAR), LARGEST_SCALAR) for each in bends])


def curvature(name: str, mesh: Mesh, row: int) -> float:
    """A curvature of the mesh at a row of its normals."""
    mean, gaussian = float(mesh.curvatures.mean[row]), float(mesh.curvatures.gaussian[row])
    beyond = math.sqrt(max(mean**2 - gaussian, 0.0))
    curvatures = {
        "mean curvature": mean,
        "gaussian curvature": gaussian,
        "largest curvature": mean + beyond,
        "smallest curvature": mean - beyond,
    }
    return curvatures[name]


def zebra_phase(run: Vector, reflected: Vector, stripes: float) -> float:
    """The phase, 0 to 1, of the long lamp along `run` that a reflected ray meets."""
    least = min(range(3), key=lambda number: abs(run[number]))
    axis = (float(least == 0), float(least == 1), float(least == 2))
    across = unit(minus(axis, times(run[least], run)))
    phase = math.atan2(dot(cross(run, across), reflected), dot(across, reflected)) * stripes / math.pi
    return phase - math.floor(phase)


def corner_weights(corners: Sequence[Vector], point: Vector) -> list[float]:
    """The weights of a polygon's corners at a point in it, which add up to 1.

    The weights of a convex polygon are Wachspress' quotients of areas. A quad with a notch counts as two
    triangles.
    """
    count = len(corners)
    if count < 3:
        return [1 / count] * count
    normal = cross(minus(corners[2], corners[0]), minus(corners[-1], corners[1]))

    def area(a: Vector, b: Vector, c: Vector) -> float:
        return dot(normal, cross(minus(b, a), minus(c, a)))

    turns = [area(corners[at - 1], corners[at], corners[(at + 1) % count]) for at in range(count)]
    if count == 4 and min(turns) < -1e-9 * max(turns):
        notch = turns.index(min(turns))
        around = [corners[(notch + step) % 4] for step in range(4)]
        three = (0, 2, 3) if area(around[0], around[2], point) > 0 else (0, 1, 2)
        within = corner_weights([around[number] for number in three], point)
        weights = [0.0] * 4
        for number, weight in zip(three, within, strict=True):
            weights[(notch + number) % 4] = weight
        return weights
    areas = [max(area(corners[at], corners[(at + 1) % count], point), 0.0) for at in range(count)]
    # The quotient turn / (area before x area after), times the product of all areas.
    products = [
        max(turns[at], 0.0) * math.prod(areas[(at + step) % count] for step in range(1, count - 1))
        for at in range(count)
    ]
    total = math.fsum(products)
    return [each / total if total else 1 / count for each in products]


def band_of(value: float, bands: Bands) -> int:
    """The band of a value; a value beyond a limit by a rounding counts as the limit."""
    low, high = bands.low, bands.high
    rounding = ROUNDING * max(abs(low), abs(high))
    if math.isnan(value):
        return bands.missing
    if value < low - rounding:
        return bands.below
    if value > high + rounding:
        return bands.above
    return min(math.floor(max(value - low, 0.0) / (high - low) * bands.bands), bands.bands - 1)


def band_colors(scale: str | tuple[Color, ...], count: int) -> Iterator[Color]:
    """The colors of the bands from low to high: the scale's colors at equal distances, mixed between."""
    given = [
        ColorKind().accepted(color) for color in (COLOR_SCALES[scale] if isinstance(scale, str) else scale)
    ]
    for band in range(count):
        if isinstance(scale, str) and scale in IN_TURN:
            yield given[band % len(given)]
            continue
        place = band * (len(given) - 1) / max(count - 1, 1)
        below = min(math.floor(place), len(given) - 2)
        mixed = between(given[below], given[below + 1], place - below)
        red, green, blue = (math.floor(part + 0.5) for part in mixed)
        yield red, green, blue


# Vectors.


def plus(a: Sequence[float], b: Sequence[float]) -> Vector:
    """a + b."""
    x, y, z = (one + other for one, other in zip(a, b, strict=True))
    return x, y, z


def minus(a: Sequence[float], b: Sequence[float]) -> Vector:
    """a - b."""
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
