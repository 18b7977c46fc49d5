"""Polygons as a file has them, before they are repaired: any number of corners, repeated ones among them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from autocolor.arrays import Floats, Numbers
from autocolor.scene.mesh import Mesh

UPS: Final = ("x", "y", "z")


@dataclass(frozen=True, eq=False)
class Polygons:
    """A node table and polygons of any number of corners, with node numbers that were checked.

    `coordinates` is (nodes, 3) float64; `corners` holds the rows of all polygons one after the other,
    `corner_counts` how many each has; `part_numbers` are rows of `part_names`.
    """

    coordinates: Floats
    corners: Numbers
    corner_counts: Numbers
    part_numbers: Numbers
    part_names: tuple[str, ...]


@dataclass(frozen=True)
class MeshReport:
    """A mesh that was read, and a sentence for everything that was repaired or skipped."""

    mesh: Mesh
    repairs: tuple[str, ...] = ()


def upright(coordinates: Floats, up: str) -> Floats:
    """The coordinates with the file's up axis as the world's z.

    Each is an even permutation, so that polygons keep their winding: y up makes (x, y, z) to (x, -z, y),
    where x stays to the right; x up makes it to (y, z, x).
    """
    if up == "y":
        turned = coordinates[:, [0, 2, 1]]
        turned[:, 1] = 0.0 - turned[:, 1]
        return turned
    return coordinates[:, [1, 2, 0]] if up == "x" else coordinates
