from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor.visibility import raster as room
from autocolor.visibility.raster import Raster, left_center, on_raster, right_center

RASTER = Raster(10, 16, 20.0)


@given(st.floats(-3, 3), st.floats(-3, 3), st.floats(0.1, 10))
def test_a_node_lies_where_its_ray_meets_the_raster(right: float, down: float, depth: float) -> None:
    x, y, inverse_depth, first_line = on_raster(np.array([[right], [down], [depth]]), 1e-9, RASTER)
    assert x[0] == pytest.approx(8 + 20 * right / depth)
    assert y[0] == pytest.approx(5 + 20 * down / depth)
    assert inverse_depth[0] == 1 / depth
    centers = np.arange(10) + 0.5
    assert first_line[0] == np.count_nonzero(centers < y[0])


def test_a_node_behind_the_near_plane_is_put_on_it() -> None:
    found = on_raster(np.array([[1.0, 0.0], [1.0, 0.0], [-1.0, 0.5]]), 0.25, RASTER)
    assert found.inverse_depth.tolist() == [4.0, 2.0]
    assert found.x.tolist() == [8 + 20 * 4.0, 8.0]


def test_nodes_lie_alike_in_chunks_of_any_size() -> None:
    positions = np.random.default_rng(1).uniform(-1, 1, (3, 50))
    whole = on_raster(positions, 0.1, RASTER)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(room, "NODES_AT_ONCE", 7)
        for one, other in zip(on_raster(positions, 0.1, RASTER), whole, strict=True):
            assert one.tobytes() == other.tobytes()


def test_a_crossing_within_its_rounding_of_a_center_may_be_on_either_side() -> None:
    for x in (3.5 - 1e-9, 3.5, 3.5 + 1e-9):
        assert (left_center(np.array([x]))[0], right_center(np.array([x]))[0]) == (3, 4)
    assert (left_center(np.array([3.6]))[0], right_center(np.array([3.6]))[0]) == (4, 4)
