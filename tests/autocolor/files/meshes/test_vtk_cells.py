from __future__ import annotations

import numpy as np
import pytest

from autocolor.errors import InputError
from autocolor.files.meshes.vtk_cells import CellLists, VtkCells, add_cells, require_nodes


def test_a_strip_turns_every_other_triangle_over() -> None:
    cells = VtkCells()
    add_cells(cells, "a.vtk", CellLists(np.array([4, 5, 6, 7, 8, 0, 1]), np.array([0, 5, 7])), 6)
    assert cells.flats[0].corners.reshape(-1, 3).tolist() == [[4, 5, 6], [6, 5, 7], [6, 7, 8]]
    assert cells.flats[0].cells.tolist() == [0, 0, 0]
    assert cells.count == 2


def lists_of(*cells: list[int]) -> CellLists:
    return CellLists(
        np.concatenate([np.array(cell, int) for cell in cells]), np.cumsum([0, *map(len, cells)])
    )


def test_cells_of_several_types_have_their_rows_in_the_file() -> None:
    cells = VtkCells()
    add_cells(cells, "a.vtk", lists_of([0, 1]), 3)
    every = lists_of([0, 1, 2], [4], [0, 1, 3, 2], [0, 1, 2, 4, 5, 6], [0, 1, 2, 3], [0, 1])
    add_cells(cells, "a.vtk", every, np.array([5, 1, 8, 22, 10, 99]))
    by_row = {
        int(row): each.corners.reshape(len(each.cells), -1)[at].tolist()
        for each in cells.flats
        for at, row in enumerate(each.cells)
    }
    assert by_row == {1: [0, 1, 2], 3: [0, 1, 2, 3], 4: [0, 1, 2]}
    assert [(each.shape, each.cells.tolist()) for each in cells.volumes] == [("tetra", [5])]
    assert cells.count == 7
    assert cells.sentences == (
        "skipped lines: 1",
        "skipped vertices: 1",
        "skipped cells of type 99: 1",
        "took the corners alone of cells of higher order: 1",
    )


@pytest.mark.parametrize("wrong", [-1, 9])
def test_a_node_number_out_of_range_is_refused_with_its_cell(wrong: int) -> None:
    require_nodes("a.vtk, CELLS", lists_of([0, 8], [1]), 9)
    with pytest.raises(InputError) as caught:
        require_nodes("a.vtk, CELLS", lists_of([0, 8], [], [1, wrong]), 9)
    assert str(caught.value) == (
        f"a.vtk, CELLS: a node number must be from 0 to 8, not {wrong} (cell 2, counted from 0); correct it"
    )
