"""Where the nodes of the solid are: a column of nodes above and below each point of the plan."""

from __future__ import annotations

import numpy as np

from autocolor.arrays import Floats
from scenes.modeling.bracket.blocks import Plan
from scenes.modeling.bracket.boss import boss_places, places_behind
from scenes.modeling.bracket.levels import BACK, LEVELS, PLATE, RIB_LAYERS
from scenes.modeling.bracket.plan import BOSS_RING
from scenes.modeling.bracket.plate import plate_places
from scenes.modeling.bracket.rib import rib_places


def places(plan: Plan) -> Floats:
    """The place x, y, z of each point of the plan at each level, (points, LEVELS, 3).

    Places where the solid has no node mean nothing.
    """
    found = np.zeros((len(plan.points), LEVELS, 3))
    above = PLATE - BACK + 1
    found[:, -BACK:above] = plate_places(plan)
    found[:, above : above + RIB_LAYERS] = rib_places(plan)
    rings = plan.blocks["bearing"][: BOSS_RING + 1]
    found[rings, above:] = boss_places(plan)
    found[rings, :-BACK] = places_behind(plan)
    return found
