"""A mesh as two tables in CSV: nodes.csv and polygons.csv.

    node,x,y,z,stress           polygon,part,node1,node2,node3,node4
    1,0.0,0.0,0.0,12.5          1,hood,1,2,3,4
    2,1.0,0.0,0.0,              2,roof,2,5,3,

The first row names the columns, which may be in any order. Cells are separated by commas; empty rows are
skipped. In messages rows are counted from 1, the header, as in a spreadsheet.

In the node table `node` may be omitted; nodes are then numbered from 1. Node numbers are unique integers, in
any order and with gaps. In the polygon table `polygon` (unique integers) and `part` may be omitted. A
triangle leaves `node4` empty.

Further columns are scalars, of the nodes or of the polygons; an empty cell is a missing value. The column
"scalar x" is the scalar "x", for names that columns of the mesh have.
"""

from __future__ import annotations

import difflib
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Final

import numpy as np

from autocolor.arrays import AnyArray, Indices, Numbers
from autocolor.checks import nearest
from autocolor.errors import InputError
from autocolor.files.meshes.csv_rows import (
    MOST_PROBLEMS,
    NOTHING,
    Cells,
    CsvRows,
    NameCells,
    NumberCells,
    Problems,
    WholeCells,
)
from autocolor.files.meshes.formats import MeshFormat, register
from autocolor.files.reading import shown
from autocolor.files.repair.found_scalars import FoundScalars
from autocolor.files.repair.mesh_repair import repaired
from autocolor.files.repair.placement import PLAIN, Placement
from autocolor.files.repair.polygons import MeshReport, Polygons
from autocolor.scene.scalars.mesh_scalars import MOST_SCALARS, NODE, POLYGON

NODE_COLUMNS: Final = ("node", "x", "y", "z")
CORNERS: Final = ("node1", "node2", "node3", "node4")
POLYGON_COLUMNS: Final = ("polygon", "part", *CORNERS)

SCALAR: Final = "scalar "
"""What a column's name begins with where the rest is the name of a scalar."""

CORNER: Final = re.compile(r"node[0-9]+")

ALIKE: Final = 0.8
"""Assumed: a name that is spelled so much like a missing column is a mistake, and no scalar."""

COORDINATES: Final = NumberCells("a coordinate must be a decimal number of at most 1e30 in size")
VALUES: Final = NumberCells(
    "a value must be a decimal number of at most 1e30 in size, or empty if it is missing", may_be_empty=True
)


class Table:
    """The columns of one table by their names, and the numbers of its rows in the file."""

    def __init__(
        self,
        problems: Problems,
        path: Path,
        columns: Mapping[str, Cells],
        required: tuple[str, ...],
    ) -> None:
        self.problems = problems
        self.place = path.name
        rows = CsvRows(path)
        header = rows.header
        _check_header(self.place, header, tuple(columns), required)
        kinds = [columns.get(name, VALUES) for name in header]
        values, self.numbers = rows.converted(problems, kinds)
        self.columns: dict[str, AnyArray] = dict(zip(header, values, strict=True))
        self.scalars = {
            name.removeprefix(SCALAR): values for name, values in self.columns.items() if name not in columns
        }

    def note(self, row: int, sentence: str) -> None:
        """Note a problem of a row, counted from 0 among those of the table."""
        self.problems.note(self.place, int(self.numbers[row]), sentence)

    def note_repeated(self, what: str, numbers: Numbers) -> None:
        """Note the numbers that repeat one before them; NOTHING may be repeated."""
        for row in _repeated(numbers)[:MOST_PROBLEMS].tolist():
            self.note(row, f"a {what} number must be unique, not repeated: {numbers[row]}; renumber it")


