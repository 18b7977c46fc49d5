from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from ramtek_emu.drawing.steps import MOST_POINTS, steps
from tests.ramtek_emu.strategies import quick


@quick
@given(st.lists(st.integers(0, 5) | st.integers(MOST_POINTS - 3, MOST_POINTS + 3), max_size=12))
def test_every_row_is_numbered_from_0_in_order(counts: list[int]) -> None:
    rows, numbers = [], []
    for which, part in steps(np.array(counts, np.int64)):
        assert len(which) <= max(MOST_POINTS, *counts)
        rows += which.tolist()
        numbers += part.tolist()
    assert rows == [row for row, count in enumerate(counts) for _ in range(count)]
    assert numbers == [number for count in counts for number in range(count)]
