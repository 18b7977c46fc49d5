"""Slow, obvious twins, made from the paper and from a scene's values alone: no function of the renderer's.

Every formula is written for one point, one intensity or one level, in plain Python floats. More such twins
are beside, in `twins`.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from fractions import Fraction
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from autocolor import Light, Mesh, Paint, Reflectance, View
from tests.autocolor.twins.light import direction_to, edge_share
from tests.autocolor.twins.point import cross, dot, minus, plus, times, unit

Vector = Sequence[float]

WORLD_AXES: list[Vector] = [(1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)]


def ray(view: View, lines: int, elements: int, line: int, element: int) -> tuple[float, float, float]:
    """The direction from the eye through the center of a pixel, as long as it is 1 deep."""
    assert view.direction is not None or view.target is not None
    toward = view.direction if view.direction is not None else minus(view.target or (), view.eye)
    forward = unit(toward)
    up = [0.0, 0.0, 1.0] if abs(forward[2]) < 1 - 1e-15 else [0.0, 1.0, 0.0]
    right = unit(cross(forward, up))
    top = cross(right, forward)
    # The horizontal axis of the picture plane turned by the angle.
    angle = math.radians(view.angle)
    across_axis = plus(times(math.cos(angle), right), times(math.sin(angle), top))
    up_axis = plus(times(math.cos(angle), top), times(-math.sin(angle), right))
    # A picture narrower than 4:3 is as wide as a picture of 4:3.
    pixel = 2 * math.tan(math.radians(view.field_of_view) / 2) / min(lines, 0.75 * elements)
    across = (element + 0.5 - elements / 2) * pixel
    up_by = (lines / 2 - line - 0.5) * pixel
    return plus(forward, plus(times(across, across_axis), times(up_by, up_axis)))


class Lit(NamedTuple):
    """What one light gives at a point, and how far the point is from where that would jump."""

    intensity: float
    from_jump: float


def light_at(light: Light, point: Vector, normal: Vector, eye: Vector, reflectance: Reflectance) -> Lit:
    """The light that reaches the eye: the paper's formula with all of its controls.

    `from_jump` is the least of the differences that decide: of cosines, and of distances from planes.
    """
    if not light.on:
        return Lit(0.0, math.inf)
    left = controlled(light, point)
    # Figure 1: the angle of incidence I.
    to_light = direction_to(light, point)
    cos_i = dot(normal, to_light)
    from_jump = min(left.from_jump, abs(cos_i))
    if left.intensity == 0 or cos_i <= 0:
        return Lit(0.0, from_jump)
    # Figure 2: the angle E between the reflected ray and the ray to the eye.
    reflected = minus(times(2 * cos_i, normal), to_light)
    cos_e = max(dot(reflected, unit(minus(eye, point))), 0.0)
    both = reflectance.diffuse * cos_i + reflectance.specular * cos_e**reflectance.exponent
    return Lit(left.intensity * light.intensity * both, from_jump)


def controlled(light: Light, point: Vector) -> Lit:
    """What all controls leave of a light of intensity 1 at a point."""
    jumps = [math.inf]
    to_light = direction_to(light, point)
    multiplier = 1.0
    toward = light.direction
    if light.aim is not None:
        toward = tuple(minus(light.aim, light.position))  # type: ignore[assignment]
    # Figure 9: the flaps that are on.
    inside: list[tuple[float, float]] = []
    for coordinate, flap in zip(point, (light.flaps.x, light.flaps.y, light.flaps.z), strict=True):
        if flap is not None and flap.on:
            inside.append((coordinate - flap.minimum, flap.edge_width))
            inside.append((flap.maximum - coordinate, flap.edge_width))
    # The half-spaces that are on; those that are carried have the light's axes.
    for half_space in light.half_spaces:
        if half_space.on:
            from_plane = minus(point, half_space.point)
            if half_space.carried:
                axes = WORLD_AXES if toward is None else frame(toward)
                from_light = minus(point, light.position)
                from_plane = minus([dot(axis, from_light) for axis in axes], half_space.point)
            inside.append((dot(from_plane, unit(half_space.direction)), half_space.edge_width))
    for distance, width in inside:
        jumps.append(abs(distance))
        multiplier *= edge_share(distance, width)
    # Figure 3: the angle L between the light's direction and the ray from the light to the point.
    if toward is not None:
        cos_l = -dot(unit(toward), to_light)
        if light.concentration > 0:
            multiplier *= max(cos_l, 0.0) ** light.concentration
            if light.concentration < 1:
                jumps.append(abs(cos_l))
        # Figure 10: the cone angle A, and the inner angle of a soft one.
        if light.cone_angle is not None:
            rim = math.cos(math.radians(light.cone_angle))
            inner = rim if light.inner_angle is None else math.cos(math.radians(light.inner_angle))
            multiplier *= edge_share(cos_l - rim, inner - rim)
            if light.cone_angle < 180:
                jumps.append(abs(cos_l - rim))
    if light.falloff != "none":
        assert light.reach is not None
        left = max(1 - math.dist(light.position, point) / light.reach, 0.0)
        multiplier *= left if light.falloff == "linear" else left * left
    return Lit(multiplier, min(jumps))


def frame(toward: Vector) -> list[Vector]:
    """The axes of a light: horizontal to the right of its direction, along it, and up."""
    x, y, z = along = unit(toward)
    right = unit((y, -x, 0.0) if x or y else (-z, 0.0, x))
    return [right, along, cross(right, along)]


def level_of(fraction: float, levels: int) -> int:
    """The level of a fraction of a range, halves up."""
    return math.floor(fraction * (levels - 1) + 0.5)


def entry_of(paint: Paint, levels: int, level: float, floor: float = 0.0) -> tuple[int, ...]:
    """One entry of a range: a color of the ramp; or (Figure 12) the two colors mixed and then darkened."""
    if paint.ramp is not None:
        place = Fraction(level) * (len(paint.ramp) - 1) / (levels - 1) if levels > 1 else Fraction(0)
        below, above = paint.ramp[math.floor(place)], paint.ramp[math.ceil(place)]
        share = place - math.floor(place)
        return tuple(
            math.floor((1 - share) * one + share * other + Fraction(1, 2))
            for one, other in zip(below, above, strict=True)
        )
    begin = math.floor(paint.blend * (levels - 1) + 0.5)
    shift = 0.0
    if level > begin:
        shift = (level - begin) / (levels - 1 - begin) * paint.light_percentage / 100
    brightness = floor + (1 - floor) * level / (levels - 1)
    return tuple(
        math.floor(brightness * ((1 - shift) * surface + shift * light) + 0.5 + 1e-9)
        for surface, light in zip(paint.object_color, paint.light_color, strict=True)
    )


def divided(levels: Sequence[int | None]) -> list[tuple[int, int]]:
    """First word and levels of each surface in equal shares: 1024 less the background and the screens' 16."""
    left = 1024 - 1 - 16 - sum(count for count in levels if count is not None)
    share = left // max(sum(1 for count in levels if count is None), 1)
    ranges: list[tuple[int, int]] = []
    first = 1
    for count in levels:
        ranges.append((first, share if count is None else count))
        first += ranges[-1][1]
    return ranges


