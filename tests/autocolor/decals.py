"""Decals on a ground: polygons in one plane, of which the decal must be seen."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from autocolor import Mesh, View
from tests.small import grid


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
