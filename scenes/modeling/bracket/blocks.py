"""Blocks of quadrilaterals in a plane, and one mesh of several blocks that share their sides."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from autocolor.arrays import Floats, Indices

SAME: Final = 6
"""Decimals to which the points of two blocks are the same node."""


@dataclass(frozen=True)
class Plan:
    """A mesh of quadrilaterals in a plane, all wound clockwise.

    `points` is (nodes, 2), `quads` (quads, 4); `blocks` has the node numbers of each block, (i, j), and
    `quads_of` the rows of its quads, (i - 1, j - 1).
    """

    points: Floats
    quads: Indices
    blocks: dict[str, Indices]
    quads_of: dict[str, Indices]

    @property
    def outline(self) -> Indices:
        """The edges that belong to one quad only, (edges, 2), in the direction of that quad."""
        edges = np.stack([self.quads, np.roll(self.quads, -1, axis=1)], axis=2).reshape(-1, 2)
        _, place, count = np.unique(np.sort(edges, axis=1), axis=0, return_index=True, return_counts=True)
        found: Indices = edges[place[count == 1]]
        return found


def plan_of(blocks: dict[str, Floats]) -> Plan:
    """The mesh of blocks of points, each (i, j, 2); points at the same place become one node."""
    points = np.concatenate([grid.reshape(-1, 2) for grid in blocks.values()])
    _, first, numbers = np.unique(
        np.round(points, SAME) + 0.0, axis=0, return_index=True, return_inverse=True
    )
    numbers = numbers.reshape(-1)
    nodes: dict[str, Indices] = {}
    quads_of: dict[str, Indices] = {}
    quads: list[Indices] = []
    taken = rows = 0
    for name, grid in blocks.items():
        block = numbers[taken : taken + grid.shape[0] * grid.shape[1]].reshape(grid.shape[:2])
        taken += block.size
        corners = np.stack([block[:-1, :-1], block[1:, :-1], block[1:, 1:], block[:-1, 1:]], axis=-1)
        nodes[name] = block
        quads_of[name] = np.arange(rows, rows + corners[..., 0].size).reshape(corners.shape[:2])
        rows += quads_of[name].size
        quads.append(corners.reshape(-1, 4))
    table, places = np.concatenate(quads), points[first]
    return Plan(places, np.where(areas(places[table])[:, None] > 0, table[:, ::-1], table), nodes, quads_of)


def areas(corners: Floats) -> Floats:
    """The areas of quadrilaterals, (n, 4, 2), positive where they are wound counterclockwise."""
    across, along = corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1]
    return (across[:, 0] * along[:, 1] - across[:, 1] * along[:, 0]) / 2


def to_outline(ring: Floats, outline: Floats, rim: float) -> Floats:
    """Three lines from a ring to an outline, (3, n, 2): the second is `rim` beside it, if there is room."""
    away = outline - ring
    sides = np.diff(outline, axis=0)
    sides /= np.linalg.norm(sides, axis=1)[:, None]
    is_closed = np.allclose(outline[0], outline[-1])
    before = np.concatenate([sides[-1:] if is_closed else sides[:1], sides])
    after = np.concatenate([sides, sides[:1] if is_closed else sides[-1:]])
    # The distances from the sides on either side of each point: the nearer one counts.
    apart = [np.abs(away[:, 0] * side[:, 1] - away[:, 1] * side[:, 0]) for side in (before, after)]
    share = np.minimum(rim / np.minimum(*apart), 0.6)[:, None]
    return np.stack([ring + away * (1 - share) / 2, outline - away * share, outline])


def circle(center: tuple[float, float], radius: float, angles: Floats) -> Floats:
    """The points of a circle at angles in radians, (n, 2)."""
    return np.array(center) + radius * np.stack([np.cos(angles), np.sin(angles)], axis=-1)


def along(line: Floats, count: int) -> Floats:
    """`count` + 1 points at equal distances on a polyline, (n, 2)."""
    lengths = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1))])
    places = np.linspace(0, lengths[-1], count + 1)
    return np.stack([np.interp(places, lengths, component) for component in line.T], axis=-1)


def around_hole(center: tuple[float, float], radii: list[float], outline: Floats, rim: float) -> Floats:
    """The block around a hole: rings of these radii, then three lines to a closed outline; (lines, n, 2).

    The outline repeats its first point. The angles on the rings are halfway between equal ones and those in
    which the points of the outline are seen.
    """
    seen = np.unwrap(np.arctan2(*(outline - center).T[::-1]))
    even = np.linspace(seen[0], seen[-1], len(seen))
    angles = (seen + even) / 2
    rings = np.stack([circle(center, radius, angles) for radius in radii])
    rings[:, -1] = rings[:, 0]
    return np.concatenate([rings, to_outline(rings[-1], outline, rim)])
