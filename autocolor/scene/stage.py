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

from autocolor.arrays import Floats, Indices, Singles, normalized, underflowing
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

REFLECTANCE: Final = Reflectance(0.75, 0.0)
PAINT: Final = Paint((150, 153, 158), blend=1.0)
"""A matt gray paper: with a highlight of its own, a stage would draw the eye."""

AROUND: Final = 64
"""Polygons around a ring."""

HAIR: Final = 1e-3
"""How far the floor is below the object, in radii of the sphere around the object, as all lengths below."""

LOW: Final = 0.12
"""The part of the object's height that is near enough to the floor to darken it."""

POOL: Final = (0.0, 0.4)
"""How far the pool reaches beyond the outline of these nodes: the darkest ring and the last."""

DARKEST: Final = 130.0
"""The angle in degrees by which normals lean below the object."""

POOL_RINGS: Final = 10

REACH: Final = {FLOOR: (9.0, 2.0), BOWL: (6.5, 1.75)}
"""The radius of the stage: at least so many radii of the object, and so many distances of the eye.

The eye is then above the flat part of a bowl and below its rim, which is as high as the radius.
"""

MOST_REACH: Final = 1e6
"""Limit: the radius for an eye that is farther away than any picture of the object needs."""

STEP: Final = 1.01
"""The radius grows by steps of this ratio, so that an eye that turns around the object moves no wall."""

BEND: Final = 0.4
"""The radius of the bend between the floor and the wall of a bowl, as a part of the bowl's radius."""

BEND_RINGS: Final = 10

TURNS: Final = np.linspace(0, 2 * np.pi, AROUND, endpoint=False)
AWAY: Final = read_only(np.stack([np.cos(TURNS), np.sin(TURNS)], axis=1))
"""The directions from the middle to the nodes of a ring, (AROUND, 2), counterclockwise from above."""

LEANING: Final = 0.4
TO_EYE: Final = np.array([math.cos(math.radians(AZIMUTH)), math.sin(math.radians(AZIMUTH))])
PAINTED: Final = read_only(normalized((-TO_EYE - LEANING * AWAY).T).T)
"""The directions in which the normals of the pool lean, (AROUND, 2).

They lean away from the eye of a new view, on whose side are the two lowest of the created lights, and by
LEANING of that toward the object. Measured and rejected: toward the object alone. At the far side of the
object they lean toward these lights, and a bright rim surrounds the pool.
"""


def stage_part(parts: Sequence[Part]) -> Part:
    """The part of the stage of an object with these parts. Its name and its surface's are not taken."""
    name = free_name(STAGE, [part.name for part in parts])
    return Part(name, free_name(STAGE, [part.surface for part in parts]), stage=True)


def stage_surface(name: str) -> Surface:
    """The surface that a stage has until the surface table has a row of this name."""
    return Surface(name, REFLECTANCE, PAINT)


def with_stage(mesh: Mesh, parts: tuple[Part, ...], stage: str, eye: Vector) -> Mesh | None:
    """The mesh with the polygons of its stage as the last part; None if the eye would see it from below.

    The same mesh is returned as long as its stage stays the same.
    """
    shape = _shape_of(mesh, parts)
    if eye[2] <= shape.floor:
        return None
    least, distances = REACH[stage]
    reach = min(max(least, distances * math.dist(eye, shape.center) / shape.radius), MOST_REACH)
    reach = STEP ** math.ceil(math.log(reach, STEP))
    return _with_rings(mesh, parts, stage, reach)


def floor_of(mesh: Mesh, parts: tuple[Part, ...]) -> float:
    """The height of the floor that is made for an object."""
    return _shape_of(mesh, parts).floor


class _Shape(NamedTuple):
    """What a stage follows of an object: the sphere around it, and its outline near the floor.

    `outline`, (AROUND, 2), are x and y of the outermost node in each of the directions of `AWAY`.
    """

    center: Vector
    radius: float
    floor: float
    outline: Floats


