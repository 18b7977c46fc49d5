"""One light at the visible points: its two planes, without D, S and the light's intensity.

Paper: "The Lighting Model" and "Light Controls". The sum over the lights with their strengths is made in
`illumination`; here is what takes the time, and what stays when only strengths change.

Measured and rejected: one surface after another (a tenth longer on the coupe, whose smaller surfaces are
hardly worth the calls); fewer pixels at once than 131,072 (a tenth more at a quarter of that); two threads,
each on half of the pixels (as long as one: what they compute they must fetch from memory, and between any two
calls they wait for the interpreter); two processes (two thirds of the time of one, for a second copy of
everything); the cosines of all lights as one matrix product (a twentieth less, but nothing says that it
rounds as the product of one light does, and an edit must give what a fresh picture gives).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import pairwise
from typing import Final, NamedTuple

import numpy as np

from autocolor.arrays import Flags, Numbers, Singles
from autocolor.lighting.light_controls import concentrated, inside_cone, inside_flaps
from autocolor.lighting.light_planes import DIFFUSE, SPECULAR
from autocolor.lighting.rays import CameraLight, rays_to
from autocolor.scene.reflection_models import phong_diffuse, phong_specular
from autocolor.visibility.visible_points import NORMAL, REFLECTED_VIEW, PointChunk, VisiblePoints

FEW: Final = 0.3
"""Below this fraction of lit pixels it takes less time to pick them than to compute them all."""


def shade(
    planes: Singles,
    light: CameraLight,
    points: VisiblePoints,
    chunk: PointChunk,
    exponents: Mapping[int, float],
) -> None:
    """Fill in the diffuse and the specular plane of a light at a chunk of points.

    `planes` is (2, n) float32, in the order of the points; 0 where the light has no effect. `exponents` has N
    for each visible surface number.
    """
    out, rows = planes[:, chunk.pixels], points.rows[:, chunk.pixels]
    is_lit = inside_flaps(light.controls, rows)
    if is_lit is not None and not is_lit.any():
        out[:] = 0
        return

    # Find what faces the light and is within its controls.
    rays = rays_to(light, rows)
    cos_incidence = rays.cosines_with(NORMAL)
    facing = cos_incidence > 0
    is_lit = facing if is_lit is None else np.logical_and(is_lit, facing, out=is_lit)
    if rays.cos_light is not None:
        is_lit &= inside_cone(light.controls, rays.cos_light)
    count = np.count_nonzero(is_lit)
    if not count:
        out[:] = 0
        return

    # Reflect the light there; of few pixels take those alone.
    cosines = _Cosines(cos_incidence, rays.cosines_with(REFLECTED_VIEW), rays.cos_light)
    concentration = light.controls.concentration
    ends = [each.stop for each in chunk.slices]
    of_surfaces = [exponents[each.surface_number] for each in chunk.slices]
    if count >= FEW * len(is_lit):
        _reflect(out, cosines, is_lit if count < len(is_lit) else None, concentration, ends, of_surfaces)
        return
    chosen = np.flatnonzero(is_lit)
    reflected = np.empty((2, count), np.float32)
    ends = np.searchsorted(chosen, ends).tolist()
    _reflect(reflected, cosines.of(chosen), None, concentration, ends, of_surfaces)
    out[:] = 0
    for plane, values in zip(out, reflected, strict=True):
        plane[chosen] = values


class _Cosines(NamedTuple):
    """cos(I), cos(E) and, of a light with a direction, cos(L), (pixels,) float32 each."""

    incidence: Singles
    eye: Singles
    light: Singles | None

    def of(self, chosen: Numbers) -> _Cosines:
        """Those of some of the pixels."""
        light = None if self.light is None else self.light.take(chosen)
        return _Cosines(self.incidence.take(chosen), self.eye.take(chosen), light)


def _reflect(
    out: Singles,
    cosines: _Cosines,
    is_lit: Flags | None,
    concentration: float,
    ends: Sequence[int],
    exponents: Sequence[float],
) -> None:
    """Fill both planes of some pixels: what is reflected to the eye, times what the controls leave.

    Where `is_lit` is given, the others become 0. The surfaces of the pixels end at `ends` and have these
    `exponents`.
    """
    if cosines.light is not None and concentration > 0:
        multiplier = concentrated(cosines.light, concentration)
    else:
        multiplier = np.ones(len(cosines.incidence), np.float32)
    if is_lit is not None:
        multiplier *= is_lit.astype(np.float32)
    np.multiply(phong_diffuse(cosines.incidence), multiplier, out=out[DIFFUSE])
    for (start, end), exponent in zip(pairwise([0, *ends]), exponents, strict=True):
        specular = phong_specular(cosines.eye[start:end], exponent)
        np.multiply(specular, multiplier[start:end], out=out[SPECULAR, start:end])
