"""A mesh as two tables in CSV: nodes.csv and polygons.csv.

    node,x,y,z,stress           polygon,part,node1,node2,node3,node4
    1,0.0,0.0,0.0,12.5          1,hood,1,2,3,4
    2,1.0,0.0,0.0,              2,roof,2,5,3,

The first row names the columns, which may be in any order. `text_table` says how cells may be written. Nodes
that no polygon uses stay.

In the node table `node` may be omitted; nodes are then numbered from 1. Node numbers are unique integers, in
any order and with gaps. In the polygon table `polygon` (integers) and `part` may be omitted. A
triangle leaves `node4` empty.

Further columns are scalars, of the nodes or of the polygons; an empty cell is a missing value. The column
"scalar x" is the scalar "x", for names that columns of the mesh have.
"""

from __future__ import annotations

import csv
import difflib
import io
import math
import re
from collections.abc import Iterable, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Final, NamedTuple

import numpy as np

from autocolor.arrays import AnyArray, Floats, chunks
from autocolor.checks import LARGEST_COORDINATE, nearest
from autocolor.errors import InputError
from autocolor.files.meshes.file_scalars import FileScalars
from autocolor.files.meshes.number_text import COORDINATE, decimal
from autocolor.files.meshes.repair import (
    PLAIN,
    MeshReport,
    Placement,
    RawPolygons,
    printable_name,
    repaired,
)
from autocolor.files.reading import read_whole, shown
from autocolor.files.text_table import MOST_EXACT, TextTable
from autocolor.files.writing import read_table, read_together, write_together
from autocolor.scene.mesh import Mesh
from autocolor.scene.scalar import NODE, POLYGON

ROWS_AT_ONCE: Final = 1 << 11
"""Measured: with more, the cells of a block fall out of the processor's cache."""

LETTERS: Final = b"0123456789+-.eE ,"
"""The letters of numbers, and the comma between them."""

GROWTH: Final = 7
"""Measured: how many times its size a table of a million rows takes."""


class ColumnCells(NamedTuple):
    """What the cells of a column must be, as the beginning of a sentence; an empty cell is NaN."""

    rule: str
    whole: bool = False
    may_be_empty: bool = False


CORNER: Final = ColumnCells("a corner must be a whole number", whole=True)
FOURTH: Final = CORNER._replace(may_be_empty=True)
VALUE: Final = ColumnCells(
    "a value must be a decimal number of at most 1e30 in size, or empty if it is missing", may_be_empty=True
)
NODE_COLUMNS: Final = {
    "node": ColumnCells("a node number must be a whole number", whole=True),
    **dict.fromkeys("xyz", ColumnCells(COORDINATE)),
}
POLYGON_COLUMNS: Final = {
    "polygon": ColumnCells("a polygon number must be a whole number", whole=True),
    "part": None,
    **dict.fromkeys(("node1", "node2", "node3"), CORNER),
    "node4": FOURTH,
}
OPTIONAL: Final = ("node", "polygon", "part")

SCALAR: Final = "scalar "
"""The prefix of a column for a scalar with the name of another column."""

MORE_CORNERS: Final = re.compile(r"node[0-9]+")

ALIKE: Final = 0.8
"""Limit: an unknown column at least this similar to a missing column is a mistake, not a scalar."""


