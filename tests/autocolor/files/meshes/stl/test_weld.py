from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor.arrays import Floats, Singles
from autocolor.files.meshes.stl import weld
from autocolor.files.meshes.stl.weld import FACTORS, welded

points = st.lists(st.tuples(*[st.sampled_from([0.0, -0.0, 1.0, 1e-45, -2.5, 1e30])] * 3), max_size=40)


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@pytest.mark.parametrize("factors", [FACTORS, FACTORS[:1], ((0, 0, 0),), ()])
@given(corners=points)
def test_equal_points_become_one_in_the_order_of_their_first_corners(
    dtype: type, factors: tuple[tuple[int, int, int], ...], corners: list[tuple[float, float, float]]
) -> None:
    given_corners: Floats | Singles = np.array(corners, dtype).reshape(-1, 3)
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(weld, "FACTORS", factors)
        found, rows = welded(given_corners)
    # The patient way: -0 equals 0 as a key of a dictionary, too.
    numbers: dict[tuple[float, ...], int] = {}
    expected = [numbers.setdefault(tuple(corner), len(numbers)) for corner in given_corners.tolist()]
    assert rows.tolist() == expected
    assert [tuple(point) for point in found.tolist()] == list(numbers)
    assert found.dtype == dtype
    assert not np.signbit(found[found == 0]).any()


def test_neighbors_in_the_last_digit_stay_apart() -> None:
    one = np.float32(1)
    corners = np.array([[one, 0, 0], [np.nextafter(one, np.float32(2)), 0, 0]], np.float32)
    assert len(welded(corners)[0]) == 2
