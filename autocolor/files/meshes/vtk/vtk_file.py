"""Reading a mesh from a legacy VTK file, versions 1.0 to 5.1, in text or binary.

- POLYDATA: polygons and triangle strips; vertices and lines are skipped and counted.
- UNSTRUCTURED_GRID: polygons of all kinds, and the outer surface of volume cells (see `cells`).
- STRUCTURED_GRID, RECTILINEAR_GRID and STRUCTURED_POINTS of one layer: its quads.

The data of nodes and cells are scalars of the mesh (see `attributes`). The file is one part, of its name.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Final, NamedTuple

import numpy as np

from autocolor.arrays import Floats, Indices
from autocolor.errors import InputError
from autocolor.files.meshes.formats import MeshFormat, register
from autocolor.files.meshes.vtk.attributes import Attributes
from autocolor.files.meshes.vtk.cells import Cells, add_polygons, add_strips, add_typed, read_cell_lists
from autocolor.files.meshes.vtk.cursor import VtkCursor
from autocolor.files.meshes.vtk.layers import LAYERS, read_layer
from autocolor.files.reading import LARGEST_MESH_FILE, read_bytes, shown
from autocolor.files.repair.cells import Flats, cell_surface, used_nodes
from autocolor.files.repair.mesh_repair import repaired
from autocolor.files.repair.placement import PLAIN, Placement
from autocolor.files.repair.polygons import MeshReport, Polygons
from autocolor.scene.scalars.mesh_scalars import NODE, POLYGON

FIRST_LINE: Final = re.compile(rb"# vtk DataFile Version [1-5]\.[0-9]+", re.IGNORECASE)

SKIPPED: Final = {b"VERTICES": "vertices", b"LINES": "lines"}

TABLES: Final = (b"POINT_DATA", b"CELL_DATA")


class Grid(NamedTuple):
    """The nodes and the cells of a file."""

    coordinates: Floats
    cells: Cells


def read_vtk(path: Path, placement: Placement = PLAIN) -> MeshReport:
    """The mesh of a legacy VTK file with its scalars, and what was repaired. Raises InputError."""
    cursor = VtkCursor(read_bytes(path, LARGEST_MESH_FILE), path.name)
    dataset = _dataset(cursor)
    grid = read_layer(cursor, dataset) if dataset in LAYERS else _grid(cursor, dataset)
    coordinates, cells = grid
    surface = cell_surface(coordinates, Flats.joined(cells.flats), cells.volumes)
    flats, nodes, sentences = surface
    if cells.higher_order and not cells.volumes:
        flats, nodes, sentences = _without_unused(flats, len(coordinates))
    counts = {NODE: len(coordinates), POLYGON: cells.count}
    attributes = Attributes(cursor, counts, {NODE: nodes, POLYGON: flats.cells})
    attributes.read()
    table = Polygons(
        coordinates[nodes],
        flats.corners,
        flats.corner_counts,
        np.zeros(len(flats.cells), np.intp),
        (path.stem,),
        attributes.found.scalars,
    )
    skipped = (*cells.sentences, *sentences, *attributes.messages)
    return repaired(table, path.name, placement, skipped=skipped)


def _dataset(cursor: VtkCursor) -> bytes:
    """The type of the data set, after the three lines before it. Raises InputError."""
    first = cursor.raw_line()
    if not FIRST_LINE.match(first):
        raise InputError(
            f"{cursor.name}, line 1: a legacy VTK file must begin '# vtk DataFile Version 1.0' to 5.1, not"
            f" {shown(first)}; write it as legacy VTK"
        )
    cursor.raw_line()
    kind = cursor.raw_line().strip().upper()
    if kind not in (b"ASCII", b"BINARY"):
        raise InputError(f"{cursor.name}, line 3: it must be ASCII or BINARY, not {shown(kind)}; correct it")
    words = cursor.words()
    if len(words) < 2 or words[0].upper() != b"DATASET":
        raise InputError(
            f"{cursor.name}, line 4: it must be DATASET and its type, not {shown(b' '.join(words))};"
            f" correct it"
        )
    if kind == b"ASCII":
        cursor.as_text()
    return words[1].upper()


def _grid(cursor: VtkCursor, dataset: bytes) -> Grid:
    """The nodes and cells of POLYDATA or an UNSTRUCTURED_GRID. Raises InputError."""
    if dataset not in (b"POLYDATA", b"UNSTRUCTURED_GRID"):
        known = ", ".join(["POLYDATA", "UNSTRUCTURED_GRID", *(each.decode() for each in LAYERS)])
        raise InputError(
            f"{cursor.where}: the DATASET must be one of {known}, not {shown(dataset)}; take its surface"
        )
    coordinates: Floats | None = None
    cells, lists = Cells(), None
    while (keyword := cursor.peek()) and keyword not in TABLES:
        words = cursor.words()
        if keyword == b"METADATA":
            cursor.skip_metadata()
        elif keyword == b"FIELD":
            Attributes(cursor, {}, {}).field(words)
        elif keyword == b"POINTS":
            coordinates = read_points(cursor, words)
        elif coordinates is None:
            raise InputError(
                f"{cursor.where}: there must be POINTS before {shown(words[0])}; correct the file"
            )
        elif keyword in SKIPPED:
            sizes = read_cell_lists(cursor, words, len(coordinates)).sizes
            cells.skip(SKIPPED[keyword], len(sizes))
            cells.count += len(sizes)
        elif keyword == b"POLYGONS":
            add_polygons(cells, read_cell_lists(cursor, words, len(coordinates)))
        elif keyword == b"TRIANGLE_STRIPS":
            add_strips(cells, read_cell_lists(cursor, words, len(coordinates)))
        elif keyword == b"CELLS":
            # The first count of version 5.1 is that of OFFSETS, one more than the cells.
            lists = read_cell_lists(cursor, words, len(coordinates))
        elif keyword == b"CELL_TYPES" and lists is not None:
            count = cursor.count(words[1] if len(words) > 1 else b"", "the count of CELL_TYPES")
            add_typed(cells, cursor, lists, cursor.wholes(count, b"int", "CELL_TYPES"))
            lists = None
        else:
            raise InputError(
                f"{cursor.where}: there must be no {shown(words[0])} in {dataset.decode()}; correct the file"
            )
    if coordinates is None:
        raise InputError(f"{cursor.name}: a data set must have POINTS, not none; add them")
    if lists is not None:
        raise InputError(f"{cursor.name}: there must be CELL_TYPES after CELLS; add them")
    return Grid(coordinates, cells)


def read_points(cursor: VtkCursor, words: list[bytes]) -> Floats:
    """The coordinates after a line such as `POINTS 8 float`, (nodes, 3). Raises InputError."""
    if len(words) < 3:
        raise InputError(f"{cursor.where}: POINTS must have a count and a type; correct it")
    count = cursor.count(words[1], "the count of POINTS")
    return cursor.coordinates(3 * count, words[2], "POINTS").reshape(-1, 3)


def _without_unused(flats: Flats, nodes: int) -> tuple[Flats, Indices, tuple[str, ...]]:
    """The polygons without the nodes between corners, as `cell_surface` returns them."""
    kept, sentences = used_nodes(nodes, flats.corners)
    row_of = np.zeros(nodes, np.intp)
    row_of[kept] = np.arange(len(kept))
    return Flats(row_of[flats.corners], flats.corner_counts, flats.cells), kept, sentences


def _begins(head: bytes) -> bool:
    return FIRST_LINE.match(head) is not None


VTK: Final = register(MeshFormat("VTK", read_vtk, (".vtk",), begins=_begins))
