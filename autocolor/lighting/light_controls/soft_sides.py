"""The soft edges of flaps and of half-spaces.

Departs: the paper's flaps end at once.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from autocolor.arrays import Singles
from autocolor.lighting.light_controls.control import LightControl, LitPoints, ramp, registered
from autocolor.lighting.light_controls.flap_sides import flap_sides
from autocolor.lighting.light_controls.half_spaces import half_space_sides
from autocolor.scene.lights.light import Light
from autocolor.visibility.visible_points import VisiblePoints

LEAST_WIDTH: Final = 1e-8
"""In units; far below the rounding of points, and float32 can hold how many of it fit before any plane."""


@registered
@dataclass(frozen=True, eq=False)
class SoftSides(LightControl):
    """The sides of flaps and half-spaces that have an edge width: the product of what each leaves.

    `sides` is (sides, 4); its product with (P, 1) is the distance from a plane as a fraction of its width.
    """

    sides: Singles

    @classmethod
    def of(cls, light: Light, points: VisiblePoints) -> SoftSides | None:
        """The sides with soft edges, if there are any."""
        sides = [*flap_sides(light, points).values(), *half_space_sides(light, points).values()]
        soft = [side.row / max(side.edge_width, LEAST_WIDTH) for side in sides if side.edge_width > 0]
        return cls(np.array(soft, np.float32)) if soft else None

    def factor(self, lit: LitPoints, out: Singles) -> Singles:
        """Nothing on a plane and all of the light at the width inside; see `ramp`."""
        positions = lit.positions()
        for number, side in enumerate(self.sides):
            fraction = np.matmul(side[:3], positions, out=None if number else out)
            fraction += side[3]
            ramp(fraction)
            if number:
                out *= fraction
        return out
