from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor.scalars.ranges import _KEPT, MOST_KEPT, kept, range_of, widened, within
from tests.autocolor.meshes import wall


def test_missing_values_are_not_in_the_range() -> None:
    assert range_of(np.array([np.nan, 3.0, -1.0, np.nan])) == (-1, 3)
    assert range_of(np.array([np.nan])) == range_of(np.empty(0)) == (0, 1)


@pytest.mark.parametrize(
    ("value", "limits"),
    [
        (8.0, (4, 12)),
        (-8.0, (-12, -4)),
        (0.0, (-0.5, 0.5)),
        (1e-45, (-0.5, 0.5)),
    ],
)
def test_a_constant_is_in_the_middle_of_its_range(value: float, limits: tuple[float, float]) -> None:
    assert range_of(np.array([value, value])) == limits


def test_an_extent_that_is_too_small_is_none() -> None:
    assert widened(-1e-9, 1e-9, least=1e-3) == pytest.approx((-1e-3, 1e-3), rel=1e-5)
    assert widened(5.0, 5.0, least=1e-3) == (2.5, 7.5)
    assert widened(0.0, 1.0, least=1e-3) == (0, 1)


def test_noise_counts_as_a_constant() -> None:
    low, high = widened(1000.0, 1000.0 + 1e-4)
    assert high - low == pytest.approx(1000, rel=1e-3)


values = st.floats(-1e30, 1e30)


@given(st.lists(values, min_size=1))
def test_every_value_is_in_the_range_also_as_a_single(numbers: list[float]) -> None:
    low, high = range_of(np.array(numbers))
    assert low < high
    assert (low, high) == (float(np.float32(low)), float(np.float32(high)))
    singles = np.array(numbers, np.float32)
    assert low <= singles.min() <= singles.max() <= high


def test_a_share_of_the_values_can_be_cut_off() -> None:
    assert range_of(np.linspace(0, 100, 1001), 2) == pytest.approx((2, 98))


def test_what_rounding_put_beyond_the_limits_is_put_on_them() -> None:
    values = np.array([-1e-9, 0.5, np.nan, 1 + 1e-6], np.float32)
    found = within(values, (0, 1))
    assert np.array_equal(found.values, np.array([0, 0.5, np.nan, 1], np.float32), equal_nan=True)


def test_a_range_is_computed_once_for_a_mesh_and_a_key() -> None:
    asked = []

    def compute() -> tuple[float, float]:
        asked.append(1)
        return 0.0, 1.0

    one, other = wall(), wall()
    for mesh, key in ((one, "a"), (one, "a"), (one, "b"), (other, "a"), (one, "a")):
        assert kept(mesh, key, compute) == (0, 1)
    assert len(asked) == 3


def test_few_ranges_are_kept_of_a_mesh() -> None:
    mesh = wall()
    for step in range(10 * MOST_KEPT):
        kept(mesh, step, lambda: (0.0, 1.0))
    assert len(_KEPT[mesh]) <= MOST_KEPT
