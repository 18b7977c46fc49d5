"""What the two OBJ readers hand on: the node table and the corners as the file numbers them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np

from autocolor.arrays import Floats, Integers, Numbers

LONGEST_LINE: Final = 1 << 20
"""Assumed: bytes of one statement, its continuation lines included."""


@dataclass(frozen=True, eq=False)
class ObjTables:
    """Node numbers as they stand in the file: from 1, or negative, counted back from the latest node.

    `coordinates` is (nodes, 3); `numbers` holds the corners of all polygons one after the other;
    `corner_counts`, `part_numbers` and `nodes_before` (how many nodes stood before it) have a row a polygon.
    """

    coordinates: Floats
    numbers: Integers
    corner_counts: Integers
    part_numbers: Integers
    nodes_before: Integers

    @cached_property
    def rows(self) -> Numbers:
        """The row of the node table for each corner, -1 where there is no such node."""
        rows = self.numbers - 1
        back = np.flatnonzero(self.numbers < 0)
        if len(back):
            rows[back] = np.repeat(self.nodes_before, self.corner_counts)[back] + self.numbers[back]
        rows[(rows < 0) | (rows >= len(self.coordinates))] = -1
        return rows.astype(np.intp, copy=False)
