"""Printing the rows of an answer: as an aligned table, as CSV, or as JSON."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Iterator, Sequence
from itertools import chain, islice
from typing import TYPE_CHECKING, Final

from autocolor.checks import printable

if TYPE_CHECKING:
    from autocolor.files.store.statements import Answer, Value

FORMATS: Final = ("table", "csv", "json")

MEASURED: Final = 1000
"""Rows whose widths are looked at; those after them are printed as they come."""

WIDEST: Final = 60
"""Assumed: letters of a cell of a table; longer text is cut."""

ABSENT: Final = "NULL"


def lines_of(answer: Answer, form: str) -> Iterator[str]:
    """The lines of an answer in one of FORMATS, made as its rows come."""
    if form == "csv":
        return _csv(answer)
    return _json(answer) if form == "json" else _table(answer)


def _table(answer: Answer) -> Iterator[str]:
    """The columns and the rows, aligned; numbers stand to the right."""
    rows = iter(answer.rows)
    cells = []
    has_number = [False] * len(answer.columns)
    has_other = [False] * len(answer.columns)
    for values in islice(rows, MEASURED):
        cells.append([_cell(value) for value in values])
        for place, value in enumerate(values):
            has_number[place] |= isinstance(value, (int, float))
            has_other[place] |= not isinstance(value, (int, float, type(None)))
    if not answer.columns:
        return
    header = [printable(name) for name in answer.columns]
    widths = [max(map(len, column)) for column in zip(header, *cells, strict=True)]
    is_number = [number and not other for number, other in zip(has_number, has_other, strict=True)]
    yield _line(header, widths, is_number)
    yield "  ".join("-" * width for width in widths)
    for row in chain(cells, ([_cell(value) for value in each] for each in rows)):
        yield _line(row, widths, is_number)


def _line(cells: Sequence[str], widths: Sequence[int], is_number: Sequence[bool]) -> str:
    placed = [
        cell.rjust(width) if right else cell.ljust(width)
        for cell, width, right in zip(cells, widths, is_number, strict=True)
    ]
    return "  ".join(placed).rstrip()


def _cell(value: Value) -> str:
    if value is None:
        return ABSENT
    text = f"{len(value):,} bytes" if isinstance(value, bytes) else str(value)
    return printable(text if len(text) <= WIDEST else f"{text[: WIDEST - 3]}...")


def _csv(answer: Answer) -> Iterator[str]:
    """Rows as CSV, NULL as an empty cell."""
    yield _csv_line(answer.columns)
    for row in answer.rows:
        yield _csv_line(["" if value is None else _plain(value) for value in row])


def _csv_line(cells: Sequence[object]) -> str:
    text = io.StringIO()
    csv.writer(text, lineterminator="").writerow(cells)
    return text.getvalue()


def _json(answer: Answer) -> Iterator[str]:
    """A list of objects by the names of columns, one a line."""
    opening = "["
    for row in answer.rows:
        values = dict(zip(answer.columns, map(_plain, row), strict=True))
        yield f"{opening}{json.dumps(values, ensure_ascii=False)}"
        opening = ","
    yield "[]" if opening == "[" else "]"


def _plain(value: Value) -> object:
    """A value that JSON and CSV can hold: infinite numbers and bytes as text."""
    if isinstance(value, bytes):
        return value.hex()
    if isinstance(value, float) and value - value != 0:
        return str(value)
    return value
