"""The value of the scalar of a scene at each visible point, and its own range."""

from __future__ import annotations

import numpy as np

from autocolor.arrays import Floats, Indices
from autocolor.immutable import read_only
from autocolor.scalars.computed import COMPUTING, ScalarValues
from autocolor.scalars.interpolation import interpolated
from autocolor.scalars.ranges import range_of
from autocolor.scene.mesh import Mesh
from autocolor.scene.scalars.mesh_scalars import POLYGON, MeshScalar
from autocolor.scene.scalars.scalar import Scalar
from autocolor.visibility.visible_points import VisiblePoints


def scalar_values(mesh: Mesh, scalar: Scalar, points: VisiblePoints) -> ScalarValues:
    """The values of a scalar at the visible points; the scalars of the mesh come before computed ones."""
    for of_mesh in mesh.scalars:
        if of_mesh.name == scalar.name:
            found = _of_polygons if of_mesh.of == POLYGON else _of_nodes
            found_values, limits = found(mesh, of_mesh, points)
            break
    else:
        found_values, limits = COMPUTING[scalar.name](mesh, scalar, points)
    return ScalarValues(read_only(found_values), limits)


def _of_polygons(mesh: Mesh, scalar: MeshScalar, points: VisiblePoints) -> ScalarValues:
    """The values of the polygons that are seen."""
    values = scalar.values[points.span_polygons].astype(np.float32)
    return ScalarValues(np.repeat(values, points.span_lengths), range_of(scalar.values))


def _of_nodes(mesh: Mesh, scalar: MeshScalar, points: VisiblePoints) -> ScalarValues:
    """The values between those of the nodes; the range is that of the nodes that polygons use."""
    node_rows = mesh.node_numbers.T
    used = np.zeros(len(scalar.values), np.bool_)
    used[node_rows] = True

    def corner_values(polygons: Indices) -> Floats:
        return scalar.values.take(np.take(node_rows, polygons, axis=1))

    limits = range_of(scalar.values[used])
    values = interpolated(mesh, points, corner_values)
    # A sum may be rounded to a little beyond the largest of its numbers.
    np.clip(values, *limits, out=values)
    return ScalarValues(values, limits)
