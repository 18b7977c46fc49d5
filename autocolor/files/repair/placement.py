"""How the mesh of a file is placed in the world: its up axis, its scale, and where its edges stay sharp."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from autocolor.arrays import Floats
from autocolor.scene.columns.value_kinds import Number

UPS: Final = ("x", "y", "z")

SCALES: Final = Number(at_least=0, at_most=1e30, above=True)
"""The factors that a mesh may be scaled by."""


@dataclass(frozen=True)
class Placement:
    """The axis of the file that is up, a factor for its coordinates, and a crease angle or None."""

    up: str = "z"
    scale: float = 1.0
    crease_angle: float | None = None


PLAIN: Final = Placement()
"""The placement of a file whose coordinates are those of the world."""


def placed(coordinates: Floats, placement: Placement) -> Floats:
    """The coordinates, (nodes, 3), in the world: the file's up axis turned to z, and scaled.

    Polygons keep their winding: with y up, (x, y, z) becomes (x, -z, y), a rotation about x; with x up it
    becomes (y, z, x). The scaled coordinates may be too large for a mesh, which refuses them.
    """
    if placement.up == "y":
        coordinates = coordinates[:, [0, 2, 1]]
        coordinates[:, 1] = 0.0 - coordinates[:, 1]
    elif placement.up == "x":
        coordinates = coordinates[:, [1, 2, 0]]
    return coordinates if placement.scale == 1 else coordinates * placement.scale
