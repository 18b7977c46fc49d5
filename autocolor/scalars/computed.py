"""The scalars that are computed of any mesh, by name.

One more is one function, a line here, and its name in `scene.scalars.computed_names`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import Final

from autocolor.scalars.angles import draft_angle, slope
from autocolor.scalars.bending import (
    gaussian_curvature,
    largest_curvature,
    mean_curvature,
    smallest_curvature,
)
from autocolor.scalars.places import coordinate, distance
from autocolor.scalars.ranges import ScalarValues
from autocolor.scalars.stripes import zebra
from autocolor.scene.mesh import Mesh
from autocolor.scene.scalars.scalar import Scalar
from autocolor.visibility.visible_points import VisiblePoints

Computing = Callable[[Mesh, Scalar, VisiblePoints], ScalarValues]

COMPUTING: Final[Mapping[str, Computing]] = {
    "x": partial(coordinate, 0),
    "y": partial(coordinate, 1),
    "z": partial(coordinate, 2),
    "distance": distance,
    "slope": slope,
    "draft angle": draft_angle,
    "mean curvature": mean_curvature,
    "gaussian curvature": gaussian_curvature,
    "largest curvature": largest_curvature,
    "smallest curvature": smallest_curvature,
    "zebra": zebra,
}
