"""Where the nodes of the solid are: a column of nodes above and below each point of the plan."""

from __future__ import annotations

from typing import Final

import numpy as np

from autocolor.arrays import Floats, Indices
from scenes.modeling.bracket.blocks import Plan
from scenes.modeling.bracket.measures import (
    BASE,
    BOSS,
    CHAMFER,
    CREST,
    EDGE,
    PROJECTION,
    PROJECTION_BACK,
    RIB,
    RIB_AT_BOSS,
    ROOT,
)
from scenes.modeling.bracket.plan import (
    BOSS_RING,
    CENTER,
    COUNTERBORE_RING,
    HOLE_Y,
    HOLES_X,
    RIB_COLUMNS,
    SEAT_RING,
)
from scenes.modeling.bracket.profile import (
    RIB_BEGINS,
    edge_of_rib,
    height_of_rib,
    inner,
    inward,
    outer,
    s_of_x,
)
from scenes.modeling.bracket.roots import (
    EDGE_ANGLES,
    FOOT,
    WALL_ANGLES,
    distances,
    heights,
    rise,
    scale_of_roots,
)

BACK: Final = -2
PLATE: Final = 6
RIB_LAYERS: Final = 8
SEAT_LAYERS: Final = 4
BOSS_LAYERS: Final = 11
LEVELS: Final = PLATE + BOSS_LAYERS - BACK + 1

NOSE_LINE: Final = 5
"""The line of the strip where the rib begins."""

SHARES: Final = np.array([0.0, 0.10, 0.36, 0.64, 0.80, 0.91, 1.0])
"""How high in the plate its levels are."""

ABOVE: Final = np.concatenate(
    [heights(WALL_ANGLES), np.linspace(ROOT, RIB_AT_BOSS, 6)[1:], [12.5, PROJECTION - CHAMFER, PROJECTION]]
)
"""How high above the plate the levels of the boss are."""


def places(plan: Plan) -> Floats:
    """The place x, y, z of each point of the plan at each level, (points, LEVELS, 3).

    Places where the solid has no node mean nothing.
    """
    found = np.zeros((len(plan.points), LEVELS, 3))
    found[:, -BACK : PLATE - BACK + 1] = _plate(plan)
    found[:, PLATE - BACK + 1 : PLATE - BACK + 1 + RIB_LAYERS] = _rib(plan)
    ring = plan.blocks["bearing"]
    found[ring[: BOSS_RING + 1], PLATE - BACK + 1 :] = _boss(plan)
    found[ring[: BOSS_RING + 1], :-BACK] = _boss_behind(plan)
    return found


def _plate(plan: Plan) -> Floats:
    """The levels of base and upright, (points, PLATE + 1, 3)."""
    s, y = (np.repeat(component[:, None], PLATE + 1, axis=1) for component in plan.points.T)
    share = np.tile(SHARES, (len(s), 1))
    thickness = np.linalg.norm(inner(s) - outer(s), axis=-1)

    # Round the edges of the outline above, and chamfer them below.
    outline, normals = _inward_of_outline(plan)
    edge = thickness[outline]
    low = 1 - EDGE / edge[:, 0]
    share[outline, 1], share[outline, 2] = CHAMFER / edge[:, 0], low / 2
    share[outline, 3:] = low[:, None] + (1 - low)[:, None] * np.sin(EDGE_ANGLES)
    into = np.concatenate([[CHAMFER, 0.0, 0.0], EDGE * (1 - np.cos(EDGE_ANGLES))])
    s[outline] += normals[:, :1] * into
    y[outline] += normals[:, 1:] * into

    # Chamfer the counterbores.
    for hole, x in (("front", HOLES_X[1]), ("back", HOLES_X[0])):
        ring = plan.blocks[hole][COUNTERBORE_RING]
        share[ring, PLATE - 1] = 1 - CHAMFER / BASE
        center = np.array([float(s_of_x(x)), HOLE_Y])
        away = plan.points[ring] - center
        away *= CHAMFER / np.linalg.norm(away, axis=1)[:, None]
        s[ring, PLATE] += away[:, 0]
        y[ring, PLATE] += away[:, 1]

    below = outer(s)
    section = below + (inner(s) - below) * share[..., None]
    section += inward(s) * (_rise(plan)[:, None] * share)[..., None]
    return np.stack([section[..., 0], y, section[..., 1]], axis=-1)


def _rise(plan: Plan) -> Floats:
    """How far the fillets at rib and boss raise the plate at each point of the plan."""
    s, y = plan.points.T
    of_rib = rise(np.maximum(RIB_BEGINS - s, y - RIB), scale_of_roots(height_of_rib(s)))
    of_rib[s > CENTER[0]] = 0.0
    of_boss = rise(np.hypot(s - CENTER[0], y) - BOSS, np.ones(len(s)))
    return np.maximum(of_rib, of_boss)


