"""The contribution of one light to the visible points: two planes, and how they are mixed."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from autocolor.arrays import Singles
from autocolor.immutable import Immutable
from autocolor.lighting.light_mix import SurfaceWeights
from autocolor.visibility.visible_points import PointChunk

DIFFUSE: Final = 0
SPECULAR: Final = 1


@dataclass(frozen=True, eq=False, repr=False)
class LightPlanes(Immutable):
    """The contribution of one light to the visible points, in their order; read-only in a picture.

    `values` is (2, n) float32: the diffuse and the specular plane, without D, S and the light's intensity.
    `weights` are their weights in the picture. `mixed`, (n,) float32, is their weighted sum where it is kept:
    that of a light that stays while others are moved need then only be added.
    """

    values: Singles
    weights: SurfaceWeights
    mixed: Singles | None = None


def mix(planes: LightPlanes, chunk: PointChunk, out: Singles) -> None:
    """Write the weighted sum of a light's two planes at a chunk of points to `out`."""
    values = planes.values[:, chunk.pixels]
    for surface in chunk.slices:
        pair = np.array(planes.weights[surface.surface_number])
        np.matmul(pair, values[:, surface.pixels], out=out[surface.pixels])
