"""What lights and ambient weigh in the sum that is a picture's intensity.

Paper: "The Lighting Model": a light gives its intensity times (D cos(I) + S cos^N(E)), and the ambient term
is added. The weights are in proportion to the strongest of them, and only the sum is multiplied by that: so
the same lights k times as strong give the same proportions, and the levels that are made from these do not
change by rounding.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from typing import Final, NamedTuple

import numpy as np

from autocolor.errors import InputError
from autocolor.scene.lights import Light
from autocolor.scene.surfaces import Surface

LARGEST: Final = float(np.finfo(np.float32).max)

SurfaceWeights = Mapping[int, tuple[np.float32, np.float32]]
"""Weights of a light's diffuse and of its specular plane, by surface number."""


class Weights(NamedTuple):
    """What the ambient and the lights that shine weigh in the sum, in proportion to `scale`.

    `lights` has by a light's name, and then by surface number, the weights of its diffuse and of its specular
    plane.
    """

    scale: float
    ambient: np.float32
    lights: Mapping[str, SurfaceWeights]


def weights_of(
    surface_numbers: Iterable[int], surfaces: Sequence[Surface], lights: Sequence[Light], ambient: float
) -> Weights:
    """The weights of the lights that shine, on the surfaces that are seen.

    Raises InputError where the sum would leave the range of float32: such an intensity is refused by name,
    never clipped into a level.
    """
    if not ambient < LARGEST:
        raise InputError(f"ambient must stay below {LARGEST:.3g}, not {ambient:g}; lower it")
    shining = [light for light in lights if light.shines]
    seen = {number: surfaces[number - 1] for number in surface_numbers}
    strengths = {
        light.name: {
            number: (
                light.intensity * surface.reflectance.diffuse,
                light.intensity * surface.reflectance.specular,
            )
            for number, surface in seen.items()
        }
        for light in shining
    }
    for number, surface in seen.items():
        _refuse_overflow(surface.name, {name: rows[number] for name, rows in strengths.items()}, ambient)
    all_strengths = [each for rows in strengths.values() for pair in rows.values() for each in pair]
    scale = max([ambient, *all_strengths]) or 1.0
    weights = {
        name: {
            number: (np.float32(diffuse / scale), np.float32(specular / scale))
            for number, (diffuse, specular) in rows.items()
        }
        for name, rows in strengths.items()
    }
    return Weights(scale, np.float32(ambient / scale), weights)


def _refuse_overflow(surface: str, strengths: Mapping[str, tuple[float, float]], ambient: float) -> None:
    """Refuse what float32 can't hold the sum of, naming the light that does most to it."""
    total = ambient + sum(diffuse + specular for diffuse, specular in strengths.values())
    if math.isfinite(total) and total < LARGEST:
        return
    light = max(strengths, key=lambda name: sum(strengths[name]))
    raise InputError(
        f"surface {surface!r} under light {light!r}: intensities must stay below {LARGEST:.3g}, not reach"
        f" {total:g}; lower the light's intensity or the surface's diffuse and specular"
    )
