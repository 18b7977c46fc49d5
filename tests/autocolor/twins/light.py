"""The controls and the specular factors of a light at a point, in Python's floats, from the paper alone."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise
from typing import Final

from autocolor.checks import Vector
from autocolor.scene.following import detached
from autocolor.scene.lights import Light
from autocolor.scene.reflection_models import (
    BlinnPhong,
    CookTorrance,
    Phong,
    ReflectionModel,
    SpecularGrowth,
)
from autocolor.scene.scene import Scene
from tests.autocolor.twins.point import PointExplained, dot, length, minus, plus, times, unit

ON_THE_EDGE: Final = 1e-9
"""Assumed: a point this close to the edge of a control, as a fraction of the sizes, counts as on the edge.

A floor that lies in the plane of a flap is lit, whichever way its points are rounded."""

GRAZING: Final = 5e-7
"""Assumed: the largest cos(I) that parallel rays along a flat surface have by the rounding of its normals."""


def contribution(light: Light, scene: Scene, at: PointExplained) -> float:
    """What a light of the world adds to the intensity at a point: Figure 2 with all controls and links."""
    to_light, links = direction_to(light, at.point), light.links
    cos_incidence = dot(at.normal, to_light)
    shines = links.shines_on_surface(at.surface_name) and (
        not links.depend_on_parts or links.lit_parts([at.part_name])
    )
    if cos_incidence <= (GRAZING if light.at_infinity else 0.0) or not shines:
        return 0.0
    to_eye = unit(minus(scene.view.eye, at.point))
    reflectance = at.reflectance
    factor = specular_factor(reflectance.model, to_light, at.normal, to_eye)
    share = light.intensity * math.prod(controls_at(light, at.point, scene).values())
    return share * (reflectance.diffuse * cos_incidence + reflectance.specular * factor)


def direction_to(light: Light, point: Sequence[float]) -> Vector:
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
            shares["concentration"] = power(cos_light, light.concentration)
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


def specular_factor(
    model: ReflectionModel, light: Sequence[float], normal: Sequence[float], eye: Sequence[float]
) -> float:
    """The factor in the place of cos^N(E) under a model, for unit vectors to the light and to the eye.

    The models are described in `scene.reflection_models`.
    """
    n_l, n_v = dot(normal, light), dot(normal, eye)
    half = unit(plus(light, eye))
    n_h, v_h = dot(normal, half), dot(eye, half)
    if isinstance(model, Phong):
        reflected = minus(times(2 * n_v, normal), eye)
        return specular_growth(model.growth, n_l) * power(dot(reflected, light), model.exponent)
    if isinstance(model, BlinnPhong):
        return specular_growth(model.growth, n_l) * power(n_h, model.exponent)
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


def power(cosine: float, exponent: float) -> float:
    """A cosine to a power, 0 to 1. A negative cosine counts as 0, and 1 may be exceeded by rounding."""
    return math.pow(min(max(cosine, 0.0), 1.0), exponent)


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
