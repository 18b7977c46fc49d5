"""The surface of a mesh of meshio: its polygons, the outer faces of its volume cells, parts and scalars.

Of cells of higher order the corners are taken. Vertices, lines and cells of other kinds are skipped and
counted. Parts are the physical groups of Gmsh, the sets of cells of Abaqus and others, or the numbers with
which Medit, Nastran and SU2 tell cells apart; a cell in several sets is of the first, and one in none of the
part named after the file. Nothing of meshio is imported here: its mesh is known by what it has.
"""

from __future__ import annotations

import re
from typing import Any, Final

import numpy as np

from autocolor.arrays import AnyArray, Indices
from autocolor.files.meshes.foreign.foreign_mesh import ForeignMesh
from autocolor.files.repair.cells import CORNERS, Flats, Volumes, cell_surface
from autocolor.files.repair.found_scalars import FoundScalars
from autocolor.files.repair.polygons import Polygons
from autocolor.scene.scalars.mesh_scalars import NODE, POLYGON

SHAPE: Final = re.compile(r"(triangle|quad|tetra|hexahedron|wedge|pyramid)([0-9]*)")
POLYGONS: Final = re.compile(r"polygon[0-9]*")
ALL_CORNERS: Final = {"triangle": 3, "quad": 4, **CORNERS}

GROUPS: Final = ("gmsh:physical", "medit:ref", "nastran:ref", "su2:tag", "ugrid:ref", "cell_tags")
"""The data of cells that number their groups, the first that a file has."""

INTERNAL: Final = re.compile(r"(gmsh|medit|nastran|su2|ugrid|abaqus):")


def polygons_of_meshio(mesh: Any, stem: str) -> ForeignMesh:
    """The surface of a mesh of meshio; `stem` is the name of the part of what is in no group."""
    points = np.asarray(mesh.points, np.float64)
    if points.ndim != 2 or points.shape[1] > 3:
        raise ValueError(f"nodes of shape {points.shape}")
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
        if shape is None and not POLYGONS.fullmatch(block.type):
            skipped[block.type] = skipped.get(block.type, 0) + len(rows)
            continue
        if shape is None:
            sizes = np.array([len(row) for row in block.data], np.intp)
            flats.append(Flats(_rows(np.concatenate([np.empty(0, np.intp), *block.data])), sizes, rows))
            continue
        table = np.asarray(block.data).reshape(len(rows), -1)
        name, corners = shape[1], ALL_CORNERS[shape[1]]
        higher_order += len(rows) if table.shape[1] > corners else 0
        table = _rows(table[:, :corners])
        if len(rows) and table.shape[1] != corners:
            raise ValueError(f"cells of type {block.type} with {table.shape[1]} corners")
        if name in CORNERS:
            volumes.append(Volumes(name, table, rows))
        else:
            flats.append(Flats.of(table, rows))
    every = Flats.joined(flats)
    for numbers in (every.corners, *(each.corners.ravel() for each in volumes)):
        if len(numbers) and not (numbers.min() >= 0 and numbers.max() < len(coordinates)):
            raise ValueError(f"a cell with a node that is none of the {len(coordinates):,} of the file")
    surface = cell_surface(coordinates, every, volumes)
    part_of_cell, part_names = _parts(mesh, count, stem)
    scalars = _scalars(mesh, surface.nodes, surface.flats.cells)
    used, part_numbers = np.unique(part_of_cell[surface.flats.cells], return_inverse=True)
    polygons = Polygons(
        coordinates[surface.nodes],
        surface.flats.corners,
        surface.flats.corner_counts,
        part_numbers.reshape(-1).astype(np.intp),
        tuple(part_names[part] for part in used.tolist()),
        scalars.scalars,
    )
    sentences = [f"skipped cells of type {kind}: {number:,}" for kind, number in skipped.items()]
    if higher_order:
        sentences.append(f"took the corners alone of cells of higher order: {higher_order:,}")
    return ForeignMesh(polygons, (*sentences, *surface.sentences, *scalars.messages))


def _rows(numbers: AnyArray) -> Indices:
    """Node numbers as rows. Raises ValueError for those that are not whole."""
    rows = numbers.astype(np.intp)
    if not np.array_equal(rows, numbers):
        raise ValueError("node numbers that are not whole")
    return rows


def _parts(mesh: Any, count: int, stem: str) -> tuple[Indices, list[str]]:
    """The part number of each cell, and the names of the parts."""
    data = getattr(mesh, "cell_data", {}) or {}
    for key in GROUPS:
        tags = _joined(data.get(key), count)
        if tags is not None and tags.ndim == 1 and tags.dtype.kind in "iu":
            named = {
                int(value[0]): str(name)
                for name, value in (getattr(mesh, "field_data", {}) or {}).items()
                if np.size(value) >= 1
            }
            numbers, parts = np.unique(tags, return_inverse=True)
            names = [named.get(number, f"part {number}") for number in numbers.tolist()]
            return parts.reshape(-1).astype(np.intp), names
    part_of_cell = np.zeros(count, np.intp)
    names = [stem]
    starts = np.cumsum([0, *(len(block.data) for block in mesh.cells)])
    for name, blocks in (getattr(mesh, "cell_sets", {}) or {}).items():
        if INTERNAL.match(str(name)):
            continue
        names.append(str(name))
        for start, end, chosen in zip(starts, starts[1:], blocks, strict=False):
            rows = np.asarray([] if chosen is None else chosen)
            rows = start + rows.astype(np.intp)
            rows = rows[(rows >= start) & (rows < end)]
            part_of_cell[rows[part_of_cell[rows] == 0]] = len(names) - 1
    return part_of_cell, names


def _joined(blocks: Any, count: int) -> AnyArray | None:
    """The data of the cells of all blocks; None if they do not fit together."""
    try:
        joined = np.concatenate([np.asarray(each) for each in blocks])
    except (TypeError, ValueError):
        return None
    return joined if len(joined) == count else None


def _scalars(mesh: Any, nodes: Indices, cells: Indices) -> FoundScalars:
    """The scalars of nodes and cells, at the rows that are kept."""
    found = FoundScalars()
    count = sum(len(block.data) for block in mesh.cells)
    of_nodes = {name: np.asarray(each) for name, each in (mesh.point_data or {}).items()}
    of_cells = {name: _joined(each, count) for name, each in (mesh.cell_data or {}).items()}
    for of, arrays, rows, length in (
        (NODE, of_nodes, nodes, len(mesh.points)),
        (POLYGON, of_cells, cells, count),
    ):
        for name, values in arrays.items():
            if INTERNAL.match(str(name)) or name in GROUPS:
                continue
            if values is None or len(values) != length or values.dtype.kind not in "iufb":
                found.sentences.append(f"skipped the {of} array {name!r}, which has no number for each {of}")
            else:
                found.add(str(name), values, of, rows)
    return found
