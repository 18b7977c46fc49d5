"""Where the rounding of float32 could change the light of a point by more than a fortieth of a level.

A steep factor multiplies the rounding of its cosine: a narrow beam, a narrow cone, a sharp highlight.
`shading` computes such points again by the definitions, in float64.
"""

from __future__ import annotations

import math
from typing import Any, Final

import numpy as np

from autocolor.arrays import ROUNDING, Booleans, RealArray
from autocolor.lighting.light import CameraLight, Rays, least_cosine, specular_factor
from autocolor.scene.reflection_models import Phong, ReflectionModel, half_length_squared

ERROR: Final = 8.5e-5
"""Assumed: how far rounding may put the share of a light, 0 to 1: a fortieth of a level."""

NARROW: Final = 2.5e-3
"""Assumed: a cone is narrow if sin^2(A) is below this: up to 2.9 degrees, or less than that from 180.

The rounding of a cosine would move its rim by a ten thousandth of the angle, or more."""

ROUNDING_OF_EYE: Final = 4.7 * ROUNDING
"""Measured: cos(E) is at least so uncertain, because the rounding of a reflected view changes its length."""

ROUNDING_OF_HALF: Final = 8 * ROUNDING
"""Assumed: the rounding of N.H itself, as a change of cos(E), of which N.H changes by a fourth or more."""


def uncertain_share(light: CameraLight, rays: Rays, rounding: float) -> Booleans | None:
    """Whether rounding could change what the controls leave at each point; None if it cannot at any.

    Each cos(L) is off by at most `rounding`.
    """
    row, cosines = light.row, rays.light
    if cosines is None or row.at_infinity:
        return None
    steep = is_steep(cosines, row.concentration, rounding)
    found = [] if steep is None else [steep]
    if row.cone_angle is not None:
        rim, near = least_cosine(row.cone_angle), rounding + ROUNDING
        inner = row.cone_angle if row.inner_angle is None else row.inner_angle
        end = math.cos(math.radians(inner))
        # The share of a soft edge changes by at most 3/2 of the change of the fraction.
        if 1 - rim * rim < NARROW or (end > rim and 1.5 * rounding > ERROR * (end - rim)):
            found.append((cosines >= rim - near) & (cosines <= max(rim, end) + near))
    return np.logical_or.reduce(found) if found else None


def uncertain_factor(
    model: ReflectionModel, rays: Rays, factor: RealArray[Any], rounding: float
) -> Booleans | None:
    """Whether rounding could change the specular factor of a model; None if it cannot at any point.

    The factor of a half vector is computed again for a cos(E) less by its rounding, unless this is too little
    to count even where it changes N.H most.
    """
    rounding = max(rounding, ROUNDING_OF_EYE)
    if isinstance(model, Phong):
        return is_steep(rays.eye, model.exponent, rounding)
    places = np.flatnonzero(factor > ERROR)
    if not len(places):
        return None
    changed = np.zeros(len(factor), np.bool_)
    rays, factor, rounding = rays.at(places), factor.take(places), rounding + ROUNDING_OF_HALF
    most = rounding / float(half_length_squared(rays.incidence, rays.eye, rays.view).min())
    if model.steepness * most * max(float(factor.max()), 1.0) <= ERROR:
        return None
    moved = rays._replace(eye=rays.eye - np.float32(rounding))
    changed[places] = np.abs(specular_factor(model, moved) - factor) > ERROR
    return changed


def is_steep(cosines: RealArray[Any], exponent: float, rounding: float) -> Booleans | None:
    """Where a rounding of the cosines could put a power of them off by more than ERROR; None if nowhere.

    A power c^N is off by at most c^N (exp(N rounding) - 1), which is below c^N N rounding exp(N rounding).
    """
    spread = exponent * rounding
    if spread <= ERROR:
        return None
    steep: Booleans = cosines > 1 - (math.log(spread / ERROR) + spread) / exponent
    return steep
