"""A mesh as two tables in CSV: nodes.csv and polygons.csv.

    node,x,y,z,stress           polygon,part,node1,node2,node3,node4
    1,0.0,0.0,0.0,12.5          1,hood,1,2,3,4
    2,1.0,0.0,0.0,              2,roof,2,5,3,

The first row names the columns, which may be in any order. `text_table` says how cells may be written. Nodes
that no polygon uses stay.

In the node table `node` may be omitted; nodes are then numbered from 1. Node numbers are unique integers, in
any order and with gaps. In the polygon table `polygon` (unique integers) and `part` may be omitted. A
triangle leaves `node4` empty.

Further columns are scalars, of the nodes or of the polygons; an empty cell is a missing value. The column
"scalar x" is the scalar "x", for names that columns of the mesh have.
"""

from __future__ import annotations

import csv
import difflib
import io
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any, Final

import numpy as np

from autocolor.arrays import AnyArray, Numbers, chunks
from autocolor.checks import LARGEST_COORDINATE, nearest
from autocolor.errors import InputError
from autocolor.files.meshes.file_scalars import FileScalars
from autocolor.files.meshes.number_text import MOST_PROBLEMS, Problems
from autocolor.files.meshes.repair import (
    PLAIN,
    MeshReport,
    Placement,
    RawPolygons,
    printable_name,
    repaired,
)
from autocolor.files.reading import read_whole, shown
from autocolor.files.text_table import TextTable
from autocolor.files.writing import read_table, read_together, write_together
from autocolor.scene.mesh import Mesh
from autocolor.scene.scalar import MOST_SCALARS, NODE, POLYGON

ROWS_AT_ONCE: Final = 1 << 11
"""Measured: with more, the cells of a block fall out of the processor's cache."""

POINT: Final = re.compile(r"(?<=[0-9])\.0*$")
"""The point of a whole number, and zeros after it."""

LETTERS: Final = b"0123456789+-.eE ,"
"""The letters of numbers, and the comma between them."""

NOTHING: Final = -(1 << 63)
"""The whole number for an empty cell; numbers in cells have at most 18 digits."""

GROWTH: Final = 7
"""Measured: how many times its size a table of a million rows takes."""


@dataclass(frozen=True)
class NumberCells:
    """Decimal numbers of at most 1e30 in size, float64, or `whole` numbers of at most 18 digits, int64.

    An empty cell is NaN or NOTHING. `rule` is the beginning of the sentence for a wrong cell.
    """

    rule: str
    whole: bool = False
    may_be_empty: bool = False

    def numbers(self, cells: Sequence[str]) -> AnyArray:
        """The numbers of some cells. Raises ValueError or OverflowError if any might be wrong."""
        text = ",".join(cells)
        if text.encode("ascii").translate(None, LETTERS):
            raise ValueError
        if not self.whole:
            given = [cell or "nan" for cell in cells] if self.may_be_empty else cells
            numbers = np.fromiter(map(float, given), np.float64, len(cells))
            if (np.abs(numbers) > LARGEST_COORDINATE).any():
                raise ValueError
            return numbers
        if "." in text:
            # pandas writes the whole numbers of a column with missing values so.
            cells = [POINT.sub("", cell) for cell in cells]
        if max(map(len, cells)) > 18:
            raise ValueError
        if self.may_be_empty and "" in cells:
            return np.array([int(cell) if cell else NOTHING for cell in cells], np.int64)
        return np.fromiter(map(int, cells), np.int64, len(cells))


COORDINATES: Final = NumberCells("a coordinate must be a decimal number of at most 1e30 in size")
CORNERS: Final = NumberCells("a corner must be a whole number", whole=True)
FOURTH: Final = NumberCells(CORNERS.rule, whole=True, may_be_empty=True)
VALUES: Final = NumberCells(
    "a value must be a decimal number of at most 1e30 in size, or empty if it is missing", may_be_empty=True
)

NODE_COLUMNS: Final = {
    "node": NumberCells("a node number must be a whole number", whole=True),
    **dict.fromkeys("xyz", COORDINATES),
}
POLYGON_COLUMNS: Final = {
    "polygon": NumberCells("a polygon number must be a whole number", whole=True),
    "part": None,
    "node1": CORNERS,
    "node2": CORNERS,
    "node3": CORNERS,
    "node4": FOURTH,
}
OPTIONAL: Final = ("node", "polygon", "part")

SCALAR: Final = "scalar "
"""The prefix of a column for a scalar with the name of another column."""

CORNER: Final = re.compile(r"node[0-9]+")