@lru_cache(maxsize=4)
@underflowing
def _shape_of(mesh: Mesh, parts: tuple[Part, ...]) -> _Shape:
    low, high = object_bounds(mesh, parts)
    center, radius = sphere_around(low, high)
    nodes = object_coordinates(mesh, parts)
    near = nodes[nodes[:, 2] <= low[2] + LOW * (high[2] - low[2])][:, :2]
    if not len(near):
        near = center[None, :2]
    outline = np.stack([near[(near @ direction).argmax()] for direction in AWAY])
    x, y, z = center.tolist()
    return _Shape((x, y, z), radius, float(low[2]) - HAIR * radius, read_only(outline))


@lru_cache(maxsize=4)
@underflowing
def _with_rings(mesh: Mesh, parts: tuple[Part, ...], stage: str, reach: float) -> Mesh:
    """The mesh with the rings of a stage, whose radius is `reach` radii of the object."""
    shape = _shape_of(mesh, parts)
    middle, radius = np.array(shape.center[:2]), shape.radius
    bend = BEND * reach if stage == BOWL else 0.0
    # A ring has a place for each direction, a height, and an angle by which its normals lean inward.
    places, heights, leans = [np.repeat(shape.outline.mean(axis=0)[None], AROUND, axis=0)], [0.0], [DARKEST]
    for share in np.linspace(0, 1, POOL_RINGS):
        places.append(shape.outline + (POOL[0] + share * (POOL[1] - POOL[0])) * radius * AWAY)
        heights.append(0.0)
        leans.append(DARKEST * (1 - share) ** 2)
    for lean in np.linspace(0, 90, BEND_RINGS if bend else 1):
        places.append(middle + (reach - bend * (1 - math.sin(math.radians(lean)))) * radius * AWAY)
        heights.append(bend * (1 - math.cos(math.radians(lean))))
        leans.append(lean)
    if bend:
        places.append(places[-1])
        heights.append(reach)
        leans.append(90.0)
    z = np.full((len(places), AROUND, 1), shape.floor) + radius * np.array(heights)[:, None, None]
    nodes = np.concatenate([np.stack(places), z], axis=2).reshape(-1, 3)
    is_pool = np.arange(len(leans)) <= POOL_RINGS
    angles = np.radians(leans)[:, None, None]
    upward = np.broadcast_to(np.cos(angles), (len(places), AROUND, 1))
    toward = np.where(is_pool[:, None, None], PAINTED, -AWAY)
    vectors = np.concatenate([np.sin(angles) * toward, upward], axis=2).reshape(-1, 3).astype(np.float32)
    inner = np.arange(len(nodes) - AROUND).reshape(-1, AROUND)
    after = np.roll(inner, -1, axis=1)
    numbers = np.stack([inner, inner + AROUND, after + AROUND, after]).reshape(4, -1)
    # The first ring is a point: its polygons are triangles.
    numbers[:, :AROUND] = numbers[[0, 1, 2, 2], :AROUND]
    return _joined(mesh, stage_part(parts).name, nodes, vectors, numbers)


def _joined(mesh: Mesh, name: str, nodes: Floats, vectors: Singles, numbers: Indices) -> Mesh:
    """The mesh with nodes, each with its normal, and polygons, (4, polygons), as a further part.

    Everything that the mesh computed of its own polygons is used again.
    """
    counts = len(mesh.node_numbers), numbers.shape[1]
    normals = NodeNormals.joined([mesh.normals, NodeNormals(vectors, numbers.T)], counts)
    planes = mesh.shared_planes
    if planes is not None:
        of_none = np.full(counts[1], -1)
        planes = replace(
            planes,
            plane_of_polygon=np.concatenate([planes.plane_of_polygon, of_none]),
            turned=np.concatenate([planes.turned, of_none > 0]),
        )
    rows = np.concatenate([mesh.coordinates.T, nodes.T], axis=1)
    parts = np.concatenate([mesh.part_numbers, np.full(counts[1], len(mesh.part_names))])
    return Mesh.of_tables(
        read_only(rows.T),
        read_only(np.concatenate([mesh.node_numbers.T, numbers + len(mesh.coordinates)], axis=1).T),
        read_only(parts),
        (*mesh.part_names, name),
        mesh.crease_angle,
        joined_scalars([mesh.scalars, ()], [len(mesh.coordinates), len(nodes)], counts),
        normals=normals,
        shared_planes=planes,
    )
