"""The light equation at some points, plainly, for arrays of any float type.

Paper: Figures 1 to 3, "The Lighting Model", "Light Direction and Concentration", "Light Flaps and Cones". The
intensity at a point is

    ambient + sum over the lights j of  light(j)
    light(j) = intensity(j) x controls(j) x (D cos(I) + S cos^N(E))

I is the angle between the normal and the ray to the light, E the angle between that ray and the view as the
surface reflects it, and L the angle between the light's direction and the ray from the light. D, S and N are
the surface's. A light gives nothing where cos(I) <= 0. Its controls leave a share of it, 0 to 1: cos^C(L) for
the concentration C, and for a cone of the angle A all of the light where L <= A and none beyond. A negative
cosine has the power 0.

`rays_to` has the cosines, and `light_at` is this equation without intensity, D and S, in one place for the
renderer and for the explanation of a pixel. `controls` has what flaps, soft edges and falloff leave, and
`scene.reflection_models` has other factors in the place of cos^N(E). `rays` computes the same cosines faster,
and `precision` finds the points where that is not exact enough.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Final, NamedTuple

import numpy as np

from autocolor.arrays import Booleans, Floats, Indices, RealArray, columns, dot, lengths, normalized, power
from autocolor.lighting.controls import LitSide, edge_share, falloff_share, soft_cone_share
from autocolor.scene.lights import Light
from autocolor.scene.reflection_models import Phong, ReflectionModel
from autocolor.visibility.visible_points import NORMAL, POINT, REFLECTED_VIEW

LEAST_DISTANCE: Final = 3e-19
"""The least distance of a point from a light, in units, so that none is 0; float32 holds its square."""

GRAZING: Final = 5e-7
"""A cosine above its rounding. Parallel rays often run along a flat surface, which they do not light."""

RIM: Final = 2e-7
"""Assumed: in radians. A cone is wider by this, so that a rim along a line of pixels does not fray."""


class CameraLight(NamedTuple):
    """A light ready for the visible points of one view, in camera space around their origin, in their unit.

    `row` is the light of the scene, with its concentration C and its cone angle A. `axis` is the unit vector
    of its direction, (3,) like `position`; None if neither a concentration nor a cone needs it. A light at
    infinity is FARTHEST away, against its axis. `sides` are the lit sides of its flaps and half-spaces, and
    `reach` is that of its falloff.
    """

    row: Light
    position: Floats
    axis: Floats | None
    sides: tuple[LitSide, ...] = ()
    reach: float | None = None


@dataclass(frozen=True, eq=False)
class Rays:
    """The rays from k points to a light: their lengths, cos(I), cos(E) and, with an axis, cos(L), (k,) each.

    `rows` are the points with their normals and reflected views, as in `VisiblePoints.rows`, and `places` the
    columns of the k points; None for all columns.
    """

    length: RealArray[Any]
    incidence: RealArray[Any]
    eye: RealArray[Any]
    light: RealArray[Any] | None
    rows: RealArray[Any]
    places: Indices | None = None

    def vectors(self, which: slice) -> RealArray[Any]:
        """The points, normals or reflected views, (3, k)."""
        rows = self.rows[which]
        return rows if self.places is None else columns(rows, self.places)

    @cached_property
    def view(self) -> RealArray[Any]:
        """The cosine of the normal and the direction to the eye, which is that of the reflected view."""
        return dot(self.vectors(NORMAL), self.vectors(REFLECTED_VIEW))

    def at(self, some: Indices | slice) -> Rays:
        """The rays from some of the points."""
        light = None if self.light is None else self.light[some]
        rows, places = self.rows, self.places
        if places is not None:
            places = places[some]
        elif isinstance(some, slice):
            rows = rows[:, some]
        else:
            places = some
        return Rays(self.length[some], self.incidence[some], self.eye[some], light, rows, places)


def rays_to(light: CameraLight, rows: RealArray[Any]) -> Rays:
    """The rays to a light from the points in some rows, as in `VisiblePoints.rows`; float64.

    Departs: the rays to a light at infinity are parallel; the paper has no such light. There cos(L) is 1
    everywhere, so that concentration and cones leave all of the light.
    """
    to_light = light.position[:, None] - rows[POINT]
    length = np.maximum(lengths(to_light), LEAST_DISTANCE)
    to_light /= length
    cos_incidence, cos_eye = dot(rows[NORMAL], to_light), dot(rows[REFLECTED_VIEW], to_light)
    cos_light = None if light.axis is None else -(light.axis @ to_light)
    if light.row.at_infinity:
        for cosines in (cos_incidence, cos_eye):
            cosines[np.abs(cosines) <= GRAZING] = 0
        cos_light = None if cos_light is None else np.ones_like(cos_light)
    return Rays(length, cos_incidence, cos_eye, cos_light, rows)


def exact_rays_to(light: CameraLight, rows: RealArray[Any]) -> Rays:
    """The same, with normals and reflected views whose lengths are not rounded to float32."""
    exact = rows.astype(np.float64)
    for vectors in (exact[NORMAL], exact[REFLECTED_VIEW]):
        vectors[:] = normalized(vectors)
    return rays_to(light, exact)


def light_at(light: CameraLight, rays: Rays, factor: RealArray[Any]) -> RealArray[Any]:
    """Controls x cos(I) and controls x cos^N(E) at some points, (2, k); 0 where cos(I) <= 0.

    `factor` is cos^N(E), (k,), from `specular_factor`.
    """
    share = (rays.incidence > 0).astype(rays.incidence.dtype)
    for _, left in shares_of(light, rays):
        share *= left
    return np.stack([share * rays.incidence, share * factor])


def specular_factor(model: ReflectionModel, rays: Rays) -> RealArray[Any]:
    """cos^N(E), (k,): Phong's model, whose S may grow with cos(I). Other models have other factors."""
    if isinstance(model, Phong):
        return model.grown(power(rays.eye, model.exponent), rays.incidence)
    return model.specular(rays.incidence, rays.eye, rays.view)


def shares_of(light: CameraLight, rays: Rays) -> Iterator[tuple[str, RealArray[Any]]]:
    """The share of the light that each of its controls leaves, (k,), by the control's name."""
    row = light.row
    if rays.light is not None and row.concentration > 0:
        yield "concentration", power(rays.light, row.concentration)
    if light.reach is not None:
        yield "falloff", falloff_share(row, light.reach, rays.length)
    if rays.light is not None and row.cone_angle is not None:
        if row.inner_angle is not None and row.inner_angle < row.cone_angle:
            yield "cone", soft_cone_share(rays.light, row.inner_angle, row.cone_angle)
        else:
            yield "cone", is_within(rays, row.cone_angle).astype(rays.light.dtype)
    for side in light.sides:
        yield side.name, edge_share(side, rays.vectors(POINT))


def is_within(rays: Rays, cone_angle: float) -> Booleans:
    """Whether each point is within a cone: cos(L) >= cos(A). The rim is lit.

    Departs: the paper prints the test as cos(L) <= cos(A), which would light the outside. With C = 0 nothing
    is dark behind the light, so a cone of more than 90 degrees lights there too.
    """
    assert rays.light is not None
    within: Booleans = rays.light >= least_cosine(cone_angle) - np.finfo(rays.light.dtype).eps
    return within


def least_cosine(cone_angle: float) -> float:
    """The least cos(L) that a cone lights."""
    return math.cos(min(math.radians(cone_angle) + RIM, math.pi))
