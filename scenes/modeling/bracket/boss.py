"""Where the nodes of the boss are, before the upright and behind it, with the seat of the bearing."""

from __future__ import annotations

from typing import Final

import numpy as np

from autocolor.arrays import Floats
from scenes.modeling.bracket.blocks import Plan
from scenes.modeling.bracket.levels import BACK, BOSS_LAYERS, RIB_LAYERS
from scenes.modeling.bracket.measures import BOSS, CHAMFER, PROJECTION, PROJECTION_BACK, RIB_AT_BOSS, ROOT
from scenes.modeling.bracket.plan import BOSS_RING, CENTER, RIB_COLUMNS, SEAT_RING
from scenes.modeling.bracket.profile import inner, inward, outer
from scenes.modeling.bracket.rib import rib_levels
from scenes.modeling.bracket.roots import FOOT, WALL_ANGLES, distances, heights

ABOVE: Final = np.concatenate(
    [heights(WALL_ANGLES), np.linspace(ROOT, RIB_AT_BOSS, 6)[1:], [12.5, PROJECTION - CHAMFER, PROJECTION]]
)
"""How high above the plate the levels of the boss are."""


def boss_places(plan: Plan) -> Floats:
    """The places of the nodes of the boss above the plate, (rings, columns, BOSS_LAYERS, 3)."""
    ring = plan.blocks["bearing"][: BOSS_RING + 1]
    s, y = (np.repeat(plan.points[ring][..., axis, None], BOSS_LAYERS, axis=-1) for axis in (0, 1))
    height = np.broadcast_to(ABOVE[1:], s.shape).copy()

    # The wall: a fillet below, a chamfer above.
    radius = np.full(BOSS_LAYERS, BOSS)
    radius[: len(WALL_ANGLES) - 1] += distances(WALL_ANGLES)[1:]
    radius[-1] -= CHAMFER
    away = (np.stack([s[-1], y[-1]], axis=-1) - CENTER) / (BOSS + FOOT)
    s[-1], y[-1] = CENTER[0] + radius * away[..., 0], radius * away[..., 1]
    # The seat of the bearing, chamfered.
    seat = np.stack([s[SEAT_RING, :, -1] - CENTER[0], y[SEAT_RING, :, -1]], axis=-1)
    seat *= 1 + CHAMFER / np.linalg.norm(seat, axis=-1)[:, None]
    s[SEAT_RING, :, -1], y[SEAT_RING, :, -1] = seat[:, 0] + CENTER[0], seat[:, 1]

    # Where the rib meets the wall, its levels are those of the rib.
    met = slice(RIB_COLUMNS + 1)
    heights_met, y_met = rib_levels(np.full((RIB_COLUMNS + 1, 1), CENTER[0] - BOSS))
    height[-1, met, :RIB_LAYERS], y[-1, met, :RIB_LAYERS] = heights_met, y_met
    s[-1, met, :RIB_LAYERS] = CENTER[0] - np.sqrt(radius[:RIB_LAYERS] ** 2 - y_met**2)

    section = inner(s) + inward(s) * height[..., None]
    return np.stack([section[..., 0], y, section[..., 1]], axis=-1)


def places_behind(plan: Plan) -> Floats:
    """Those behind the upright, beginning with the last, (rings, columns, -BACK, 3)."""
    ring = plan.blocks["bearing"][: BOSS_RING + 1]
    s, y = (np.repeat(plan.points[ring][..., axis, None], -BACK, axis=-1) for axis in (0, 1))
    away = np.stack([s[..., 0] - CENTER[0], y[..., 0]], axis=-1)
    away /= np.linalg.norm(away, axis=-1)[..., None]
    for edge, direction in ((0, 1), (BOSS_RING, -1)):
        s[edge, :, 0] += direction * CHAMFER * away[edge, :, 0]
        y[edge, :, 0] += direction * CHAMFER * away[edge, :, 1]
    depth = np.broadcast_to([PROJECTION_BACK, PROJECTION_BACK - CHAMFER], s.shape)
    section = outer(s) - inward(s) * depth[..., None]
    return np.stack([section[..., 0], y, section[..., 1]], axis=-1)
