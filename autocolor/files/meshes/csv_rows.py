"""The rows of a table in CSV, in blocks whose columns are converted at once.

A block in which a column cannot be converted at once is gone through cell by cell, so that every problem is
told with its row. Rows are counted from 1, the header, as in a spreadsheet.
"""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import islice
from pathlib import Path
from typing import Final, Protocol

import numpy as np

from autocolor.arrays import AnyArray, Floats, Numbers
from autocolor.checks import LARGEST_COORDINATE, printable
from autocolor.errors import InputError
from autocolor.files.reading import LARGEST_MESH_FILE, read_bytes, shown, text_problem
from autocolor.files.repair.names import LONGEST_NAME

MOST_PROBLEMS: Final = 20

ROWS_AT_ONCE: Final = 1 << 14
"""Measured: with more, the cells of a block fall out of the processor's cache."""

NUMBER: Final = re.compile(r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?")
WHOLE_NUMBER: Final = re.compile(r"[+-]?[0-9]{1,18}")

LONGEST_WHOLE: Final = 19

IN_NUMBERS: Final = b"0123456789+-.eE ,"
IN_WHOLES: Final = b"0123456789+- ,"

NOTHING: Final = -(1 << 63)
"""What stands for an empty or a wrong cell among whole numbers, which have at most 18 digits."""


class Problems:
    """Collects the problems of several tables, up to MOST_PROBLEMS, in the order of their rows."""

    def __init__(self) -> None:
        self._found: list[tuple[int, int, str]] = []
        self._places: list[str] = []

    def note(self, place: str, row: int, sentence: str) -> None:
        """Add a problem; raise InputError once there are MOST_PROBLEMS."""
        if place not in self._places:
            self._places.append(place)
        self._found.append((self._places.index(place), row, f"{place}, row {row}: {sentence}"))
        if len(self._found) >= MOST_PROBLEMS:
            self.raise_any()

    def raise_any(self) -> None:
        """Raise InputError with the problems found so far, if any."""
        if self._found:
            in_order = sorted(self._found, key=lambda each: each[:2])
            raise InputError([sentence for _, _, sentence in in_order])


class Cells(Protocol):
    """How the cells of one column are converted."""

    def at_once(self, cells: Sequence[str]) -> AnyArray:
        """The values of many cells. Raises ValueError if any might be wrong."""

    def one(self, cell: str, note: Callable[[str], None]) -> float | int:
        """The value of one cell, without spaces around; a problem is noted."""


@dataclass(frozen=True)
class NumberCells:
    """Decimal numbers of at most 1e30 in size; an empty cell is NaN where that is allowed."""

    rule: str
    may_be_empty: bool = False

    def at_once(self, cells: Sequence[str]) -> Floats:
        """The numbers, float64. Raises ValueError if any might be wrong."""
        _require_letters(cells, IN_NUMBERS)
        if self.may_be_empty:
            cells = [cell or "nan" for cell in cells]
        numbers = np.fromiter(map(float, cells), np.float64, len(cells))
        if (np.abs(numbers) > LARGEST_COORDINATE).any():
            raise ValueError
        return numbers

    def one(self, cell: str, note: Callable[[str], None]) -> float:
        """The number, 0 if it is wrong."""
        if not cell and self.may_be_empty:
            return np.nan
        number = float(cell) if NUMBER.fullmatch(cell) else np.inf
        if abs(number) <= LARGEST_COORDINATE:
            return number
        note(f"{self.rule}, not {shown(cell)}; correct it")
        return 0.0


@dataclass(frozen=True)
class WholeCells:
    """Whole numbers of at most 18 digits; NOTHING for a wrong one, and for an empty one if allowed."""

    what: str
    may_be_empty: bool = False

    def at_once(self, cells: Sequence[str]) -> Numbers:
        """The numbers, int64. Raises ValueError if any might be wrong."""
        _require_letters(cells, IN_WHOLES)
        if max(map(len, cells)) > LONGEST_WHOLE:
            raise ValueError
        if self.may_be_empty and "" in cells:
            return np.array([int(cell) if cell else NOTHING for cell in cells], np.int64)
        return np.fromiter(map(int, cells), np.int64, len(cells))

    def one(self, cell: str, note: Callable[[str], None]) -> int:
        """The number, NOTHING if it is wrong."""
        if WHOLE_NUMBER.fullmatch(cell):
            return int(cell)
        if cell or not self.may_be_empty:
            note(f"{self.what} must be a whole number, not {shown(cell)}; correct it")
        return NOTHING


class NameCells:
    """Names, each converted to its row in the list of all names, `rows`; an empty one is `empty`."""

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


def _require_letters(cells: Sequence[str], letters: bytes) -> None:
    """Raise ValueError if cells have other letters."""
    if ",".join(cells).encode("ascii").translate(None, letters):
        raise ValueError


class CsvRows:
    """The header of a file, its cells without spaces around, and the other rows in blocks."""

    def __init__(self, path: Path) -> None:
        self.place = path.name
        data = read_bytes(path, LARGEST_MESH_FILE)
        if problem := text_problem(data):
            raise InputError(f"{self.place}: a table {problem}")
        if b"\r" in data:
            data = data.replace(b"\r\n", b"\n").replace(b"\r", b"\n")
        if not data.isascii():
            self._require_utf_8(data)
        lines = io.TextIOWrapper(io.BytesIO(data), "utf-8", newline="")
        self._reader = csv.reader(lines, strict=True)
        self.row = 0
        header = self._next(1)
        if not header:
            raise InputError(f"{self.place}: a table must start with a row of column names, not be empty")
        self.header = [cell.strip() for cell in header[0]]

    def _require_utf_8(self, data: bytes) -> None:
        try:
            data.decode("utf-8")
        except UnicodeDecodeError as error:
            line = data.count(b"\n", 0, error.start) + 1
            raise InputError(
                f"{self.place}, row {line}: a table must be text in UTF-8; save it as UTF-8"
            ) from None

    def _next(self, count: int) -> list[list[str]]:
        """The next rows, fewer at the end of the file. Raises InputError."""
        rows: list[list[str]] = []
        try:
            rows.extend(islice(self._reader, count))
        except csv.Error as error:
            row = self.row + len(rows) + 1
            raise InputError(f"{self.place}, row {row}: it must be CSV ({error}); correct the row") from None
        self.row += len(rows)
        return rows

    def converted(self, problems: Problems, columns: Sequence[Cells]) -> tuple[list[AnyArray], Numbers]:
        """The values of each column, and the row numbers of the file.

        Empty rows are skipped, and shorter ones filled with empty cells. Problems are noted.
        """
        found: list[list[AnyArray]] = [[] for _ in columns]
        numbers: list[Numbers] = []
        first = self.row + 1
        while (block := self._next(ROWS_AT_ONCE)) or not numbers:
            values, in_file = _block(problems, self.place, block, first, columns)
            for column, each in zip(found, values, strict=True):
                column.append(each)
            numbers.append(in_file)
            first += len(block)
        return [np.concatenate(column) for column in found], np.concatenate(numbers)


def _block(
    problems: Problems, place: str, block: list[list[str]], first: int, columns: Sequence[Cells]
) -> tuple[list[AnyArray], Numbers]:
    """The values of each column in some rows, and the numbers of these in the file."""
    width = len(columns)
    if block and all(len(cells) == width for cells in block):
        try:
            at_once = [
                cells.at_once(column) for cells, column in zip(columns, zip(*block, strict=True), strict=True)
            ]
        except (ValueError, OverflowError):
            pass
        else:
            return at_once, np.arange(first, first + len(block))
    values: list[list[float | int]] = [[] for _ in columns]
    numbers = []
    for row, raw in enumerate(block, start=first):
        cells = [cell.strip() for cell in raw]
        if not any(cells):
            continue

        def note(sentence: str, row: int = row) -> None:
            problems.note(place, row, sentence)

        if len(cells) > width:
            note(f"a row must have {width} cells, not {len(cells)}; correct it")
        cells.extend([""] * (width - len(cells)))
        numbers.append(row)
        for column, kind, cell in zip(values, columns, cells, strict=False):
            column.append(kind.one(cell, note))
    types = [np.float64 if isinstance(each, NumberCells) else np.int64 for each in columns]
    arrays: list[AnyArray] = [np.array(each, of) for each, of in zip(values, types, strict=True)]
    return arrays, np.array(numbers, np.int64)
