from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor.mapping.legend_numbers import bands_apart, numbers_between


@given(st.integers(2, 256), st.integers(1, 24))
def test_numbers_are_at_limits_of_bands_and_far_enough_apart_or_at_the_ends_alone(
    bands: int, lines: int
) -> None:
    apart = bands_apart(bands, lines, 22)
    assert bands % apart == 0
    assert apart == bands or apart * lines >= 22


@pytest.mark.parametrize(
    ("low", "high", "count", "told"),
    [
        (0, 250, 4, ["0", "62.5", "125", "187.5", "250"]),
        (-1, 1, 4, ["-1", "-0.5", "0", "0.5", "1"]),
        (0, 1, 3, ["0", "0.333", "0.667", "1.000"]),
        (0, 2e-6, 2, ["0", "1e-06", "2e-06"]),
        (0, 4e6, 2, ["0", "2e+06", "4e+06"]),
        (1e6, 1e6 + 4, 2, ["1000000", "1000002", "1000004"]),
        (-0.3, 0.3, 2, ["-0.3", "0", "0.3"]),
    ],
)
def test_numbers_are_told_in_few_digits(low: float, high: float, count: int, told: list[str]) -> None:
    assert numbers_between(low, high, count) == told


numbers = st.floats(-1e9, 1e9).filter(lambda value: value == 0 or abs(value) > 1e-9)


@given(numbers, st.floats(1e-6, 1e9), st.integers(1, 16))
def test_each_number_is_that_of_its_limit_to_a_twentieth_of_the_distance(
    low: float, extent: float, count: int
) -> None:
    high = low + extent
    distance = (high - low) / count
    told = numbers_between(low, high, count)
    assert len(told) == count + 1
    # Seven digits are as many as there is room for.
    lost = max(abs(low), abs(high)) * 1e-6
    for number, text in enumerate(told):
        assert abs(float(text) - (low + distance * number)) <= distance / 20 + lost
        assert len(text) <= 13
