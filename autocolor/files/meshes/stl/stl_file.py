"""Reading a mesh from an STL file, binary or text, welded.

A binary file may begin with `solid`, as text does: it is told apart by its size, which its count of triangles
gives. Each solid of a text is a part with its name; a binary file is one part, named after the file. Normals,
attributes and the text before binary triangles are ignored. Corners at one place become one node (see
`weld`); triangles that have no area then are dropped and counted.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Final

import numpy as np

from autocolor.arrays import AnyArray, Indices
from autocolor.errors import InputError
from autocolor.files.meshes.formats import MeshFormat, register
from autocolor.files.meshes.stl.binary import has_binary_size, read_binary
from autocolor.files.meshes.stl.text import read_text
from autocolor.files.meshes.stl.weld import welded
from autocolor.files.reading import (
    LARGEST_BINARY_MESH_FILE,
    LARGEST_MESH_FILE,
    UTF_8_MARK,
    read_bytes,
    text_problem,
)
from autocolor.files.repair.mesh_repair import repaired
from autocolor.files.repair.names import different, name_of
from autocolor.files.repair.placement import PLAIN, Placement
from autocolor.files.repair.polygons import MeshReport, Polygons

BEGINNING: Final = re.compile(rb"\s*solid\b", re.IGNORECASE)
FIRST_FACET: Final = re.compile(rb"\s*solid\b[^\r\n]*[\r\n]\s*facet\s+normal\s", re.IGNORECASE)
IN_UTF_16: Final = (b"\xff\xfe", b"\xfe\xff")


def read_stl(path: Path, placement: Placement = PLAIN) -> MeshReport:
    """The mesh of an STL file, and what was repaired or skipped.

    Raises InputError, with the place of each problem, and MissingInputError if the file does not exist.
    """
    corners, part_numbers, names, skipped = _triangles(path)
    points, rows = welded(corners)
    del corners
    polygons = Polygons(
        points.astype(np.float64, copy=False),
        rows,
        np.full(len(rows) // 3, 3, np.intp),
        part_numbers,
        names,
    )
    del points, rows
    return repaired(polygons, path.name, placement, skipped=skipped)


def _triangles(path: Path) -> tuple[AnyArray, Indices, tuple[str, ...], tuple[str, ...]]:
    """The corners of the triangles, (corners, 3), their part numbers, the names of parts, and messages."""
    data = read_bytes(path, LARGEST_BINARY_MESH_FILE)
    if has_binary_size(data) or not _is_text(data):
        corners, skipped = read_binary(data, path.name)
        return corners, np.zeros(len(corners) // 3, np.intp), (path.stem,), skipped
    if problem := text_problem(data):
        raise InputError(f"{path.name}: an ascii STL file {problem}")
    if len(data) > LARGEST_MESH_FILE:
        raise InputError(
            f"{path.name}: an ascii STL file must have at most {LARGEST_MESH_FILE:,} bytes, not more;"
            " export it as binary"
        )
    if b"\r" in data:
        data = data.replace(b"\r\n", b"\n").replace(b"\r", b"\n")
    found = read_text(data, path.name)
    names = different([name_of(name) or path.stem for name in found.names])
    return found.corners, found.part_numbers, names, found.messages


def _is_text(data: bytes) -> bool:
    """Whether a file that has not the size of a binary one is to be read as text."""
    return data[:2] in IN_UTF_16 or (BEGINNING.match(data) is not None and b"\0" not in data[:84])


def _begins(head: bytes) -> bool:
    """Whether a file begins as a text of solids does; binary files are only known by their names."""
    return FIRST_FACET.match(head.removeprefix(UTF_8_MARK)) is not None


STL: Final = register(MeshFormat("STL", read_stl, (".stl",), begins=_begins))
