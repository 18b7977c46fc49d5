"""Shapes with flat sides."""

from __future__ import annotations

from itertools import combinations

import numpy as np

from autocolor import Mesh
from autocolor.arrays import Floats
from benchmarks.shapes.polygons import cells, mesh_of, turned, whole_turn

GOLDEN = (1 + np.sqrt(5)) / 2


def box(name: str, x: float, y: float, z: float) -> Mesh:
    """A box."""
    return mesh_of(name, cells([[0, x], [0, y], [0, z]], np.ones((1, 1, 1), np.bool_)))


def frame(thickness: float = 0.08) -> Mesh:
    """The twelve edges of a cube, as rods."""
    bounds = [0.0, thickness, 1 - thickness, 1.0]
    at_end = np.array([1, 0, 1])
    ends = at_end[:, None, None] + at_end[None, :, None] + at_end[None, None, :]
    return mesh_of("frame", cells([bounds] * 3, ends >= 2))


def bracket() -> Mesh:
    """An L of two plates, with an inward corner."""
    filled = np.array([[1, 1], [1, 0]], np.bool_)[:, None, :]
    return mesh_of("bracket", cells([[0, 0.25, 1.2], [0, 0.9], [0, 0.25, 1.2]], filled))


def open_box(thickness: float = 0.06) -> Mesh:
    """A box with walls and a floor, open above."""
    filled = np.ones((3, 3, 2), np.bool_)
    filled[1, 1, 1] = False
    bounds = [0, thickness, 1 - thickness, 1]
    return mesh_of("open box", cells([bounds, bounds, [0, thickness, 0.7]], filled))


def stairs(steps: int = 5) -> Mesh:
    """A flight of stairs that goes up along y."""
    filled = np.tri(steps, dtype=np.bool_)[None]
    along = np.linspace(0, 0.3 * steps, steps + 1)
    return mesh_of("stairs", cells([[0, 1.2], along, along * 0.6], filled))


def prism(name: str, sides: int) -> Mesh:
    """A prism with so many sides, both ends closed."""
    return mesh_of(name, turned(np.array([[0.0], [1], [1], [0]]), [0, 0, 1.4, 1.4], whole_turn(sides)))


def gear(teeth: int = 12) -> Mesh:
    """A gear with a bore."""
    steps = np.array([-0.5, -0.22, -0.12, 0.12, 0.22])
    angles = (np.arange(teeth)[:, None] + steps[:-1]).ravel() * (2 * np.pi / teeth)
    angles = np.append(angles, angles[0] + 2 * np.pi)
    rim = np.append(np.tile([0.8, 0.8, 1.0, 1.0], teeth), 0.8)
    bore = np.full_like(rim, 0.35)
    return mesh_of("gear", turned(np.stack([bore, rim, rim, bore, bore]), [0, 0, 0.4, 0.4, 0], angles))


def icosahedron() -> Mesh:
    """Twenty triangles, which meet at 41.8 degrees."""
    nodes = np.array(
        [np.roll((0, a, b * GOLDEN), turn) for turn in range(3) for a in (-1, 1) for b in (-1, 1)]
    )
    faces = []
    for face in combinations(nodes, 3):
        if all(np.linalg.norm(one - other) < 2.1 for one, other in combinations(face, 2)):
            outward = np.linalg.det(np.array(face)) > 0
            faces.append(face if outward else face[::-1])
    triangles = np.array(faces)
    return mesh_of("icosahedron", np.concatenate([triangles, triangles[:, 2:]], axis=1))


def two_scales(studs: int = 12) -> Mesh:
    """A large block with many small pyramids on half of its top."""
    block = cells([[0, 2], [0, 1.4], [0, 0.8]], np.ones((1, 1, 1), np.bool_))
    places = (np.arange(studs) + 0.5) / studs
    middles = np.array([(0.1 + 0.9 * x, 0.2 + y, 0.8) for x in places for y in places])
    half = 0.38 / studs
    foot: Floats = np.array([(-half, -half, 0), (half, -half, 0), (half, half, 0), (-half, half, 0)])
    top = np.broadcast_to([0, 0, half], (4, 3))
    sides = np.stack([foot, np.roll(foot, -1, axis=0), top, top], axis=1)
    return mesh_of("two scales", block, (middles[:, None, None] + sides).reshape(-1, 4, 3))