class Table:
    """The columns of one table by their names, and the numbers of its rows in the file.

    `kinds` says what the cells of a column are; None for names, whose rows in the list `names` the column
    has. Columns of other names are scalars. Raises InputError with the first problem of a block of rows.
    """

    def __init__(self, path: Path, data: bytes, kinds: Mapping[str, ColumnCells | None]) -> None:
        self.text = TextTable(data, path.name)
        _check_header(self.text, kinds)
        self.names: dict[str, int] = {}
        self.empty_name = printable_name(path.stem)
        numbers = [np.empty(0, np.int64)]
        columns: dict[str, list[Floats]] = {name: [np.empty(0)] for name in self.text.header if name}
        for rows, block in self.text.blocks(ROWS_AT_ONCE):
            numbers.append(np.fromiter(rows, np.int64, len(rows)))
            for name, cells in zip(self.text.header, zip(*block, strict=True), strict=True):
                if name:
                    columns[name].append(self._converted(kinds.get(name, VALUE), cells, rows))
        self.numbers = np.concatenate(numbers)
        self.columns = {name: np.concatenate(blocks) for name, blocks in columns.items()}
        self.scalars = {
            name.removeprefix(SCALAR): values for name, values in self.columns.items() if name not in kinds
        }

    def _converted(self, kind: ColumnCells | None, cells: Sequence[str], rows: Sequence[int]) -> Floats:
        """The values of some cells of a column, as float64, which has all whole numbers below 2^53."""
        if kind is None:
            names = {cell: printable_name(cell) or self.empty_name for cell in dict.fromkeys(cells)}
            row_of = {cell: self.names.setdefault(name, len(self.names)) for cell, name in names.items()}
            return np.fromiter(map(row_of.__getitem__, cells), np.float64, len(cells))
        try:
            if ",".join(cells).encode("ascii").translate(None, LETTERS):
                raise ValueError
            given = [cell or "nan" for cell in cells] if "" in cells else cells
            values = np.fromiter(map(float, given), np.float64, len(cells))
        except ValueError:
            numbers = []
            for word in map(str.strip, cells):
                number = decimal(word.encode()) if word else math.nan
                # Unlike a missing number, a wrong one is infinite.
                numbers.append(math.inf if word and math.isnan(number) else number)
            values = np.array(numbers)
        is_wrong = np.abs(values) > (MOST_EXACT - 1 if kind.whole else LARGEST_COORDINATE)
        if kind.whole:
            is_wrong |= np.floor(values) != values
        is_missing = np.isnan(values)
        is_wrong = is_wrong & ~is_missing if kind.may_be_empty else is_wrong | is_missing
        if is_wrong.any():
            at = int(is_wrong.argmax())
            raise self.text.wrong(f"{kind.rule}, not {shown(cells[at])}; correct it", rows[at])
        return values


def read_csv_tables(nodes: Path, polygons: Path, placement: Placement = PLAIN) -> MeshReport:
    """The mesh of a node table and a polygon table, and what was repaired.

    Raises InputError with the first problem of a table, with its file and row.
    """

    def tables() -> list[bytes]:
        read = partial(read_whole, growth=GROWTH)
        return [read_table(path.parent, path.name, read) for path in (nodes, polygons)]

    node_data, polygon_data = read_together(polygons.parent, polygons.name, tables)
    node_table = Table(nodes, node_data, NODE_COLUMNS)
    if not len(node_table.numbers):
        raise InputError(f"{node_table.text.place}: a node table must have a node, not none; add rows")
    given = node_table.columns.get("node", np.arange(1.0, len(node_table.numbers) + 1))
    row_of = np.argsort(given, kind="stable")
    numbers = given[row_of]
    is_repeated = numbers[1:] == numbers[:-1]
    if is_repeated.any():
        row = int(row_of[1:][is_repeated][0])
        sentence = f"a node number must be unique, not repeated: {given[row]:.0f}; renumber it"
        raise node_table.text.wrong(sentence, int(node_table.numbers[row]))

    table = Table(polygons, polygon_data, POLYGON_COLUMNS)
    corners = np.stack([table.columns[f"node{number}"] for number in (1, 2, 3, 4)], axis=1)
    is_corner = ~np.isnan(corners)
    at = np.minimum(np.searchsorted(numbers, corners), len(numbers) - 1)
    is_wrong = (numbers[at] != corners) & is_corner
    if is_wrong.any():
        row = int(is_wrong.any(axis=1).argmax())
        raise table.text.wrong(
            f"a corner must be in the node table, {numbers[0]:.0f} to {numbers[-1]:.0f}, not"
            f" {corners[row][is_wrong[row]][0]:.0f}; correct it",
            int(table.numbers[row]),
        )
    parts = table.columns.get("part", np.zeros(len(corners)))
    scalars = FileScalars()
    for of, each in ((NODE, node_table), (POLYGON, table)):
        for name, values in each.scalars.items():
            scalars.add(name, values, of)
    mesh = RawPolygons(
        np.stack([node_table.columns[axis] for axis in "xyz"], axis=1),
        row_of[at[is_corner]],
        is_corner.sum(axis=1),
        parts.astype(np.intp),
        tuple(table.names) or (table.empty_name,),
        scalars.scalars,
    )
    return repaired(mesh, polygons.name, placement, skipped=scalars.messages, unused_nodes=True)


