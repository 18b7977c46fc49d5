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
from collections import deque
from collections.abc import Callable, Iterator, Mapping
from itertools import islice
from pathlib import Path
from typing import Any, Final

import meshio
import numpy as np
from meshio._common import cell_data_from_raw
from meshio.gmsh import _gmsh22, _gmsh40, _gmsh41, main
from meshio.gmsh.common import _fast_forward_to_end_block, _read_data

from autocolor.arrays import AnyArray, Indices
from autocolor.errors import InputError
from autocolor.files.meshes.cells import CORNERS, Flats, Volumes, cell_surface
from autocolor.files.meshes.file_scalars import FileScalars
from autocolor.files.meshes.foreign_mesh import ForeignMesh, ForeignRefusal, part_names_of, unreadable
from autocolor.files.meshes.meshio_text import PlainText, abaqus_text, medit_text, nastran_text
from autocolor.files.meshes.repair import RawPolygons
from autocolor.scene.scalar import NODE, POLYGON

TEXTS: Final[dict[str, Callable[[Path], PlainText]]] = {"abaqus": abaqus_text, "nastran": nastran_text}

KEYS: Final = {"gmsh": "element type", "su2": "element type"}
"""What a number is that meshio looks up and does not find; else it is a node."""

HARMLESS: Final = re.compile(r"tags of string type|tag data that couldn't|Gmf(?!\w*[PQ]\d)\w+ type\. Skip")
"""Warnings of meshio about names of boundaries, partitions, and Medit's data other than cells."""


def read(path: Path, kind: str) -> ForeignMesh:
    """The surface of a mesh in a format that meshio names `kind`. Raises ForeignRefusal."""
    printed = io.StringIO()
    try:
        with (
            contextlib.redirect_stdout(printed),
            contextlib.redirect_stderr(printed),
            warnings.catch_warnings(),
        ):
            # numpy warns of text that is no number, and gives fewer numbers.
            warnings.simplefilter("error", DeprecationWarning)
            text = TEXTS[kind](path) if kind in TEXTS else None
            sentences = _before_gmsh(path) if kind == "gmsh" else _before_su2(path) if kind == "su2" else []
            source = str(path) if text is None else io.StringIO("\n".join([*text.lines, ""]))
            if kind == "medit" and path.suffix.lower() == ".mesh":
                with tempfile.NamedTemporaryFile("w", suffix=".mesh", delete=False) as file:
                    file.write(medit_text(path))
                source = file.name
            mesh = getattr(meshio, kind).read(source)
        for warning in " ".join(printed.getvalue().split()).split("Warning: "):
            if warning and not HARMLESS.search(warning):
                raise unreadable("meshio", warning)
        return polygons_of(mesh, path.stem, text, sentences)
    except (ForeignRefusal, InputError, MemoryError):
        raise
    except (Exception, SystemExit) as error:
        raise unreadable("meshio", _reason(kind, error)) from None


def _reason(kind: str, error: BaseException) -> str:
    """Why meshio failed, in words; most of its exceptions are Python's own."""
    text = " ".join(str(error).split())
    if isinstance(error, KeyError):
        return f"there is no {KEYS.get(kind, 'node')} {error.args[0]}"
    if isinstance(error, IndexError) and kind == "gmsh":
        return "an element has a node that the file does not have"
    if isinstance(error, (OSError, meshio.ReadError, ValueError)) and text and "reshape" not in text:
        return text
    return "its numbers or keywords are cut short or in another order than in the format"


# What meshio gets wrong in the files of Gmsh and SU2.

# Its reader of MSH 2.2 divides data by the wrong lengths of blocks.
_gmsh22.cell_data_from_raw = lambda cells, data: cell_data_from_raw([each for _, each in cells], data)


