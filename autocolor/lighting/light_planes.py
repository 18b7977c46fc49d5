"""What one light gives to what is seen: two planes, and what they weigh in the sum."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from autocolor.arrays import Singles
from autocolor.lighting.light_mix import SurfaceWeights
from autocolor.visibility.visible_points import Share

DIFFUSE: Final = 0
SPECULAR: Final = 1


@dataclass(frozen=True, eq=False)
class LightPlanes:
    """What one light gives to what is seen, in the order of `Seen.pixels`; read-only in a picture.

    `values` is (2, n) float32: its diffuse and its specular plane, without D, S and the light's intensity.
    `weights` are what they weigh in the sum. `weighed` is their sum by the weights, (n,) float32, where it is
    kept: for a light that stays while others are moved, and need then only be added.
    """

    values: Singles
    weights: SurfaceWeights
    weighed: Singles | None = None


def weigh(planes: LightPlanes, share: Share, out: Singles) -> None:
    """Fill `out` with the weighed sum of a light's planes at the pixels of a share."""
    values = planes.values[:, share.pixels]
    for surface in share.slices:
        pair = np.array(planes.weights[surface.surface_number])
        np.matmul(pair, values[:, surface.pixels], out=out[surface.pixels])