def _check_header(table: TextTable, kinds: Iterable[str]) -> None:
    """Raise InputError if a column is missing or seems misspelled."""
    columns = tuple(kinds)
    missing = [column for column in columns if column not in table.header]
    for name in filter(None, table.header):
        if name not in columns:
            near = difflib.get_close_matches(name[:60].casefold(), missing, n=1, cutoff=ALIKE)
            if near or ("node1" in columns and MORE_CORNERS.fullmatch(name)):
                rule = f"there is no column {shown(name)} ({table.understood}){nearest(name[:60], columns)}"
                raise table.wrong(rule)
    for column in missing:
        if column not in OPTIONAL:
            others = ", ".join(filter(None, table.header[:20]))
            rule = f"there must be a column {column!r}, not only {others} ({table.understood}); add it"
            raise table.wrong(rule)


ROWS_IN_TEXT: Final = 1 << 16
"""Rows that become text at once, so that there are few Python values at a time."""

CSV_FILES: Final = ("nodes.csv", "polygons.csv")
"""The files of a folder that is a mesh in CSV."""


def write_csv_tables(folder: Path, mesh: Mesh, *, overwrite: bool = False) -> list[Path]:
    """Write a mesh with its scalars to a folder, as the two CSV_FILES in UTF-8, and return their paths.

    Numbers have all digits of double precision. Reading them back gives the same mesh unless the reader
    repairs it: a polygon without area is dropped, parts are those of polygons and in their order, and names
    are printable, at most 200 letters, with no spaces around them. Raises OutputError and WriteError.
    """
    corners = mesh.node_numbers.T + 1
    fourth = np.where(corners[2] == corners[3], 0, corners[3])
    names = np.array(mesh.part_names, object)[mesh.part_numbers]
    nodes, polygons = (np.arange(1, len(each) + 1) for each in (mesh.coordinates, names))
    tables = (
        _table_bytes(mesh, NODE, NODE_COLUMNS, (nodes, *mesh.coordinates.T)),
        _table_bytes(mesh, POLYGON, POLYGON_COLUMNS, (polygons, names, *corners[:3], fourth)),
    )
    return write_together(folder, zip(CSV_FILES, tables, strict=True), others=(), overwrite=overwrite)


def _table_bytes(mesh: Mesh, of: str, names: Iterable[str], columns: Iterable[AnyArray]) -> bytes:
    """A table of columns, and the scalars `of` its rows.

    A scalar has a prefix if its name might be taken for a column. NaN, and 0 for a node, is an empty cell.
    """
    table = dict(zip(names, columns, strict=True))
    for scalar in [each for each in mesh.scalars if each.of == of]:
        name = scalar.name
        needs_prefix = name.casefold() in names or MORE_CORNERS.fullmatch(name) or name.startswith(SCALAR)
        table[f"{SCALAR if needs_prefix else ''}{name}"] = scalar.values
    text = io.StringIO(newline="")
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(table)
    for rows in chunks(len(table[of]), ROWS_IN_TEXT):
        cells = [values[rows].astype(object) for values in table.values()]
        for column, values in zip(cells, table.values(), strict=True):
            column[values[rows] == 0 if values.dtype == np.int64 else values[rows] != values[rows]] = ""
        writer.writerows(zip(*cells, strict=True))
    return text.getvalue().encode("utf-8", "replace")
