from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor.scene.geometry import used_rows as room
from autocolor.scene.geometry.used_rows import used_bounds, used_rows


@given(st.lists(st.tuples(*[st.integers(0, 9)] * 4), max_size=9), st.sampled_from([1, 2, 100]))
def test_the_used_rows_are_those_that_appear(polygons: list[tuple[int, int, int, int]], at_once: int) -> None:
    numbers = np.array(polygons, np.intp).reshape(-1, 4).T
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(room, "AT_ONCE", at_once)
        assert np.flatnonzero(used_rows(numbers, 10)).tolist() == sorted({n for row in polygons for n in row})


def test_bounds_leave_out_what_no_number_uses() -> None:
    rows = np.array([[1.0, -9.0, 3.0], [5.0, 99.0, 4.0]])
    low, high = used_bounds(rows, np.array([[0, 2, 0]]))
    assert (low.tolist(), high.tolist()) == ([1.0, 4.0], [3.0, 5.0])
    low, high = used_bounds(rows, np.empty((1, 0), np.intp))
    assert (low.tolist(), high.tolist()) == ([np.inf] * 2, [-np.inf] * 2)
