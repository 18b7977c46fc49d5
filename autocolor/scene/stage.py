"""The stage that is made for any mesh: a floor, or a bowl, whose floor bends up into a wall all around.

The floor lies a hair below the lowest point of the object, so that no underside is in the plane of the floor.
A stage is rings around the object. It catches the lights of the scene like every other part, and no shadow
falls on it, as nowhere in the paper. The soft pool below the object is painted, not computed: there the
normals of the rings lean away from the lights, and finally down. Assumed: all proportions of this module.

An eye at the height of the floor or below it sees no stage, which would hide the object.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache
from typing import Final, NamedTuple

import numpy as np

from autocolor.arrays import Floats, normalized, underflowing
from autocolor.checks import Color, Vector
from autocolor.immutable import read_only
from autocolor.scene.defaults import AZIMUTH, object_bounds, object_coordinates, sphere_around
from autocolor.scene.geometry.normals import NodeNormals
from autocolor.scene.lights import free_name
from autocolor.scene.mesh import Mesh
from autocolor.scene.scalar import joined_scalars
from autocolor.scene.surfaces import Paint, Part, Reflectance, Surface

NONE: Final = "none"
FLOOR: Final = "floor"
BOWL: Final = "bowl"
STAGES: Final = (NONE, FLOOR, BOWL)

STAGE: Final = "stage"
"""The name of the part and the surface of a stage; "stage 2" and so on if the object has that name."""

BACKDROP: Final[tuple[Color, Color]] = ((60, 63, 69), (122, 126, 132))
"""The colors of the backdrop of a made stage, from the top of the picture to its bottom."""

SURFACE: Final = Surface(STAGE, Reflectance(0.75, 0.0), Paint((150, 153, 158), blend=1.0))
"""A matt gray paper: with a highlight of its own, a stage would draw the eye."""

AROUND: Final = 64
"""Polygons around a ring."""

HAIR: Final = 1e-3
"""How far the floor is below the object. All lengths here are in radii of the sphere around the object."""

LOW: Final = 0.12
"""The part of the object's height that darkens the floor."""

POOL: Final = 0.4
"""How far the pool of a tall object reaches beyond the outline of that part; that of a sheet is narrow."""

DARKEST: Final = 130.0
"""The angle in degrees by which the normals of the pool lean below the object."""

REACH: Final = 6.5, 1.75
"""The radius of the stage: at least so many radii of the object, and so many distances of the eye.

The eye is then above the flat part of a bowl, and below its rim, which is as high as the radius.
"""

BEND: Final = 0.4
"""The radius of the bend between the floor and the wall of a bowl, as a part of the bowl's radius."""

RINGS: Final = 10
"""The rings of the pool, and of the bend."""

TURNS: Final = np.linspace(0, 2 * np.pi, AROUND, endpoint=False)
AWAY: Final = read_only(np.stack([np.cos(TURNS), np.sin(TURNS)], axis=1))
"""The directions from the middle to the nodes of a ring, (AROUND, 2), counterclockwise from above."""

FROM_EYE: Final = -np.array([math.cos(math.radians(AZIMUTH)), math.sin(math.radians(AZIMUTH))])
PAINTED: Final = read_only(normalized((FROM_EYE - 0.4 * AWAY).T).T)
"""The directions in which the normals of the pool lean, (AROUND, 2).

They lean away from the eye of a new view, because the lowest lights that are created are on its side, and a
little toward the object. Measured and rejected: toward the object alone. Beyond the object they then lean
toward these lights, and a bright rim surrounds the pool.
"""


def stage_part(parts: Sequence[Part]) -> Part:
    """The part of the stage of an object with these parts. Its name and its surface's are not taken."""
    name = free_name(STAGE, [part.name for part in parts])
    return Part(name, free_name(STAGE, [part.surface for part in parts]), stage=True)


def with_stage(mesh: Mesh, parts: tuple[Part, ...], stage: str, eye: Vector) -> Mesh | None:
    """The mesh with the polygons of its stage as the last part; None if the eye would see it from below.

    The same mesh is returned as long as its stage stays the same.
    """
    shape = shape_of(mesh, parts)
    if eye[2] <= shape.floor:
        return None
    least, distances = REACH
    reach = min(max(least, distances * math.dist(eye, shape.center) / shape.radius), 1e9)
    # Rounding keeps the mesh while the eye turns around the object.
    return _with_rings(mesh, parts, stage, round(reach + 0.05, 1))