ALIKE: Final = 0.8
"""Limit: an unknown column at least this similar to a missing column is a mistake, not a scalar."""


class Table:
    """The columns of one table by their names, and the numbers of its rows in the file.

    `kinds` says what the cells of a column are; None for names, whose rows in the list `names` the column
    has. Columns of other names are scalars. Raises InputError with the problems of the table.
    """

    def __init__(self, path: Path, data: bytes, kinds: Mapping[str, NumberCells | None]) -> None:
        text = TextTable(data, path.name)
        _check_header(text, kinds)
        self.place = text.place
        self.problems = Problems("row")
        self.names: dict[str, int] = {}
        self._empty_name = printable_name(path.stem)
        empty = np.empty(0, np.int64)
        numbers = [empty]
        columns: dict[str, list[AnyArray]] = {name: [] for name in text.header if name}
        for rows, block in text.blocks(ROWS_AT_ONCE):
            numbers.append(np.fromiter(rows, np.int64, len(rows)))
            for name, cells in zip(text.header, zip(*block, strict=True), strict=True):
                if name:
                    columns[name].append(self._converted(kinds.get(name, VALUES), cells, rows))
        self.problems.raise_any()
        self.numbers = np.concatenate(numbers)
        self.columns = {name: np.concatenate(blocks or [empty]) for name, blocks in columns.items()}
        self.scalars = {
            name.removeprefix(SCALAR): values for name, values in self.columns.items() if name not in kinds
        }

    def _converted(self, kind: NumberCells | None, cells: Sequence[str], rows: Sequence[int]) -> AnyArray:
        """The values of some cells of a column; problems are noted with their rows."""
        if kind is None:
            row_of = {cell: self.name_row(cell) for cell in dict.fromkeys(cells)}
            return np.fromiter(map(row_of.__getitem__, cells), np.int64, len(cells))
        try:
            return kind.numbers(cells)
        except (ValueError, OverflowError):
            pass
        values = []
        for row, cell in zip(rows, map(str.strip, cells), strict=True):
            try:
                values.append(kind.numbers([cell])[0])
            except (ValueError, OverflowError):
                self.note(row, f"{kind.rule}, not {shown(cell)}; correct it")
        return np.array(values, np.int64 if kind.whole else np.float64)

    def name_row(self, cell: str) -> int:
        """The row of a name; the name for an empty cell is the file's."""
        return self.names.setdefault(printable_name(cell) or self._empty_name, len(self.names))

    def note(self, row: int, sentence: str) -> None:
        """Note a problem of a row in the file."""
        self.problems.note(self.place, row, sentence)

    def numbered(self, what: str) -> tuple[Numbers, AnyArray]:
        """The numbers of the rows in ascending order, and their rows. Raises InputError for repeated ones."""
        numbers = self.columns.get(what, np.arange(1, len(self.numbers) + 1))
        in_order, order = np.unique(numbers, return_index=True)
        is_first = np.zeros(len(numbers), np.bool_)
        is_first[order] = True
        for row in np.flatnonzero(~is_first)[:MOST_PROBLEMS].tolist():
            sentence = f"a {what} number must be unique, not repeated: {numbers[row]}; renumber it"
            self.note(int(self.numbers[row]), sentence)
        self.problems.raise_any()
        return in_order, order


def read_csv_tables(nodes: Path, polygons: Path, placement: Placement = PLAIN) -> MeshReport:
    """The mesh of a node table and a polygon table, and what was repaired.

    Raises InputError with up to MOST_PROBLEMS problems of a table, each with its file and row.
    """

    def tables() -> list[bytes]:
        read = partial(read_whole, growth=GROWTH)
        return [read_table(path.parent, path.name, read) for path in (nodes, polygons)]

    node_data, polygon_data = read_together(polygons.parent, polygons.name, tables)
    node_table = Table(nodes, node_data, NODE_COLUMNS)
    if not len(node_table.numbers):
        raise InputError(f"{node_table.place}: a node table must have a node, not none; add rows")
    numbers, row_of = node_table.numbered("node")

    table = Table(polygons, polygon_data, POLYGON_COLUMNS)
    table.numbered("polygon")
    corners = np.stack([table.columns[f"node{number}"] for number in (1, 2, 3, 4)], axis=1)
    is_corner = corners != NOTHING
    at = np.minimum(np.searchsorted(numbers, corners), len(numbers) - 1)
    for row, column in np.argwhere((numbers[at] != corners) & is_corner)[:MOST_PROBLEMS].tolist():
        rule = f"a corner must be in the node table, {numbers[0]} to {numbers[-1]}"
        table.note(int(table.numbers[row]), f"{rule}, not {corners[row, column]}; correct it")
    table.problems.raise_any()
    parts = table.columns.get("part")
    if parts is None:
        parts = np.full(len(corners), table.name_row(""))

    scalars = FileScalars()
    for of, each in ((NODE, node_table), (POLYGON, table)):
        for name, values in each.scalars.items():
            scalars.add(name, values, of)
    mesh = RawPolygons(
        np.stack([node_table.columns[axis] for axis in "xyz"], axis=1),
        row_of[at[is_corner]],
        is_corner.sum(axis=1),
        parts.astype(np.intp),
        tuple(table.names),
        scalars.scalars,
        lambda row: f"row {table.numbers[row]}",
    )
    return repaired(mesh, polygons.name, placement, unused_nodes=True)


