"""Reading a mesh from a PLY file, in text or binary in either byte order.

Nodes come from the element `vertex`, polygons from `face`, or from `tristrips` where there are no faces.
Properties may have any type and any order; integers and real numbers beside coordinates are scalars (see
`ply_polygons`). NaN is a missing value of a scalar; an infinite one becomes missing, and is counted. Other
elements, and what follows the last one, are skipped and counted.
"""

from __future__ import annotations

from pathlib import Path
from typing import Final

from autocolor.errors import InputError
from autocolor.files.meshes.formats import MeshFormat, register
from autocolor.files.meshes.ply.binary import read_binary
from autocolor.files.meshes.ply.header import FIRST_LINE, parsed_header
from autocolor.files.meshes.ply.ply_bytes import ply_bytes
from autocolor.files.meshes.ply.ply_polygons import ply_polygons
from autocolor.files.meshes.ply.properties import named_in
from autocolor.files.meshes.ply.text import read_text
from autocolor.files.reading import LARGEST_BINARY_MESH_FILE, LARGEST_MESH_FILE, read_bytes, read_head
from autocolor.files.repair.mesh_repair import repaired
from autocolor.files.repair.placement import PLAIN, Placement
from autocolor.files.repair.polygons import MeshReport, Polygons


def read_ply(path: Path, placement: Placement = PLAIN) -> MeshReport:
    """The mesh of a PLY file, and what was repaired or skipped.

    Raises InputError, with the place of each problem, and MissingInputError if the file does not exist.
    """
    polygons, skipped = _read(path)
    return repaired(polygons, path.name, placement, skipped=tuple(skipped))


def _read(path: Path) -> tuple[Polygons, list[str]]:
    """The polygons of a file, and what was skipped; its bytes are given up before the mesh is made."""
    is_text = b"format ascii" in read_head(path)
    data = read_bytes(path, LARGEST_MESH_FILE if is_text else LARGEST_BINARY_MESH_FILE)
    header = parsed_header(data, path.name)
    if not header.order and len(data) > LARGEST_MESH_FILE:
        raise InputError(
            f"{path.name}: an ascii PLY file must have at most {LARGEST_MESH_FILE:,} bytes, not more; export"
            " it as binary"
        )
    tables = read_binary(data, header, path.name) if header.order else read_text(data, header, path.name)
    return ply_polygons(tables, named_in(header.comments), path.name, path.stem)


def _begins(head: bytes) -> bool:
    """Whether a file begins as PLY does."""
    return FIRST_LINE.match(head) is not None


PLY: Final = register(MeshFormat("PLY", read_ply, (".ply",), begins=_begins, written=ply_bytes))
