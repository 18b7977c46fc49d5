"""Where the nodes of the rib are, which stands on the plate from its nose to the boss."""

from __future__ import annotations

import numpy as np

from autocolor.arrays import Floats
from scenes.modeling.bracket.blocks import Plan
from scenes.modeling.bracket.levels import RIB_LAYERS
from scenes.modeling.bracket.measures import CREST, RIB
from scenes.modeling.bracket.plan import BOSS_RING, NOSE_LINE, RIB_COLUMNS
from scenes.modeling.bracket.profile import RIB_BEGINS, edge_of_rib, height_of_rib, inner, inward
from scenes.modeling.bracket.roots import EDGE_ANGLES, FOOT, WALL_ANGLES, distances, heights, scale_of_roots


def rib_places(plan: Plan) -> Floats:
    """The places of the nodes of the rib above the plate, (points, RIB_LAYERS, 3)."""
    strip, bearing = plan.blocks["strip"], plan.blocks["bearing"]
    found = np.zeros((len(plan.points), RIB_LAYERS, 3))
    lines = [*strip[NOSE_LINE:, : RIB_COLUMNS + 1], *bearing[:BOSS_RING:-1, : RIB_COLUMNS + 1]]
    for line in lines:
        s = np.repeat(plan.points[line, :1], RIB_LAYERS, axis=1)
        if line[0] == strip[NOSE_LINE, 0]:
            # The nose has the same fillet and the same round edge as the sides.
            _, side = _side(height_of_rib(RIB_BEGINS[None]))
            s = np.tile(RIB_BEGINS - (side[0, 1:] - RIB), (len(line), 1))
        height, y = rib_levels(s)
        foot = inner(s)
        path = edge_of_rib(np.maximum(s, RIB_BEGINS)) - foot
        path[s < RIB_BEGINS] = inward(np.array(0.0)) * height_of_rib(RIB_BEGINS)
        section = foot + path * (height / height_of_rib(s))[..., None]
        found[line] = np.stack([section[..., 0], y, section[..., 1]], axis=-1)
    return found


def rib_levels(s: Floats) -> tuple[Floats, Floats]:
    """The heights and the y of the columns from the rib's middle to its side, (columns, RIB_LAYERS)."""
    share = np.arange(RIB_COLUMNS + 1)[:, None] / RIB_COLUMNS
    full = height_of_rib(s[:, -1])
    side, half = (levels[:, 1:] for levels in _side(full))
    foot = FOOT * scale_of_roots(full)[:, None]
    even = foot + (full[:, None] - foot) * np.arange(1, RIB_LAYERS + 1) / RIB_LAYERS
    return even + (side - even) * share, half * share


def _side(height: Floats) -> tuple[Floats, Floats]:
    """The heights and the y of the rib's side at its levels, both (n, RIB_LAYERS + 1), for heights (n,)."""
    scale = scale_of_roots(height)[:, None]
    crest = CREST * scale
    root, wall = scale * heights(WALL_ANGLES), RIB + scale * distances(WALL_ANGLES)
    top = height[:, None] - crest * (1 - np.sin(EDGE_ANGLES))
    middle = (root[:, -1:] + top[:, :1]) / 2
    y = np.concatenate([wall, np.full_like(middle, RIB), RIB - crest * (1 - np.cos(EDGE_ANGLES))], axis=1)
    return np.concatenate([root, middle, top], axis=1), y
