"""The solid of half the bracket: hexahedra in layers on the quads of its plan.

Six layers are the plate of base and upright. The rib has eight more, and the boss eleven in front and two
behind; the counterbores and the seat of the bearing lack some. A node is a column of the plan at a level.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from autocolor.arrays import Floats, Indices
from scenes.modeling.bracket.blocks import Plan
from scenes.modeling.bracket.columns import places
from scenes.modeling.bracket.levels import BACK, BOSS_LAYERS, LEVELS, PLATE, RIB_LAYERS, SEAT_LAYERS
from scenes.modeling.bracket.plan import (
    BOSS_RING,
    COUNTERBORE_RING,
    FLAT_RING,
    NOSE_LINE,
    RIB_COLUMNS,
    SEAT_RING,
    STRIP_COLUMNS,
    half_plan,
)

COUNTERBORE_LEVEL: Final = 3
"""The level of the counterbores' floors."""


@dataclass(frozen=True)
class Solid:
    """Hexahedra: `nodes` (n, 3) in millimeters, `corners` (m, 8), the lower four and then the upper four.

    `zones` tells what each quad of the plan belongs to. `quads`, (m,), are the rows of the hexahedra in the
    plan and `layers`, (m,), their lower levels; `columns`, (n,), are the points of the plan that the nodes
    stand on, and `levels`, (n,), their levels.
    """

    plan: Plan
    zones: tuple[str, ...]
    nodes: Floats
    corners: Indices
    quads: Indices
    layers: Indices
    columns: Indices
    levels: Indices


def half_solid() -> Solid:
    """The half from y = 0 to the right side."""
    plan = half_plan()
    zones = zones_of(plan)
    reach = {
        "counterbore": (0, COUNTERBORE_LEVEL),
        "rib": (0, PLATE + RIB_LAYERS),
        "boss": (BACK, PLATE + BOSS_LAYERS),
        "seat": (BACK, PLATE + SEAT_LAYERS),
    }
    lowest, highest = np.array([reach.get(zone, (0, PLATE)) for zone in zones]).T
    levels = np.arange(BACK, PLATE + BOSS_LAYERS)
    quads, at = np.nonzero((levels >= lowest[:, None]) & (levels < highest[:, None]))
    layers = levels[at]

    # Number the nodes in use: a column and a level each.
    low = plan.quads[quads] * LEVELS + (layers - BACK)[:, None]
    used, corners = np.unique(np.concatenate([low, low + 1], axis=1), return_inverse=True)
    return Solid(
        plan,
        zones,
        places(plan).reshape(-1, 3)[used],
        corners.reshape(-1, 8),
        quads,
        layers,
        used // LEVELS,
        used % LEVELS + BACK,
    )


def zones_of(plan: Plan) -> tuple[str, ...]:
    """What each quad of the plan belongs to.

    Beside the parts these are "rib_foot", "boss_foot" and "counterbore": what is around rib, boss and hole.
    """
    zones = np.full(len(plan.quads), "base", "U12")
    zones[plan.quads_of["bend"]] = "fillet"
    zones[plan.quads_of["stem"]] = "upright"
    # The strip: in front of the nose all of it is the base, but for the last line of cells.
    strip, bearing = plan.quads_of["strip"], plan.quads_of["bearing"]
    zones[strip[1:, :STRIP_COLUMNS]] = "rib_foot"
    zones[strip[NOSE_LINE:, :RIB_COLUMNS]] = "rib"
    zones[bearing] = "upright"
    zones[bearing[:, :STRIP_COLUMNS]] = "rib_foot"
    zones[bearing[:FLAT_RING]] = "boss_foot"
    zones[bearing[:, :RIB_COLUMNS]] = "rib"
    zones[bearing[:BOSS_RING]] = "boss"
    zones[bearing[:SEAT_RING]] = "seat"
    for hole in ("front", "back"):
        zones[plan.quads_of[hole][:COUNTERBORE_RING]] = "counterbore"
    return tuple(zones.tolist())
