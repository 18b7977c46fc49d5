"""The soft edge of a cone, between its inner angle and its rim.

Departs: the paper's cones end at once.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from autocolor.arrays import Singles
from autocolor.lighting.light_controls.control import ROUNDING, LightControl, LitPoints, ramp, registered
from autocolor.scene.lights.light import Light
from autocolor.visibility.visible_points import VisiblePoints


@registered
@dataclass(frozen=True, eq=False)
class SoftCone(LightControl):
    """All of the light up to the inner angle, and nothing from the cone angle on; see `ramp`.

    Assumed: between them it goes with cos(L), not with L. That takes no arc cosine at each pixel, and is
    smooth on the axis, too, where the inner angle is 0: there cos(L) has a slope of 0, and L a corner.
    """

    rim: float
    width: float
    directed = True

    @classmethod
    def of(cls, light: Light, points: VisiblePoints) -> SoftCone | None:
        """The soft edge, if the inner angle is below the cone angle; else the cone is sharp."""
        inner, outer = light.inner_angle, light.cone_angle
        if inner is None or outer is None or inner >= outer:
            return None
        # Rounded as the cosines are that it is subtracted from.
        rim = float(np.float32(math.cos(math.radians(outer))))
        return cls(rim, max(math.cos(math.radians(inner)) - rim, ROUNDING))

    def factor(self, lit: LitPoints, out: Singles) -> Singles:
        """What is left of the light between the two angles."""
        assert lit.cos_light is not None
        np.subtract(lit.cos_light, np.float32(self.rim), out=out)
        out *= np.float32(1 / self.width)
        return ramp(out)
