from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor.scene.geometry.planes.coordinate_rounding import EXACT, coordinate_rounding

RANDOM = np.random.default_rng(7).uniform(-3, 3, (3, 30))
LARGEST = float(np.abs(RANDOM).max())


def test_random_numbers_are_exact_but_for_a_few_units_in_the_last_place() -> None:
    assert coordinate_rounding(RANDOM).most == pytest.approx(EXACT * LARGEST)


@given(st.integers(-100, 100))
def test_numbers_rounded_to_single_precision_are_rounded_by_half_a_unit_in_the_last_place(power: int) -> None:
    scaled = RANDOM * 2.0**power
    singles = scaled.astype(np.float32).astype(np.float64)
    rounding = coordinate_rounding(singles)
    assert (np.abs(singles - scaled) <= rounding.most).all()
    assert (np.abs(singles - scaled) <= rounding.fraction * np.abs(scaled)).all()
    assert rounding.most <= 2.0**-23 * np.abs(scaled).max()


@given(st.integers(0, 9), st.integers(0, 1 << 32))
def test_numbers_with_some_decimals_are_rounded_by_half_a_unit_in_the_last(decimals: int, seed: int) -> None:
    exact = np.random.default_rng(seed).uniform(-100, 100, (3, 30)) + 0.123456789
    rounding = coordinate_rounding(exact.round(decimals))
    # Whole numbers are numbers in single precision, too.
    expected = 10.0**-decimals / 2 if decimals else 2.0**-24 * np.abs(exact.round()).max()
    assert rounding.most == pytest.approx(expected)
    assert rounding.fraction == (EXACT if decimals else 2.0**-24)


def test_if_some_numbers_were_rounded_to_single_precision_all_may_be() -> None:
    mixed = RANDOM.copy()
    mixed[:, :10] = mixed[:, :10].astype(np.float32)
    assert coordinate_rounding(mixed).most == pytest.approx(2.0**-24 * LARGEST)
    mixed[:, :10] = (0.5, 0.25, 12345.5, 3, 100, 0, -1, -2, 7, 19)
    assert coordinate_rounding(mixed).most == pytest.approx(EXACT * 12345.5)


def test_numbers_that_were_moved_after_they_were_rounded_show_it() -> None:
    moved = RANDOM.round(6) + np.array([[1 / 3], [0.1], [-5]])
    assert coordinate_rounding(moved).most == pytest.approx(5e-7)
    assert not coordinate_rounding(moved * (1 / 3)).known


def test_numbers_of_any_size_have_a_rounding() -> None:
    for factor in (0.0, 2.0**-1000, 2.0**1000):
        assert coordinate_rounding(RANDOM * factor).most == pytest.approx(EXACT * LARGEST * factor)
