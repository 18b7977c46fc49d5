"""Meshes that the tests know all about."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from autocolor import Mesh, Reflectance, Scene, Surface, View, scene_of
from autocolor.checks import Vector
from autocolor.scene.changes import SceneFields

STRETCHED: SceneFields = {
    "scaling": "surface",
    "contrast": "stretch",
    "mapping": "linear",
    "interpolation": "scan line",
    "exposure": "auto",
}
"""How intensities are shown where a test rests on it: as in a scene file that does not say it."""


def grid(columns: int, rows: int, corner: Vector, across: Vector, up: Vector, name: str = "wall") -> Mesh:
    """A parallelogram of columns x rows quads, counterclockwise where `across` x `up` points to one."""
    along = np.arange(columns + 1) / columns
    upward = np.arange(rows + 1) / rows
    coordinates = (
        np.array(corner) + along[None, :, None] * np.array(across) + upward[:, None, None] * np.array(up)
    ).reshape(-1, 3)
    first = (np.arange(rows)[:, None] * (columns + 1) + np.arange(columns)).ravel()
    quads = np.stack([first, first + 1, first + columns + 2, first + columns + 1], axis=1)
    return Mesh(coordinates, quads, np.zeros(len(quads), np.intp), (name,))


def wall(columns: int = 1, rows: int = 1, half: float = 1.0) -> Mesh:
    """A square in the plane y = 0 that faces -y."""
    return grid(columns, rows, (-half, 0.0, -half), (2 * half, 0.0, 0.0), (0.0, 0.0, 2 * half))


def wall_scene(
    mesh: Mesh | None = None,
    reflectance: Reflectance | None = None,
    view: View | None = None,
    two_sided: bool = True,
    **fields: object,
) -> Scene:
    """A wall, seen from straight before it unless a view is given; no ambient light unless given.

    Other parts than the wall have a surface of their own, and so do intensities, unless `fields` say it.
    """
    mesh = wall() if mesh is None else mesh
    return scene_of(
        mesh,
        surface_of_part={name: name for name in mesh.part_names},
        surfaces=[Surface("wall", reflectance or Reflectance(0.7, 0.5, 20.0), two_sided=two_sided)],
        view=view or View((0.0, -4.0, 0.0), target=(0.0, 0.0, 0.0), field_of_view=25.0),
        **{**STRETCHED, "ambient": 0.0, **fields},  # type: ignore[arg-type]
    )


CUBE_NODES = [(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)]
CUBE_QUADS = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]


def uneven_wall(seed: int) -> Mesh:
    """A wall of 6 x 5 warped quads, six units wide."""
    flat = grid(6, 5, (-3, 0, -3), (6, 0, 0), (0, 0, 6))
    moved = flat.coordinates.copy()
    inner = (np.abs(moved[:, 0]) < 2.9) & (np.abs(moved[:, 2]) < 2.9)
    moved[inner] += np.random.default_rng(seed).uniform(-0.3, 0.3, (inner.sum(), 3))
    return Mesh(moved, flat.node_numbers, flat.part_numbers, flat.part_names)


def cube(size: float = 1.0) -> Mesh:
    """The cube from the origin to (size, size, size), facing outward."""
    return Mesh(
        np.array(CUBE_NODES, np.float64) * size, np.array(CUBE_QUADS), np.zeros(6, np.intp), ("cube",)
    )


def sphere(columns: int = 32, rows: int = 16, radius: float = 1.0) -> Mesh:
    """A sphere around the origin, of quads and of triangles at the poles, facing outward."""
    coordinates = [(0.0, 0.0, -radius)]
    for row in range(1, rows):
        low = math.pi * (row / rows - 0.5)
        for column in range(columns):
            turn = 2 * math.pi * column / columns
            coordinates.append(
                (
                    radius * math.cos(low) * math.cos(turn),
                    radius * math.cos(low) * math.sin(turn),
                    radius * math.sin(low),
                )
            )
    coordinates.append((0.0, 0.0, radius))
    last = len(coordinates) - 1

    def node(row: int, column: int) -> int:
        return 0 if row == 0 else last if row == rows else 1 + (row - 1) * columns + column % columns

    quads = []
    for row in range(rows):
        for column in range(columns):
            a, b = node(row, column), node(row, column + 1)
            c, d = node(row + 1, column + 1), node(row + 1, column)
            quads.append((d, a, b, b) if a != b and c == d else (a, c, d, d) if a == b else (a, b, c, d))
    return Mesh(np.array(coordinates), np.array(quads), np.zeros(len(quads), np.intp), ("sphere",))


LYING = """\
v -2 0 -2
v 2 0 -2
v 2 0 2
v -2 0 2
v 0 5 0
v -1 0 -1
v 1 0 -1
v 1 0 1
v -1 0 1
f 1 2 5
f 2 3 5
f 3 4 5
f 4 1 5
f 1 2 7 6
f 2 3 8 7
f 3 4 9 8
f 4 1 6 9
f 6 7 8 9
"""
"""An OBJ file: a pyramid with y up, which lies on its side when it is read with z up."""


def ramp(count: int) -> npt.NDArray[np.float32]:
    """Intensities from 0 to 1."""
    return np.linspace(0, 1, count, dtype=np.float32)


def decal_on_ground(seed: int, rounding: str = "none") -> tuple[Mesh, View]:
    """A ground of a few polygons in a random plane, a decal on it, and a view; part 1 is the decal.

    `rounding` is "none", "float32" or "decimals" (six of them).
    """
    random = np.random.default_rng(seed)
    normal, some = random.normal(size=(2, 3))
    across = np.cross(normal, some) / np.linalg.norm(np.cross(normal, some))
    up = np.cross(normal, across) / np.linalg.norm(normal)
    middle, size = random.uniform(-1, 1, 3), random.uniform(0.5, 3)

    def patch(center: npt.NDArray[np.float64], half: npt.NDArray[np.float64], name: str) -> Mesh:
        turn = random.uniform(0, 2 * math.pi)
        along = 2 * half[0] * (math.cos(turn) * across + math.sin(turn) * up)
        upward = 2 * half[1] * (math.cos(turn) * up - math.sin(turn) * across)
        columns, rows = random.integers(1, 9, 2).tolist()
        corner = tuple((center - along / 2 - upward / 2).tolist())
        flat = grid(columns, rows, corner, tuple(along.tolist()), tuple(upward.tolist()), name)
        quads = flat.node_numbers
        if random.random() < 0.5:
            quads = np.concatenate([quads[:, [0, 1, 2, 2]], quads[:, [0, 2, 3, 3]]])
        return Mesh(flat.coordinates, quads, np.zeros(len(quads), np.intp), (name,))

    offset = random.uniform(-0.3, 0.3, 2) * size
    both = Mesh.joined(
        [
            patch(middle, np.array([size, size]), "ground"),
            patch(middle + offset[0] * across + offset[1] * up, random.uniform(0.1, 0.6, 2) * size, "decal"),
        ]
    )
    coordinates = {
        "none": both.coordinates,
        "float32": both.coordinates.astype(np.float32).astype(np.float64),
        "decimals": both.coordinates.round(6),
    }[rounding]
    eye = random.normal(size=3)
    eye *= random.uniform(2, 6) * size / np.linalg.norm(eye)
    view = View(
        tuple((middle + eye).tolist()),
        target=tuple((middle + random.uniform(-0.3, 0.3, 3)).tolist()),
        field_of_view=random.uniform(20, 70),
    )
    return Mesh(coordinates, both.node_numbers, both.part_numbers, both.part_names), view


ROUNDINGS = ("none", "float32", "decimals")
