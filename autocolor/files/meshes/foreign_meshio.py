"""Abaqus, Nastran, Gmsh, Medit, SU2 and UGRID, read by meshio.

The texts of Abaqus and Nastran are looked over first (`meshio_text`). Of volume cells the outer surface is
taken, of cells of higher order the corners; cells without faces are skipped and counted. Parts are the
physical groups of Gmsh, the element sets of Abaqus, and the numbers by which the other formats tell cells
apart. A cell in several sets belongs to the first set; a cell in no set, to the part named after the file.
"""

from __future__ import annotations

import contextlib
import io
import re
import tempfile
import warnings
from collections import Counter
from collections.abc import Callable, Iterator, Mapping
from itertools import islice
from pathlib import Path
from typing import Any, Final

import meshio
import numpy as np
from meshio._common import cell_data_from_raw
from meshio.gmsh import _gmsh22, _gmsh40, _gmsh41, main
from meshio.gmsh.common import _fast_forward_to_end_block, _read_data

from autocolor.arrays import Indices
from autocolor.errors import InputError
from autocolor.files.meshes.cells import CORNERS, Flats, Volumes, cell_surface
from autocolor.files.meshes.file_scalars import FileScalars
from autocolor.files.meshes.foreign_mesh import ForeignMesh, ForeignRefusal, part_names_of, unreadable
from autocolor.files.meshes.meshio_text import abaqus_text, medit_text, nastran_text
from autocolor.files.meshes.repair import RawPolygons
from autocolor.scene.scalar import NODE, POLYGON

HARMLESS: Final = re.compile(r"tags of string type|tag data that couldn't|Gmf(?!\w*[PQ]\d)\w+ type\. Skip")
"""Warnings of meshio about names of boundaries, partitions, and Medit's data other than cells."""


def read(path: Path, kind: str) -> ForeignMesh:
    """The surface of a mesh in a format that meshio names `kind`. Raises ForeignRefusal and InputError."""
    printed, sentences, sets = io.StringIO(), list[str](), None
    source: str | io.StringIO = str(path)
    try:
        with contextlib.ExitStack() as stack:
            stack.enter_context(contextlib.redirect_stdout(printed))
            stack.enter_context(contextlib.redirect_stderr(printed))
            stack.enter_context(warnings.catch_warnings())
            # numpy warns of text that is no number, and gives fewer numbers.
            warnings.simplefilter("error", DeprecationWarning)
            if kind in ("abaqus", "nastran"):
                text = abaqus_text(path) if kind == "abaqus" else nastran_text(path)
                source, sentences, sets = io.StringIO("\n".join([*text.lines, ""])), text.sentences, text.sets
            elif kind == "medit" and path.suffix.lower() == ".mesh":
                with tempfile.NamedTemporaryFile("w", suffix=".mesh", delete=False) as file:
                    file.write(medit_text(path))
                source = file.name
            elif kind == "gmsh":
                sentences = _prepare_gmsh(path.read_bytes())
            elif zones := re.search(rb"^\s*NZONE\s*=\s*(?!1\b)\d+", path.read_bytes(), re.M):
                raise ForeignRefusal(f"the file must have one zone, not {zones[0].decode().strip()}")
            mesh = getattr(meshio, kind).read(source)
        for warning in " ".join(printed.getvalue().split()).split("Warning: "):
            if warning and not HARMLESS.search(warning):
                raise unreadable("meshio", warning)
        return _polygons_of(mesh, path.stem, sets, sentences)
    except (ForeignRefusal, InputError, MemoryError):
        raise
    except (Exception, SystemExit) as error:
        raise unreadable("meshio", _reason(kind, error)) from None


def _reason(kind: str, error: BaseException) -> str:
    """Why meshio failed, in words; most of its exceptions are Python's own."""
    text = " ".join(str(error).split())
    if isinstance(error, KeyError):
        noun = "node" if kind in ("abaqus", "nastran") else "element type"
        return f"there is no {noun} {error.args[0]}"
    if isinstance(error, (OSError, meshio.ReadError, ValueError)) and text and "reshape" not in text:
        return text
    return "its numbers are cut short, or name nodes that it does not have"


