"""The two CSV tables of a mesh as a format: a folder of nodes.csv and polygons.csv, or two files."""

from __future__ import annotations

from pathlib import Path
from typing import Final

from autocolor.files.meshes.csv_tables import read_csv_tables
from autocolor.files.meshes.csv_writing import csv_tables_bytes
from autocolor.files.meshes.formats import MeshFormat, register
from autocolor.scene.mesh import Mesh

IN_FOLDER: Final = ("nodes.csv", "polygons.csv")


def write_csv_tables(folder: Path, mesh: Mesh) -> None:
    """Write the tables of a mesh to an empty folder. Raises OSError."""
    for name, data in zip(IN_FOLDER, csv_tables_bytes(mesh), strict=True):
        (folder / name).write_bytes(data)


CSV: Final = register(
    MeshFormat(
        "CSV",
        read_csv_tables,
        (".csv",),
        keys=("nodes", "polygons"),
        in_folder=IN_FOLDER,
        write=write_csv_tables,
    )
)