def _inward_of_outline(plan: Plan) -> tuple[Indices, Floats]:
    """The points of the outline but for y = 0 and the holes, and the directions into the plan, (n, 2)."""
    edges = plan.outline
    ends = plan.points[edges]
    rings = [plan.blocks[name][0] for name in ("front", "back", "bearing")]
    is_side = ~np.isin(edges, np.concatenate(rings)).any(axis=1) & (ends[:, :, 1] > 1e-9).any(axis=1)
    edges, ends = edges[is_side], ends[is_side]
    along = ends[:, 1] - ends[:, 0]
    along /= np.linalg.norm(along, axis=1)[:, None]
    # The quads are wound clockwise.
    normal = np.stack([along[:, 1], -along[:, 0]], axis=1)
    sums = np.zeros_like(plan.points)
    for end in (0, 1):
        np.add.at(sums, edges[:, end], normal)
    outline = np.unique(edges)
    found = sums[outline]
    found[plan.points[outline, 1] < 1e-9, 1] = 0.0
    return outline, found / np.linalg.norm(found, axis=1)[:, None]


def rib_levels(height: Floats) -> tuple[Floats, Floats]:
    """The heights and the y of the rib's side at its levels, both (n, RIB_LAYERS + 1), for heights (n,)."""
    scale = scale_of_roots(height)[:, None]
    crest = CREST * scale
    root, wall = scale * heights(WALL_ANGLES), RIB + scale * distances(WALL_ANGLES)
    top = height[:, None] - crest * (1 - np.sin(EDGE_ANGLES))
    middle = (root[:, -1:] + top[:, :1]) / 2
    y = np.concatenate([wall, np.full_like(middle, RIB), RIB - crest * (1 - np.cos(EDGE_ANGLES))], axis=1)
    return np.concatenate([root, middle, top], axis=1), y


def _rib(plan: Plan) -> Floats:
    """The levels of the rib above the plate, (points, RIB_LAYERS, 3)."""
    strip, bearing = plan.blocks["strip"], plan.blocks["bearing"]
    found = np.zeros((len(plan.points), RIB_LAYERS, 3))
    lines = [*strip[NOSE_LINE:, : RIB_COLUMNS + 1], *bearing[:BOSS_RING:-1, : RIB_COLUMNS + 1]]
    for line in lines:
        s = np.repeat(plan.points[line, :1], RIB_LAYERS, axis=1)
        if line[0] == strip[NOSE_LINE, 0]:
            # The nose has the same fillet and the same round edge as the sides.
            s = np.tile(
                RIB_BEGINS - (rib_levels(height_of_rib(np.array([RIB_BEGINS])))[1][0, 1:] - RIB),
                (len(line), 1),
            )
        height, y = _rib_levels(s)
        foot = inner(s)
        path = edge_of_rib(np.maximum(s, RIB_BEGINS)) - foot
        path[s < RIB_BEGINS] = inward(np.array(0.0)) * height_of_rib(RIB_BEGINS)
        section = foot + path * (height / height_of_rib(s))[..., None]
        found[line] = np.stack([section[..., 0], y, section[..., 1]], axis=-1)
    return found


def _rib_levels(s: Floats) -> tuple[Floats, Floats]:
    """The heights and the y of the columns from the rib's middle to its side, (columns, RIB_LAYERS)."""
    share = np.arange(RIB_COLUMNS + 1)[:, None] / RIB_COLUMNS
    full = height_of_rib(s[:, -1])
    side, half = (levels[:, 1:] for levels in rib_levels(full))
    foot = FOOT * scale_of_roots(full)[:, None]
    even = foot + (full[:, None] - foot) * np.arange(1, RIB_LAYERS + 1) / RIB_LAYERS
    return even + (side - even) * share, half * share


def _boss(plan: Plan) -> Floats:
    """The levels of the boss above the plate, (rings, columns, BOSS_LAYERS, 3)."""
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
    heights_met, y_met = _rib_levels(np.full((RIB_COLUMNS + 1, 1), CENTER[0] - BOSS))
    height[-1, met, :RIB_LAYERS], y[-1, met, :RIB_LAYERS] = heights_met, y_met
    s[-1, met, :RIB_LAYERS] = CENTER[0] - np.sqrt(radius[:RIB_LAYERS] ** 2 - y_met**2)

    section = inner(s) + inward(s) * height[..., None]
    return np.stack([section[..., 0], y, section[..., 1]], axis=-1)


def _boss_behind(plan: Plan) -> Floats:
    """The levels of the boss behind the upright, from the last one on, (rings, columns, -BACK, 3)."""
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
