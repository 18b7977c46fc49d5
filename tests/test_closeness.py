from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.closeness import all_close

VALUES = st.sampled_from([0.0, 1.0, -2.0, 1e-13, 3e5, np.inf, -np.inf, np.nan])
BOUNDS = st.sampled_from([None, 1e-6, 1e-4])


@given(VALUES, st.sampled_from([0.0, 1e-7, 1e-5, 1e-3]), st.sampled_from([0.0, 1e-13, 1e-7]), BOUNDS, BOUNDS)
def test_it_is_what_pytest_says(
    expected: float, relative: float, absolute: float, rel: float | None, abs: float | None
) -> None:
    value = expected * (1 + relative) + absolute
    assert all_close([value], [expected], rel, abs) == (value == pytest.approx(expected, rel, abs))


def test_other_shapes_are_not_close() -> None:
    assert not all_close(np.zeros(2), np.zeros(1))
    assert not all_close(np.zeros((1, 2)), np.zeros(2))
