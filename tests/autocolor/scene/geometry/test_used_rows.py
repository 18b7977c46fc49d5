from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor.scene.geometry import used_rows as room
from autocolor.scene.geometry.used_rows import used_rows


@given(st.lists(st.tuples(*[st.integers(0, 9)] * 4), max_size=9), st.sampled_from([1, 2, 100]))
def test_the_used_rows_are_those_that_appear(polygons: list[tuple[int, int, int, int]], at_once: int) -> None:
    numbers = np.array(polygons, np.intp).reshape(-1, 4).T
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(room, "AT_ONCE", at_once)
        assert np.flatnonzero(used_rows(numbers, 10)).tolist() == sorted({n for row in polygons for n in row})
