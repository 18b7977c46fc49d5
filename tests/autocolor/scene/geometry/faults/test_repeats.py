from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from autocolor.scene.geometry.faults.repeats import nodes_at_one_place, repeated_polygons, repeated_rows

rows = st.lists(st.tuples(*[st.integers(-2, 2)] * 3), max_size=30)


@given(rows)
def test_the_rows_that_equal_another_are_found(table: list[tuple[int, int, int]]) -> None:
    expected = [row for row, values in enumerate(table) if table.count(values) > 1]
    assert repeated_rows(np.array(table, np.int64).reshape(-1, 3)).tolist() == expected


def test_polygons_are_the_same_in_any_order_of_their_nodes() -> None:
    table = np.array([[0, 1, 2, 3], [0, 1, 2, 2], [3, 2, 1, 0], [0, 1, 3, 3], [2, 0, 1, 1]])
    assert repeated_polygons(table).tolist() == [0, 1, 2, 4]


def test_only_nodes_that_are_used_count_and_zero_has_no_sign() -> None:
    places = np.array([[0.0, 0, 0], [1, 0, 0], [-0.0, 0, 0], [0, 0, 0], [0, 1, 0]])
    assert nodes_at_one_place(places, np.array([[0, 1, 4, 4]])).tolist() == []
    assert nodes_at_one_place(places, np.array([[0, 1, 4, 4], [2, 1, 4, 4]])).tolist() == [0, 2]
