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
import math
import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any, Final

import numpy as np

from autocolor.arrays import AnyArray, Floats, Indices, Numbers, chunks
from autocolor.checks import LARGEST_COORDINATE, nearest, printable
from autocolor.errors import InputError
from autocolor.files.meshes.file_scalars import FileScalars
from autocolor.files.meshes.number_text import MOST_PROBLEMS, NUMBER, Problems
from autocolor.files.meshes.repair import LONGEST_NAME, PLAIN, MeshReport, Placement, RawPolygons, repaired
from autocolor.files.reading import read_whole, shown
from autocolor.files.text_table import TextTable
from autocolor.files.writing import read_table, read_together, write_together
from autocolor.scene.mesh import Mesh
from autocolor.scene.scalar import MOST_SCALARS, NODE, POLYGON

ROWS_AT_ONCE: Final = 1 << 14
"""Measured: with more, the cells of a block fall out of the processor's cache."""

WHOLE_NUMBER: Final = re.compile(r"[+-]?[0-9]{1,18}(?:\.0*)?")

LETTERS: Final = b"0123456789+-.eE ,"
"""The letters of numbers, and the comma between them."""

NOTHING: Final = -(1 << 63)
"""The whole number for an empty or wrong cell; numbers in cells have at most 18 digits."""

GROWTH: Final = 7
"""Measured: how many times its size a table of a million rows takes."""


@dataclass(frozen=True)
class NumberCells:
    """Decimal numbers of at most 1e30 in size, float64, or `whole` numbers of at most 18 digits, int64.

    An empty or wrong cell is NaN or 0, or NOTHING. `rule` is the beginning of the sentence for a wrong one.
    """

    rule: str
    whole: bool = False
    may_be_empty: bool = False

    def at_once(self, cells: Sequence[str]) -> Floats | Numbers:
        """The numbers of many cells. Raises ValueError if any might be wrong."""
        text = ",".join(cells)
        if text.encode("ascii").translate(None, LETTERS):
            raise ValueError
        if not self.whole:
            numbers = np.fromiter(
                map(float, [cell or "nan" for cell in cells] if self.may_be_empty else cells),
                np.float64,
                len(cells),
            )
            if (np.abs(numbers) > LARGEST_COORDINATE).any():
                raise ValueError
            return numbers
        if "." in text:
            # pandas writes the whole numbers of a column with missing values so.
            cells = [cell.removesuffix(".0") for cell in cells]
        if max(map(len, cells)) > 18:
            raise ValueError
        if self.may_be_empty and "" in cells:
            return np.array([int(cell) if cell else NOTHING for cell in cells], np.int64)
        return np.fromiter(map(int, cells), np.int64, len(cells))

    def one(self, cell: str, note: Callable[[str], None]) -> float | int:
        """The number of a cell without spaces around it. Notes a problem."""
        if not cell and self.may_be_empty:
            return NOTHING if self.whole else math.nan
        if self.whole and WHOLE_NUMBER.fullmatch(cell):
            return int(cell.partition(".")[0])
        if not self.whole and NUMBER.fullmatch(cell.encode()) and abs(float(cell)) <= LARGEST_COORDINATE:
            return float(cell)
        note(f"{self.rule}, not {shown(cell)}; correct it")
        return NOTHING if self.whole else 0.0


class NameCells:
    """Names, as their rows in the list of all names, `rows`; an empty cell has the name `empty`."""

    whole = True

    def __init__(self, empty: str) -> None:
        self.empty = empty
        self.rows: dict[str, int] = {}
        self._of_cell: dict[str, int] = {}

    def at_once(self, cells: Sequence[str]) -> Numbers:
        """The rows of the names, int64."""
        for cell in dict.fromkeys(cells):
            if cell not in self._of_cell:
                self._of_cell[cell] = self.one(cell.strip())
        return np.fromiter(map(self._of_cell.__getitem__, cells), np.int64, len(cells))

    def one(self, cell: str, note: Callable[[str], None] | None = None) -> int:
        """The row of the name, which is made printable and cut to LONGEST_NAME letters."""
        name = printable((cell or self.empty)[:LONGEST_NAME])
        return self.rows.setdefault(name, len(self.rows))


