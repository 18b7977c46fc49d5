from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor.errors import InputError
from autocolor.files.meshes.vtk.cells import CellLists, Cells, add_strips, add_typed, read_cell_lists
from autocolor.files.meshes.vtk.cursor import VtkCursor


def cursor_of(text: str) -> VtkCursor:
    cursor = VtkCursor(text.encode(), "a.vtk")
    cursor.as_text()
    return cursor


def lists_of(text: str, nodes: int = 9) -> CellLists:
    cursor = cursor_of(text)
    return read_cell_lists(cursor, cursor.words(), nodes)


@given(st.lists(st.lists(st.integers(0, 8), max_size=5), max_size=8))
def test_cells_are_the_same_in_both_forms(cells: list[list[int]]) -> None:
    numbers = [node for cell in cells for node in cell]
    counted = " ".join(str(number) for cell in cells for number in (len(cell), *cell))
    offsets = np.cumsum([0, *map(len, cells)]).tolist()
    old = lists_of(f"POLYGONS {len(cells)} {len(numbers) + len(cells)}\n{counted}")
    new = lists_of(
        f"POLYGONS {len(offsets)} {len(numbers)}\nOFFSETS vtktypeint64\n{' '.join(map(str, offsets))}\n"
        f"CONNECTIVITY vtktypeint64\n{' '.join(map(str, numbers))}"
    )
    for lists in (old, new):
        assert lists.numbers.tolist() == numbers
        assert lists.offsets.tolist() == offsets


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("CELLS 1", "a.vtk, line 1: CELLS must have two counts, not 1; correct it"),
        (
            "CELLS 5 4\n1 2 3 4",
            "a.vtk, line 1: CELLS must have at least as many numbers as cells, 5, not 4; correct it",
        ),
        (
            "CELLS 2 7\n3 0 1 2 3 1 2",
            "a.vtk, CELLS: a cell must have as many nodes as its count says, not 2 after 3 (cell 1,"
            " counted from"
            " 0); correct it",
        ),
        (
            "CELLS 1 4\n-3 0 1 2",
            "a.vtk, CELLS: a cell must have as many nodes as its count says, not 3 after -3 (cell 0,"
            " counted from"
            " 0); correct it",
        ),
        (
            "CELLS 1 5\n3 0 1 2 3",
            "a.vtk, CELLS: its 1 cells must fill 5 numbers, not 4; correct its counts",
        ),
        (
            "CELLS 2 8\n3 0 1 2 3 0 1 9",
            "a.vtk, CELLS: a node number must be from 0 to 8, not 9 (cell 1, counted from 0); correct it",
        ),
        (
            "CELLS 2 3\nOFFSETS int\n0 2\nCONNECTIVITY int\n0 1 2",
            "a.vtk, CELLS: OFFSETS must rise from 0 to the size of CONNECTIVITY, 3; correct them",
        ),
        (
            "CELLS 2 3\nOFFSETS int\n0 3\nNODES int\n0 1 2",
            "a.vtk, line 2: after OFFSETS there must be CONNECTIVITY; correct the file",
        ),
        ("CELLS 2 3\nOFFSETS\n0 3", "a.vtk, line 2: CELLS must have types of its arrays; correct it"),
    ],
)  # fmt: skip
def test_wrong_lists_are_refused(text: str, sentence: str) -> None:
    with pytest.raises(InputError) as caught:
        lists_of(text)
    assert str(caught.value) == sentence


def test_a_strip_turns_every_other_triangle_over() -> None:
    cells = Cells()
    add_strips(cells, CellLists(np.array([4, 5, 6, 7, 8, 0, 1]), np.array([0, 5, 7])))
    assert cells.flats[0].corners.reshape(-1, 3).tolist() == [[4, 5, 6], [6, 5, 7], [6, 7, 8]]
    assert cells.flats[0].cells.tolist() == [0, 0, 0]
    assert cells.count == 2


def test_there_are_as_many_types_as_cells() -> None:
    lists = CellLists(np.zeros(0, np.int64), np.zeros(1, np.int64))
    with pytest.raises(InputError) as caught:
        add_typed(Cells(), cursor_of(""), lists, np.array([5]))
    assert str(caught.value) == (
        "a.vtk: there must be as many CELL_TYPES as CELLS, 0, not 1; correct the file"
    )
