"""A mesh as arrays in an .npz archive, which numpy can open.

The members are `header` (the part names and what the scalars are, as JSON in UTF-8), `coordinates` (nodes, 3)
float64, `node_numbers` (polygons, 4) and `part_numbers` (polygons,) int32, and `mesh_scalar_0` and so on, the
values of each scalar, (nodes,) or (polygons,) float64, and the normals of the mesh file, if they are used:
`own_normal_0`, (normals, 3) float32, and `own_normal_number_0`, (polygons, 4) int32. Nothing is lost:
polygons without area, parts without polygons and names of any characters stay.
"""

from __future__ import annotations

from pathlib import Path
from typing import Final

from autocolor.files.array_file import ArrayFileKind, array_file_bytes, mesh_of, read_array_file
from autocolor.files.meshes.repair import FILE, PLAIN, MeshReport, Placement, placed, turned_up
from autocolor.scene.geometry.normals import CREASE_ANGLE
from autocolor.scene.mesh import Mesh

SUFFIX: Final = ".tables"

TABLE_FILE: Final = ArrayFileKind("table file", "write the scene again", "autocolor tables 2", {})


def table_file_bytes(mesh: Mesh) -> bytes:
    """The content of the table file of a mesh, without its crease angle."""
    return array_file_bytes(TABLE_FILE, mesh, {"part_names": mesh.part_names}, {})


def read_table_file(path: Path, placement: Placement = PLAIN) -> MeshReport:
    """The mesh of a table file, in which nothing is ever repaired. Raises InputError."""
    header, arrays = read_array_file(TABLE_FILE, path)
    normals = arrays.pop("own_normal_0", None)
    if normals is not None and placement.normals == FILE:
        arrays["own_normal_0"] = turned_up(normals, placement.up)
    angle = CREASE_ANGLE if placement.crease_angle is None else placement.crease_angle
    with TABLE_FILE.naming(path.name):
        arrays["coordinates"] = placed(arrays["coordinates"], placement)
        return MeshReport(mesh_of(header, arrays, header["part_names"], angle))
