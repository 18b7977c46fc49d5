from __future__ import annotations

import statistics
import time

import pytest
from hypothesis import given
from hypothesis import strategies as st

from benchmarks import cases
from benchmarks.cases import WARMING, Case, ratios, spread, timed

TIMES = st.lists(st.floats(1e-6, 1e3), min_size=1)


@given(TIMES)
def test_the_median_is_between_the_quartiles(numbers: list[float]) -> None:
    low, median, high = spread(numbers)
    assert median == pytest.approx(statistics.median(numbers))
    assert low <= median <= high


@pytest.mark.parametrize("count", [1, 2, 5, 9, 26])
def test_the_quartiles_of_an_even_row_cut_it_in_four(count: int) -> None:
    last = count - 1
    assert spread(range(count)) == (last / 4, last / 2, 3 * last / 4)


@given(TIMES, st.floats(0.1, 10))
def test_a_case_that_always_takes_so_many_times_as_long_has_that_ratio(
    numbers: list[float], factor: float
) -> None:
    assert ratios([factor * number for number in numbers], numbers) == pytest.approx((factor,) * 3)


def test_a_ratio_compares_the_same_round_of_both_cases() -> None:
    # The machine was ten times slower in the second round.
    assert ratios([2, 20, 2], [1, 10, 1]) == (2, 2, 2)


def test_cases_are_taken_in_turns_and_what_comes_before_one_is_not_timed(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    clock, order = [0.0], list[str]()

    def spend(name: str, seconds: float) -> None:
        clock[0] += seconds
        order.append(name)

    monkeypatch.setattr(cases, "CACHES", 1)
    monkeypatch.setattr(time, "perf_counter", lambda: clock[0])
    seconds = timed(
        [
            Case("one", lambda: spend("one", 1), before=lambda: spend("before", 100)),
            Case("two", lambda: spend("two", 2)),
        ],
        3,
    )
    assert seconds == {"one": [1] * 3, "two": [2] * 3}
    assert order == ["before", "one", "two"] * (3 + WARMING)
