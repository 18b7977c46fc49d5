"""The nodes of a mesh moved to the middle and scaled to a size of 1, without a copy of the node table."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from autocolor.arrays import Floats, Indices


class ScaledNodes(NamedTuple):
    """Nodes, rows (3, nodes), of which `middle`, (3,), becomes 0 and `extent` becomes 1."""

    rows: Floats
    middle: Floats
    extent: float

    def corners(self, node_rows: Indices) -> Floats:
        """The corners, (3, 4, polygons), of polygons with these nodes, (4, polygons)."""
        corners: Floats = np.take(self.rows, node_rows, axis=1)
        corners -= self.middle[:, None, None]
        corners /= self.extent
        return corners


def as_they_are(rows: Floats) -> ScaledNodes:
    """Nodes that are neither moved nor scaled."""
    return ScaledNodes(rows, np.zeros(3), 1.0)
