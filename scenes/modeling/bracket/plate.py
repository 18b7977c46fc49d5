"""Where the nodes of base and upright are, with the lower halves of the fillets and the rounded edges."""

from __future__ import annotations

from typing import Final

import numpy as np

from autocolor.arrays import Floats, Indices
from scenes.modeling.bracket.blocks import Plan
from scenes.modeling.bracket.levels import PLATE
from scenes.modeling.bracket.measures import BASE, BOSS, CHAMFER, EDGE, RIB
from scenes.modeling.bracket.plan import CENTER, COUNTERBORE_RING, HOLE_Y, HOLES_X
from scenes.modeling.bracket.profile import RIB_BEGINS, height_of_rib, inner, inward, outer, s_of_x
from scenes.modeling.bracket.roots import EDGE_ANGLES, rise, scale_of_roots

SHARES: Final = np.array([0.0, 0.10, 0.36, 0.64, 0.80, 0.91, 1.0])
"""How high in the plate its levels are."""


def plate_places(plan: Plan) -> Floats:
    """The places of the nodes of base and upright, (points, PLATE + 1, 3)."""
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