CellKind = NumberCells | NameCells


def _block(
    table: TextTable, problems: Problems, block: list[list[str]], columns: Sequence[CellKind]
) -> tuple[list[AnyArray], Numbers]:
    """The values of each column in the last rows of a table, and the numbers of these rows in the file.

    Empty rows are skipped, and shorter ones filled with empty cells. The columns are converted at once; where
    this is not possible, cell by cell, so that every problem is noted with its row.
    """
    first = table.row + 1 - len(block)
    if block and all(len(cells) == len(columns) for cells in block):
        try:
            at_once = [
                _nameless(cells, column) if not name else kind.at_once(table.with_points(cells))
                for column, (name, kind, cells) in enumerate(
                    zip(table.header, columns, zip(*block, strict=True), strict=True)
                )
            ]
        except (ValueError, OverflowError):
            pass
        else:
            return at_once, np.arange(first, first + len(block))
    values: list[list[float | int]] = [[] for _ in columns]
    numbers = []
    for row, raw in enumerate(block, start=first):
        cells = [table.plain(cell) for cell in raw]
        if not any(cells):
            continue

        def note(sentence: str, row: int = row) -> None:
            problems.note(table.place, row, sentence)

        if problem := table.problem_of(cells):
            note(problem)
        cells.extend([""] * (len(columns) - len(cells)))
        numbers.append(row)
        for name, column, kind, cell in zip(table.header, values, columns, cells, strict=False):
            column.append(kind.one(cell, note) if name else 0)
    types = [np.int64 if kind.whole else np.float64 for kind in columns]
    arrays: list[AnyArray] = [np.array(each, of) for each, of in zip(values, types, strict=True)]
    return arrays, np.array(numbers, np.int64)


def _nameless(cells: Sequence[str], column: int) -> AnyArray:
    """Numbers that nobody needs, for a column without a name. Raises ValueError if a cell might be wrong."""
    if column and any(cells):
        raise ValueError
    return WHOLE.at_once(cells)


NODE_COLUMNS: Final = ("node", "x", "y", "z")
CORNERS: Final = ("node1", "node2", "node3", "node4")
POLYGON_COLUMNS: Final = ("polygon", "part", *CORNERS)

SCALAR: Final = "scalar "
"""The prefix of a column for a scalar with the name of another column."""

CORNER: Final = re.compile(r"node[0-9]+")

ALIKE: Final = 0.8
"""Limit: an unknown column at least this similar to a missing column is a mistake, not a scalar."""

COORDINATES: Final = NumberCells("a coordinate must be a decimal number of at most 1e30 in size")
WHOLE: Final = NumberCells("a number must be a whole number", whole=True, may_be_empty=True)
VALUES: Final = NumberCells(
    "a value must be a decimal number of at most 1e30 in size, or empty if it is missing", may_be_empty=True
)


class Table:
    """The columns of one table by their names, and the numbers of its rows in the file."""

    def __init__(
        self,
        problems: Problems,
        name: str,
        data: bytes,
        columns: Mapping[str, CellKind],
        required: tuple[str, ...],
    ) -> None:
        text = TextTable(data, name)
        self.problems = problems
        self.place = text.place
        _check_header(text, tuple(columns), required)
        kinds = [columns.get(name, VALUES) for name in text.header]
        blocks = [_block(text, problems, text.rows(ROWS_AT_ONCE), kinds)]
        while rows := text.rows(ROWS_AT_ONCE):
            blocks.append(_block(text, problems, rows, kinds))
        self.numbers = np.concatenate([numbers for _, numbers in blocks])
        in_columns = zip(*(values for values, _ in blocks), strict=True)
        self.columns: dict[str, AnyArray] = dict(
            zip(text.header, map(np.concatenate, in_columns), strict=True)
        )
        self.columns.pop("", None)
        self.scalars = {
            name.removeprefix(SCALAR): values for name, values in self.columns.items() if name not in columns
        }

    def note(self, row: int, sentence: str) -> None:
        """Note a problem of a row, counted from 0 among those of the table."""
        self.problems.note(self.place, int(self.numbers[row]), sentence)

    def note_repeated(self, what: str, numbers: Numbers) -> None:
        """Note the numbers that an earlier row has. NOTHING may repeat."""
        for row in _repeated(numbers)[:MOST_PROBLEMS].tolist():
            self.note(row, f"a {what} number must be unique, not repeated: {numbers[row]}; renumber it")


