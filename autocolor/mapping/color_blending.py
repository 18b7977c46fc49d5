"""The entries of a surface's range: the object color, blended with the color of the light.

Paper: "Light Source Color Blending", Figure 12. All intensities below the blend level are taken as purely
diffuse; from there the color shifts to the specular one in N equal steps. That the brightest points are the
color of the light is an assumption of the method, which predicts no color.
"""

from __future__ import annotations

from functools import lru_cache
from typing import Final

import numpy as np

from autocolor.arrays import Bytes, Floats
from autocolor.mapping.rounding import HALF, half_up
from autocolor.scene.surfaces import Paint

HALVES_UP: Final = (HALF + 1e-9,) * 3
"""What rounds a mixed color when it is added and the fractions are then cut off.

Mixing in floats may miss a whole color by the last bit, just below a half.
"""


def blend_level(blend: float, levels: int) -> int:
    """The highest level that is purely the object color."""
    return half_up(blend * (levels - 1))


@lru_cache(maxsize=512)
def entries_of(paint: Paint, levels: int, floor: float = 0.0) -> Bytes:
    """The entries of a range, (levels, 3) uint8, read-only: red, green, blue from the lowest level up.

    The colors are those of the paint, darkened in proportion to the level. `floor` is how bright the lowest
    level is, as a fraction of the highest: 0 stretches the range to black, minimum / maximum of the
    surface's intensities keeps the shading in proportion to them.

    Paper: a weight that grows by 1 / N for each of the N levels above the blend level; "another control
    should be added to adjust the percentage of the specular color at the maximum intensity". Assumed: the
    blend weighs the colors and the level darkens them, so that a blend never changes how bright a level
    is when the two colors are alike. With the blend at the maximum there is no shift.
    """
    shares = color_shares(paint.blend, paint.light_percentage, levels, floor)
    # One product mixes and rounds. Measured with cold caches, where a call costs more than what it computes:
    # rounding apart, or "@" in place of "dot", takes 1.4 times as long, both together twice.
    colors = np.array((paint.object_color, paint.light_color, HALVES_UP), np.float64)
    entries: Bytes = shares.dot(colors).astype(np.uint8)
    entries.setflags(write=False)
    return entries


@lru_cache(maxsize=128)
def color_shares(blend: float, percentage: float, levels: int, floor: float) -> Floats:
    """How much of the object color, of the light color and of the rounding each level has, (levels, 3).

    The light color begins above the blend level; the rounding is a whole one everywhere.
    """
    level, begin = np.arange(levels), blend_level(blend, levels)
    weight = np.maximum(level - begin, 0) / max(levels - 1 - begin, 1) * (percentage / 100)
    share = floor + (1 - floor) * level / max(levels - 1, 1)
    shares = np.stack([(1 - weight) * share, weight * share, np.ones(levels)], axis=1)
    shares.flags.writeable = False
    return shares
