"""Tables of text: CSV as Excel, LibreOffice, pandas and text editors write it, and the values in texts.

Variants, meshes in tables, and palettes are read through here. The first row that is not empty names the
columns. Cells are separated by commas, semicolons or tabs, whichever the header has most of, or as a first
line `sep=;` says. A cell in quotes may hold separators and line breaks. Understood are also:

- a UTF-8 mark, any line ends, empty rows, and columns without a name and without cells, as at the right;
- rows that end early: the missing cells are empty;
- a first column of whole numbers without a name: the row numbers of pandas, which are left out;
- a decimal comma in a cell that is one number, where semicolons or tabs separate.

In messages rows are counted from 1, as in a spreadsheet.
"""

from __future__ import annotations

import csv
import io
import re
from collections import Counter
from collections.abc import Iterator, Sequence
from itertools import islice
from typing import Any, Final

from autocolor.checks import shown
from autocolor.errors import InputError
from autocolor.files.reading import HEAD, UTF_8_MARK, text_lines
from autocolor.files.scene_toml.toml_text import parsed_toml

SEPARATORS: Final = {",": "commas", ";": "semicolons", "\t": "tabs"}
"""The separators of cells, and what messages call them."""

SEP_LINE: Final = re.compile(r'"?sep=(.)"?[,;\t]*\n', re.IGNORECASE)
"""The first line in which Excel is told the separator."""

QUOTED: Final = re.compile(r'"(?:[^"]|"")*"?')

COMMA_NUMBER: Final = re.compile(r"\s*[+-]?(?:[0-9]{1,99},[0-9]{0,99}|,[0-9]{1,99})(?:[eE][+-]?[0-9]+)?\s*")
"""A number with a decimal comma."""

POINTED: Final = re.compile(r"[+-]?(?:[0-9]{1,99}\.|\.[0-9]{1,99})(?:[eE][+-]?[0-9]+)?")
"""A number with a point that TOML does not accept."""

ROW_NUMBER: Final = re.compile(r"[0-9]{1,18}(?:\.0)?")

MOST_EXACT: Final = 1 << 53
"""Limit: float64 has each whole number up to this."""


