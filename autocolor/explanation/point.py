"""The visible point at a pixel: the rows of the tables that lead to it, and its vectors.

Paper: "The Lighting Model". The normal is interpolated between the normals of the nodes. `visibility` finds
the point; see `Seen`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from autocolor.checks import Vector
from autocolor.scene.mesh import Mesh
from autocolor.scene.scene import Scene
from autocolor.scene.surfaces import Reflectance
from autocolor.visibility.visible_points import Seen


@dataclass(frozen=True)
class Corner:
    """A corner of the polygon: its row of the node table, and the mesh's unit normal at it."""

    node: int
    coordinates: Vector
    normal: Vector


@dataclass(frozen=True)
class PointExplained:
    """The visible point: the rows of the tables that lead to it, and its vectors in object coordinates.

    `reflectance` is the surface's. `normal` is the unit normal N, interpolated between the corners, and
    turned to the eye if `is_turned`. `reflected_view` is R = 2 (N.V) N - V. `distance` leads from the eye to
    the point.
    """

    polygon: int
    corners: tuple[Corner, ...]
    part: int
    part_name: str
    surface: int
    surface_name: str
    reflectance: Reflectance
    point: Vector
    distance: float
    normal: Vector
    is_turned: bool
    reflected_view: Vector


def point_explained(scene: Scene, seen: Seen) -> PointExplained:
    """The visible point at a pixel, with the rows of its tables, counted from 1."""
    mesh = scene.staged.mesh
    corners = [
        Corner(
            node + 1,
            tuple(mesh.coordinates[node].tolist()),
            tuple(mesh.normals.vectors[normal].tolist()),
        )
        for node, normal in corner_rows(mesh, seen.polygon)
    ]
    surface = scene.surfaces[seen.surface]
    along = (sum(map(float.__mul__, corner.normal, seen.normal)) for corner in corners)
    return PointExplained(
        polygon=seen.polygon + 1,
        corners=tuple(corners),
        part=int(mesh.part_numbers[seen.polygon]) + 1,
        part_name=seen.part,
        surface=scene.surfaces.index(surface) + 1,
        surface_name=surface.name,
        reflectance=surface.reflectance,
        point=seen.point,
        distance=math.dist(scene.view.eye, seen.point),
        normal=seen.normal,
        is_turned=surface.two_sided and math.fsum(along) < 0,
        reflected_view=seen.reflected_view,
    )


def corner_rows(mesh: Mesh, polygon: int) -> list[tuple[int, int]]:
    """The node and the row of the mesh's normals at each corner of a polygon. A triangle repeats a node."""
    nodes, normals = mesh.node_numbers[polygon].tolist(), mesh.normals.numbers[polygon].tolist()
    rows = list(zip(nodes, normals, strict=True))
    corners = [row for row, before in zip(rows, [rows[-1], *rows[:-1]], strict=True) if row[0] != before[0]]
    return corners or rows[:1]
