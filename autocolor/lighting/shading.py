"""The two planes of a light: what its light is at each visible point, but for D, S and its intensity.

Paper: "The Lighting Model". The equation of `light` is computed in two planes.

    light(j) = (intensity(j) D) x diffuse plane + (intensity(j) S) x specular plane
    diffuse plane = controls(j) cos(I)
    specular plane = controls(j) cos^N(E)

`shade` fills in the two planes of a light, which takes the time. `mix` weighs and adds them; an edit of D, S
or an intensity needs no more. `illumination` adds up the lights. docs/PERFORMANCE.md has what was measured
and rejected.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Final, NamedTuple

import numpy as np

from autocolor.arrays import LARGEST_SINGLE, NEGLIGIBLE, ROUNDING, Booleans, Singles, underflowing
from autocolor.errors import InputError
from autocolor.immutable import Immutable
from autocolor.lighting.controls import lit_points
from autocolor.lighting.light import (
    CameraLight,
    Rays,
    exact_rays_to,
    least_cosine,
    light_at,
    shares_of,
    specular_factor,
)
from autocolor.lighting.precision import uncertain_factor, uncertain_share
from autocolor.lighting.rays import fast_rays
from autocolor.scene.lights import Light
from autocolor.scene.reflection_models import ReflectionModel
from autocolor.scene.surfaces import Part, Surface
from autocolor.visibility.visible_points import PointChunk, VisiblePoints

DIFFUSE: Final = 0
SPECULAR: Final = 1
"""The rows of the two planes."""

FEW: Final = 0.3
"""The fraction of lit points below which it takes less time to pick them than to compute all points."""

MOST_SPREAD: Final = 100.0
"""The largest concentration whose light counts wherever cos(L) is above 0."""

SurfaceWeights = Mapping[int, tuple[np.float32, np.float32]]
"""The weights of a light's diffuse and specular planes, by surface number."""


@dataclass(frozen=True, eq=False, repr=False)
class LightPlanes(Immutable):
    """The contribution of one light to the visible points, in their order; read-only in a picture.

    `values` is (2, n) float32: the diffuse and the specular plane, without D, S and the light's intensity.
    `weights` are their weights in the picture. `mixed`, (n,) float32, is their weighted sum, or None. It is
    cached for a light that stays while other lights are edited.
    """

    values: Singles
    weights: SurfaceWeights
    mixed: Singles | None = None


@underflowing
def shade(
    planes: Singles,
    light: CameraLight,
    points: VisiblePoints,
    chunk: PointChunk,
    models: Mapping[int, ReflectionModel],
) -> None:
    """Fill in the diffuse and the specular plane of a light at a chunk of points.

    `planes` is (2, n) float32, in the order of the points; 0 where the light has no effect. `models` has the
    reflection model of each visible surface number.
    """
    out, rows = planes[:, chunk.pixels], points.rows[:, chunk.pixels]
    is_lit = lit_points(light.row, light.sides, points, rows, chunk.pixels)
    if is_lit is not None and not is_lit.any():
        out[:] = 0
        return

    # Find the points that face the light and may be within its controls.
    rays, rounding = fast_rays(light, rows, points.radius)
    facing = rays.cos_incidence > 0
    is_lit = facing if is_lit is None else np.logical_and(is_lit, facing, out=is_lit)
    if light.reach is not None:
        is_lit &= rays.length < light.reach
    if rays.cos_light is not None:
        is_lit &= rays.cos_light >= np.float32(_least_cosine(light.row) - rounding - ROUNDING)
    count = np.count_nonzero(is_lit)
    if not count:
        out[:] = 0
        return

    # Reflect the light there, which is within all sharp sides. Where few points are lit, compute only them.
    light = light._replace(sides=tuple(side for side in light.sides if side.edge_width > 0))
    ends = [each.stop for each in chunk.slices]
    of_surfaces = [models[each.surface_number] for each in chunk.slices]
    if count >= FEW * len(is_lit):
        _reflect(out, light, rays, is_lit, ends, of_surfaces, rounding)
        return
    chosen = np.flatnonzero(is_lit)
    reflected = np.empty((2, count), np.float32)
    ends = np.searchsorted(chosen, ends).tolist()
    _reflect(reflected, light, rays.at(chosen), None, ends, of_surfaces, rounding)
    out[:] = 0
    for plane, values in zip(out, reflected, strict=True):
        plane[chosen] = values


def _least_cosine(light: Light) -> float:
    """A cos(L) below which nothing of a directed light is left, or a negligible share."""
    least = -1.0 if light.cone_angle is None else least_cosine(light.cone_angle)
    if light.concentration > MOST_SPREAD:
        least = max(least, math.exp(-NEGLIGIBLE / light.concentration))
    elif light.concentration > 0:
        least = max(least, 0.0)
    return least


