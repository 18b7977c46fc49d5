from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor.files.meshes.obj.tables import ObjTables


def tables_of(nodes: int, *polygons: tuple[int, list[int]]) -> ObjTables:
    """Tables of a number of nodes and of polygons: how many nodes stood before each, and its numbers."""
    return ObjTables(
        np.zeros((nodes, 3)),
        np.array([number for _, numbers in polygons for number in numbers], np.int64),
        np.array([len(numbers) for _, numbers in polygons], np.int64),
        np.zeros(len(polygons), np.int64),
        np.array([before for before, _ in polygons], np.int64),
    )


def row_of(nodes: int, before: int, number: int) -> int:
    """The slow twin: the row of the node table that a number in a file means, or -1."""
    if 1 <= number <= nodes:
        return number - 1
    if -before <= number <= -1:
        return before + number
    return -1


numbers = st.integers(-8, 8) | st.integers(-(1 << 63), (1 << 63) - 1)


@given(st.integers(0, 6), st.data())
def test_every_corner_has_the_row_of_the_slow_twin(nodes: int, data: st.DataObject) -> None:
    polygon = st.tuples(st.integers(0, nodes), st.lists(numbers, max_size=5))
    polygons = data.draw(st.lists(polygon, max_size=5))
    tables = tables_of(nodes, *polygons)
    assert tables.rows.tolist() == [
        row_of(nodes, before, number) for before, numbers in polygons for number in numbers
    ]
    assert tables.rows.dtype == np.intp


def test_a_negative_number_counts_back_from_its_polygon_and_not_from_the_end() -> None:
    assert tables_of(4, (2, [-1, -2]), (4, [-1, -4])).rows.tolist() == [1, 0, 3, 0]


@pytest.mark.parametrize("number", [0, 4, -3, 1 << 62, -(1 << 63)])
def test_a_number_of_no_node_has_no_row(number: int) -> None:
    assert tables_of(3, (2, [1, number])).rows.tolist() == [0, -1]


def test_the_numbers_of_the_file_stay_as_they_are() -> None:
    tables = tables_of(3, (3, [-1, 9, 1]))
    assert tables.rows.tolist() == [2, -1, 0]
    assert tables.numbers.tolist() == [-1, 9, 1]
