"""The concentration of a light around its direction.

Paper: "Light Direction and Concentration".
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from autocolor.arrays import Singles, power
from autocolor.lighting.light_controls.control import LightControl, LitPoints, registered
from autocolor.scene.lights.light import Light
from autocolor.visibility.visible_points import VisiblePoints

ABOVE_ZERO: Final = float(np.finfo(np.float32).smallest_subnormal)
"""The least positive float32."""


@registered
@dataclass(frozen=True, eq=False)
class Concentration(LightControl):
    """Concentration: cos^C(L) where cos(L) > 0.

    Paper: "Light Direction and Concentration". Half is left at 60 degrees for C = 1, at 21.1 for C = 10 and
    at 10.6 for C = 40. With C = 0 the light is a point source, and nothing is dark behind it.
    """

    exponent: float
    directed = True
    least_cosine = ABOVE_ZERO

    @classmethod
    def of(cls, light: Light, points: VisiblePoints) -> Concentration | None:
        """The concentration, if the light has any."""
        return cls(light.concentration) if light.concentration > 0 else None

    def factor(self, lit: LitPoints, out: Singles) -> Singles:
        """cos^C(L)."""
        assert lit.cos_light is not None
        return power(lit.cos_light, self.exponent, out=out)
