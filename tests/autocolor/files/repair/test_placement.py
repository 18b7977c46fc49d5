from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor.files.repair.placement import Placement, placed
from tests.autocolor.strategies import vectors


def test_the_up_axis_becomes_z_and_windings_stay() -> None:
    axes = np.eye(3)
    assert placed(axes, Placement("z")).tolist() == [[1, 0, 0], [0, 1, 0], [0, 0, 1]]
    assert placed(axes, Placement("y")).tolist() == [[1, 0, 0], [0, 0, 1], [0, -1, 0]]
    assert placed(axes, Placement("x")).tolist() == [[0, 0, 1], [1, 0, 0], [0, 1, 0]]
    for up in "xyz":
        assert np.linalg.det(placed(axes, Placement(up))) == 1


def test_turning_makes_no_negative_zero() -> None:
    assert not np.signbit(placed(np.zeros((1, 3)), Placement("y"))).any()


@pytest.mark.parametrize("up", ["x", "y", "z"])
@given(points=st.lists(vectors(), max_size=9))
def test_the_coordinate_on_the_up_axis_becomes_the_height(up: str, points: list[tuple[float, ...]]) -> None:
    coordinates = np.array(points).reshape(-1, 3)
    turned = placed(coordinates, Placement(up))
    assert turned[:, 2].tolist() == coordinates[:, "xyz".index(up)].tolist()
    assert (np.sort(np.abs(turned), axis=1) == np.sort(np.abs(coordinates), axis=1)).all()


@pytest.mark.parametrize("up", ["x", "y", "z"])
def test_the_coordinates_that_were_given_stay_as_they_are(up: str) -> None:
    coordinates = np.arange(6.0).reshape(2, 3)
    placed(coordinates, Placement(up))
    assert coordinates.tolist() == [[0, 1, 2], [3, 4, 5]]


def test_coordinates_are_scaled_after_they_are_turned() -> None:
    assert placed(np.array([[1.0, 2.0, 3.0]]), Placement("y", 0.5)).tolist() == [[0.5, -1.5, 1.0]]