# Gmsh: what meshio would get wrong.


def _prepare_gmsh(data: bytes) -> list[str]:
    """Correct meshio's readers for the bytes of a Gmsh file. Returns sentences about data to leave out."""
    header = re.match(rb"\s*(?:\$Comments.*?\$EndComments\s+)?\$MeshFormat\s+(\S+) (\d)", data, re.S)
    if header is None:
        raise ForeignRefusal("a Gmsh file must begin with $MeshFormat, as it does from MSH 2 on")
    # Gmsh wrote version 4.0 as "4", which meshio takes for 4.1.
    main._readers["4"] = _gmsh40
    # The reader of MSH 2.2 divides data by wrong lengths of blocks.
    _gmsh22.cell_data_from_raw = lambda cells, raw: cell_data_from_raw([each for _, each in cells], raw)
    # meshio ignores the numbers in data. In a binary file it refuses data that is not in order.
    skipped = [
        name
        for name, of in (("NodeData", "Nodes"), ("ElementData", "Elements"))
        if header[2] == b"0" and not _are_in_order(data, name, of, header[1])
    ]
    for module in (_gmsh22, _gmsh40, _gmsh41):
        module._read_data = lambda file, name, *others: (
            _fast_forward_to_end_block(file, name) if name in skipped else _read_data(file, name, *others)
        )
    return [f"left out ${name}, whose numbers are not all numbers of the mesh in order" for name in skipped]


def _are_in_order(data: bytes, name: str, of: str, version: bytes) -> bool:
    """Whether all sections of data in a text have the numbers of all nodes or elements, in their order."""
    sections = list(_sections(data, name))
    numbers = [each for lines in _sections(data, of) for each in _numbers(lines, of, version)] * bool(
        sections
    )
    for lines in sections:
        at = 0
        for _ in ("strings", "real numbers", "whole numbers"):
            at += 1 + int(lines[at])
        if [line.split()[0] for line in lines[at:]] != numbers:
            return False
    return True


def _sections(data: bytes, name: str) -> Iterator[list[bytes]]:
    """The lines of each section of a Gmsh text with a name."""
    for match in re.finditer(rb"\$%b\s+(.*?)\s*\$End%b" % (name.encode(), name.encode()), data, re.S):
        yield match[1].split(b"\n")


def _numbers(lines: list[bytes], of: str, version: bytes) -> list[bytes]:
    """The numbers of the nodes or elements in the lines of their section."""
    if version.startswith(b"2"):
        return [line.split()[0] for line in lines[1:]]
    rows, numbers = iter(lines[1:]), []
    for header in rows:
        count = int(header.split()[-1])
        numbers += [line.split()[0] for line in islice(rows, count)]
        if of == "Nodes" and version == b"4.1":
            # The coordinates follow in lines of their own.
            list(islice(rows, count))
    return numbers


def _grouped(read_entities: Callable[..., Any]) -> Callable[..., Any]:
    """A reader of entities of meshio with group 0 for an entity in no group: else cells lose all groups."""

    def read(*arguments: Any) -> Any:
        result = read_entities(*arguments)
        for groups in result if len(result) == 4 else result[0]:
            groups.update({entity: numbers or [0] for entity, numbers in groups.items()})
        return result

    return read


for _module in (_gmsh40, _gmsh41):
    _module._read_entities = _grouped(_module._read_entities)


# The surface of a mesh of meshio.

SHAPE: Final = re.compile(r"(triangle|quad|tetra|hexahedron|wedge|pyramid)[0-9]*")
ALL_CORNERS: Final = {"triangle": 3, "quad": 4, **CORNERS}

GROUPS: Final = re.compile(r"gmsh:physical|(medit|nastran|ugrid):ref|su2:tag")
"""The cell data with the numbers of groups."""


