"""Scalars of how much the surface bends: its curvatures.

The sign is that of `Mesh.curvatures`: positive where the surface bends away from its normal, as a ball does.
The largest and the smallest curvature are the principal ones.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Final

import numpy as np

from autocolor.arrays import Floats, Indices
from autocolor.scalars.interpolation import interpolated
from autocolor.scalars.ranges import ScalarValues, kept, range_of, size_of
from autocolor.scene.geometry.curvature import Curvatures
from autocolor.scene.mesh import Mesh
from autocolor.scene.scalars.mesh_scalars import LARGEST_SCALAR
from autocolor.scene.scalars.scalar import Scalar
from autocolor.visibility.visible_points import VisiblePoints

CUT: Final = 2.0
"""Assumed: percent of the normals whose curvature is beyond either end of the range; a few sharp bends would
take all of the colors."""

LEAST: Final = 1e-2
"""Assumed: the range of what is as good as flat, such as rounding on a plate: curvatures in proportion to the
inverse of the object's size."""


def mean_curvature(mesh: Mesh, scalar: Scalar, points: VisiblePoints) -> ScalarValues:
    """The mean of the principal curvatures, in the inverse of the world unit."""
    return _bending(lambda found: found.mean, "mean", mesh, points)


def gaussian_curvature(mesh: Mesh, scalar: Scalar, points: VisiblePoints) -> ScalarValues:
    """The product of the principal curvatures: positive on a ball, negative on a saddle, 0 on a cylinder."""
    return _bending(lambda found: found.gaussian, "gaussian", mesh, points, power=2)


def largest_curvature(mesh: Mesh, scalar: Scalar, points: VisiblePoints) -> ScalarValues:
    """The larger of the principal curvatures."""
    return _bending(partial(_principal, 1.0), "largest", mesh, points)


def smallest_curvature(mesh: Mesh, scalar: Scalar, points: VisiblePoints) -> ScalarValues:
    """The smaller of the principal curvatures."""
    return _bending(partial(_principal, -1.0), "smallest", mesh, points)


def _principal(sign: float, found: Curvatures) -> Floats:
    values: Floats = found.mean + sign * np.sqrt(np.maximum(found.mean**2 - found.gaussian, 0))
    return values


def _bending(
    choose: Callable[[Curvatures], Floats], name: str, mesh: Mesh, points: VisiblePoints, power: int = 1
) -> ScalarValues:
    """Values between those at the normals of the corners; their unit is the inverse world unit to a power."""
    numbers = mesh.normals.numbers.T
    at_normals = np.clip(choose(mesh.curvatures), -LARGEST_SCALAR, LARGEST_SCALAR)

    def corner_values(polygons: Indices) -> Floats:
        return at_normals.take(np.take(numbers, polygons, axis=1))

    least = (LEAST / (size_of(mesh) or 1.0)) ** power
    limits = kept(mesh, ("bending", name), lambda: range_of(at_normals, CUT, least))
    return ScalarValues(interpolated(mesh, points, corner_values), limits)