def _check_header(table: TextTable, kinds: Iterable[str]) -> None:
    """Raise InputError if a column is missing or seems misspelled, or for too many scalars."""
    columns = tuple(kinds)
    names = [name for name in table.header if name]
    missing = [column for column in columns if column not in names]
    for name in names:
        near = difflib.get_close_matches(name[:60].casefold(), missing, n=1, cutoff=ALIKE)
        if name not in columns and (near or ("node1" in columns and CORNER.fullmatch(name))):
            rule = f"there is no column {shown(name)} ({table.understood}){nearest(name[:60], columns)}"
            raise table.wrong(rule)
    for column in missing:
        if column not in OPTIONAL:
            others = ", ".join(names[:MOST_PROBLEMS])
            raise table.wrong(
                f"there must be a column {column!r}, not only {others} ({table.understood}); add it"
            )
    if len(names) - len(columns) > MOST_SCALARS:
        raise table.wrong(
            f"there must be at most {MOST_SCALARS:,} columns of scalars, not {len(names):,}; remove some"
        )


ROWS_IN_TEXT: Final = 1 << 16
"""Rows that become text at once, so that there are few Python values at a time."""


def csv_tables_bytes(mesh: Mesh) -> tuple[bytes, bytes]:
    """The node table and the polygon table of a mesh with its scalars, in UTF-8.

    Numbers have all digits of double precision. Reading them back gives the same mesh unless the reader
    repairs it: a polygon without area is dropped, parts are those of polygons and in their order, and names
    are printable, at most 200 letters, with no spaces around them.
    """
    corners = mesh.node_numbers.T + 1
    fourth = np.where(corners[2] == corners[3], NOTHING, corners[3])
    names = np.array(mesh.part_names, object)[mesh.part_numbers]
    nodes, polygons = (np.arange(1, len(each) + 1) for each in (mesh.coordinates, names))
    return (
        _table_bytes(mesh, NODE, NODE_COLUMNS, (nodes, *mesh.coordinates.T)),
        _table_bytes(mesh, POLYGON, POLYGON_COLUMNS, (polygons, names, *corners[:3], fourth)),
    )


def _table_bytes(mesh: Mesh, of: str, names: Iterable[str], columns: Iterable[AnyArray]) -> bytes:
    """A table of columns, and the scalars `of` its rows.

    A scalar has a prefix if its name might be taken for a column; a missing value is an empty cell.
    """
    table = dict(zip(names, columns, strict=True))
    for scalar in [each for each in mesh.scalars if each.of == of]:
        name = scalar.name
        needs_prefix = name.casefold() in names or CORNER.fullmatch(name) or name.startswith(SCALAR)
        table[f"{SCALAR if needs_prefix else ''}{name}"] = scalar.values
    text = io.StringIO(newline="")
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(table)
    for rows in chunks(len(table[of]), ROWS_IN_TEXT):
        writer.writerows(zip(*(_cells(values[rows]) for values in table.values()), strict=True))
    return text.getvalue().encode("utf-8", "replace")


def _cells(values: AnyArray) -> list[Any]:
    """Some values of a column as cells."""
    cells = values.astype(object)
    cells[values == NOTHING if values.dtype == np.int64 else values != values] = ""
    return list(cells)


CSV_FILES: Final = ("nodes.csv", "polygons.csv")
"""The files of a folder that is a mesh in CSV."""


def write_csv_tables(folder: Path, mesh: Mesh, *, overwrite: bool = False) -> list[Path]:
    """Write the tables of a mesh to a folder, and return their paths. Raises OutputError and WriteError."""
    tables = zip(CSV_FILES, csv_tables_bytes(mesh), strict=True)
    return write_together(folder, ((name, [data]) for name, data in tables), others=(), overwrite=overwrite)
