"""The skin of the solid: its outer faces, in parts, and both halves of it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from autocolor.arrays import Floats, Indices
from scenes.modeling.bracket.columns import PLATE, SEAT_LAYERS
from scenes.modeling.bracket.measures import PROJECTION, UPRIGHT
from scenes.modeling.bracket.solid import Solid

FACES: Final = np.array([(0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)])
"""The faces of a hexahedron, the lower, the upper and the sides, each wound counterclockwise from outside."""

PARTS: Final = (
    "base", "upright", "fillet", "rib", "boss", "boss_faces", "bore", "seat", "counterbores", "holes", "underside",
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
    """The part of each face, by what its quad in the plan belongs to and where it looks."""
    zone = np.array(solid.zones)[solid.quads[hexahedra]]
    layer = solid.layers[hexahedra]
    part = zone.copy().astype("U12")
    part[zone == "rib_foot"] = "rib"
    part[zone == "boss_foot"] = "boss"

    is_above, is_below = faces == 1, faces == 0
    is_side = faces > 1
    part[zone == "counterbore"] = "holes"
    part[(zone == "counterbore") & is_above] = "counterbores"
    # Faces beside a ring of the plan: the nodes of the walls of counterbores are its own.
    ring = np.zeros(len(solid.plan.points), np.bool_)
    for hole in ("front", "back"):
        ring[solid.plan.blocks[hole][2]] = True
    part[is_side & ring[solid.columns[corners]].all(axis=1)] = "counterbores"
    # The boss: what looks forward or backward, and all chamfers, are machined.
    is_boss = zone == "boss"
    inside = np.hypot(solid.nodes[corners, 1], solid.nodes[corners, 2] - 92.0).max(axis=1) < 20
    part[is_boss & (is_above | is_below)] = "boss_faces"
    part[is_boss & is_side & (layer < 0)] = "boss_faces"
    part[is_boss & is_side & (layer == layer.max())] = "boss_faces"
    part[is_boss & is_side & inside] = "seat"
    part[(zone == "seat")] = "bore"
    part[(zone == "seat") & is_above] = "seat"
    part[(zone == "seat") & is_below] = "boss_faces"
    # What the bracket stands on, and the back.
    middle = solid.nodes[corners].mean(axis=1)
    part[is_below & (layer == 0) & (middle[:, 2] < 1e-6)] = "underside"
    part[is_below & (layer == 0) & (middle[:, 2] > 1e-6)] = "upright"
    return np.array([PARTS.index(name) for name in part.tolist()])


def both_halves(nodes: Floats, skin: Skin) -> tuple[Floats, Indices, Indices, Indices]:
    """The nodes (n, 3), corners and parts of the whole skin, and the row of the solid's node at each."""
    used, numbers = np.unique(skin.corners, return_inverse=True)
    numbers = numbers.reshape(-1, 4)
    is_apart = np.abs(nodes[used, 1]) > 1e-9
    mirrored = np.where(is_apart, len(used) + np.cumsum(is_apart) - 1, np.arange(len(used)))
    places = np.concatenate([nodes[used], nodes[used[is_apart]] * [1, -1, 1]])
    corners = np.concatenate([numbers, mirrored[numbers][:, ::-1]])
    return places, corners, np.tile(skin.parts, 2), np.concatenate([used, used[is_apart]])
