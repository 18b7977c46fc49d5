"""Reading a mesh from a Wavefront OBJ file.

These statements are used: `v` (a weight or color after x y z is ignored); `f`, with node numbers that count
from 1 or, if negative, back from the latest node (texture and normal numbers are ignored); `g`, `o` and
`usemtl`, which name the parts and their materials (see `statements`); and `mtllib`, which names the files
with the materials (see `materials`). A polygon may name nodes that are defined later. Quads stay quads, and
shared nodes stay shared.

Texture coordinates and normals are ignored. Points, lines, curves and unknown statements are skipped and
counted. Lines may end with LF, CR LF or CR, may be continued with a backslash, and may start with spaces or
tabs.
"""

from __future__ import annotations

import dataclasses
import re
from pathlib import Path
from typing import Final

from autocolor.errors import InputError
from autocolor.files.meshes.formats import PARTS, MeshFormat, register
from autocolor.files.meshes.obj.lines import read_obj_lines
from autocolor.files.meshes.obj.materials import read_materials
from autocolor.files.meshes.obj.obj_text import obj_text
from autocolor.files.meshes.obj.plain import read_plain_obj
from autocolor.files.meshes.obj.statements import Statements
from autocolor.files.reading import LARGEST_MESH_FILE, read_bytes, text_problem
from autocolor.files.repair.mesh_repair import repaired
from autocolor.files.repair.placement import PLAIN, Placement
from autocolor.files.repair.polygons import MeshReport, Polygons

NODE_LINE: Final = re.compile(rb"^[ \t]*v([ \t]+[-+.0-9][^\s]*){3}", re.MULTILINE)
"""A line that defines a node."""


def read_obj(path: Path, placement: Placement = PLAIN) -> MeshReport:
    """The mesh of an OBJ file, and what was repaired or skipped.

    Raises InputError with every problem, each with its line, MissingInputError if the file does not exist.
    """
    data = read_bytes(path, LARGEST_MESH_FILE)
    if problem := text_problem(data):
        raise InputError(f"{path.name}: an OBJ file {problem}")
    if b"\r" in data:
        data = data.replace(b"\r\n", b"\n").replace(b"\r", b"\n")
    statements = Statements(path.stem)
    tables = read_plain_obj(data, statements)
    if tables is None or (tables.rows < 0).any():
        del tables
        statements = Statements(path.stem)
        tables = read_obj_lines(data, path.name, statements)
    del data
    parts = statements.parts()
    polygons = Polygons(
        tables.coordinates,
        tables.rows,
        tables.corner_counts,
        tables.part_numbers,
        tuple(part.name for part in parts),
    )
    report = repaired(polygons, path.name, placement, skipped=statements.sentences)
    material_of_part = {part.name: part.material for part in parts if part.material is not None}
    materials = read_materials(path, statements.libraries, tuple(dict.fromkeys(material_of_part.values())))
    return dataclasses.replace(
        report,
        repairs=report.repairs + materials.sentences,
        material_of_part=material_of_part,
        materials=materials.surfaces,
    )


def _begins(head: bytes) -> bool:
    """Whether the first bytes of a file contain a line that defines a node, and no NUL byte."""
    return NODE_LINE.search(head) is not None and b"\0" not in head


OBJ: Final = register(
    MeshFormat("OBJ", read_obj, (".obj",), begins=_begins, written=obj_text, holds=frozenset((PARTS,)))
)
