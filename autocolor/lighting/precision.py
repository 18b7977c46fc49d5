"""Where the rounding of float32 could change the light of a point by more than a fortieth of a level.

A steep factor multiplies the rounding of its cosine: a narrow beam, the edge of a cone, a sharp highlight.
`shading` computes such points again by the definitions, in float64.
"""

from __future__ import annotations

import math
from typing import Any, Final

from autocolor.arrays import ROUNDING, Booleans, RealArray
from autocolor.lighting.light import CameraLight, Rays, least_cosine
from autocolor.scene.reflection_models import Phong, ReflectionModel

ERROR: Final = 8.5e-5
"""Assumed: how far rounding may put the share of a light, 0 to 1: a fortieth of a level."""

ROUNDING_OF_EYE: Final = 4.7 * ROUNDING
"""Measured: cos(E) is at least so uncertain, because the rounding of a reflected view changes its length."""

ROUNDING_OF_HALF: Final = 8 * ROUNDING
"""Assumed: the rounding of N.H itself, as a change of cos(E), of which N.H changes by a fourth or more."""


def uncertain_share(light: CameraLight, rays: Rays, rounding: float) -> Booleans | None:
    """Whether rounding could change what the controls leave at each point; None if it cannot at any.

    Each cos(L) is off by at most `rounding`.
    """
    row, cosines = light.row, rays.cos_light
    if cosines is None:
        return None
    uncertain = is_steep(cosines, row.concentration, rounding)
    if row.cone_angle is not None:
        least, near = least_cosine(row.cone_angle), rounding + ROUNDING
        inner = row.cone_angle if row.inner_angle is None else row.inner_angle
        end = math.cos(math.radians(inner))
        # The share of a soft edge changes by at most 3/2 of the change of the fraction, that of a sharp by 1.
        if 1.5 * rounding > ERROR * (end - least):
            at_edge: Booleans = (cosines >= least - near) & (cosines <= max(least, end) + near)
            uncertain = at_edge if uncertain is None else uncertain | at_edge
    return uncertain


def uncertain_factor(
    model: ReflectionModel, rays: Rays, factor: RealArray[Any], rounding: float
) -> Booleans | None:
    """Whether rounding could change the specular factor of a model; None if it cannot at any point.

    A change of cos(E) changes the logarithm of N.H by the same over |L + V|^2, and that of the factor by the
    model's steepness times as much. |L + V| is (N.L + N.V) / (N.H), so at least N.L + N.V.
    """
    rounding = max(rounding, ROUNDING_OF_EYE)
    if isinstance(model, Phong):
        return is_steep(rays.cos_eye, model.exponent, rounding)
    spread = model.steepness * (rounding + ROUNDING_OF_HALF) / ERROR
    least = rays.cos_incidence + rays.cos_view
    uncertain: Booleans = factor * spread > least * least
    return uncertain


def is_steep(cosines: RealArray[Any], exponent: float, rounding: float) -> Booleans | None:
    """Where a rounding of the cosines could put a power of them off by more than ERROR; None if nowhere.

    A power c^N is off by at most c^N (exp(N rounding) - 1), which is below c^N N rounding exp(N rounding).
    """
    spread = exponent * rounding
    if spread <= ERROR:
        return None
    steep: Booleans = cosines > 1 - (math.log(spread / ERROR) + spread) / exponent
    return steep