class Hit(NamedTuple):
    """The polygon that a ray meets first, its distance, and how clear that is: 0 is a tie or an edge."""

    polygon: int
    depth: float
    clear: float


def first_hit(mesh: Mesh, eye: Vector, direction: Vector) -> Hit:
    """Brute force: the ray against every triangle of the mesh, each quad as two; polygon -1 for none."""
    best = Hit(-1, math.inf, math.inf)
    clear = math.inf
    for number, depth, inside in _meetings(mesh, np.array(eye), np.array(direction)):
        clear = min(clear, abs(inside))
        if inside < 0:
            continue
        clear = min(clear, abs(depth - best.depth) / depth)
        if depth < best.depth:
            best = Hit(number, depth, 0.0)
    return best._replace(clear=clear)


def _meetings(
    mesh: Mesh, eye: npt.NDArray[np.float64], direction: npt.NDArray[np.float64]
) -> list[tuple[int, float, float]]:
    """Polygon, depth and least barycentric coordinate where the ray meets each triangle's plane."""
    corners = mesh.coordinates[mesh.node_numbers[:, [0, 1, 2, 0, 2, 3]]].reshape(-1, 3, 3)
    number = np.repeat(np.arange(len(mesh.node_numbers)), 2)
    columns = np.stack(
        [
            corners[:, 0] - corners[:, 1],
            corners[:, 0] - corners[:, 2],
            np.broadcast_to(direction, corners[:, 0].shape),
        ],
        axis=2,
    )
    real = np.abs(np.linalg.det(columns)) > 1e-9
    second, third, depth = np.linalg.solve(columns[real], (corners[real, 0] - eye)[..., None])[..., 0].T
    inside = np.minimum(np.minimum(second, third), 1 - second - third)
    before = depth > 0
    rows = (number[real][before], depth[before], inside[before])
    return list(zip(*(row.tolist() for row in rows), strict=True))


def trimmed(intensities: Sequence[float], percentage: str) -> tuple[float, float]:
    """The range of intensities without the brightest, at least as wide as from 0.6 to 1 of its maximum."""
    rising = sorted(intensities)
    left_out = math.floor(len(rising) * (100 - Fraction(percentage.removesuffix(" %"))) / 100)
    maximum = rising[len(rising) - 1 - left_out]
    if maximum - rising[0] <= 2.0**-20 * maximum:
        maximum = rising[-1]
    return min(rising[0], 0.6 * maximum), maximum


class OnTriangle(NamedTuple):
    """Where a ray meets a quad of two triangles: depth, weights of the corners, whether it meets the front.

    `clear` is the least distance, in weights, from a side of a triangle.
    """

    depth: float
    weights: list[float]
    meets_front: bool
    clear: float


def on_triangles(corners: Sequence[Vector], start: int, eye: Vector, direction: Vector) -> OnTriangle | None:
    """Where a ray first meets a quad that is cut from corner `start` to the opposite corner, or None."""
    hits, clear = [], math.inf
    for places in ([start, start + 1, start + 2], [start + 2, start + 3, start]):
        places = [place % 4 for place in places]
        first, second, third = (corners[place] for place in places)
        along, across, away = minus(second, first), minus(third, first), minus(eye, first)
        normal = cross(along, across)
        slope = dot(direction, normal)
        if abs(slope) < 1e-3 * math.sqrt(dot(normal, normal)) or dot(normal, normal) < 1e-12:
            return None
        depth = -dot(away, normal) / slope
        from_first = plus(away, times(depth, direction))
        weight = dot(cross(from_first, across), normal) / dot(normal, normal)
        other = dot(cross(along, from_first), normal) / dot(normal, normal)
        of_three = [1 - weight - other, weight, other]
        clear = min(clear, *map(abs, of_three))
        if depth > 0 and min(of_three) >= 0:
            weights = [0.0] * 4
            for place, share in zip(places, of_three, strict=True):
                weights[place] = share
            hits.append(OnTriangle(depth, weights, slope < 0, 0.0))
    return min(hits)._replace(clear=clear) if hits else None