class TextTable:
    """The header of a table, and its other rows, which are read once.

    `header` has the names of the columns without spaces around them, "" for columns without a name.
    `understood` says in messages what separates cells. `place` is the file's name in messages, with the
    separator unless it is a comma. `row` is the number of the last row that was read. Raises InputError for
    text that is no table, for a repeated name, and for text that is not UTF-8.
    """

    def __init__(self, data: bytes, name: str, thing: str = "a table") -> None:
        data = text_lines(data.removeprefix(UTF_8_MARK), name, thing)
        head = data[:HEAD].decode("utf-8", "ignore")
        told = SEP_LINE.match(head)
        # Otherwise the separator that the first line with text has most of, outside of quotes.
        line = next((line for line in head.split("\n") if line.strip(" ,;\t")), head)
        self._separator = told[1] if told else max(SEPARATORS, key=QUOTED.sub("", line).count)
        if self._separator not in SEPARATORS:
            raise InputError(
                f"{name}, row 1: cells must be separated by commas, semicolons or tabs, not by"
                f" {self._separator!r}; save the table with one of these"
            )
        self.understood = f"separated by {SEPARATORS[self._separator]}"
        self.place = name if self._separator == "," else f"{name} ({self.understood})"
        # Measured: the text in an io.StringIO takes four times as much memory.
        lines = map(bytes.decode, io.BytesIO(data))
        self._reader = csv.reader(lines, delimiter=self._separator, strict=True)
        self.row = 0
        if told:
            self._rows(1)
        self.header: list[str] = []
        while not any(self.header):
            rows = self._rows(1)
            if not rows:
                raise InputError(f"{name}: {thing} must start with a row of column names, not be empty")
            self.header = [cell.strip() for cell in rows[0]]
        repeated = [name for name, count in Counter(self.header).items() if count > 1 and name]
        if repeated:
            rule = f"a column name must be unique, not repeated: {shown(repeated[0], 40)} ({self.understood})"
            raise self.wrong(f"{rule}; remove one")

    def blocks(self, most: int = 1000) -> Iterator[tuple[Sequence[int], list[list[str]]]]:
        """The other rows that are not empty, up to `most` at a time: their numbers, and their cells.

        A row has a cell for each column, with a decimal point instead of a decimal comma. Raises InputError
        for a row with a cell beyond the columns, or in a column without a name.
        """
        is_plain = self._separator == "," and all(self.header)
        while rows := self._rows(most):
            numbers: Sequence[int] = range(self.row + 1 - len(rows), self.row + 1)
            # Measured: without this test, a mesh takes half as long again.
            if not (is_plain and {*map(len, rows)} == {len(self.header)} and all(map(any, rows))):
                numbers = [
                    row for row, cells in zip(numbers, rows, strict=True) if any(map(str.strip, cells))
                ]
                rows = [self._cells(row, rows[row - self.row - 1]) for row in numbers]
            if rows:
                yield numbers, rows

    def _cells(self, row: int, cells: list[str]) -> list[str]:
        """The cells of a row, one for each column. Raises InputError."""
        width = len(self.header)
        if any(map(str.strip, cells[width:])):
            rule = f"a row must have at most {width} cells, {self.understood}, not {len(cells)}"
            raise self.wrong(f"{rule}; quote a value that contains a separator", row)
        for column, (name, cell) in enumerate(zip(self.header, map(str.strip, cells), strict=False)):
            if cell and not name and (column or not ROW_NUMBER.fullmatch(cell)):
                rule = f"column {column + 1} must have a name, as it has {shown(cell, 40)}"
                raise self.wrong(f"{rule} ({self.understood}); write the name at its top", row)
        if self._separator != ",":
            cells = [
                cell.replace(",", ".") if "," in cell and COMMA_NUMBER.fullmatch(cell) else cell
                for cell in cells
            ]
        return (cells + [""] * width)[:width]

    def records(self) -> Iterator[tuple[int, dict[str, str]]]:
        """The rows of `blocks`: each row's number, and its cells by the names of the columns.

        Cells have no spaces around them.
        """
        for numbers, rows in self.blocks():
            for number, cells in zip(numbers, rows, strict=True):
                named = zip(self.header, map(str.strip, cells), strict=True)
                yield number, {name: cell for name, cell in named if name}

    def wrong(self, sentence: str, row: int = 0) -> InputError:
        """The error for a row; for the last row that was read if none is given."""
        return InputError(f"{self.place}, row {row or self.row}: {sentence}")

    def _rows(self, count: int) -> list[list[str]]:
        """The cells of the next rows as they are written; fewer rows at the end. Raises InputError."""
        rows: list[list[str]] = []
        try:
            rows.extend(islice(self._reader, count))
        except (csv.Error, UnicodeDecodeError) as error:
            self.row += len(rows) + 1
            rule = f"it must be CSV in UTF-8 ({error}), {self.understood}"
            raise self.wrong(f"{rule}; correct the row, or save the table as UTF-8") from None
        self.row += len(rows)
        return rows


def value_of_text(text: str) -> Any:
    """The value of a text, as a cell or after `--set`: a TOML value, or the text itself if it is none.

    Also read are the truth values of other programs, numbers without digits on one side of the point, and
    whole numbers with a point.

    >>> value_of_text("2.5"), value_of_text("[1, 2]"), value_of_text("TRUE"), value_of_text("#b01020")
    (2.5, [1, 2], True, '#b01020')
    >>> value_of_text(".5"), value_of_text("64.0"), value_of_text("WAHR")
    (0.5, 64, 'WAHR')
    """
    # In TOML, the # of a color begins a comment, and a line break ends the value.
    if not text or text.startswith("#") or not text.isprintable():
        return text
    if text.lower() in ("true", "false"):
        return text.lower() == "true"
    if text[0].isalpha() and not text.startswith(("true", "false", "inf", "nan")):
        # A name, such as that of a color, is no TOML value.
        return text
    value: Any
    if POINTED.fullmatch(text):
        value = float(text)
    else:
        try:
            value = parsed_toml(f"value = {text}".encode(), "a value")["value"]
        except (InputError, UnicodeEncodeError):
            return text
    is_whole = isinstance(value, float) and value.is_integer() and 0 < abs(value) <= MOST_EXACT
    return int(value) if is_whole else value
