"""The values of a scene's scalar at the visible points, and its range: of the mesh, or computed."""

from __future__ import annotations

from functools import partial

import numpy as np

from autocolor.arrays import Floats, Indices, used_rows
from autocolor.immutable import read_only
from autocolor.scalars.computed import (
    COMPUTING,
    Limits,
    ScalarValues,
    cached_range,
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
    """The values of a scalar at the visible points; a scalar of the mesh hides a computed one of its name.

    If the object is a part of the mesh, the range of a coordinate or a distance is that of the
    `object_coordinates`, (nodes, 3): a wide floor would leave the object few colors.
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
    """The values of the visible polygons, and the range of all polygons."""
    values = scalar.values.take(points.span_polygons).astype(np.float32)
    limits = cached_range(mesh, ("of mesh", scalar.name), partial(range_of, scalar.values))
    return ScalarValues(np.repeat(values, points.span_lengths), limits)


def _of_nodes(mesh: Mesh, scalar: MeshScalar, points: VisiblePoints) -> ScalarValues:
    """The values interpolated between nodes, and the range of the nodes that polygons use."""
    node_rows = mesh.node_numbers.T

    def corner_values(polygons: Indices) -> Floats:
        return scalar.values.take(np.take(node_rows, polygons, axis=1))

    limits = cached_range(mesh, ("of mesh", scalar.name), partial(_range_of_nodes, mesh, scalar))
    return within(interpolated(mesh, points, corner_values), limits)


def _range_of_nodes(mesh: Mesh, scalar: MeshScalar) -> Limits:
    used = used_rows(mesh.node_numbers.T, len(scalar.values))
    return range_of(scalar.values if used.all() else scalar.values[used])
