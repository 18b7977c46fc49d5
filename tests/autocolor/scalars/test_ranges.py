from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor.scalars.ranges import range_of, widened


def test_missing_values_are_not_in_the_range() -> None:
    assert range_of(np.array([np.nan, 3.0, -1.0, np.nan])) == (-1, 3)
    assert range_of(np.array([np.nan])) == range_of(np.empty(0)) == (0, 1)


@pytest.mark.parametrize(
    ("value", "limits"),
    [
        (8.0, (4, 12)),
        (-8.0, (-12, -4)),
        (0.0, (-0.5, 0.5)),
        (1e-45, (-0.5, 0.5)),
    ],
)
def test_a_constant_is_in_the_middle_of_its_range(value: float, limits: tuple[float, float]) -> None:
    assert range_of(np.array([value, value])) == limits


def test_noise_counts_as_a_constant() -> None:
    low, high = widened(1000.0, 1000.0 + 1e-4)
    assert high - low == pytest.approx(1000, rel=1e-3)


values = st.floats(-1e30, 1e30)


@given(st.lists(values, min_size=1))
def test_every_value_is_in_the_range_also_as_a_single(numbers: list[float]) -> None:
    low, high = range_of(np.array(numbers))
    assert low < high
    assert (low, high) == (float(np.float32(low)), float(np.float32(high)))
    singles = np.array(numbers, np.float32)
    assert low <= singles.min() <= singles.max() <= high
