from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor.scene.reflection_models import phong_diffuse, phong_specular
from tests.autocolor.meshes import ramp
from tests.autocolor.strategies import numbers


@given(numbers(-1, 1), st.sampled_from([0.0, 1e-3, 0.3, 1.0, 20.0, 100.0]))
def test_the_specular_term_is_a_power_of_the_cosine_and_0_behind(cosine: float, exponent: float) -> None:
    given_as = np.array([cosine], np.float32)
    expected = max(float(given_as[0]), 0.0) ** exponent
    assert phong_specular(given_as, exponent)[0] == pytest.approx(expected, rel=1e-4, abs=2e-12)


@pytest.mark.parametrize("exponent", [1e4, 1e7, 1e30, 1e300])
def test_rounding_above_1_never_makes_a_peak(exponent: float) -> None:
    assert phong_specular(np.array([1.0000002, 1.0], np.float32), exponent).tolist() == [1, 1]


@pytest.mark.parametrize("exponent", [1.0, 3.0, 50.0])
def test_the_specular_term_never_falls_toward_the_mirrored_ray(exponent: float) -> None:
    assert (np.diff(phong_specular(ramp(5000), exponent)) >= 0).all()


def test_the_diffuse_term_is_the_cosine() -> None:
    assert phong_diffuse(ramp(9)).tolist() == ramp(9).tolist()