def _before_gmsh(path: Path) -> list[str]:
    """Correct meshio's reader for a Gmsh file. Returns sentences about data to leave out."""
    data = path.read_bytes()
    header = re.match(rb"\s*(?:\$Comments.*?\$EndComments\s+)?\$MeshFormat\s+(\S+) (\d)", data, re.S)
    if header is None:
        raise ForeignRefusal("a Gmsh file must begin with $MeshFormat, as it does from MSH 2 on")
    version, is_text = header[1].decode("latin-1"), header[2] == b"0"
    # Gmsh wrote version 4.0 as "4", which meshio takes for 4.1.
    main._readers["4"] = _gmsh40
    skipped = [
        name
        for name, of in (("NodeData", "Nodes"), ("ElementData", "Elements"))
        if is_text and not _in_order(data, name, of, version)
    ]
    for module in (_gmsh22, _gmsh40, _gmsh41):
        module._read_data = lambda file, name, *others: (
            _fast_forward_to_end_block(file, name) if name in skipped else _read_data(file, name, *others)
        )
    return [f"left out ${name}, whose numbers are not all numbers of the mesh in order" for name in skipped]


def _in_order(data: bytes, name: str, of: str, version: str) -> bool:
    """Whether the rows of all sections of data of a text have the numbers of the nodes or elements."""
    numbers = None
    for lines in _sections(data, name):
        if numbers is None:
            numbers = [number for section in _sections(data, of) for number in _numbers(section, of, version)]
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


def _numbers(lines: list[bytes], of: str, version: str) -> list[bytes]:
    """The numbers of the nodes or elements in the lines of their section."""
    if version.startswith("2"):
        return [line.split()[0] for line in lines[1:]]
    rows, numbers = iter(lines[1:]), []
    for header in rows:
        count = int(header.split()[-1])
        numbers += [line.split()[0] for line in islice(rows, count)]
        if of == "Nodes" and version == "4.1":
            # The coordinates follow in lines of their own.
            deque(islice(rows, count), 0)
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


def _before_su2(path: Path) -> list[str]:
    """Refuse a file of several zones, of which meshio reads the last."""
    zones = re.search(rb"^\s*NZONE\s*=\s*(\d+)", path.read_bytes(), re.M)
    if zones and int(zones[1]) != 1:
        raise ForeignRefusal(f"NZONE must be 1, not {int(zones[1])}")
    return []


# The surface of a mesh of meshio.

SHAPE: Final = re.compile(r"(triangle|quad|tetra|hexahedron|wedge|pyramid)[0-9]*")
ALL_CORNERS: Final = {"triangle": 3, "quad": 4, **CORNERS}

GROUPS: Final = ("gmsh:physical", "medit:ref", "nastran:ref", "su2:tag", "ugrid:ref", "cell_tags")
"""The cell data with group numbers, in order of preference."""

INTERNAL: Final = re.compile(r"(gmsh|medit|nastran|su2|ugrid):")


