"""The light equation: the contribution of each light to the intensity at a visible point.

Paper: Figure 2, and "The Lighting Model". The intensity at a point is

    ambient + sum over the lights j of  light(j)
    light(j) = intensity(j) x controls(j) x (D cos(I) + S cos^N(E))

I is the angle between the normal and the direction to the light, and E the angle between the direction to the
light and the reflected view. D, S and N are the surface's; a light gives nothing where cos(I) <= 0. The light
controls leave a share of the light, 0 to 1 (see `controls`). Another reflection model has its own factor in
the place of cos^N(E) (see `scene.reflection_models`).

The equation is computed as

    light(j) = (intensity(j) D) x diffuse plane + (intensity(j) S) x specular plane
    diffuse plane = controls(j) cos(I)
    specular plane = controls(j) cos^N(E)

`shade` fills in the two planes of a light, which takes the time. `mix` weighs and adds them; an edit of D, S
or an intensity needs no more. `illumination` adds up the lights.

Measured and rejected: one surface after another (a tenth longer on the coupe, whose smaller surfaces are
hardly worth the calls); fewer points at once than 131,072 (a tenth more at a quarter of that); two threads,
each on half of the points (as long as one: what they compute they must fetch from memory, and between any two
calls they wait for the interpreter); two processes (two thirds of the time of one, for a second copy of
everything); the cosines of all lights as one matrix product (a twentieth less, but nothing says that it
rounds as the product of one light does, and an edit must give the same bits as a fresh picture).
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Final, NamedTuple

import numpy as np

from autocolor.arrays import (
    LARGEST_SINGLE,
    ROUNDING,
    Booleans,
    ExactLogarithms,
    Indices,
    Singles,
    columns,
    dot,
    underflowing,
)
from autocolor.errors import InputError
from autocolor.immutable import Immutable
from autocolor.lighting.controls import ExactLight, LightControl, LitPoints, controls_of, within
from autocolor.lighting.rays import CameraLight, Rays, camera_light, rays_to
from autocolor.scene.lights import Light
from autocolor.scene.reflection_models import Cosines, ExactVectors, ReflectionModel
from autocolor.scene.surfaces import Part, Surface
from autocolor.visibility.visible_points import NORMAL, POINT, REFLECTED_VIEW, PointChunk, VisiblePoints

DIFFUSE: Final = 0
SPECULAR: Final = 1
"""The rows of the two planes."""

FEW: Final = 0.3
"""The fraction of lit points below which it takes less time to pick them than to compute all points."""

ROUNDING_OF_EYE: Final = 4.7 * ROUNDING
"""Measured: cos(E) is at least so uncertain, because the rounding of a reflected view changes its length."""

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


class ControlledLight(NamedTuple):
    """A light in camera space and its controls, ready for the visible points of one view."""

    light: CameraLight
    controls: tuple[LightControl, ...]


def controlled_light(light: Light, points: VisiblePoints, with_controls: bool = True) -> ControlledLight:
    """A light ready for some visible points; without its controls if `with_controls` is false."""
    controls = controls_of(light, points) if with_controls else ()
    directed = any(control.directed for control in controls)
    return ControlledLight(camera_light(light, points, directed), controls)


@underflowing
def shade(
    planes: Singles,
    light: ControlledLight,
    points: VisiblePoints,
    chunk: PointChunk,
    models: Mapping[int, ReflectionModel],
) -> None:
    """Fill in the diffuse and the specular plane of a light at a chunk of points.

    `planes` is (2, n) float32, in the order of the points; 0 where the light has no effect. `models` has the
    reflection model of each visible surface number.
    """
    out, rows = planes[:, chunk.pixels], points.rows[:, chunk.pixels]
    is_lit = _lit_points(light.controls, rows, chunk.pixels)
    if is_lit is not None and not is_lit.any():
        out[:] = 0
        return

    # Find the points that face the light and are within its controls.
    rays = rays_to(light.light, rows)
    incidence = rays.cosines_with(NORMAL)
    facing = incidence > 0
    is_lit = facing if is_lit is None else np.logical_and(is_lit, facing, out=is_lit)
    if rays.cos_light is not None:
        is_lit &= within(rays, max(control.least_cosine for control in light.controls))
    count = np.count_nonzero(is_lit)
    if not count:
        out[:] = 0
        return

    # Reflect the light there. Where few points are lit, compute only them.
    at_points = _AtPoints(incidence, rays.cosines_with(REFLECTED_VIEW), rays.cos_light, rays, None)
    ends = [each.stop for each in chunk.slices]
    of_surfaces = [models[each.surface_number] for each in chunk.slices]
    if count >= FEW * len(is_lit):
        flags = is_lit if count < len(is_lit) else None
        _reflect(out, at_points, flags, light.controls, ends, of_surfaces)
        return
    chosen = np.flatnonzero(is_lit)
    reflected = np.empty((2, count), np.float32)
    ends = np.searchsorted(chosen, ends).tolist()
    _reflect(reflected, at_points.chosen(chosen), None, light.controls, ends, of_surfaces)
    out[:] = 0
    for plane, values in zip(out, reflected, strict=True):
        plane[chosen] = values


def _lit_points(controls: Sequence[LightControl], rows: Singles, pixels: slice) -> Booleans | None:
    """Whether each point may be lit under all controls; None where no control decides by the points."""
    lit: Booleans | None = None
    for control in controls:
        allowed = control.lit_points(rows, pixels)
        if allowed is not None:
            lit = allowed if lit is None else np.logical_and(lit, allowed, out=lit)
    return lit


class _AtPoints(NamedTuple):
    """cos(I), cos(E) and, for a directed light, cos(L) at some points, (points,) float32 each.

    `rays` belong to the whole chunk. `places` are the places of the points in it; None for all.
    """

    incidence: Singles
    eye: Singles
    light: Singles | None
    rays: Rays
    places: Indices | None

    def chosen(self, places: Indices) -> _AtPoints:
        """Some points of the whole chunk."""
        light = None if self.light is None else self.light.take(places)
        return self._replace(
            incidence=self.incidence.take(places), eye=self.eye.take(places), light=light, places=places
        )

    def distance(self) -> Singles:
        """The distances to the light, (points,)."""
        length = self.rays.length
        return length if self.places is None else length.take(self.places)

    def positions(self) -> Singles:
        """The points in camera space, (3, points)."""
        points = self.rays.rows[POINT]
        return points if self.places is None else columns(points, self.places)

    def exact_light(self) -> ExactLight | None:
        """cos(L) at some of the points; None if it is exact in float32."""
        rays, chosen = self.rays, self.places
        if rays.direction is None or rays.are_parallel:
            return None
        logarithms = ExactLogarithms(rays.rounding, rays.cos_light_logarithms)
        if chosen is None:
            return ExactLight(logarithms, rays.exact_cos_light)
        return ExactLight(logarithms.chosen(chosen), lambda places: rays.exact_cos_light(chosen.take(places)))

    def cosines(self, start: int, end: int) -> Cosines:
        """The cosines for a reflection model at a slice of the points."""
        rays = self.rays
        chosen = None if self.places is None else self.places[start:end]

        def view() -> Singles:
            places = slice(start, end) if chosen is None else chosen
            # N.V = N . R for the reflected view R.
            return dot(rays.rows[NORMAL, places], rays.rows[REFLECTED_VIEW, places])

        def in_chunk(places: Indices) -> Indices:
            return places + start if chosen is None else chosen.take(places)

        def mirror_difference(places: Indices) -> Singles:
            places = in_chunk(places)
            difference = rays.from_light(places)
            # The rounding of the lengths hardly matters where the vectors are close to each other.
            difference /= -rays.length.take(places)
            difference -= columns(rays.rows[REFLECTED_VIEW], places)
            return difference

        def normal(places: Indices) -> Singles:
            return columns(rays.rows[NORMAL], in_chunk(places))

        exact = ExactVectors(max(rays.rounding, ROUNDING_OF_EYE), mirror_difference, normal)
        return Cosines(self.incidence[start:end], self.eye[start:end], view, exact)


def _reflect(
    out: Singles,
    at_points: _AtPoints,
    is_lit: Booleans | None,
    controls: Sequence[LightControl],
    ends: Sequence[int],
    models: Sequence[ReflectionModel],
) -> None:
    """Fill in both planes at some points: the reflected light times the shares that the controls leave.

    If `is_lit` is given, points that are not lit become 0. The surfaces of the points end at `ends` and have
    these `models`. The arrays of the cosines are overwritten.
    """
    multiplier = _multiplier(controls, at_points)
    if is_lit is not None:
        lit = is_lit.astype(np.float32)
        multiplier = lit if multiplier is None else np.multiply(multiplier, lit, out=multiplier)
    # The specular factor takes the place of cos(E), surface by surface.
    for (start, end), model in zip(pairwise([0, *ends]), models, strict=True):
        cosines = at_points.cosines(start, end)
        model.specular(cosines, out=cosines.eye)
    for plane, factor in ((DIFFUSE, at_points.incidence), (SPECULAR, at_points.eye)):
        if multiplier is None:
            out[plane] = factor
        else:
            np.multiply(factor, multiplier, out=out[plane])


def _multiplier(controls: Sequence[LightControl], at_points: _AtPoints) -> Singles | None:
    """The product of the factors of all controls; None if none has a factor. cos(L) may be overwritten."""
    shaping = [control for control in controls if type(control).factor is not LightControl.factor]
    lit = LitPoints(at_points.light, at_points.distance, at_points.positions, at_points.exact_light())
    multiplier: Singles | None = None
    for control in shaping:
        # The last control may overwrite the cosines.
        spare = lit.cos_light if control is shaping[-1] else None
        factor = control.factor(lit, np.empty_like(at_points.incidence) if spare is None else spare)
        multiplier = factor if multiplier is None else np.multiply(multiplier, factor, out=multiplier)
    return multiplier


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
    the same relative sum, and rounding changes no level. Departs: on surfaces to which a light is not linked,
    its weights are 0. Its planes are computed on all surfaces, so that changing a link only costs the sum.
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
    shining = [light for light in lights if light.shines]
    visible = {number: surfaces[number - 1] for number in models}
    strengths = {light.name: _strengths(light, visible, parts) for light in shining}
    for number, surface in visible.items():
        peaks = {
            name: rows[number][0] + rows[number][1] * models[number].largest
            for name, rows in strengths.items()
        }
        _refuse_overflow(surface.name, peaks, ambient)
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
    return {
        number: (
            light.intensity * surface.reflectance.diffuse,
            light.intensity * surface.reflectance.specular,
        )
        if surface.name in lit and links.shines_on_surface(surface.name)
        else (0.0, 0.0)
        for number, surface in visible.items()
    }


def _refuse_overflow(surface: str, peaks: Mapping[str, float], ambient: float) -> None:
    """Raise InputError if float32 can't hold the sum of the peaks; it names the light that adds most."""
    total = ambient + sum(peaks.values())
    if math.isfinite(total) and total < LARGEST_SINGLE:
        return
    light = max(peaks, key=lambda name: peaks[name])
    raise InputError(
        f"surface {surface!r} under light {light!r}: intensities must stay below {LARGEST_SINGLE:.3g}, not"
        f" reach {total:g}; lower the light's intensity or the surface's diffuse and specular"
    )
