from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor.arrays import Singles
from autocolor.scene.curves import CURVES, mapping_curve
from autocolor.testing import MAPPINGS
from tests.small import ramp

ALONG_THE_RANGE = [mapping for mapping in MAPPINGS if mapping != "equalize"]


def mapped(mapping: Any, intensities: Singles) -> Singles:
    """The fractions of intensities by the extent that they have themselves."""
    return mapping_curve(mapping)(intensities.min(), intensities.max(), intensities)(intensities)


@pytest.mark.parametrize("mapping", ALONG_THE_RANGE, ids=str)
def test_a_curve_never_falls_and_ends_at_1(mapping: Any) -> None:
    fractions = mapped(mapping, ramp(20_001))
    assert fractions[-1] == pytest.approx(1)
    assert fractions[0] == pytest.approx(0.1 if isinstance(mapping, tuple) else 0)
    assert (np.diff(fractions) >= -1e-6).all()


@pytest.mark.parametrize("mapping", CURVES)
@given(steps=st.lists(st.integers(0, 50), min_size=2).filter(lambda steps: min(steps) < max(steps)))
def test_every_named_curve_goes_from_0_to_1_and_leaves_its_intensities_alone(
    mapping: str, steps: list[int]
) -> None:
    intensities = np.array(sorted(steps), np.float32)
    fractions = mapped(mapping, intensities)
    assert fractions[0] == 0
    assert fractions[-1] == pytest.approx(1)
    assert (np.diff(fractions) >= 0).all()
    assert intensities.tolist() == sorted(steps)


def test_gamma_and_logarithm_lift_the_dark() -> None:
    for mapping in ("gamma", "logarithm"):
        middle = mapped(mapping, np.array([0, 0.1, 0.5, 1], np.float32))[1:3]
        assert (middle > [0.3, 0.7]).all()


def test_points_are_joined_by_straight_lines() -> None:
    points = ((0, 0), (0.5, 0.2), (1, 1))
    assert mapped(points, np.array([10, 15, 17.5, 20], np.float32)).tolist() == pytest.approx(
        [0, 0.2, 0.6, 1]
    )


@given(st.lists(st.integers(0, 100), min_size=2, max_size=60, unique=True))
def test_equalize_shows_every_level_equally_often(steps: list[int]) -> None:
    intensities = np.array(steps, np.float32) ** 3
    fractions = mapped("equalize", intensities)
    assert sorted(fractions.tolist()) == pytest.approx(np.linspace(0, 1, len(steps)).tolist())
    assert np.argsort(fractions).tolist() == np.argsort(intensities).tolist()
