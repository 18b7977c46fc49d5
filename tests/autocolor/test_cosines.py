from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor.cosines import power_of

exponents = st.one_of(
    st.integers(0, 64).map(float),
    st.floats(0.0, 200.0),
    st.sampled_from([1e-300, 1e-46, 1e-45, 1e-7, 63.5, 65.0, 1e6, 1e30, 1e300]),
)


@given(st.lists(st.floats(-1.0, 1.0, width=32), min_size=1), exponents)
def test_every_cosine_is_raised_and_a_negative_one_counts_as_0(cosines: list[float], exponent: float) -> None:
    powers = power_of(np.array(cosines, np.float32), exponent)
    # Float32 takes the smallest exponents for 0, and anything to the power 0 is 1.
    single = float(np.float32(min(exponent, 3e38)))
    expected = [max(cosine, 0.0) ** single for cosine in cosines]
    assert ((powers >= 0) & (powers <= 1)).all()
    assert powers.tolist() == pytest.approx(expected, abs=2e-5)


@given(exponents)
def test_a_cosine_that_rounding_left_above_1_stays_1(exponent: float) -> None:
    assert power_of(np.array([1.0000002], np.float32), exponent).tolist() == [1.0]