def read_csv_tables(nodes: Path, polygons: Path, placement: Placement = PLAIN) -> MeshReport:
    """The mesh of a node table and a polygon table, and what was repaired.

    Raises InputError with every problem of both tables, each with its file and row.
    """

    def tables() -> list[bytes]:
        read = partial(read_whole, growth=GROWTH)
        return [read_table(path.parent, path.name, read) for path in (nodes, polygons)]

    node_data, polygon_data = read_together(polygons.parent, polygons.name, tables)
    problems = Problems("row")
    node_table = Table(
        problems,
        nodes.name,
        node_data,
        {
            "node": NumberCells("a node number must be a whole number", whole=True),
            **dict.fromkeys("xyz", COORDINATES),
        },
        ("x", "y", "z"),
    )
    coordinates = np.stack([node_table.columns[axis] for axis in "xyz"], axis=1)
    numbers = node_table.columns.get("node", np.arange(1, len(coordinates) + 1))
    node_table.note_repeated("node", numbers)

    names = NameCells(polygons.stem)
    corner = NumberCells("a corner must be a whole number", whole=True)
    polygon_table = Table(
        problems,
        polygons.name,
        polygon_data,
        {
            "polygon": NumberCells("a polygon number must be a whole number", whole=True),
            "part": names,
            **dict.fromkeys(CORNERS, corner),
            CORNERS[-1]: replace(corner, may_be_empty=True),
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
    scalars = FileScalars()
    for of, table in ((NODE, node_table), (POLYGON, polygon_table)):
        for name, values in table.scalars.items():
            scalars.add(name, values, of)
    mesh = RawPolygons(
        coordinates,
        rows[is_corner],
        is_corner.sum(axis=1),
        parts.astype(np.intp),
        tuple(names.rows),
        scalars.scalars,
        lambda row: f"row {polygon_table.numbers[row]}",
    )
    return repaired(mesh, polygons.name, placement, unused_nodes=True)


def _repeated(numbers: Numbers) -> Indices:
    """The rows whose number an earlier row has, in order. NOTHING may repeat."""
    if (np.diff(numbers) > 0).all():
        return np.empty(0, np.intp)
    order = np.argsort(numbers, kind="stable")
    in_order = numbers[order]
    again = order[1:][(np.diff(in_order) == 0) & (in_order[1:] != NOTHING)]
    return np.sort(again)


def _rows_of(table: Table, corners: Numbers, numbers: Numbers) -> Indices:
    """The row of the node with each number, 0 for NOTHING. Numbers without a node are noted."""
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
        table.note(row, f"node {corners[row, column]} is not in the node table ({_range_of(numbers)})")
    return rows


def _range_of(numbers: Numbers) -> str:
    """The range of the node numbers, for a message; it says if there are gaps."""
    different_numbers = np.unique(numbers[numbers != NOTHING])
    if not len(different_numbers):
        return "it is empty"
    gaps = "" if different_numbers[-1] - different_numbers[0] + 1 == len(different_numbers) else ", with gaps"
    return f"{different_numbers[0]} to {different_numbers[-1]}{gaps}"


def _check_header(table: TextTable, columns: tuple[str, ...], required: tuple[str, ...]) -> None:
    """Raise InputError if a required column is missing, or a column seems misspelled."""
    names = [name for name in table.header if name]
    missing = [column for column in columns if column not in names]
    lacks_required = any(column in missing for column in required)
    rules = [
        f"there is no column {shown(name)} ({table.understood}){nearest(name[:60], columns)}"
        for name in names
        if name not in columns and (lacks_required or _is_mistake(name, columns, missing))
    ][:MOST_PROBLEMS]
    rules = rules or [
        f"there must be a column {column!r}, not only {', '.join(names)} ({table.understood}); add it"
        for column in required
        if column in missing
    ]
    if not rules and len(names) - len(columns) > MOST_SCALARS:
        rules = [
            f"there must be at most {MOST_SCALARS:,} columns of scalars, not {len(names):,}; remove some"
        ]
    if rules:
        raise InputError(f"{table.place}, row {table.row}: {rule}" for rule in rules)


def _is_mistake(cell: str, columns: tuple[str, ...], missing: list[str]) -> bool:
    """Whether an unknown column is a mistake, not a scalar: it is a corner, or nearly a column."""
    is_corner = "node1" in columns and CORNER.fullmatch(cell) is not None
    near = difflib.get_close_matches(cell[:60], missing, n=1, cutoff=ALIKE)
    return is_corner or cell.casefold() in columns or bool(near)


ROWS_IN_TEXT: Final = 1 << 16
"""Rows that become text at once, so that there are few Python values at a time."""


def csv_tables_bytes(mesh: Mesh) -> tuple[bytes, bytes]:
    """The node table and the polygon table of a mesh with its scalars, in UTF-8.

    Numbers have all digits of double precision. Reading them back gives the same mesh unless the reader
    repairs it: a polygon without area is dropped, parts are those of polygons and in their order, and names
    are printable, at most 200 letters, with no spaces around them.
    """
    names = np.array(mesh.part_names, object)

    def nodes(rows: slice) -> Iterator[list[Any]]:
        yield from mesh.coordinates[rows].T.tolist()

    def polygons(rows: slice) -> Iterator[list[Any]]:
        corners = mesh.node_numbers[rows] + 1
        yield names[mesh.part_numbers[rows]].tolist()
        yield from corners[:, :3].T.tolist()
        yield np.where(corners[:, 2] == corners[:, 3], "", corners[:, 3].astype(object)).tolist()

    return (
        _table_bytes(mesh, NODE_COLUMNS, NODE, len(mesh.coordinates), nodes),
        _table_bytes(mesh, POLYGON_COLUMNS, POLYGON, len(mesh.node_numbers), polygons),
    )


def _table_bytes(
    mesh: Mesh, columns: tuple[str, ...], of: str, count: int, cells: Callable[[slice], Iterable[list[Any]]]
) -> bytes:
    """A table with numbered rows, the cells of further columns, and scalars.

    A scalar named like a column of the mesh has a prefix; a missing value is an empty cell.
    """
    scalars = [each for each in mesh.scalars if each.of == of]
    text = io.StringIO(newline="")
    writer = csv.writer(text, lineterminator="\n")
    needs_prefix = [
        each.name.casefold() in columns or CORNER.fullmatch(each.name) or each.name.startswith(SCALAR)
        for each in scalars
    ]
    headings = [
        f"{SCALAR * bool(prefix)}{each.name}" for each, prefix in zip(scalars, needs_prefix, strict=True)
    ]
    writer.writerow([*columns, *headings])
    for rows in chunks(count, ROWS_IN_TEXT):
        values = [each.values[rows].astype(object) for each in scalars]
        for each in values:
            each[each != each] = ""
        writer.writerows(zip(range(rows.start + 1, rows.stop + 1), *cells(rows), *values, strict=True))
    return text.getvalue().encode("utf-8", "replace")


CSV_FILES: Final = ("nodes.csv", "polygons.csv")
"""The files of a folder that is a mesh in CSV."""


def write_csv_tables(folder: Path, mesh: Mesh, *, overwrite: bool = False) -> list[Path]:
    """Write the tables of a mesh to a folder, and return their paths. Raises OutputError and WriteError."""
    tables = zip(CSV_FILES, csv_tables_bytes(mesh), strict=True)
    return write_together(folder, ((name, [data]) for name, data in tables), others=(), overwrite=overwrite)
