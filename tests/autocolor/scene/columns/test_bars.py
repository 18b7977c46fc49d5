from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor.scene.columns.bars import Bar, bar_within

bars = st.tuples(
    st.integers(-100, 100), st.integers(1, 400), st.sampled_from([0.001, 0.01, 0.02, 0.05, 0.1, 0.5, 1, 5])
).map(lambda given: Bar(given[0] * given[2], (given[0] + given[1]) * given[2], given[2]))


@given(bars, st.floats(-1e6, 1e6))
def test_a_rounded_value_is_on_the_bar_and_the_nearest_step(bar: Bar, value: float) -> None:
    rounded = bar.rounded(value)
    assert bar.low <= rounded <= bar.high
    within = min(max(value, bar.low), bar.high)
    assert abs(rounded - within) <= bar.step * 0.5000001
    assert bar.rounded(rounded) == rounded


def test_values_are_multiples_of_the_step_or_the_ends() -> None:
    bar = Bar(0.01, 1, 0.05)
    assert [bar.rounded(value) for value in (0, 0.04, 0.31, 2)] == [0.01, 0.05, 0.3, 1.0]


def test_halves_are_rounded_up_and_written_short() -> None:
    bar = Bar(-1, 1, 0.1)
    assert [bar.rounded(value) for value in (0.25, -0.25, 0.30000000000000004)] == [0.3, -0.2, 0.3]


@given(bars, st.floats(0, 1))
def test_the_value_at_a_fraction_has_that_fraction_but_for_a_step(bar: Bar, fraction: float) -> None:
    assert abs(bar.fraction(bar.at(fraction)) - fraction) * (bar.high - bar.low) <= bar.step * 0.5000001


@pytest.mark.parametrize(
    ("low", "high", "step"),
    [(0, 1, 0.01), (0, 100, 1), (0, 180, 1), (-180, 180, 2), (3, 3.004, 2e-5), (0, 3e-9, 2e-11)],
)
def test_a_bar_has_round_steps_of_at_most_a_hundredth(low: float, high: float, step: float) -> None:
    assert bar_within(low, high) == Bar(low, high, step)
