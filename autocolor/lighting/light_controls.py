"""The light controls: direction and concentration, cone, and flaps, as a multiplier in [0, 1].

Paper: "Light Controls". They modify what a reflection model gives at a point and know nothing of it, so they
work with any. Points are columns of `VisiblePoints.rows`, in camera space.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np

from autocolor.arrays import Flags, Floats, Singles, power
from autocolor.scene.lights import Light
from autocolor.visibility.visible_points import POINT, VisiblePoints

ROUNDING: Final = float(np.finfo(np.float32).eps)
FAR_FLAP: Final = 1e30
"""In units; farther than any point, and float32 can hold it."""


@dataclass(frozen=True, eq=False)
class Controls:
    """One light's controls, made ready for the points of one view.

    `toward` is the unit vector of the light direction in camera space, or None where the light is the same
    all around; `least_cosine` is what cos(L) must reach, None with it. `flaps` is (sides, 4): a point
    is inside where every row's product with (P, 1) is at least 0.
    """

    toward: Floats | None
    concentration: float
    least_cosine: float | None
    flaps: Singles


def controls(light: Light, points: VisiblePoints) -> Controls:
    """The controls of a light for the visible points of a view.

    Paper: cos^C(L) for cos(L) > 0; with C = 0 the light is a point source. A point is in the cone where
    L <= A. Departs: the paper prints the test as cos(L) <= cos(A), which would light the outside; the rim
    itself is lit. With C = 0 nothing is cut behind the light, so a cone of more than 90 degrees lights
    there too; with C > 0 the hemisphere ends at 90.
    """
    toward, least = None, None
    if light.axis is not None and (light.concentration > 0 or light.cone_angle is not None):
        toward = points.camera_direction(light.axis)
        if light.cone_angle is not None:
            # A float32 rounding of the rim keeps a cone that ends on a line of pixels from fraying.
            least = math.cos(math.radians(light.cone_angle)) - ROUNDING
        if light.concentration > 0:
            least = max(least if least is not None else 0.0, 0.0)
    return Controls(toward, light.concentration, least, _flap_sides(light, points))


def _flap_sides(light: Light, points: VisiblePoints) -> Singles:
    """A row for each side of each flap that is on; a point of the side itself is inside.

    Paper: "Light Flaps and Cones": a flap is a range of an object coordinate, a box and no shadow.
    """
    rows: list[Floats] = []
    for axis, flap in enumerate((light.flaps.x, light.flaps.y, light.flaps.z)):
        if flap is None or not flap.on:
            continue
        coordinate = points.world_coordinate(axis)
        # A surface that lies on the flap is lit: allow what float32 rounds a point by.
        slack = 4 * ROUNDING * points.radius
        for sign, limit in ((1.0, flap.minimum), (-1.0, flap.maximum)):
            if math.isfinite(limit):
                beyond = min(max(sign * limit / points.unit, -FAR_FLAP), FAR_FLAP)
                rows.append(sign * coordinate - np.array([0, 0, 0, beyond - slack]))
    return np.array(rows, np.float32).reshape(-1, 4)


def inside_flaps(ready: Controls, rows: Singles) -> Flags | None:
    """Whether each point is within the flaps; None where there are none."""
    within: Flags | None = None
    for side in ready.flaps:
        inside = side[:3] @ rows[POINT] >= -side[3]
        within = inside if within is None else np.logical_and(within, inside, out=within)
    return within


def inside_cone(ready: Controls, cos_light: Singles) -> Flags:
    """Whether each point is in the cone and before the light; `ready` has a direction."""
    assert ready.least_cosine is not None
    inside: Flags = cos_light > 0 if ready.least_cosine == 0 else cos_light >= np.float32(ready.least_cosine)
    return inside


def concentrated(cos_light: Singles, concentration: float) -> Singles:
    """cos^C(L), the light's concentration around its direction. The array of the cosines is worked in.

    Paper: "Light Direction and Concentration". Half is left at 60 degrees for C = 1, at 21.1 for C = 10 and
    at 10.6 for C = 40.
    """
    return power(cos_light, concentration, out=cos_light)
