"""The cone of a light.

Paper: "Light Flaps and Cones".
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from autocolor.lighting.light_controls.control import ROUNDING, LightControl, registered
from autocolor.scene.lights.light import Light
from autocolor.visibility.visible_points import VisiblePoints


@registered
@dataclass(frozen=True, eq=False)
class Cone(LightControl):
    """The cone: a point is lit where L <= A.

    Departs: the paper prints the test as cos(L) <= cos(A), which would light the outside; the rim itself is
    lit. With C = 0 nothing is dark behind the light, so a cone of more than 90 degrees lights there too; with
    C > 0 the hemisphere ends at 90.
    """

    least_cosine: float
    directed = True

    @classmethod
    def of(cls, light: Light, points: VisiblePoints) -> Cone | None:
        """The cone, widened by a rounding of float32: a rim along a line of pixels does not fray."""
        if light.cone_angle is None:
            return None
        return cls(math.cos(math.radians(light.cone_angle)) - ROUNDING)
