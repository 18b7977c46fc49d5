"""Scalars of how the surface lies: its slope, and its draft angle.

Assumed: the normal is that of the mesh, interpolated between the corners as scalars are. It is not turned to
the eye, so both are the same from every view: the front of a polygon, where its corners run counterclockwise,
is the outside.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from autocolor.arrays import Singles, lengths
from autocolor.scalars.interpolation import weighted_points
from autocolor.scalars.places import unit_vector
from autocolor.scalars.ranges import ScalarValues
from autocolor.scene.mesh import Mesh
from autocolor.scene.scalars.scalar import Scalar
from autocolor.visibility.visible_points import VisiblePoints

SLOPES: Final = (0.0, 90.0)
DRAFT_ANGLES: Final = (-90.0, 90.0)


def slope(mesh: Mesh, scalar: Scalar, points: VisiblePoints) -> ScalarValues:
    """The angle in degrees between the surface and what is level: 0 lies flat, 90 stands.

    Level is across the scalar's direction. Assumed: an overhang has the slope of its upper side.
    """
    return ScalarValues(np.abs(_elevations(mesh, scalar, points, of_surface=True)), SLOPES)


def draft_angle(mesh: Mesh, scalar: Scalar, points: VisiblePoints) -> ScalarValues:
    """The draft angle in degrees for a mold that is pulled off along the scalar's direction.

    It is the angle of the normal above the plane across the pull: 90 faces the pull, 0 is a wall along it,
    and what is negative holds the mold.
    """
    return ScalarValues(_elevations(mesh, scalar, points, of_surface=False), DRAFT_ANGLES)


def _elevations(mesh: Mesh, scalar: Scalar, points: VisiblePoints, *, of_surface: bool) -> Singles:
    """The angle in degrees of the normal above the plane across the direction; 90 less it `of_surface`."""
    pull = unit_vector(scalar)
    vectors, numbers = mesh.normals.vectors.T, mesh.normals.numbers.T
    values = np.empty(len(points.pixels), np.float32)
    for chunk in weighted_points(mesh, points):
        at_corners = np.take(vectors, np.take(numbers, chunk.polygons, axis=1), axis=1)
        rows = [chunk.interpolated(row) for row in at_corners.astype(np.float64)]
        normals = np.stack(rows).astype(np.float64)
        along = pull @ normals
        across = lengths(normals - pull[:, None] * along)
        # An arc tangent of both is exact where an arc sine or cosine is not.
        angles = np.arctan2(across, np.abs(along)) if of_surface else np.arctan2(along, across)
        values[chunk.pixels] = np.degrees(angles)
    return values
