"""The parts that a light shines on.

Departs: the paper's lights shine on all parts. That a light shines on some surfaces only is no control but a
matter of weights: see `lighting.light_mix`.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from autocolor.arrays import Booleans, PartNumbers, Singles
from autocolor.lighting.light_controls.control import LightControl, registered
from autocolor.scene.lights.light import Light
from autocolor.visibility.visible_points import VisiblePoints


@registered
@dataclass(frozen=True, eq=False)
class LinkedParts(LightControl):
    """The links of a light to parts: it leaves the points of other parts dark.

    `is_lit` tells by part number whether a part is lit, and `numbers` are the part numbers of all points.
    """

    is_lit: Booleans
    numbers: PartNumbers

    @classmethod
    def of(cls, light: Light, points: VisiblePoints) -> LinkedParts | None:
        """The parts that the light is linked to, if it is."""
        if not light.links.depend_on_parts:
            return None
        names = points.parts.names
        lit = light.links.lit_parts(names)
        return cls(np.array([False, *(name in lit for name in names)]), points.parts.numbers)

    def lit_points(self, rows: Singles, pixels: slice) -> Booleans:
        """Whether each point is of a part that is lit."""
        return self.is_lit.take(self.numbers[pixels])
