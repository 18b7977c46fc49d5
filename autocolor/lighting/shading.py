"""One light at the visible points: its two planes, without D, S and the light's intensity.

Paper: "The Lighting Model" and "Light Controls". `illumination` adds up the lights; here is what takes the
time, and what an edit keeps while only strengths change.

Measured and rejected: one surface after another (a tenth longer on the coupe, whose smaller surfaces are
hardly worth the calls); fewer points at once than 131,072 (a tenth more at a quarter of that); two threads,
each on half of the points (as long as one: what they compute they must fetch from memory, and between any two
calls they wait for the interpreter); two processes (two thirds of the time of one, for a second copy of
everything); the cosines of all lights as one matrix product (a twentieth less, but nothing says that it
rounds as the product of one light does, and an edit must give the same bits as a fresh picture).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import pairwise
from typing import Final, NamedTuple

import numpy as np

from autocolor.arrays import Booleans, Indices, Singles, dot
from autocolor.lighting.light_controls.control import LightControl, LitPoints, controls_of
from autocolor.lighting.light_planes import DIFFUSE, SPECULAR
from autocolor.lighting.rays import CameraLight, camera_light, rays_to
from autocolor.scene.lights.light import Light
from autocolor.scene.reflection_models import Cosines, ReflectionModel
from autocolor.visibility.visible_points import NORMAL, POINT, REFLECTED_VIEW, PointChunk, VisiblePoints

FEW: Final = 0.3
"""Below this fraction of lit points it takes less time to pick them than to compute them all."""


class ControlledLight(NamedTuple):
    """A light in camera space and its controls, ready for the visible points of one view."""

    light: CameraLight
    controls: tuple[LightControl, ...]


def controlled_light(light: Light, points: VisiblePoints) -> ControlledLight:
    """A light ready for some visible points."""
    controls = controls_of(light, points)
    directed = any(control.directed for control in controls)
    return ControlledLight(camera_light(light, points, directed), controls)


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

    # Find what faces the light and is within its controls.
    rays = rays_to(light.light, rows)
    incidence = rays.cosines_with(NORMAL)
    facing = incidence > 0
    is_lit = facing if is_lit is None else np.logical_and(is_lit, facing, out=is_lit)
    if rays.cos_light is not None:
        is_lit &= rays.cos_light >= np.float32(max(control.least_cosine for control in light.controls))
    count = np.count_nonzero(is_lit)
    if not count:
        out[:] = 0
        return

    # Reflect the light there; where few points are lit, compute those alone.
    at_points = _AtPoints(
        incidence, rays.cosines_with(REFLECTED_VIEW), rays.cos_light, rays.length, rows, None
    )
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

    `length` and `rows` are those of the whole chunk, and `places` the places of the points there, None for
    all of it.
    """

    incidence: Singles
    eye: Singles
    light: Singles | None
    length: Singles
    rows: Singles
    places: Indices | None

    def chosen(self, places: Indices) -> _AtPoints:
        """Some points of the whole chunk."""
        light = None if self.light is None else self.light.take(places)
        return self._replace(
            incidence=self.incidence.take(places), eye=self.eye.take(places), light=light, places=places
        )

    def lit(self) -> LitPoints:
        """What a light control may ask about the points."""

        def distance() -> Singles:
            return self.length if self.places is None else self.length.take(self.places)

        def positions() -> Singles:
            return self.rows[POINT] if self.places is None else self.rows[POINT].take(self.places, axis=1)

        return LitPoints(self.light, distance, positions)

    def cosines(self, start: int, end: int) -> Cosines:
        """What a reflection model needs at a slice of the points."""

        def view() -> Singles:
            places = slice(start, end) if self.places is None else self.places[start:end]
            # N.V = N . R for the reflected view R.
            return dot(self.rows[NORMAL, places], self.rows[REFLECTED_VIEW, places])

        return Cosines(self.incidence[start:end], self.eye[start:end], view)


def _reflect(
    out: Singles,
    at_points: _AtPoints,
    is_lit: Booleans | None,
    controls: Sequence[LightControl],
    ends: Sequence[int],
    models: Sequence[ReflectionModel],
) -> None:
    """Fill in both planes at some points: what is reflected to the eye, times what the controls leave.

    Where `is_lit` is given, the other points become 0. The surfaces of the points end at `ends` and have
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
    """The product of the factors of all controls, or None if there is none; cos(L) may be overwritten."""
    shaping = [control for control in controls if type(control).factor is not LightControl.factor]
    lit = at_points.lit()
    multiplier: Singles | None = None
    for control in shaping:
        # The last control may overwrite the cosines.
        spare = lit.cos_light if control is shaping[-1] else None
        factor = control.factor(lit, np.empty_like(at_points.incidence) if spare is None else spare)
        multiplier = factor if multiplier is None else np.multiply(multiplier, factor, out=multiplier)
    return multiplier
