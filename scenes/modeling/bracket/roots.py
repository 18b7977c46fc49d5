"""The profiles of the fillets at the foot of rib and boss, and of the edges that are rounded or chamfered.

A fillet is divided at its middle: below, the plate rises to it; above, the wall that stands on the plate
begins. So no hexahedron has an edge that ends in nothing.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from autocolor.arrays import Floats
from scenes.modeling.bracket.measures import CREST, ROOT

FOOT_ANGLES: Final = np.radians([0.0, 15.0, 30.0, 45.0])
"""Where the nodes of the plate are on the fillet, from where it is tangent to the plate."""

WALL_ANGLES: Final = np.radians([45.0, 60.0, 75.0, 90.0])
"""Where those of the wall are."""

EDGE_ANGLES: Final = np.radians([0.0, 30.0, 60.0, 90.0])
"""Where the nodes of a rounded edge are, from the wall to the top."""

FOOT: Final = ROOT * (1 - np.sqrt(0.5))
"""The distance of a fillet's middle from the wall, which is its height above the plate as well."""


def scale_of_roots(height: Floats) -> Floats:
    """How much smaller fillet and crest are where a rib of this height has no room for them."""
    return np.minimum(1.0, height / (ROOT + CREST + 0.5))


def distances(angles: Floats) -> Floats:
    """The distances from the wall of the points of a fillet."""
    return ROOT * (1 - np.sin(angles))


def heights(angles: Floats) -> Floats:
    """Their heights above the plate."""
    return ROOT * (1 - np.cos(angles))


def rise(distance: Floats, scale: Floats) -> Floats:
    """How far the plate rises at a distance from a wall: to the middle of the fillet, and no further."""
    radius = ROOT * scale
    left = radius - np.clip(distance, FOOT * scale, radius)
    return radius - np.sqrt(radius**2 - left**2)
