"""The part that is seen at each visible point, worked out when it is first asked for."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from autocolor.arrays import Indices, PartNumbers
from autocolor.immutable import Immutable, read_only


@dataclass(frozen=True, eq=False, repr=False)
class VisibleParts(Immutable):
    """The parts of the visible points, which come in spans that see the same polygon.

    `names` are those of all parts of the mesh, and `part_of_polygon` their rows, (polygons,). `span_polygons`
    are rows of the polygon table, and `span_lengths` counts of points.
    """

    names: tuple[str, ...]
    part_of_polygon: Indices
    span_polygons: Indices
    span_lengths: Indices

    def __post_init__(self) -> None:
        for array in (self.part_of_polygon, self.span_polygons, self.span_lengths):
            read_only(array)

    @classmethod
    def of_points(cls, names: tuple[str, ...], numbers: PartNumbers) -> VisibleParts:
        """The parts of points whose part numbers, (n,), are known, each of them from 1 on."""
        return cls(names, np.arange(len(names)), numbers.astype(np.intp) - 1, np.ones(len(numbers), np.intp))

    @cached_property
    def numbers(self) -> PartNumbers:
        """The part number at each point, (n,) int32: number k is names[k - 1]; read-only."""
        of_spans = (self.part_of_polygon.take(self.span_polygons) + 1).astype(np.int32)
        return read_only(np.repeat(of_spans, self.span_lengths))
