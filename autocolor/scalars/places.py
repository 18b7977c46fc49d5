"""Scalars of where a point is: its coordinates, and its distance along a direction."""

from __future__ import annotations

from functools import partial
from typing import Final

import numpy as np

from autocolor.arrays import Floats, Singles, chunks
from autocolor.scalars.ranges import UNIT, Limits, ScalarValues, kept, size_of, widened, within
from autocolor.scene.geometry.used_rows import used_rows
from autocolor.scene.mesh import Mesh
from autocolor.scene.scalars.scalar import Scalar
from autocolor.visibility.visible_points import PIXELS_AT_ONCE, POINT, VisiblePoints

LEAST: Final = 1e-6
"""Assumed: the share of an object's size that is rounding, as in the height of a level plate."""


def coordinate(axis: int, mesh: Mesh, scalar: Scalar, points: VisiblePoints) -> ScalarValues:
    """A world coordinate; the range is that of the nodes that polygons use."""
    low, high = mesh.bounds
    limits = widened(float(low[axis]), float(high[axis]), LEAST * size_of(mesh))
    return within(_along(np.eye(3)[axis], points), limits)


def distance(mesh: Mesh, scalar: Scalar, points: VisiblePoints) -> ScalarValues:
    """The distance from the origin along the scalar's direction; the range is that of the nodes in use."""
    direction = unit_vector(scalar)
    key = ("distance", *direction.tolist())
    return within(_along(direction, points), kept(mesh, key, partial(_range_along, direction, mesh)))


def limits_of_object(scalar: Scalar, coordinates: Floats) -> Limits | None:
    """The range of a scalar that tells where a point is, over the nodes of an object, (nodes, 3).

    None for any other scalar.
    """
    if scalar.name not in ("x", "y", "z", "distance") or not len(coordinates):
        return None
    direction = unit_vector(scalar) if scalar.name == "distance" else np.eye(3)["xyz".index(scalar.name)]
    values = coordinates @ direction
    size = float(np.linalg.norm(np.ptp(coordinates, axis=0)))
    return widened(float(values.min()), float(values.max()), LEAST * size)


def unit_vector(scalar: Scalar) -> Floats:
    """The direction of a scalar in unit length."""
    direction = np.array(scalar.direction)
    # Measure in the largest component, so that no square is too large or too small.
    direction /= np.abs(direction).max()
    unit: Floats = direction / np.linalg.norm(direction)
    return unit


def _along(direction: Floats, points: VisiblePoints) -> Singles:
    """The component of each point along a unit vector."""
    toward = points.camera_direction((direction[0], direction[1], direction[2])) * points.unit
    start = toward @ points.middle + direction @ np.array(points.view.eye)
    values = np.empty(len(points.pixels), np.float32)
    for chunk in chunks(len(values), PIXELS_AT_ONCE):
        right, down, ahead = points.rows[POINT, chunk].astype(np.float64)
        values[chunk] = toward[0] * right + toward[1] * down + toward[2] * ahead + start
    return values


def _range_along(direction: Floats, mesh: Mesh) -> Limits:
    """The range of the nodes that polygons use, in chunks: the table may be a mapped file."""
    used = used_rows(mesh.node_numbers.T, len(mesh.coordinates))
    ends = [UNIT] if not used.any() else []
    for chunk in chunks(len(used), PIXELS_AT_ONCE):
        values = (direction @ mesh.coordinates.T[:, chunk])[used[chunk]]
        if len(values):
            ends.append((float(values.min()), float(values.max())))
    return widened(min(low for low, _ in ends), max(high for _, high in ends), LEAST * size_of(mesh))