def _reflect(
    out: Singles,
    light: CameraLight,
    rays: Rays,
    is_lit: Booleans | None,
    ends: Sequence[int],
    models: Sequence[ReflectionModel],
    rounding: float,
) -> None:
    """Fill in both planes at some points; 0 where `is_lit` is false.

    The surfaces of the points end at `ends` and have these `models`. Points at which `rounding` counts
    are computed again by the definitions: the specular plane only, if it counts in the factor alone.
    """
    share = None if is_lit is None or is_lit.all() else is_lit.astype(np.float32)
    for _, left in shares_of(light, rays):
        share = left if share is None else np.multiply(share, left, out=share)
    of_share = uncertain_share(light, rays, rounding)
    again = np.zeros(out.shape[1], np.bool_) if of_share is None else of_share.copy()
    for (start, end), model in zip(pairwise([0, *ends]), models, strict=True):
        if start == end:
            continue
        here = slice(start, end)
        some, planes = rays.at(here), out[:, here]
        factor = specular_factor(model, some)
        if share is None:
            planes[DIFFUSE], planes[SPECULAR] = some.cos_incidence, factor
        else:
            np.multiply(some.cos_incidence, share[here], out=planes[DIFFUSE])
            np.multiply(factor, share[here], out=planes[SPECULAR])
        of_factor = uncertain_factor(model, some, factor, rounding)
        if of_factor is not None:
            again[here] |= of_factor

    # Compute the uncertain points again.
    places = np.flatnonzero(again if is_lit is None else np.logical_and(again, is_lit, out=again))
    if len(places):
        exact = exact_rays_to(light, rays.at(places).vectors(slice(None)))
        bounds = pairwise(np.searchsorted(places, [0, *ends]).tolist())
        factors = [
            specular_factor(model, exact.at(slice(start, end)))
            for (start, end), model in zip(bounds, models, strict=True)
            if start < end
        ]
        computed = light_at(light, exact, np.concatenate(factors))
        out[SPECULAR, places] = computed[SPECULAR]
        if of_share is not None:
            of_share = of_share[places]
            out[DIFFUSE, places[of_share]] = computed[DIFFUSE, of_share]


@underflowing
def mix(planes: LightPlanes, chunk: PointChunk, out: Singles) -> None:
    """Write the weighted sum of a light's two planes at a chunk of points to `out`."""
    values = planes.values[:, chunk.pixels]
    for surface in chunk.slices:
        pair = np.array(planes.weights[surface.surface_number])
        np.matmul(pair, values[:, surface.pixels], out=out[surface.pixels])


class LightMix(NamedTuple):
    """The weights of the ambient term and of the planes of each light that shines, relative to `scale`.

    The scale is the largest weight, and only the sum is multiplied by it. So lights k times as strong give
    the same relative sum, and rounding changes no level. On surfaces to which a light is not linked, its
    weights are 0. Its planes are computed on all surfaces, so that changing a link only costs the sum.
    """

    scale: float
    ambient: np.float32
    lights: Mapping[str, SurfaceWeights]


def light_mix(
    models: Mapping[int, ReflectionModel],
    surfaces: Sequence[Surface],
    lights: Sequence[Light],
    ambient: float,
    parts: Sequence[Part],
) -> LightMix:
    """The mix of the lights that shine; `models` has the reflection model of each visible surface number.

    `parts` are the parts of the scene: a light that is linked to parts shines on their surfaces only. Raises
    InputError if the sum would leave the range of float32: such an intensity is refused by name, never
    clipped into a level.
    """
    if not ambient < LARGEST_SINGLE:
        raise InputError(f"ambient must stay below {LARGEST_SINGLE:.3g}, not {ambient:g}; lower it")
    visible = {number: surfaces[number - 1] for number in models}
    strengths = {light.name: _strengths(light, visible, parts) for light in lights if light.shines}
    for number, surface in visible.items():
        largest = models[number].largest
        peaks = {name: rows[number][0] + rows[number][1] * largest for name, rows in strengths.items()}
        total = ambient + sum(peaks.values())
        if not total < LARGEST_SINGLE:
            strongest = max(peaks, key=lambda name: peaks[name])
            raise InputError(
                f"surface {surface.name!r} under light {strongest!r}: intensities must stay below"
                f" {LARGEST_SINGLE:.3g}, not reach {total:g}; lower the light's intensity"
            )
    all_strengths = [each for rows in strengths.values() for pair in rows.values() for each in pair]
    scale = max([ambient, *all_strengths]) or 1.0
    weights = {
        name: {
            number: (np.float32(diffuse / scale), np.float32(specular / scale))
            for number, (diffuse, specular) in rows.items()
        }
        for name, rows in strengths.items()
    }
    return LightMix(scale, np.float32(ambient / scale), weights)


def _strengths(
    light: Light, visible: Mapping[int, Surface], parts: Sequence[Part]
) -> dict[int, tuple[float, float]]:
    """The light's intensity times D and S by number of the visible surfaces; 0 where it does not shine."""
    links, lit = light.links, {surface.name for surface in visible.values()}
    if links.depend_on_parts:
        lit_parts = links.lit_parts(part.name for part in parts)
        lit &= {part.surface for part in parts if part.name in lit_parts}
    strengths = {}
    for number, surface in visible.items():
        is_lit = surface.name in lit and links.shines_on_surface(surface.name)
        intensity = light.intensity if is_lit else 0.0
        strengths[number] = intensity * surface.reflectance.diffuse, intensity * surface.reflectance.specular
    return strengths
