"""A mesh as two tables in CSV: nodes.csv and polygons.csv.

    node,x,y,z              polygon,part,node1,node2,node3,node4
    1,0.0,0.0,0.0           1,hood,1,2,3,4
    2,1.0,0.0,0.0           2,roof,2,5,3,

The first row names the columns, which may be in any order. Cells are separated by commas; empty rows are
skipped. In messages rows are counted from 1, the header, as in a spreadsheet.

In the node table `node` may be omitted; nodes are then numbered from 1. Node numbers are unique integers, in
any order and with gaps. In the polygon table `polygon` (unique integers) and `part` may be omitted. A
triangle leaves `node4` empty.
"""

from __future__ import annotations

import csv
import io
import math
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Final

import numpy as np

from autocolor.checks import LARGEST_COORDINATE, nearest
from autocolor.errors import InputError
from autocolor.files.meshes.formats import MeshFormat, register
from autocolor.files.reading import LARGEST_MESH_FILE, read_bytes, shown, text_problem
from autocolor.files.repair.mesh_repair import repaired
from autocolor.files.repair.placement import PLAIN, Placement
from autocolor.files.repair.polygons import MeshReport, Polygons

MOST_PROBLEMS: Final = 20

NUMBER: Final = re.compile(r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?")
WHOLE_NUMBER: Final = re.compile(r"[+-]?[0-9]{1,18}")

NODE_COLUMNS: Final = ("node", "x", "y", "z")
POLYGON_COLUMNS: Final = ("polygon", "part", "node1", "node2", "node3", "node4")


class Problems:
    """Collects the problems of both tables, up to MOST_PROBLEMS."""

    def __init__(self) -> None:
        self.found: list[str] = []

    def note(self, place: str, row: int, sentence: str) -> None:
        """Add a problem; raise InputError once there are MOST_PROBLEMS."""
        self.found.append(f"{place}, row {row}: {sentence}")
        if len(self.found) >= MOST_PROBLEMS:
            raise InputError(self.found)


def read_csv_tables(nodes: Path, polygons: Path, placement: Placement = PLAIN) -> MeshReport:
    """The mesh of a node table and a polygon table, and what was repaired.

    Raises InputError with every problem of both tables, each with its file and row.
    """
    problems = Problems()
    coordinates, row_of_node = _nodes(problems, nodes)
    corners, counts, parts, names = _polygons(problems, polygons, row_of_node)
    if problems.found:
        raise InputError(problems.found)
    table = Polygons(
        np.array(coordinates, np.float64).reshape(-1, 3),
        np.array(corners, np.intp),
        np.array(counts, np.intp),
        np.array(parts, np.intp),
        tuple(names),
    )
    return repaired(table, polygons.name, placement)


def _nodes(problems: Problems, path: Path) -> tuple[list[float], dict[int, int]]:
    """The coordinates as one flat list, and the row index of each node number."""
    coordinates: list[float] = []
    row_of_node: dict[int, int] = {}
    for row, (node, *place) in _rows(problems, path, NODE_COLUMNS, ("x", "y", "z")):
        number = (
            len(row_of_node) + 1 if node is None else _whole(problems, path.name, row, "a node number", node)
        )
        if number in row_of_node:
            problems.note(
                path.name, row, f"a node number must be unique, not repeated: {number}; renumber it"
            )
        elif number is not None:
            row_of_node[number] = len(row_of_node)
        for cell in place:
            value = float(cell) if cell is not None and NUMBER.fullmatch(cell) else math.nan
            if not abs(value) <= LARGEST_COORDINATE:
                rule = "a coordinate must be a decimal number of at most 1e30 in size"
                problems.note(path.name, row, f"{rule}, not {shown(cell or '')}; correct it")
            coordinates.append(value)
    return coordinates, row_of_node


def _polygons(
    problems: Problems, path: Path, row_of_node: dict[int, int]
) -> tuple[list[int], list[int], list[int], dict[str, int]]:
    """The corners as one flat list, the corner counts and part numbers of the polygons, the part names."""
    corners: list[int] = []
    counts: list[int] = []
    parts: list[int] = []
    names: dict[str, int] = {}
    seen: set[int] = set()
    for row, (polygon, part, *cells) in _rows(problems, path, POLYGON_COLUMNS, POLYGON_COLUMNS[2:]):
        if polygon is not None:
            number = _whole(problems, path.name, row, "a polygon number", polygon)
            if number in seen:
                problems.note(
                    path.name, row, f"a polygon number must be unique, not repeated: {number}; renumber it"
                )
            elif number is not None:
                seen.add(number)
        # Only the last corner, that of a triangle, may be empty.
        if not cells[3]:
            del cells[3]
        for cell in cells:
            node = _whole(problems, path.name, row, "a corner", cell or "")
            if node is not None and node not in row_of_node:
                problems.note(path.name, row, f"node {node} is not in the node table ({_known(row_of_node)})")
            corners.append(row_of_node.get(node, 0) if node is not None else 0)
        counts.append(len(cells))
        name = "".join(letter if letter.isprintable() else "?" for letter in (part or path.stem)[:200])
        parts.append(names.setdefault(name, len(names)))
    return corners, counts, parts, names


def _known(row_of_node: dict[int, int]) -> str:
    """The range of the node numbers, for a message; it says if there are gaps."""
    if not row_of_node:
        return "it is empty"
    low, high = min(row_of_node), max(row_of_node)
    gaps = "" if high - low + 1 == len(row_of_node) else ", with gaps"
    return f"{low} to {high}{gaps}"


def _whole(problems: Problems, place: str, row: int, what: str, cell: str) -> int | None:
    if WHOLE_NUMBER.fullmatch(cell):
        return int(cell)
    problems.note(place, row, f"{what} must be a whole number, not {shown(cell)}; correct it")
    return None


def _rows(
    problems: Problems, path: Path, columns: tuple[str, ...], required: tuple[str, ...]
) -> Iterator[tuple[int, list[str | None]]]:
    """The row number and cells of each row that is not empty.

    The cells are in the order of `columns`, with None for a column that the file does not have.
    """
    data = read_bytes(path, LARGEST_MESH_FILE)
    if problem := text_problem(data):
        raise InputError(f"{path.name}: a table {problem}")
    try:
        text = data.replace(b"\r\n", b"\n").replace(b"\r", b"\n").decode("utf-8")
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        raise InputError(
            f"{path.name}, row {line}: a table must be text in UTF-8; save it as UTF-8"
        ) from None
    reader = csv.reader(io.StringIO(text, newline=""), strict=True)
    order: list[int | None] | None = None
    row = 0
    try:
        for row, cells in enumerate(reader, start=1):
            cells = [cell.strip() for cell in cells]
            if order is None:
                order = _header(path.name, cells, columns, required)
                width = len(cells)
            elif any(cells):
                if len(cells) > width:
                    problems.note(
                        path.name, row, f"a row must have {width} cells, not {len(cells)}; correct it"
                    )
                cells.extend([""] * (width - len(cells)))
                yield row, [None if at is None else cells[at] for at in order]
    except csv.Error as error:
        raise InputError(f"{path.name}, row {row + 1}: it must be CSV ({error}); correct the row") from None
    if order is None:
        raise InputError(f"{path.name}: a table must start with a row of column names, not be empty")


def _header(
    place: str, cells: list[str], columns: tuple[str, ...], required: tuple[str, ...]
) -> list[int | None]:
    """The index of each column in the header; None for an optional column that is missing."""
    problems = [
        f"{place}, row 1: there is no column {shown(cell)}{nearest(cell[:60], columns)}"
        for cell in cells[:MOST_PROBLEMS]
        if cell not in columns
    ]
    problems += [
        f"{place}, row 1: a column name must be unique, not repeated: {column!r}; remove one"
        for column in columns
        if cells.count(column) > 1
    ]
    if not problems:
        problems = [
            f"{place}, row 1: there must be a column {column!r}, not only {', '.join(cells)}; add it"
            for column in required
            if column not in cells
        ]
    if problems:
        raise InputError(problems)
    return [cells.index(column) if column in cells else None for column in columns]


CSV_TABLES: Final = register(
    MeshFormat("CSV", read_csv_tables, keys=("nodes", "polygons"), in_folder=("nodes.csv", "polygons.csv"))
)