def polygons_of(mesh: Any, stem: str, text: PlainText | None, sentences: list[str]) -> ForeignMesh:
    """The surface of a mesh of meshio; cells in no group are the part `stem`."""
    points = np.asarray(mesh.points, np.float64)
    if not len(points):
        raise ForeignRefusal("the file must have nodes, not none")
    if points.ndim != 2 or points.shape[1] > 3:
        raise ForeignRefusal(
            f"nodes must have two or three coordinates, not an array of shape {points.shape}"
        )
    coordinates = np.zeros((len(points), 3))
    coordinates[:, : points.shape[1]] = points

    flats: list[Flats] = []
    volumes: list[Volumes] = []
    skipped: dict[str, int] = {}
    higher_order = count = 0
    for block in mesh.cells:
        rows = np.arange(count, count + len(block.data))
        count += len(rows)
        shape = SHAPE.fullmatch(block.type)
        if shape is None:
            skipped[block.type] = skipped.get(block.type, 0) + len(rows)
            continue
        corners = ALL_CORNERS[shape[1]]
        table = np.asarray(block.data, np.intp).reshape(len(rows), -1)
        higher_order += len(rows) if table.shape[1] > corners else 0
        table = table[:, :corners]
        if len(rows) and not (table.min() >= 0 and table.max() < len(coordinates)):
            raise ForeignRefusal(f"a cell must have nodes of the file, which has {len(coordinates):,}")
        if shape[1] in CORNERS:
            volumes.append(Volumes(shape[1], table, rows))
        else:
            flats.append(Flats.of(table, rows))
    surface = cell_surface(coordinates, Flats.joined(flats), volumes)
    part_of_cell, part_names = _sets(text, count, stem) if text and text.sets else _groups(mesh, count, stem)
    scalars = _scalars(mesh, surface.nodes, surface.flats.cells)
    used, part_numbers = np.unique(part_of_cell[surface.flats.cells], return_inverse=True)
    polygons = RawPolygons(
        coordinates[surface.nodes],
        surface.flats.corners,
        surface.flats.corner_counts,
        part_numbers.reshape(-1).astype(np.intp),
        part_names_of([part_names[part] for part in used.tolist()]),
        scalars.scalars,
    )
    sentences += text.sentences if text else []
    sentences += [f"skipped cells of type {kind}: {number:,}" for kind, number in skipped.items()]
    if higher_order:
        sentences.append(f"took the corners alone of cells of higher order: {higher_order:,}")
    return ForeignMesh(polygons, (*sentences, *surface.sentences, *scalars.messages))


def _sets(text: PlainText, count: int, stem: str) -> tuple[Indices, list[str]]:
    """The part number of each cell by the sets of a text, and the names of the parts."""
    part_of_cell = np.zeros(count, np.intp)
    for number, members in enumerate(text.sets.values(), 1):
        part_of_cell[np.isin(text.ids, members) & (part_of_cell == 0)] = number
    return part_of_cell, [stem, *text.sets]


def _groups(mesh: Any, count: int, stem: str) -> tuple[Indices, list[str]]:
    """The part number of each cell by group numbers, and the names of the parts."""
    for key in GROUPS:
        tags = _joined(mesh.cell_data.get(key), count)
        if tags is None:
            continue
        # The physical groups of Gmsh have numbers of their own in each dimension; 0 is no group.
        is_gmsh = key == "gmsh:physical"
        dimensions = np.concatenate([np.full(len(each), each.dim * is_gmsh) for each in mesh.cells])
        named = {(abs(int(tag)), int(dimension)): name for name, (tag, dimension) in mesh.field_data.items()}
        groups, parts = np.unique(np.column_stack([np.abs(tags), dimensions]), axis=0, return_inverse=True)
        names = [
            stem if is_gmsh and not tag else named.get((tag, dimension), f"part {tag}")
            for tag, dimension in groups.tolist()
        ]
        return parts.reshape(-1).astype(np.intp), names
    return np.zeros(count, np.intp), [stem]


def _joined(blocks: Any, count: int) -> AnyArray | None:
    """The data of the cells of all blocks; None if they do not fit together."""
    try:
        joined = np.concatenate([np.asarray(each) for each in blocks])
    except (TypeError, ValueError):
        return None
    return joined if len(joined) == count else None


def _scalars(mesh: Any, nodes: Indices, cells: Indices) -> FileScalars:
    """The scalars of nodes and cells at the given rows."""
    scalars = FileScalars()
    count = sum(len(block.data) for block in mesh.cells)
    of_cells = {name: _joined(each, count) for name, each in mesh.cell_data.items()}
    kinds: tuple[tuple[str, Mapping[str, Any], Indices], ...] = (
        (NODE, mesh.point_data, nodes),
        (POLYGON, of_cells, cells),
    )
    for of, arrays, rows in kinds:
        for name, values in arrays.items():
            if INTERNAL.match(name) or name in GROUPS:
                continue
            if values is None or values.dtype.kind not in "iufb":
                scalars.sentences.append(
                    f"skipped the {of} array {name!r}, which has no number for each {of}"
                )
            else:
                scalars.add(name, values, of, rows)
    return scalars
