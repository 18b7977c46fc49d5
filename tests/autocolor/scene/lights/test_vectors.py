from __future__ import annotations

import math

import pytest
from hypothesis import given

from autocolor.scene.lights.vectors import middle_between, unit_vector
from tests.autocolor.strategies import Vector, directions, numbers


@given(directions, numbers(1e-30, 1e30))
def test_a_unit_vector_has_the_direction_of_any_longer_one(direction: Vector, length: float) -> None:
    x, y, z = direction
    found = unit_vector((x * length, y * length, z * length))
    assert math.hypot(*found) == pytest.approx(1, rel=1e-15)
    assert found == pytest.approx([each / math.hypot(x, y, z) for each in direction], rel=1e-12)


@pytest.mark.parametrize("size", [5e-324, 1e-300, 1e300])
def test_squares_of_very_small_or_large_ones_do_not_matter(size: float) -> None:
    assert unit_vector((size, 0.0, -size)) == pytest.approx((math.sqrt(0.5), 0, -math.sqrt(0.5)))


def test_the_middle_of_two_points_is_halfway_also_between_the_largest() -> None:
    assert middle_between((1, 2, -3), (3, 2, 5)) == (2, 2, 1)
    assert middle_between((1.5e308, 0, 0), (1.7e308, 0, 0)) == (1.6e308, 0, 0)
