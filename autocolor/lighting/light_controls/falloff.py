"""The falloff of a light with the distance."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from autocolor.arrays import Booleans, Singles
from autocolor.lighting.light_controls.control import ROUNDING, LightControl, LitPoints, registered
from autocolor.lighting.rays import FARTHEST, camera_light
from autocolor.scene.lights.light import Light
from autocolor.visibility.visible_points import POINT, POINT_SQUARED, VisiblePoints

LEAST_REACH: Final = 1e-20
"""In units; float32 can hold any distance as a multiple of it."""


@registered
@dataclass(frozen=True, eq=False)
class Falloff(LightControl):
    """Falloff: (1 - f)^n at the distance f as a fraction of the reach, n = 1 or 2, and 0 beyond it.

    Departs: the paper's light at a point does not depend on its distance, nor does one here unless it is
    given a falloff. 1/d^2 has no upper limit: a point close to the light would take the whole range of levels
    and leave the others black. This stays within 0 to 1, and ends.
    """

    reach: float
    exponent: int
    sphere: Singles

    @classmethod
    def of(cls, light: Light, points: VisiblePoints) -> Falloff | None:
        """The falloff, if the light has any."""
        if light.falloff == "none" or light.reach is None:
            return None
        reach = min(max(light.reach / points.unit, LEAST_REACH), FARTHEST)
        position = camera_light(light, points, directed=False).position
        square = float(position @ position)
        # Whatever is rounded beyond the reach gets nothing from the factor.
        slack = 8 * ROUNDING * (square + points.radius**2)
        sphere = np.array([*(-2 * position), 1, square - reach**2 - slack], np.float32)
        return cls(reach, 1 if light.falloff == "linear" else 2, sphere)

    def lit_points(self, rows: Singles, pixels: slice) -> Booleans:
        """Whether each point is within reach: (p - P)^2 = p.p - 2 p.P + P.P, as in `rays`."""
        within: Booleans = self.sphere[:4] @ rows[POINT.start : POINT_SQUARED + 1] <= -self.sphere[4]
        return within

    def factor(self, lit: LitPoints, out: Singles) -> Singles:
        """All of the light at the light itself, nothing at its reach."""
        np.divide(lit.distance(), np.float32(-self.reach), out=out)
        out += 1
        np.maximum(out, 0, out=out)
        return out if self.exponent == 1 else np.square(out, out=out)
