from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor.mapping.rounding import half_up, halves_up


@pytest.mark.parametrize(
    ("value", "whole"), [(2.5, 3), (-2.5, -2), (2.49, 2), (0.0, 0), (-0.5, 0), (1022.5, 1023)]
)
def test_halves_go_up(value: float, whole: int) -> None:
    assert half_up(value) == whole
    assert halves_up(np.array([value])).tolist() == [whole]
    assert halves_up(np.array([value], np.float32)).dtype == np.float32


@given(st.integers(-4096, 4096).map(lambda sixteenths: sixteenths / 16))
def test_the_nearest_whole_number_is_at_most_a_half_away(value: float) -> None:
    assert -Fraction(1, 2) < Fraction(half_up(value)) - Fraction(value) <= Fraction(1, 2)
    assert halves_up(np.array([value]))[0] == half_up(value)
