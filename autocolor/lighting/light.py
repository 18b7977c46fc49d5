"""The light equation at some points, plainly, for arrays of any float type.

Paper: Figures 1 to 3, "The Lighting Model", "Light Direction and Concentration", "Light Flaps and Cones". The
intensity at a point is

    ambient + sum over the lights j of  light(j)
    light(j) = intensity(j) x controls(j) x (D cos(I) + S cos^N(E))

I is the angle between the normal and the ray to the light, E the angle between that ray and the view mirrored
in the surface, and L the angle between the light's direction and the ray from the light. D, S and N are the
surface's. A light gives nothing where cos(I) <= 0. Each control of a light multiplies it by a share, 0 to 1:
cos^C(L) for the concentration C, and for a cone of the angle A, 1 where L <= A and 0 beyond. A power of a
negative cosine is 0.

`rays_to` has the cosines, and `light_at` has both terms of a light without its intensity, D and S, in one
place for the renderer and for the explanation of a pixel. `controls.py` has the shares of flaps, soft edges
and falloff, and `scene.reflection_models` has the factors that take the place of cos^N(E). `rays.py` computes
the same cosines faster, and `precision.py` finds the points where that is not exact enough.
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
"""The least distance of a point from a light, in units. Its square is not 0 in float32."""

GRAZING: Final = 5e-7
"""Parallel rays often run along a flat surface and do not light it. A cosine up to this is rounding."""

RIM: Final = 2e-7
"""Assumed: the radians by which a cone is wider, so that a rim along a line of pixels does not fray."""


class CameraLight(NamedTuple):
    """A light ready for the visible points of one view, in camera space around their origin, in their unit.

    `row` is the `Light` of the scene, with its concentration C and cone angle A. `axis` is the unit vector of
    its direction, (3,) like `position`; None if neither a concentration nor a cone needs it. A light at
    infinity is very far away, against its direction. `sides` are the lit sides of its flaps and half-spaces.
    `reach` is for `falloff_share`.
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
    cos_incidence: RealArray[Any]
    cos_eye: RealArray[Any]
    cos_light: RealArray[Any] | None
    rows: RealArray[Any]
    places: Indices | None = None

    def vectors(self, which: slice) -> RealArray[Any]:
        """The points, normals or reflected views, (3, k)."""
        rows = self.rows[which]
        return rows if self.places is None else columns(rows, self.places)

    @cached_property
    def cos_view(self) -> RealArray[Any]:
        """The cosine of the angle between the normal and the direction to the eye or the reflected view."""
        return dot(self.vectors(NORMAL), self.vectors(REFLECTED_VIEW))

    def at(self, some: Indices | slice) -> Rays:
        """The rays from some of the points."""
        light = None if self.cos_light is None else self.cos_light[some]
        rows, places = self.rows, self.places
        if places is not None:
            places = places[some]
        elif isinstance(some, slice):
            rows = rows[:, some]
        else:
            places = some
        return Rays(self.length[some], self.cos_incidence[some], self.cos_eye[some], light, rows, places)


def rays_to(light: CameraLight, rows: RealArray[Any]) -> Rays:
    """The rays to a light from the points in some rows, as in `VisiblePoints.rows`; float64.

    Departs: a light may be at infinity, with parallel rays; the paper has no such light. Its cos(L) is 1
    everywhere, so that concentration and cones leave all of it.
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
    """`rays_to`, with normals and reflected views that are normalized again in float64."""
    exact = rows.astype(np.float64)
    for vectors in (exact[NORMAL], exact[REFLECTED_VIEW]):
        vectors[:] = normalized(vectors)
    return rays_to(light, exact)


def light_at(light: CameraLight, rays: Rays, factor: RealArray[Any]) -> RealArray[Any]:
    """Controls x cos(I) and controls x `factor` at some points, (2, k); 0 where cos(I) <= 0.

    `factor`, (k,), is from `specular_factor`.
    """
    share = (rays.cos_incidence > 0).astype(rays.cos_incidence.dtype)
    for _, left in shares_of(light, rays):
        share *= left
    return np.stack([share * rays.cos_incidence, share * factor])


def specular_factor(model: ReflectionModel, rays: Rays) -> RealArray[Any]:
    """Phong's cos^N(E), (k,), with the growth of S with I, if any; or the factor of another model."""
    if isinstance(model, Phong):
        return model.grown(power(rays.cos_eye, model.exponent), rays.cos_incidence)
    return model.specular(rays.cos_incidence, rays.cos_eye, rays.cos_view)


def shares_of(light: CameraLight, rays: Rays) -> Iterator[tuple[str, RealArray[Any]]]:
    """The share of the light that each of its controls leaves, (k,), by the control's name."""
    row = light.row
    if rays.cos_light is not None and row.concentration > 0:
        yield "concentration", power(rays.cos_light, row.concentration)
    if light.reach is not None:
        yield "falloff", falloff_share(row, light.reach, rays.length)
    if rays.cos_light is not None and row.cone_angle is not None:
        if row.inner_angle is not None and row.inner_angle < row.cone_angle:
            yield "cone", soft_cone_share(rays.cos_light, row.inner_angle, row.cone_angle)
        else:
            yield "cone", is_within(rays, row.cone_angle).astype(rays.cos_light.dtype)
    for side in light.sides:
        yield side.name, edge_share(side, rays.vectors(POINT))


def is_within(rays: Rays, cone_angle: float) -> Booleans:
    """Whether each point is within a cone: L <= A, with RIM and the rounding of cos(L). The rim is lit.

    Departs: the paper prints the test as cos(L) <= cos(A), which would light the outside of the cone. A cone
    of more than 90 degrees also lights behind the light if C = 0; otherwise cos^C(L) is 0 there.
    """
    assert rays.cos_light is not None
    within: Booleans = rays.cos_light >= least_cosine(cone_angle) - np.finfo(rays.cos_light.dtype).eps
    return within


def least_cosine(cone_angle: float) -> float:
    """The cosine of the angle of a cone that is wider by RIM."""
    return math.cos(min(math.radians(cone_angle) + RIM, math.pi))
