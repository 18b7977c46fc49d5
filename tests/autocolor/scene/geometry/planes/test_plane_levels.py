from __future__ import annotations

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor.scene.geometry.planes import plane_levels as room
from autocolor.scene.geometry.planes.coordinate_rounding import EXACT, Rounding
from autocolor.scene.geometry.planes.plane_cells import facets
from autocolor.scene.geometry.planes.plane_levels import levels
from tests.autocolor.meshes import grid

WALL = grid(4, 3, (-0.5, 0, -0.4), (1, 0, 0), (0, 0, 0.8))
POSTER = grid(1, 1, (-0.1, 0, -0.2), (0.3, 0, 0), (0, 0, 0.2))
NONE = Rounding(EXACT, EXACT)


def found(
    heights: list[float], noise: float, turn: npt.NDArray[np.float64], rounding: Rounding = NONE
) -> list[int]:
    """The levels of a wall and posters at some heights; the corners are noisy, and then turned."""
    random = np.random.default_rng(len(heights))
    posters = [POSTER.coordinates + np.array([0.05 * k, height, 0]) for k, height in enumerate(heights)]
    corners = np.concatenate([WALL.coordinates, *posters])
    corners[:, 1] += random.uniform(-noise, noise, len(corners))
    first_nodes = range(len(WALL.coordinates), len(corners), 4)
    numbers = np.concatenate([WALL.node_numbers, *(POSTER.node_numbers + first for first in first_nodes)])
    patches = np.array([0] * len(WALL.node_numbers) + list(range(1, len(heights) + 1)))
    given_levels = levels(
        facets((corners @ turn).T[:, numbers.T]),
        np.zeros(len(numbers), np.intp),
        patches,
        rounding,
        np.zeros(3),
    )
    assert (given_levels[: len(WALL.node_numbers)] == 0).all()
    return [int(level) for level in given_levels[len(WALL.node_numbers) :]]


def turned(seed: int) -> npt.NDArray[np.float64]:
    turn, _ = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))
    return turn


@given(st.integers(0, 1 << 32), st.integers(1, 9))
def test_scattered_corners_are_on_one_level(seed: int, posters: int) -> None:
    assert found([0.0] * posters, 1e-7, turned(seed), Rounding(1e-7, EXACT)) == [0] * posters


@given(st.integers(0, 1 << 32))
def test_patches_farther_than_they_are_scattered_have_levels_of_their_own(seed: int) -> None:
    heights = [1e-6, 0.0, -2e-6, 1e-6, 0.0]
    assert found(heights, 1e-8, turned(seed), Rounding(1e-8, EXACT)) in ([1, 0, 2, 1, 0], [2, 0, 1, 2, 0])


@given(st.integers(0, 1 << 32))
def test_exact_corners_have_levels_however_close(seed: int) -> None:
    assert found([1e-10, 0.0, 1e-10], 0.0, turned(seed)) == [1, 0, 1]


def test_less_than_the_rounding_of_a_corner_is_no_distance_unless_along_an_axis() -> None:
    rounding = Rounding(1e-6, EXACT)
    assert found([1e-6], 0.0, turned(3), rounding) == [0]
    assert found([1e-6], 0.0, np.eye(3), rounding) == [1]
    assert found([0.0], 0.0, np.eye(3), rounding) == [0]


def test_more_levels_than_are_looked_for_are_one() -> None:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(room, "MOST_LEVELS", 2)
        assert found([1e-3, 2e-3, 3e-3], 0.0, np.eye(3)) == [1, 2, 2]
