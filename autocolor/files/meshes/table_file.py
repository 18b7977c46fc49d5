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

import numpy as np

from autocolor.errors import InputError
from autocolor.files.array_file import (
    KEY,
    MESH_SCALARS,
    NORMALS,
    ArrayFileKind,
    array_file_bytes,
    normal_members,
    normal_rows,
    normals_of,
    read_array_file,
    scalar_members,
    scalar_rows,
    scalars_of,
)
from autocolor.files.meshes.repair import FILE, PLAIN, MeshReport, Placement, placed, turned_up
from autocolor.immutable import read_only
from autocolor.scene.geometry.normals import CREASE_ANGLE, NodeNormals
from autocolor.scene.mesh import Mesh

SUFFIX: Final = ".tables"

TABLE_FILE: Final = ArrayFileKind(
    noun="table file",
    advice="write the scene again",
    formats=("autocolor tables 2",),
    keys=frozenset(("part_names",)),
    arrays={"coordinates": ("<f8", 2), "node_numbers": ("<i4", 2), "part_numbers": ("<i4", 1)},
    series={KEY: MESH_SCALARS, **NORMALS},
    optional=frozenset(NORMALS),
)


def table_file_bytes(mesh: Mesh) -> bytes:
    """The content of the table file of a mesh, without its crease angle."""
    arrays = {name: vars(mesh)[name] for name in TABLE_FILE.arrays}
    header = {"part_names": mesh.part_names, KEY: scalar_rows(mesh.scalars), **normal_rows(mesh.own_normals)}
    members = {**scalar_members(mesh.scalars), **normal_members(mesh.own_normals)}
    return array_file_bytes(TABLE_FILE, header, {**arrays, **members})


def read_table_file(path: Path, placement: Placement = PLAIN) -> MeshReport:
    """The mesh of a table file, in which nothing is ever repaired. Raises InputError."""
    header, arrays = read_array_file(TABLE_FILE, path)
    names = header["part_names"]
    try:
        own_normals = normals_of(arrays) if placement.normals == FILE else None
        if own_normals is not None:
            vectors = turned_up(own_normals.vectors.astype(np.float64), placement.up).astype(np.float32)
            own_normals = NodeNormals(read_only(np.asfortranarray(vectors)), own_normals.numbers)
        mesh = Mesh(
            placed(arrays["coordinates"], placement)
            if arrays["coordinates"].shape[1] == 3
            else arrays["coordinates"],
            arrays["node_numbers"],
            arrays["part_numbers"],
            tuple(names) if isinstance(names, list) else (),
            CREASE_ANGLE if placement.crease_angle is None else placement.crease_angle,
            scalars_of(header, arrays),
            own_normals,
        )
    except InputError as error:
        raise InputError(
            f"{path.name}: {problem[:400]}; {TABLE_FILE.advice}" for problem in error.problems
        ) from None
    return MeshReport(mesh)
