from __future__ import annotations

import math
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor.errors import InputError
from autocolor.files.meshes.csv_rows import (
    NOTHING,
    ROWS_AT_ONCE,
    Cells,
    CsvRows,
    NameCells,
    NumberCells,
    Problems,
    WholeCells,
)

CELL = st.text("0123456789+-.eE _nx\u0661 ", max_size=6) | st.floats().map(repr) | st.integers().map(str)


def refuse(sentence: str) -> None:
    raise AssertionError(sentence)


@given(st.lists(CELL.map(str.strip), min_size=1, max_size=3), st.booleans())
def test_cells_converted_at_once_are_those_converted_one_by_one(cells: list[str], may_be_empty: bool) -> None:
    for kind in (NumberCells("rule", may_be_empty), WholeCells("a number", may_be_empty)):
        try:
            values = kind.at_once(cells)
        except (ValueError, OverflowError):
            continue
        for value, cell in zip(values.tolist(), cells, strict=True):
            one = kind.one(cell, refuse)
            assert value == one or (math.isnan(value) and math.isnan(one))


def test_names_are_numbered_in_their_order_and_made_printable() -> None:
    names = NameCells("file")
    assert names.at_once(["hood", "", " hood", "a\0b", "hood"]).tolist() == [0, 1, 0, 2, 0]
    assert list(names.rows) == ["hood", "file", "a?b"]


def test_problems_come_in_the_order_of_tables_and_rows() -> None:
    problems = Problems()
    for place, row in (("nodes.csv", 9), ("polygons.csv", 1), ("nodes.csv", 2)):
        problems.note(place, row, "wrong")
    with pytest.raises(InputError) as caught:
        problems.raise_any()
    assert caught.value.problems == (
        "nodes.csv, row 2: wrong",
        "nodes.csv, row 9: wrong",
        "polygons.csv, row 1: wrong",
    )


def test_there_are_at_most_twenty_problems() -> None:
    problems = Problems()
    for row in range(19):
        problems.note("a.csv", row, "wrong")
    with pytest.raises(InputError) as caught:
        problems.note("a.csv", 19, "wrong")
    assert len(caught.value.problems) == 20


def test_rows_of_many_blocks_keep_their_numbers_and_values(tmp_path: Path) -> None:
    count = 2 * ROWS_AT_ONCE + 5
    path = tmp_path / "a.csv"
    lines = [f"{row}.5,{row if row % 2 else ''}" for row in range(count)]
    lines[ROWS_AT_ONCE + 3] = "\u00a07.5 ,8"
    path.write_text("number, whole\n\n" + "\n".join(lines), "utf-8")
    rows = CsvRows(path)
    assert rows.header == ["number", "whole"]
    problems = Problems()
    kinds: list[Cells] = [NumberCells("rule"), WholeCells("a whole", may_be_empty=True)]
    (numbers, wholes), in_file = rows.converted(problems, kinds)
    expected = [row + 0.5 for row in range(count)]
    expected[ROWS_AT_ONCE + 3] = 7.5
    assert numbers.tolist() == expected
    assert in_file.tolist() == list(range(3, count + 3))
    assert wholes[:4].tolist() == [NOTHING, 1, NOTHING, 3]
    problems.raise_any()
