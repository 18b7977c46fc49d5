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
from autocolor.files.reading import HEAD, UTF_8_MARK, text_lines, utf_8_text
from autocolor.files.scene_toml.toml_text import parsed_toml

SEPARATORS: Final = {",": "commas", ";": "semicolons", "\t": "tabs"}
"""The separators of cells, and what messages call them."""

SEP_LINE: Final = re.compile(r'"?sep=(.)"?[,;\t]*\n', re.IGNORECASE)
"""The first line in which Excel is told the separator."""

QUOTED: Final = re.compile(r'"(?:[^"]|"")*"?')

COMMA_NUMBER: Final = re.compile(r"[+-]?(?:[0-9]+,[0-9]*|,[0-9]+)(?:[eE][+-]?[0-9]+)?")
"""A number with a decimal comma."""

POINTED: Final = re.compile(r"[+-]?(?:[0-9]+\.|\.[0-9]+)(?:[eE][+-]?[0-9]+)?")
"""A number with a point that TOML does not accept."""

ROW_NUMBER: Final = re.compile(r"[0-9]{1,18}(?:\.0)?")

LONGEST_NUMBER: Final = 100
"""Limit: characters of a number with a decimal comma."""

MOST_EXACT: Final = 1 << 53
"""Limit: float64 has each whole number up to this."""


class TextTable:
    """The header of a table, and its other rows, which are read once.

    `header` has the names of the columns without spaces around them, "" for columns without a name.
    `separator` is the separator of cells, and `understood` says it in messages. `place` is the file's name in
    messages, with the separator unless it is a comma. `row` is the number of the last row that was read.
    Raises InputError for text that is no table, for a repeated name, and for text that is not UTF-8.
    """

    def __init__(self, data: bytes, name: str, thing: str = "a table") -> None:
        data = text_lines(data.removeprefix(UTF_8_MARK), name, thing)
        utf_8_text(data, name, thing)
        head = data[:HEAD].decode("utf-8", "ignore")
        told = SEP_LINE.match(head)
        self.separator = told[1] if told else _separator_in(head)
        if self.separator not in SEPARATORS:
            raise InputError(
                f"{name}, row 1: cells must be separated by commas, semicolons or tabs, not by"
                f" {self.separator!r}; save the table with one of these"
            )
        self.understood = f"separated by {SEPARATORS[self.separator]}"
        self.place = name if self.separator == "," else f"{name} ({self.understood})"
        # Measured: the text in an io.StringIO takes four times as much memory.
        lines = io.TextIOWrapper(io.BytesIO(data), "utf-8", newline="")
        self._reader = csv.reader(lines, delimiter=self.separator, strict=True)
        self.row = 0
        if told:
            self.rows(1)
        header: list[str] = []
        while not any(header):
            rows = self.rows(1)
            if not rows:
                raise InputError(f"{name}: {thing} must start with a row of column names, not be empty")
            header = [cell.strip() for cell in rows[0]]
        self.header = header
        repeated = [name for name, count in Counter(header).items() if count > 1 and name]
        if repeated:
            rule = f"a column name must be unique, not repeated: {shown(repeated[0], 40)} ({self.understood})"
            raise self.wrong(f"{rule}; remove one")

    def rows(self, count: int) -> list[list[str]]:
        """The cells of the next rows as they are written; fewer rows at the end. Raises InputError."""
        rows: list[list[str]] = []
        try:
            rows.extend(islice(self._reader, count))
        except csv.Error as error:
            self.row += len(rows) + 1
            raise self.wrong(f"it must be CSV ({error}), {self.understood}; correct the row") from None
        self.row += len(rows)
        return rows

    def records(self) -> Iterator[tuple[int, dict[str, str]]]:
        """The other rows that are not empty: each row's number, and its cells by the names of the columns.

        Cells have no spaces around them, and decimal points. Raises InputError for a row with a cell beyond
        the columns, or in a column without a name.
        """
        while rows := self.rows(1):
            cells = [self.plain(cell) for cell in rows[0]]
            if any(cells):
                if problem := self.problem_of(cells):
                    raise self.wrong(problem)
                cells += [""] * (len(self.header) - len(cells))
                yield self.row, {name: cell for name, cell in zip(self.header, cells, strict=False) if name}

    def plain(self, cell: str) -> str:
        """A cell without spaces around it; with a decimal point if it is a number with a decimal comma."""
        cell = cell.strip()
        if self.separator != "," and len(cell) <= LONGEST_NUMBER and COMMA_NUMBER.fullmatch(cell):
            return cell.replace(",", ".")
        return cell

    def with_points(self, cells: Sequence[str]) -> Sequence[str]:
        """Many cells, of which those are plain that have a comma."""
        if self.separator == ",":
            return cells
        return [self.plain(cell) if "," in cell else cell for cell in cells]

    def problem_of(self, cells: Sequence[str]) -> str:
        """The problem of a row with a cell beyond the columns, or in a column without a name; "" if none.

        Row numbers in the first column need no name.
        """
        width = len(self.header)
        if any(cells[width:]):
            return (
                f"a row must have at most {width} cells, {self.understood}, not {len(cells)}; quote a value"
                " that contains a separator"
            )
        for column, (name, cell) in enumerate(zip(self.header, cells, strict=False)):
            if cell and not name and (column or not ROW_NUMBER.fullmatch(cell)):
                return (
                    f"column {column + 1} must have a name, as it has {shown(cell, 40)} ({self.understood});"
                    " write the name at its top"
                )
        return ""

    def wrong(self, sentence: str) -> InputError:
        """The error for the last row that was read."""
        return InputError(f"{self.place}, row {self.row}: {sentence}")


def _separator_in(head: str) -> str:
    """The separator that the first line with text has most of, outside of quotes; a comma if it has none."""
    line = next((line for line in head.split("\n") if line.strip(" ,;\t")), head)
    text = QUOTED.sub("", line)
    return max(SEPARATORS, key=text.count)


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
    value: Any
    if len(text) <= LONGEST_NUMBER and POINTED.fullmatch(text):
        value = float(text)
    else:
        try:
            value = parsed_toml(f"value = {text}".encode(), "a value")["value"]
        except (InputError, UnicodeEncodeError):
            return text
    is_whole = isinstance(value, float) and value.is_integer() and 0 < abs(value) <= MOST_EXACT
    return int(value) if is_whole else value