def read_csv_tables(nodes: Path, polygons: Path, placement: Placement = PLAIN) -> MeshReport:
    """The mesh of a node table and a polygon table, and what was repaired.

    Raises InputError with every problem of both tables, each with its file and row.
    """
    problems = Problems()
    node_table = Table(
        problems,
        nodes,
        {"node": WholeCells("a node number"), **dict.fromkeys("xyz", COORDINATES)},
        ("x", "y", "z"),
    )
    coordinates = np.stack([node_table.columns[axis] for axis in "xyz"], axis=1)
    numbers = node_table.columns.get("node", np.arange(1, len(coordinates) + 1))
    node_table.note_repeated("node", numbers)

    names = NameCells(polygons.stem)
    corner, last = WholeCells("a corner"), WholeCells("a corner", may_be_empty=True)
    polygon_table = Table(
        problems,
        polygons,
        {
            "polygon": WholeCells("a polygon number"),
            "part": names,
            **dict(zip(CORNERS, (corner, corner, corner, last), strict=True)),
        },
        CORNERS,
    )
    count = len(polygon_table.numbers)
    if "polygon" in polygon_table.columns:
        polygon_table.note_repeated("polygon", polygon_table.columns["polygon"])
    parts = polygon_table.columns.get("part")
    if parts is None:
        parts = np.full(count, names.one(""))
    corners = np.stack([polygon_table.columns[name] for name in CORNERS], axis=1)
    rows = _rows_of(polygon_table, corners, numbers)
    problems.raise_any()

    is_corner = corners != NOTHING
    scalars = FoundScalars()
    for of, table in ((NODE, node_table), (POLYGON, polygon_table)):
        for name, values in table.scalars.items():
            scalars.add(name, values, of)
    mesh = Polygons(
        coordinates,
        rows[is_corner],
        is_corner.sum(axis=1),
        parts.astype(np.intp),
        tuple(names.rows),
        scalars.scalars,
    )
    return repaired(mesh, polygons.name, placement)


def _repeated(numbers: Numbers) -> Indices:
    """The rows of numbers that repeat one before them, in order; those of NOTHING are left out."""
    if (np.diff(numbers) > 0).all():
        return np.empty(0, np.intp)
    order = np.argsort(numbers, kind="stable")
    in_order = numbers[order]
    again = order[1:][(np.diff(in_order) == 0) & (in_order[1:] != NOTHING)]
    return np.sort(again)


def _rows_of(table: Table, corners: Numbers, numbers: Numbers) -> Indices:
    """The rows of the nodes of some numbers, 0 for NOTHING; a number that no node has is noted."""
    if not len(numbers):
        missing = corners != NOTHING
        rows = np.zeros(corners.shape, np.intp)
    else:
        order = np.argsort(numbers, kind="stable")
        in_order = numbers[order]
        at = np.minimum(np.searchsorted(in_order, corners), len(numbers) - 1)
        missing = (in_order[at] != corners) & (corners != NOTHING)
        rows = order[at]
    for row, column in np.argwhere(missing)[:MOST_PROBLEMS].tolist():
        table.note(row, f"node {corners[row, column]} is not in the node table ({_known(numbers)})")
    return rows


def _known(numbers: Numbers) -> str:
    """The range of the node numbers, for a message; it says if there are gaps."""
    known = np.unique(numbers[numbers != NOTHING])
    if not len(known):
        return "it is empty"
    gaps = "" if known[-1] - known[0] + 1 == len(known) else ", with gaps"
    return f"{known[0]} to {known[-1]}{gaps}"


def _check_header(place: str, cells: list[str], columns: tuple[str, ...], required: tuple[str, ...]) -> None:
    """Raise InputError if a required column is missing, or a column is repeated or seems misspelled."""
    missing = [column for column in columns if column not in cells]
    lacks_required = any(column in missing for column in required)
    problems = [
        f"{place}, row 1: there is no column {shown(cell)}{nearest(cell[:60], columns)}"
        for cell in dict.fromkeys(cells)
        if cell not in columns and (lacks_required or _is_mistake(cell, columns, missing))
    ][:MOST_PROBLEMS]
    counts: dict[str, int] = {}
    for cell in cells:
        counts[cell] = counts.get(cell, 0) + 1
    problems += [
        f"{place}, row 1: a column name must be unique, not repeated: {shown(cell)}; remove one"
        for cell, count in counts.items()
        if count > 1 and cell
    ][:MOST_PROBLEMS]
    if not problems:
        problems = [
            f"{place}, row 1: there must be a column {column!r}, not only {', '.join(cells)}; add it"
            for column in required
            if column in missing
        ]
    if not problems and len(counts) - len(columns) > MOST_SCALARS:
        problems = [
            f"{place}, row 1: there must be at most {MOST_SCALARS:,} columns of scalars, not {len(counts):,};"
            " remove some"
        ]
    if problems:
        raise InputError(problems)


def _is_mistake(cell: str, columns: tuple[str, ...], missing: list[str]) -> bool:
    """Whether the name of an unknown column is no scalar's: it is empty, a corner, or nearly a column."""
    if not cell or cell.casefold() in columns or ("node1" in columns and CORNER.fullmatch(cell) is not None):
        return True
    return bool(difflib.get_close_matches(cell[:60], missing, n=1, cutoff=ALIKE))


CSV_TABLES: Final = register(
    MeshFormat("CSV", read_csv_tables, keys=("nodes", "polygons"), in_folder=("nodes.csv", "polygons.csv"))
)
