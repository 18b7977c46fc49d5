"""The L of the bracket as it is seen from its side, in x and z: two curves, and the rib between its legs."""

from __future__ import annotations

from typing import Final

import numpy as np

from autocolor.arrays import Floats
from scenes.modeling.bracket.measures import AXIS, BASE, BOSS, FILLET, NOSE, NOSE_HEIGHT, RIB_AT_BOSS, UPRIGHT

BEND: Final = FILLET * np.pi / 2
"""The length of the inner fillet."""

LINE_OF_RIB: Final = np.array(
    [(NOSE, BASE + NOSE_HEIGHT), (48.0, 30.0), (UPRIGHT + RIB_AT_BOSS, AXIS - BOSS)]
)
"""The control points of the parabola that the rib ends with, from its nose to the boss."""


def s_of_x(x: Floats | float) -> Floats:
    """The place along the inner curve of a point of the base; 0 is where the fillet begins."""
    return np.asarray(UPRIGHT + FILLET - x, np.float64)


def s_of_z(z: Floats | float) -> Floats:
    """The place along the inner curve of a point of the upright."""
    return np.asarray(BEND + z - BASE - FILLET, np.float64)


def inner(s: Floats) -> Floats:
    """The points x, z of the inner curve by its length, (..., 2): top of the base, front of the upright."""
    angle = np.clip(s, 0, BEND) / FILLET
    x = UPRIGHT + FILLET - FILLET * np.sin(angle) - np.minimum(s, 0)
    z = BASE + FILLET - FILLET * np.cos(angle) + np.maximum(s - BEND, 0)
    return np.stack([x, z], axis=-1)


def inward(s: Floats) -> Floats:
    """The unit normals of the inner curve, away from the material: (..., 2)."""
    angle = np.clip(s, 0, BEND) / FILLET
    return np.stack([np.sin(angle), np.cos(angle)], axis=-1)


def outer(s: Floats) -> Floats:
    """The points x, z of the outer curve across from those of the inner one, (..., 2); it has a corner."""
    turn = np.clip(s, 0, BEND) / BEND
    x = (UPRIGHT + FILLET) * (1 - np.minimum(2 * turn, 1)) - np.minimum(s, 0)
    z = (BASE + FILLET) * np.maximum(2 * turn - 1, 0) + np.maximum(s - BEND, 0)
    return np.stack([x, z], axis=-1)


RIB_BEGINS: Final = s_of_x(NOSE)
RIB_ENDS: Final = s_of_z(AXIS - BOSS)


def edge_of_rib(s: Floats) -> Floats:
    """The points x, z of the rib's edge across from places of the inner curve: (..., 2)."""
    share = ((s - RIB_BEGINS) / (RIB_ENDS - RIB_BEGINS))[..., None]
    first, second, third = LINE_OF_RIB
    return np.asarray((1 - share) ** 2 * first + 2 * share * (1 - share) * second + share**2 * third)


def height_of_rib(s: Floats) -> Floats:
    """The distance from the inner curve to the rib's edge; in front of the rib that of its nose."""
    s = np.maximum(s, RIB_BEGINS)
    return np.asarray(np.linalg.norm(edge_of_rib(s) - inner(s), axis=-1))
