"""Mesh files of any kind: which reader reads which."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Final

from autocolor.errors import InputError
from autocolor.files.repair.polygons import MeshReport

MESH_SUFFIXES: Final = (".obj",)


def read_mesh(path: Path, *, up: str = "z", crease_angle: float | None = None) -> MeshReport:
    """The mesh of one file, and what was repaired; `up` is the file's up axis. Raises InputError."""
    if path.suffix.lower() not in MESH_SUFFIXES:
        raise InputError(
            f"{path.name}: a mesh file must end in {' or '.join(MESH_SUFFIXES)}, not in {path.suffix!r};"
            " export it as OBJ"
        )
    from autocolor.files.meshes.obj.obj_file import read_obj

    return read_obj(path, up=up, crease_angle=crease_angle)


def read_tables(
    nodes: Path, polygons: Path, *, up: str = "z", crease_angle: float | None = None
) -> MeshReport:
    """The mesh of a node table and a polygon table, and what was repaired. Raises InputError."""
    from autocolor.files.meshes.csv_tables import read_csv_tables

    return read_csv_tables(nodes, polygons, up=up, crease_angle=crease_angle)


def read_entry(files: Mapping[str, Path], *, up: str = "z", crease_angle: float | None = None) -> MeshReport:
    """The mesh of a `[[mesh]]` table, of its `file` or of its `nodes` and `polygons`. Raises InputError."""
    if "file" in files:
        return read_mesh(files["file"], up=up, crease_angle=crease_angle)
    return read_tables(files["nodes"], files["polygons"], up=up, crease_angle=crease_angle)
