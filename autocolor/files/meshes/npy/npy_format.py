"""The registration of .npy tables as a mesh format."""

from __future__ import annotations

from typing import Final

from autocolor.files.meshes.formats import HELD, MeshFormat, register
from autocolor.files.meshes.npy.npy_array import MAGIC
from autocolor.files.meshes.npy.npy_tables import NODES, POLYGONS, read_npy_tables
from autocolor.files.meshes.npy.npy_writing import write_npy_tables

NPY: Final = register(
    MeshFormat(
        "npy",
        read_npy_tables,
        (".npy",),
        keys=("nodes", "polygons"),
        in_folder=(NODES, POLYGONS),
        begins=lambda head: head.startswith(MAGIC),
        write=write_npy_tables,
        holds=frozenset(HELD),
        mapped=True,
    )
)
