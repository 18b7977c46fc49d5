"""The weights of lights and ambient in the sum that is a picture's intensity.

Paper: "The Lighting Model": a light contributes its intensity times (D cos(I) + S cos^N(E)), and the ambient
term is added. The weights are relative to the largest of them, the scale, and only the sum is multiplied by
it: so lights k times as strong give the same relative sum, and levels that do not change by rounding.
Departs: a light that is linked to other surfaces has the weight 0. Its planes are those of all surfaces, so
that another link costs no more than the sum.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from autocolor.arrays import LARGEST_SINGLE
from autocolor.errors import InputError
from autocolor.scene.lights.light import Light
from autocolor.scene.reflection_models import ReflectionModel
from autocolor.scene.surfaces import Part, Surface

SurfaceWeights = Mapping[int, tuple[np.float32, np.float32]]
"""The weights of a light's diffuse and specular planes, by surface number."""


class LightMix(NamedTuple):
    """The weights of the ambient term and of the planes of each light that shines, relative to `scale`."""

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

    `parts` are those of the scene: a light that is linked to parts shines on their surfaces only. Raises
    InputError where the sum would leave the range of float32: such an intensity is refused by name, never
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
    """Refuse lights whose peaks have a sum float32 can't hold, naming the light that contributes most."""
    total = ambient + sum(peaks.values())
    if math.isfinite(total) and total < LARGEST_SINGLE:
        return
    light = max(peaks, key=lambda name: peaks[name])
    raise InputError(
        f"surface {surface!r} under light {light!r}: intensities must stay below {LARGEST_SINGLE:.3g}, not"
        f" reach {total:g}; lower the light's intensity or the surface's diffuse and specular"
    )