def _polygons_of(
    mesh: Any, stem: str, sets: Mapping[str, Indices] | None, sentences: list[str]
) -> ForeignMesh:
    """The surface of a mesh of meshio; `sets` are the rows of cells by the names of parts, or None."""
    points = np.asarray(mesh.points, np.float64)
    if not len(points) or not mesh.cells or points.shape[1] > 3:
        raise ForeignRefusal("the file must have nodes of two or three coordinates, and elements")
    coordinates = np.zeros((len(points), 3))
    coordinates[:, : points.shape[1]] = points

    flats: list[Flats] = []
    volumes: list[Volumes] = []
    higher_order = count = 0
    skipped: Counter[str] = Counter()
    for block in mesh.cells:
        rows = np.arange(count, count + len(block))
        count += len(rows)
        shape = SHAPE.fullmatch(block.type)
        if shape is None:
            skipped[block.type] += len(rows)
            continue
        corners = ALL_CORNERS[shape[1]]
        higher_order += len(rows) * (block.data.shape[1] > corners)
        table = block.data[:, :corners].astype(np.intp)
        if len(rows) and not (table.min() >= 0 and table.max() < len(coordinates)):
            raise ForeignRefusal(f"a cell must have nodes of the file, which has {len(coordinates):,}")
        if shape[1] in CORNERS:
            volumes.append(Volumes(shape[1], table, rows))
        else:
            flats.append(Flats.of(table, rows))
    surface = cell_surface(coordinates, Flats.joined(flats), volumes)
    cells = surface.flats.cells
    part_of_cell, part_names = _groups(mesh, count, stem) if sets is None else _sets(sets, count, stem)
    used, part_numbers = np.unique(part_of_cell[cells], return_inverse=True)
    scalars = FileScalars()
    for name, values in mesh.point_data.items():
        if ":" not in name:
            scalars.add(name, values, NODE, surface.nodes)
    for name, blocks in mesh.cell_data.items():
        if ":" not in name:
            scalars.add(name, np.concatenate(blocks), POLYGON, cells)
    polygons = RawPolygons(
        coordinates[surface.nodes],
        surface.flats.corners,
        surface.flats.corner_counts,
        part_numbers.reshape(-1).astype(np.intp),
        part_names_of([part_names[part] for part in used.tolist()]),
        scalars.scalars,
    )
    sentences += [f"skipped cells of type {kind}: {number:,}" for kind, number in skipped.items()]
    if higher_order:
        sentences.append(f"took the corners alone of cells of higher order: {higher_order:,}")
    return ForeignMesh(polygons, (*sentences, *surface.sentences, *scalars.messages))


def _sets(sets: Mapping[str, Indices], count: int, stem: str) -> tuple[Indices, list[str]]:
    """The part number of each cell by sets of cells, and the names of the parts."""
    part_of_cell = np.zeros(count, np.intp)
    for number, rows in enumerate(sets.values(), 1):
        part_of_cell[rows[part_of_cell[rows] == 0]] = number
    return part_of_cell, [stem, *sets]


def _groups(mesh: Any, count: int, stem: str) -> tuple[Indices, list[str]]:
    """The part number of each cell by the numbers of groups, and the names of the parts."""
    for key, blocks in mesh.cell_data.items():
        if not GROUPS.fullmatch(key):
            continue
        # The physical groups of Gmsh have numbers of their own in each dimension; 0 is no group.
        is_gmsh = key == "gmsh:physical"
        dimensions = np.concatenate([np.full(len(each), each.dim * is_gmsh) for each in mesh.cells])
        groups, parts = np.unique(
            np.column_stack([np.abs(np.concatenate(blocks)), dimensions]), axis=0, return_inverse=True
        )
        named = {(int(tag), int(dimension)): name for name, (tag, dimension) in mesh.field_data.items()}
        names = [
            stem if is_gmsh and not tag else named.get((tag, dimension), f"part {tag}")
            for tag, dimension in groups.tolist()
        ]
        return parts.reshape(-1).astype(np.intp), names
    return np.zeros(count, np.intp), [stem]
