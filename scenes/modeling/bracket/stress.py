"""The stress in the bracket under its bearing, computed: bolts hold the base, a shaft loads the boss.

Assumed: cast steel, a shaft that presses down and pushes back against the shoulder of its seat, and bolts
whose heads do not move. Around them the base may lift off what it stands on.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from autocolor.arrays import Floats
from scenes.modeling.bracket.elasticity import displacements, node_stresses, von_mises
from scenes.modeling.bracket.elements import Material
from scenes.modeling.bracket.measures import AXIS, SEAT
from scenes.modeling.bracket.skin import PARTS, Skin
from scenes.modeling.bracket.solid import COUNTERBORE_LEVEL, Solid

STEEL: Final = Material(young=210_000.0, poisson=0.3)

DOWN: Final = 12_000.0
"""The load across the shaft in newtons, and that along it, to the back."""
BACK: Final = 6_000.0


def stress(solid: Solid, skin: Skin) -> Floats:
    """The von Mises stress at the nodes of half the bracket, (n,), in MPa."""
    held = np.zeros(solid.nodes.shape, np.bool_)
    # The other half pulls back what would cross the middle.
    held[np.abs(solid.nodes[:, 1]) < 1e-9, 1] = True
    is_floor = (solid.levels[skin.corners] == COUNTERBORE_LEVEL).all(axis=1)
    is_bolted = (skin.parts == PARTS.index("counterbores")) & is_floor
    held[skin.corners[is_bolted]] = True
    moved = displacements(solid.nodes, solid.corners, STEEL, bearing_load(solid, skin), held)
    return von_mises(node_stresses(solid.nodes, solid.corners, STEEL, moved))


def bearing_load(solid: Solid, skin: Skin) -> Floats:
    """The forces of the bearing on the nodes of half the bracket, (n, 3), in newtons.

    It presses on the lower half of its seat, most at the bottom, and evenly on the shoulder behind it.
    """
    faces = skin.corners[skin.parts == PARTS.index("seat")]
    places = solid.nodes[faces]
    areas = np.cross(places[:, 2] - places[:, 0], places[:, 3] - places[:, 1]) / 2
    middle = places.mean(axis=1) - [0.0, 0.0, AXIS]
    is_shoulder = np.abs(areas[:, 0]) > 0.9 * np.linalg.norm(areas, axis=1)

    pressure = np.where(is_shoulder, 0.0, np.maximum(-middle[:, 2] / SEAT, 0.0))
    across = -pressure[:, None] * areas * [0.0, 1.0, 1.0]
    across *= DOWN / 2 / -across[:, 2].sum()
    along = np.where(is_shoulder[:, None], -areas * [1.0, 0.0, 0.0], 0.0)
    along *= BACK / 2 / -along[:, 0].sum()
    load = np.zeros_like(solid.nodes)
    np.add.at(load, faces, (across + along)[:, None] / 4)
    return load
