from __future__ import annotations

from itertools import pairwise

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from autocolor.mapping.legend_numbers import bands_apart, numbers_beside, numbers_between


@given(st.integers(2, 256), st.integers(1, 24))
def test_numbers_are_at_limits_of_bands_and_far_enough_apart_or_at_the_ends_alone(
    bands: int, lines: int
) -> None:
    apart = bands_apart(bands, lines, 22)
    assert bands % apart == 0
    assert apart == bands or apart * lines >= 22


@pytest.mark.parametrize(
    ("low", "high", "count", "told", "exponent"),
    [
        (0, 250, 4, ["0", "62.5", "125", "187.5", "250"], 0),
        (-1, 1, 4, ["-1", "-0.5", "0", "0.5", "1"], 0),
        (0, 1, 3, ["0", "0.333", "0.667", "1.000"], 0),
        (0, 2e-6, 2, ["0", "1", "2"], -6),
        (320.1, 8019584, 2, ["0.00", "4.01", "8.02"], 6),
        (0, 45_000, 3, ["0", "15000", "30000", "45000"], 0),
        (-0.3, 0.3, 2, ["-0.3", "0", "0.3"], 0),
        (1e30, 3e30, 2, ["1", "2", "3"], 30),
    ],
)
def test_numbers_are_told_in_few_digits(
    low: float, high: float, count: int, told: list[str], exponent: int
) -> None:
    assert numbers_between(low, high, count) == (told, exponent)


numbers = st.floats(-1e9, 1e9).filter(lambda value: value == 0 or abs(value) > 1e-9)


@given(numbers, st.floats(1e-6, 1e9), st.integers(1, 16))
def test_each_number_is_that_of_its_limit_to_a_twentieth_of_the_distance(
    low: float, extent: float, count: int
) -> None:
    high = low + extent
    assume(low < high)
    distance = (high - low) / count
    told, exponent = numbers_between(low, high, count)
    assert len(told) == count + 1
    for number, text in enumerate(told):
        wanted = low + (high - low) * number / count
        assert abs(float(text) * 10.0**exponent - wanted) <= distance / 20 + 1e-9 * abs(wanted)


@given(st.integers(-40, 40), st.integers(2, 256), st.integers(1, 24))
def test_whole_numbers_are_beside_the_middles_of_their_bands_and_far_enough_apart(
    first: int, bands: int, lines: int
) -> None:
    texts, exponent, places = numbers_beside(first - 0.5, first - 0.5 + bands, bands, lines, 22)
    assert exponent == 0
    assert [int(text) - first for text in texts] == [place // lines for place in places]
    assert all(after - before >= 11 for before, after in pairwise(places))
    assert texts[0] == str(first)
