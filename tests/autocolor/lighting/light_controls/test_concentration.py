from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor.arrays import Singles
from autocolor.lighting.light_controls.concentration import Concentration
from tests.autocolor.lighting.light_controls.lit_points import lit_at
from tests.autocolor.strategies import numbers


def factor(cosines: list[float], concentration: float) -> Singles:
    given_as = np.array(cosines, np.float32)
    return Concentration(concentration).factor(lit_at(given_as), out=np.empty_like(given_as))


@given(numbers(0, 60), numbers(1e-6, 1))
def test_the_concentrated_light_is_the_cosine_to_the_power_of_the_concentration(
    concentration: float, cosine: float
) -> None:
    value = factor([cosine], concentration)[0]
    assert value == pytest.approx(float(np.float32(cosine)) ** concentration, rel=2e-5, abs=1e-30)


@pytest.mark.parametrize(("concentration", "degrees"), [(1, 60.0), (10, 21.1), (40, 10.6)])
def test_half_is_left_at_the_papers_angles(concentration: float, degrees: float) -> None:
    assert factor([math.cos(math.radians(degrees))], concentration)[0] == pytest.approx(0.5, abs=0.005)


@given(st.lists(numbers(-1, 1), min_size=2), st.sampled_from([0.5, 1, 2, 40, 1e6, 1e30, 1e300]))
def test_the_factor_never_leaves_0_to_1(cosines: list[float], concentration: float) -> None:
    values = factor([*cosines, 1.0000002], concentration)
    assert ((values >= 0) & (values <= 1)).all()


def test_a_factor_may_overwrite_the_cosines() -> None:
    cosines = np.array([0.5, 1.0], np.float32)
    assert Concentration(2.0).factor(lit_at(cosines), out=cosines) is cosines
    assert cosines.tolist() == [0.25, 1.0]
