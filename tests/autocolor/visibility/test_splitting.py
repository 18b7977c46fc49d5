from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor.visibility.splitting import split_quads

DART = [(0, 0), (2, 5), (4, 0), (2, 1)]
BOW_TIE = [(0, 0), (4, 3), (4, 0), (0, 5)]


def triangles(
    corners: Sequence[tuple[float, float]], order: npt.NDArray[np.intp], depths: Sequence[float] | None = None
) -> list[frozenset[int]]:
    """The nodes of the two triangles of a quad, first the one that comes first."""
    x, y = np.array(corners, np.float64).T
    positions = np.stack([x, y, np.array(depths or [1.0] * 4)])
    columns = np.array(order, np.intp)[:, None]
    split, normals, parents = split_quads(np.array([0]), x, y, positions, columns, columns)
    assert split.tolist() == normals.tolist()
    assert parents.tolist() == [0, 0]
    return [frozenset(column.tolist()) for column in split.T]


@pytest.mark.parametrize("turn", range(4))
def test_a_dart_is_split_from_its_notch(turn: int) -> None:
    halves = triangles(DART, np.roll(np.arange(4), turn))
    assert all({1, 3} <= half for half in halves)


@pytest.mark.parametrize("turn", range(4))
def test_a_quad_that_crosses_itself_is_split_along_its_shorter_diagonal_in_space(turn: int) -> None:
    order = np.roll(np.arange(4), turn)
    assert all({0, 2} <= half for half in triangles(BOW_TIE, order))
    assert all({1, 3} <= half for half in triangles(BOW_TIE, order, [1.0, 2.0, 9.0, 2.0]))


@given(
    st.lists(st.tuples(st.integers(0, 4), st.integers(0, 4)), min_size=4, max_size=4, unique=True),
    st.integers(0, 3),
    st.booleans(),
)
def test_the_triangles_do_not_depend_on_the_corner_that_is_written_first(
    corners: list[tuple[float, float]], turn: int, backward: bool
) -> None:
    order = np.roll(np.arange(4), turn)
    assert triangles(corners, order[::-1] if backward else order) == triangles(corners, np.arange(4))


def test_triangles_take_the_place_of_their_quad_and_keep_its_winding() -> None:
    x, y = np.array([*DART, (9, 9), (9, 8), (8, 8)], np.float64).T
    positions = np.stack([x, y, np.ones(7)])
    columns = np.array([(4, 5, 6, 6), (0, 1, 2, 3), (6, 5, 4, 4)]).T
    split, _, parents = split_quads(np.array([1]), x, y, positions, columns, columns)
    assert parents.tolist() == [0, 1, 1, 2]
    assert split[:, [0, 3]].tolist() == columns[:, [0, 2]].tolist()
    for column in split[:, 1:3].T.tolist():
        # The nodes of a triangle follow each other around the quad as they did.
        assert column[2] == column[3]
        steps = np.diff([*column[:3], column[0]]) % 4
        assert steps.sum() == 4
