from __future__ import annotations

import csv
import io
import re
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor.files.text_table import TextTable, value_of_text
from tests.tables import refused


def read(data: str | bytes) -> list[dict[str, str]]:
    table = TextTable(data.encode() if isinstance(data, str) else data, "t.csv")
    return [cells for _, cells in table.records()]


CELL = st.text("ab \"',;\t\n.0", max_size=5).map(str.strip)
KEY = st.text("abc.", min_size=1, max_size=4)


@st.composite
def tables(draw: st.DrawFn) -> tuple[list[str], list[list[str]]]:
    header = draw(st.lists(KEY, min_size=2, max_size=4, unique=True))
    row = st.lists(CELL, min_size=len(header), max_size=len(header)).filter(any)
    return header, draw(st.lists(row, max_size=4))


@given(
    tables(),
    st.sampled_from(",;\t"),
    st.sampled_from(["\n", "\r\n", "\r"]),
    st.sampled_from([b"", b"\xef\xbb\xbf"]),
    st.booleans(),
    st.integers(0, 2),
    st.booleans(),
)
def test_a_table_is_read_however_programs_write_it(
    table: tuple[list[str], list[list[str]]],
    separator: str,
    ending: str,
    mark: bytes,
    told: bool,
    empty: int,
    numbered: bool,
) -> None:
    header, rows = table
    text = io.StringIO(newline="")
    writer = csv.writer(text, delimiter=separator, lineterminator="\n")
    if told:
        text.write(f"sep={separator}\n")
    numbers = [[str(number)] for number in range(len(rows))] if numbered else [[]] * len(rows)
    writer.writerow([*([""] if numbered else []), *header, *[""] * empty])
    for number, row in zip(numbers, rows, strict=True):
        writer.writerow([*number, *row, *[""] * empty])
        text.write(f"{separator}\n\n")
    data = mark + text.getvalue().replace("\n", ending).encode()
    if separator != ",":
        # A cell that is one number has a decimal comma, as in "0," and ",00".
        rows = [
            [re.sub(r"^(0+,0*|,0+)$", lambda number: number[0].replace(",", "."), cell) for cell in row]
            for row in rows
        ]
    expected = [[cell.replace("\r", "\n") for cell in row] for row in rows]
    assert read(data) == [dict(zip(header, row, strict=True)) for row in expected]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        # A decimal comma, in a cell that is one number.
        ("a;b\n0,5;-1,25E-3\n", {"a": "0.5", "b": "-1.25E-3"}),
        ("a\tb\n,5\t[1,5, 2]\n", {"a": ".5", "b": "[1,5, 2]"}),
        ("a;b\n64,;,\n", {"a": "64.", "b": ","}),
        ('a;b\n"1.234,5";1,2,3\n', {"a": "1.234,5", "b": "1,2,3"}),
        ('a,b\n"0,5",1\n', {"a": "0,5", "b": "1"}),
        # Other separators in the header's quotes, and rows that end early, as in Excel's.
        ('"a,b,c";d;e\n1;2\n', {"a,b,c": "1", "d": "2", "e": ""}),
        ("sep=;\na,b;c\n1;2\n", {"a,b": "1", "c": "2"}),
    ],
)
def test_what_a_row_says(text: str, expected: dict[str, str]) -> None:
    assert read(text) == [expected]


def test_rows_are_numbered_as_in_the_file() -> None:
    table = TextTable(b"\n;;\na;b\n\n1;2\n;\n3\n", "t.csv")
    assert [number for number, _ in table.records()] == [5, 7]
    assert table.place == "t.csv (separated by semicolons)"
    assert TextTable(b"a,b\n", "t.csv").place == "t.csv"


MANY = "a row must have at most 2 cells, separated by"
NAMELESS = "must have a name, as it has"
test_what_is_refused = refused(
    read,
    [
        ("", "t.csv: a table must start with a row of column names, not be empty"),
        (
            "a,b,a\n",
            "t.csv, row 1: a column name must be unique, not repeated: 'a' (separated by commas); remove one",
        ),
        (
            "a;b\n1;2;;3\n",
            f"t.csv (separated by semicolons), row 2: {MANY} semicolons, not 4; quote a value that contains a"
            " separator",
        ),
        (
            "a,,b\n1,x,2\n",
            f"t.csv, row 2: column 2 {NAMELESS} 'x' (separated by commas); write the name at its top",
        ),
        (
            'a\n"1',
            "t.csv, row 2: it must be CSV in UTF-8 (unexpected end of data), separated by commas; correct the"
            " row, or save the table as UTF-8",
        ),
        (
            "sep=|\na|b\n",
            "t.csv, row 1: cells must be separated by commas, semicolons or tabs, not by '|'; save the table"
            " with one of these",
        ),
        (
            b"a\n\xff\n",
            "t.csv, row 2: it must be CSV in UTF-8 ('utf-8' codec can't decode byte 0xff in position 0:"
            " invalid start byte), separated by commas; correct the row, or save the table as UTF-8",
        ),
        ("a,b\n".encode("utf-16"), "t.csv: a table must be text in UTF-8, not UTF-16; save it as UTF-8"),
    ],
)


@pytest.mark.parametrize(
    ("text", "value"),
    [
        *((text, text == "True") for text in ("True", "FALSE")),
        *((text, 0.5) for text in (".5", "5.00E-01", "50.e-2")),
        *((text, 64) for text in ("64.0", "64.", "6.4e1")),
        ("[1, 2.5]", [1, 2.5]),
        *((text, float("inf")) for text in ("inf", "inf # most")),
        *((text, text) for text in ("#b01020", "WAHR", "infinite", "1,5", "", "1_", ".", "1\n2", "\udcff")),
    ],
)
def test_the_value_of_a_text(text: str, value: Any) -> None:
    given_value = value_of_text(text)
    assert given_value == value
    assert type(given_value) is type(value)


@given(st.floats(allow_nan=False, allow_infinity=False) | st.integers(-(10**20), 10**20))
def test_any_number_is_read_as_it_was_written(number: float) -> None:
    assert value_of_text(repr(number)) == number