class Shape(NamedTuple):
    """The center and the radius of the sphere around an object, and the height of the floor below it.

    `pool` is how far the pool reaches beyond the outline. `outline`, (AROUND, 2), has x and y of the
    outermost low node in each of the directions of `AWAY`.
    """

    center: Vector
    radius: float
    floor: float
    pool: float
    outline: Floats


@lru_cache(maxsize=4)
@underflowing
def shape_of(mesh: Mesh, parts: tuple[Part, ...]) -> Shape:
    """What a stage follows of an object."""
    low, high = object_bounds(mesh, parts)
    (x, y, z), radius = sphere_around(low, high)
    nodes = object_coordinates(mesh, parts)
    near = nodes[nodes[:, 2] <= low[2] + LOW * (high[2] - low[2]), :2]
    near = near if len(near) else np.array([[x, y]])
    outline = np.stack([near[(near @ direction).argmax()] for direction in AWAY])
    floor, pool = float(low[2]) - HAIR * radius, POOL * min(radius, 0.15 * radius + float(high[2] - low[2]))
    return Shape((float(x), float(y), float(z)), radius, floor, pool, outline)


@lru_cache(maxsize=2)
@underflowing
def _with_rings(mesh: Mesh, parts: tuple[Part, ...], stage: str, reach: float) -> Mesh:
    """The mesh with the rings of a stage, whose radius is `reach`, as a further part."""
    shape, shares = shape_of(mesh, parts), np.linspace(0, 1, RINGS)
    bend = BEND * reach if stage == BOWL else 0.0
    # A ring has places, a height, directions in which its normals lean, and the angle by which they do.
    rings = [(np.full((AROUND, 2), shape.outline.mean(axis=0)), 0.0, PAINTED, DARKEST)]
    for share in shares:
        places = shape.outline + share * shape.pool * AWAY
        rings.append((places, 0.0, PAINTED, DARKEST * (1 - share) ** 2))
    for angle in 90 * shares if bend else (0.0,):
        out, up = (bend * each for each in (math.sin(math.radians(angle)), 1 - math.cos(math.radians(angle))))
        places = np.array(shape.center[:2]) + (reach - bend + out) * shape.radius * AWAY
        rings.append((places, up, -AWAY, angle))
    if bend:
        rings.append((rings[-1][0], reach, -AWAY, 90.0))
    nodes = np.concatenate([_lifted(each[0], shape.floor + shape.radius * each[1]) for each in rings])
    vectors = np.concatenate(
        [_lifted(math.sin(math.radians(a)) * toward, math.cos(math.radians(a))) for _, _, toward, a in rings]
    )
    inner = np.arange(len(nodes) - AROUND).reshape(-1, AROUND)
    after = np.roll(inner, -1, axis=1)
    numbers = np.stack([inner, inner + AROUND, after + AROUND, after]).reshape(4, -1)
    # The first ring is a point: its polygons are triangles.
    numbers[3, :AROUND] = numbers[2, :AROUND]

    # Everything that the mesh computed of its own polygons is used again.
    counts, planes = (len(mesh.node_numbers), numbers.shape[1]), mesh.shared_planes
    if planes is not None:
        planes = replace(
            planes,
            plane_of_polygon=np.append(planes.plane_of_polygon, np.full(counts[1], -1)),
            turned=np.append(planes.turned, np.zeros(counts[1], np.bool_)),
        )
    own = NodeNormals(vectors.astype(np.float32), numbers.T)
    return Mesh.of_tables(
        read_only(np.append(mesh.coordinates.T, nodes.T, axis=1).T),
        read_only(np.append(mesh.node_numbers.T, numbers + len(mesh.coordinates), axis=1).T),
        read_only(np.append(mesh.part_numbers, np.full(counts[1], len(mesh.part_names)))),
        (*mesh.part_names, stage_part(parts).name),
        mesh.crease_angle,
        joined_scalars([mesh.scalars, ()], [len(mesh.coordinates), len(nodes)], counts),
        normals=NodeNormals.joined([mesh.normals, own], counts),
        shared_planes=planes,
    )


def _lifted(flat: Floats, height: float) -> Floats:
    """Vectors, (n, 3), with these x and y, (n, 2), and the same z."""
    return np.column_stack([flat, np.full(len(flat), height)])
