"""The polygons in camera space.

Camera space has its origin at the eye and the axes of the view: right, down and forward.
"""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass
from typing import Final

import numpy as np

from autocolor.arrays import Floats, Indices, Real, RealArray, Singles, chunks
from autocolor.checks import Vector
from autocolor.scene.mesh import Mesh
from autocolor.scene.view import View

NEAR: Final = 1e-6
"""Assumed: the near plane where the object reaches behind the eye; what is nearer vanishes.

It is a fraction of the depth of the farthest corner.
"""

LEAST_NEAR: Final = 1e-9
"""Assumed: the least depth of the near plane, in units.

An object wholly before the eye is clipped only here: nothing of it vanishes that is farther, however small
it is. Closer to the eye, crossings would be rounded by more than a thousandth of a pixel.
"""

LEAST_UNIT: Final = 2.0**-800
"""Assumed: far below the size of any object, and still a divisor for the farthest light."""

POINTS_AT_ONCE: Final = 1 << 14


@dataclass(frozen=True, eq=False)
class CameraPolygons:
    """Nodes and polygons in camera space, measured in `unit`, a power of two near the size of the view.

    `positions` is (3, nodes) float64, `normals` (3, normals) float32. `corners` and `corner_normals` are (4,
    polygons) intp: the node and the normal at each corner. `polygon_numbers` are rows of the mesh's polygon
    table. The near plane is at depth `near`; `nearest` is the least depth of a node of the mesh.
    """

    unit: float
    near: float
    nearest: float
    positions: Floats
    normals: Singles
    corners: Indices
    corner_normals: Indices
    polygon_numbers: Indices


def camera_space(mesh: Mesh, view: View) -> CameraPolygons:
    """All polygons of the mesh in the camera space of a view."""
    unit, near = unit_and_near(mesh, view)
    positions = rotated(view.axes / unit, mesh.coordinates.T, view.eye)
    nearest = float(positions[2].min(initial=np.inf))
    if nearest < near:
        near = near_of(near, float(positions[2].take(mesh.node_numbers.T).min(initial=near)))
    return CameraPolygons(
        unit,
        near,
        nearest,
        positions,
        rotated(view.axes, mesh.normals.vectors.T),
        mesh.node_numbers.T,
        mesh.normals.numbers.T,
        np.arange(len(mesh.node_numbers)),
    )


def unit_and_near(mesh: Mesh, view: View) -> tuple[float, float]:
    """The unit of a view of a mesh, and the depth of the near plane if the mesh reaches behind it."""
    box = (
        np.array(list(itertools.product(*np.stack(mesh.bounds, axis=1)))) - np.array(view.eye)
    ) @ view.axes.T
    unit = max(2.0 ** math.frexp(float(np.abs(box).max()))[1], LEAST_UNIT)
    return unit, max(NEAR * float(box[:, 2].max()) / unit, LEAST_NEAR)


def near_of(near: float, nearest_corner: float) -> float:
    """The depth of the near plane, given the depth of the nearest corner of a polygon.

    Nothing needs to be clipped where all corners lie before the eye.
    """
    return max(nearest_corner, LEAST_NEAR) if nearest_corner > 0 else near


def rotated(axes: Floats, points: RealArray[Real], origin: Vector = (0.0, 0.0, 0.0)) -> RealArray[Real]:
    """Points, (3, n), relative to an origin and in other axes, the rows of a matrix.

    Measured: a matrix product of so few rows takes as long, and up to thirty times as long while another
    process uses the second processor, because its threads wait for each other.
    """
    out = np.empty_like(points)
    axes = axes.astype(points.dtype)
    for chunk in chunks(points.shape[1], POINTS_AT_ONCE):
        relative = [row[chunk] - start for row, start in zip(points, origin, strict=True)]
        for axis, row in zip(axes, out[:, chunk], strict=True):
            np.multiply(relative[0], axis[0], out=row)
            row += relative[1] * axis[1]
            row += relative[2] * axis[2]
    return out
