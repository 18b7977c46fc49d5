"""The tables that both OBJ readers return: nodes, and polygons with the node numbers of the file."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np

from autocolor.arrays import Floats, Indices, Numbers

LONGEST_LINE: Final = 1 << 20
"""Assumed: bytes of one statement, including its continuation lines."""


@dataclass(frozen=True, eq=False)
class ObjTables:
    """The nodes and polygons of an OBJ file.

    `coordinates` is (nodes, 3). `numbers` holds the node numbers of all polygons, concatenated, as in the
    file: from 1, or negative, counted back from the latest node. `corner_counts`, `part_numbers` and
    `nodes_before` (the number of nodes defined before the polygon) have one element for each polygon.
    """

    coordinates: Floats
    numbers: Numbers
    corner_counts: Numbers
    part_numbers: Numbers
    nodes_before: Numbers

    @cached_property
    def rows(self) -> Indices:
        """The row in `coordinates` of each corner; -1 if there is no such node."""
        rows = self.numbers - 1
        back = np.flatnonzero(self.numbers < 0)
        if len(back):
            rows[back] = np.repeat(self.nodes_before, self.corner_counts)[back] + self.numbers[back]
        rows[(rows < 0) | (rows >= len(self.coordinates))] = -1
        return rows.astype(np.intp, copy=False)
