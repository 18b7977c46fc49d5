"""The skin of the solid: its outer faces, in parts, and both halves of it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from autocolor.arrays import Floats, Indices
from scenes.modeling.bracket.measures import AXIS, BOSS, SEAT
from scenes.modeling.bracket.plan import COUNTERBORE_RING
from scenes.modeling.bracket.solid import Solid

FACES: Final = np.array([(0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)])
"""The faces of a hexahedron, the lower, the upper and the sides, each wound counterclockwise from outside."""

PARTS: Final = (
    "base", "upright", "fillet", "rib", "boss", "boss_faces", "bore", "seat", "counterbores", "holes",
    "underside", "back",
)  # fmt: skip


@dataclass(frozen=True)
class Skin:
    """Quads: `corners` (n, 4), rows of the solid's nodes, and `parts` (n,), rows of PARTS."""

    corners: Indices
    parts: Indices


def half_skin(solid: Solid) -> Skin:
    """The outer faces of half the bracket; those in the middle, where the other half begins, are none."""
    faces = solid.corners[:, FACES]
    keys = np.sort(faces.reshape(-1, 4), axis=1)
    _, first, count = np.unique(keys, axis=0, return_index=True, return_counts=True)
    rows = np.sort(first[count == 1])
    corners = faces.reshape(-1, 4)[rows]
    is_middle = (np.abs(solid.nodes[corners, 1]) < 1e-9).all(axis=1)
    rows, corners = rows[~is_middle], corners[~is_middle]
    return Skin(corners, _parts(solid, rows // len(FACES), rows % len(FACES), corners))


def _parts(solid: Solid, hexahedra: Indices, faces: Indices, corners: Indices) -> Indices:
    """The part of each face, by what its quad in the plan belongs to and by where it looks."""
    zone = np.array(solid.zones)[solid.quads[hexahedra]]
    layer = solid.layers[hexahedra]
    middle = solid.nodes[corners].mean(axis=1)
    is_below, is_above, is_side = faces == 0, faces == 1, faces > 1
    rings = [solid.plan.blocks[hole][COUNTERBORE_RING] for hole in ("front", "back")]
    is_ring = np.isin(solid.columns[corners], np.concatenate(rings)).all(axis=1)
    is_boss, is_seat = zone == "boss", zone == "seat"
    is_inside = np.hypot(middle[:, 1], middle[:, 2] - AXIS) < (SEAT + BOSS) / 2
    # Later rules go before earlier ones.
    rules = {
        "base": zone == "base",
        "upright": zone == "upright",
        "fillet": zone == "fillet",
        "rib": (zone == "rib") | (zone == "rib_foot"),
        "boss": is_boss | (zone == "boss_foot"),
        # What is cut of the boss: its faces with their chamfers, and all of it behind.
        "boss_faces": (is_boss & (~is_side | (layer < 0) | (layer == layer.max()))) | (is_seat & is_below),
        "bore": is_seat & is_side,
        "seat": (is_boss & is_side & is_inside) | (is_seat & is_above),
        "holes": zone == "counterbore",
        "counterbores": ((zone == "counterbore") & is_above) | (is_side & is_ring),
        "underside": is_below & (layer == 0) & (middle[:, 2] < 1e-6),
        "back": is_below & (layer == 0) & (middle[:, 2] >= 1e-6),
    }
    parts = np.zeros(len(corners), np.intp)
    for name, holds in rules.items():
        parts[holds] = PARTS.index(name)
    return parts


def both_halves(nodes: Floats, skin: Skin) -> tuple[Floats, Indices, Indices, Indices]:
    """The nodes (n, 3), corners and parts of the whole skin, and the row of the solid's node at each."""
    used, numbers = np.unique(skin.corners, return_inverse=True)
    numbers = numbers.reshape(-1, 4)
    is_apart = np.abs(nodes[used, 1]) > 1e-9
    mirrored = np.where(is_apart, len(used) + np.cumsum(is_apart) - 1, np.arange(len(used)))
    places = np.concatenate([nodes[used], nodes[used[is_apart]] * [1, -1, 1]])
    corners = np.concatenate([numbers, mirrored[numbers][:, ::-1]])
    return places, corners, np.tile(skin.parts, 2), np.concatenate([used, used[is_apart]])
