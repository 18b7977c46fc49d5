"""The scalars that are computed of any mesh, by name.

One more is one function here, and its name in `scene.scalars.computed_names`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import Final, NamedTuple

import numpy as np

from autocolor.arrays import Singles, chunks
from autocolor.scalars.ranges import Limits, widened
from autocolor.scene.mesh import Mesh
from autocolor.scene.scalars.scalar import Scalar
from autocolor.visibility.visible_points import PIXELS_AT_ONCE, VisiblePoints


class ScalarValues(NamedTuple):
    """A scalar at the visible points, (n,) float32 in their order, NaN where missing, and its own range."""

    values: Singles
    limits: Limits


Computing = Callable[[Mesh, Scalar, VisiblePoints], ScalarValues]


def coordinate(axis: int, mesh: Mesh, scalar: Scalar, points: VisiblePoints) -> ScalarValues:
    """A world coordinate; the range is that of the nodes that polygons use."""
    values = np.empty(len(points.pixels), np.float32)
    for chunk in chunks(len(values), PIXELS_AT_ONCE):
        values[chunk] = points.world_rows(chunk)[axis]
    low, high = mesh.bounds
    limits = widened(float(low[axis]), float(high[axis]))
    return ScalarValues(np.clip(values, *limits, out=values), limits)


COMPUTING: Final[Mapping[str, Computing]] = {
    "x": partial(coordinate, 0),
    "y": partial(coordinate, 1),
    "z": partial(coordinate, 2),
}
