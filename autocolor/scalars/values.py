"""The value of the scalar of a scene at each visible point, and its own range."""

from __future__ import annotations

from functools import partial

import numpy as np

from autocolor.arrays import Floats, Indices, used_rows
from autocolor.immutable import read_only
from autocolor.scalars.computed import (
    COMPUTING,
    Limits,
    ScalarValues,
    kept,
    limits_of_object,
    range_of,
    within,
)
from autocolor.scalars.interpolation import interpolated
from autocolor.scene.mesh import Mesh
from autocolor.scene.scalar import POLYGON, MeshScalar, Scalar
from autocolor.visibility.visible_points import VisiblePoints


def scalar_values(
    mesh: Mesh, scalar: Scalar, points: VisiblePoints, object_coordinates: Floats | None = None
) -> ScalarValues:
    """The values of a scalar at the visible points; the scalars of the mesh come before computed ones.

    Where the object is a part of the mesh, the range of a coordinate or a distance is that of the
    `object_coordinates`, (nodes, 3): a wide floor would leave it few colors.
    """
    of_mesh = {each.name: each for each in mesh.scalars}.get(scalar.name)
    if of_mesh is None:
        values, limits = COMPUTING[scalar.name](mesh, scalar, points)
        if object_coordinates is not None:
            limits = limits_of_object(scalar, object_coordinates) or limits
    else:
        values, limits = (_of_polygons if of_mesh.of == POLYGON else _of_nodes)(mesh, of_mesh, points)
    return ScalarValues(read_only(values), limits)


def _of_polygons(mesh: Mesh, scalar: MeshScalar, points: VisiblePoints) -> ScalarValues:
    """The values of the polygons that are seen; the range is that of all polygons."""
    values = scalar.values.take(points.span_polygons).astype(np.float32)
    limits = kept(mesh, ("of mesh", scalar.name), partial(range_of, scalar.values))
    return ScalarValues(np.repeat(values, points.span_lengths), limits)


def _of_nodes(mesh: Mesh, scalar: MeshScalar, points: VisiblePoints) -> ScalarValues:
    """The values between those of the nodes; the range is that of the nodes that polygons use."""
    node_rows = mesh.node_numbers.T

    def corner_values(polygons: Indices) -> Floats:
        return scalar.values.take(np.take(node_rows, polygons, axis=1))

    limits = kept(mesh, ("of mesh", scalar.name), partial(_range_of_nodes, mesh, scalar))
    return within(interpolated(mesh, points, corner_values), limits)


def _range_of_nodes(mesh: Mesh, scalar: MeshScalar) -> Limits:
    used = used_rows(mesh.node_numbers.T, len(scalar.values))
    return range_of(scalar.values if used.all() else scalar.values[used])
