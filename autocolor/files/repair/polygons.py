"""Polygons as they were in a file, before repair: with any number of corners, possibly repeated."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from autocolor.arrays import Floats, Indices
from autocolor.scene.mesh import Mesh
from autocolor.scene.scalars.mesh_scalars import MeshScalar
from autocolor.scene.surfaces import Surface


@dataclass(frozen=True, eq=False)
class Polygons:
    """Nodes, and polygons with any number of corners.

    `coordinates` is (nodes, 3) float64. `corners` holds the rows in `coordinates` of all corners, polygon
    after polygon; they must be valid. `corner_counts` and `part_numbers`, indices of `part_names`, have one
    element for each polygon. `scalars` are those of the nodes and of the polygons.
    """

    coordinates: Floats
    corners: Indices
    corner_counts: Indices
    part_numbers: Indices
    part_names: tuple[str, ...]
    scalars: tuple[MeshScalar, ...] = ()


@dataclass(frozen=True)
class MeshReport:
    """A mesh that was read, with messages about what was repaired or skipped.

    `material_of_part` has the names of materials by part name, where the file gives any; `materials` are the
    surfaces of those that it describes.
    """

    mesh: Mesh
    repairs: tuple[str, ...] = ()
    material_of_part: Mapping[str, str] = field(default_factory=dict)
    materials: tuple[Surface, ...] = ()
