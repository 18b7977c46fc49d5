"""Planes fitted to groups of polygons."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from autocolor.arrays import Floats, Indices
from autocolor.scene.geometry.planes.plane_cells import Facets


class Fits(NamedTuple):
    """A plane fitted to each group: a unit normal and a point, (3, groups), and how wide its polygons reach.

    `widths`, (groups,), is across the longest direction: of those of a square with area 1 it is about 1.
    """

    normals: Floats
    points: Floats
    widths: Floats

    def off(self, corners: Floats, groups: Indices) -> Floats:
        """How far corners, (3, 4, n), are from the planes of `groups`, (n,), on their signed side: (4, n)."""
        off: Floats = np.einsum(
            "in,icn->cn",
            np.take(self.normals, groups, axis=1),
            corners - np.take(self.points, groups, axis=1)[:, None],
        )
        return off


def fitted(found: Facets, groups: Indices) -> Fits:
    """The planes from which the corners are least far; `groups` are sorted, and numbered without gaps."""
    if not len(groups):
        return Fits(np.empty((3, 0)), np.empty((3, 0)), np.empty(0))
    first = np.flatnonzero(np.diff(groups, prepend=-1))
    weights = found.areas / np.add.reduceat(found.areas, first)[groups]
    points = np.add.reduceat(weights * found.centers, first, axis=1)
    away = found.corners - points[:, None, groups]
    spread = np.add.reduceat(np.einsum("n,icn,jcn->nij", weights, away, away), first, axis=0)
    # The normal is the direction in which the corners spread least.
    spreads, directions = np.linalg.eigh(spread)
    return Fits(directions[:, :, 0].T.copy(), points, np.sqrt(np.maximum(spreads[:, 1], 0.0)))


def renumbered(groups: Indices) -> Indices:
    """Sorted group numbers without gaps, from 0."""
    numbers: Indices = np.cumsum(np.diff(groups, prepend=groups[:1]) != 0)
    return numbers
