"""Scalars of where a point is: its coordinates, and its distance along a direction."""

from __future__ import annotations

from functools import partial
from typing import Final

import numpy as np

from autocolor.arrays import Floats, chunks
from autocolor.scalars.ranges import Limits, ScalarValues, kept, range_of, within
from autocolor.scene.mesh import Mesh
from autocolor.scene.scalars.scalar import Scalar
from autocolor.visibility.visible_points import PIXELS_AT_ONCE, VisiblePoints

AXES: Final = np.eye(3)


def coordinate(axis: int, mesh: Mesh, scalar: Scalar, points: VisiblePoints) -> ScalarValues:
    """A world coordinate; the range is that of the nodes that polygons use."""
    return _along(AXES[axis], mesh, points)


def distance(mesh: Mesh, scalar: Scalar, points: VisiblePoints) -> ScalarValues:
    """The distance from the origin along the scalar's direction; the range is that of the nodes in use."""
    return _along(unit_vector(scalar), mesh, points)


def unit_vector(scalar: Scalar) -> Floats:
    """The direction of a scalar in unit length."""
    direction = np.array(scalar.direction)
    # Measure in the largest component, so that no square is too large or too small.
    direction /= np.abs(direction).max()
    unit: Floats = direction / np.linalg.norm(direction)
    return unit


def _along(direction: Floats, mesh: Mesh, points: VisiblePoints) -> ScalarValues:
    values = np.empty(len(points.pixels), np.float32)
    for chunk in chunks(len(values), PIXELS_AT_ONCE):
        values[chunk] = direction @ points.world_rows(chunk)
    key = ("along", *direction.tolist())
    return within(values, kept(mesh, key, partial(_range_along, direction, mesh)))


def _range_along(direction: Floats, mesh: Mesh) -> Limits:
    return range_of(direction @ mesh.used_coordinates.T)
