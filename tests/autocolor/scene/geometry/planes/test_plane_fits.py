from __future__ import annotations

import numpy as np
import pytest

from autocolor.scene.geometry.planes.plane_cells import facets
from autocolor.scene.geometry.planes.plane_fits import fitted, renumbered


def test_a_plane_is_fitted_to_each_group() -> None:
    square = np.array([(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0)], np.float64)
    corners = np.concatenate(
        [square, square + np.array([2, 0, 0]), square[:, [0, 2, 1]] + np.array([0, 3, 0])]
    )
    found = facets(corners.T[:, np.arange(12).reshape(3, 4).T])
    groups = np.array([0, 0, 1])
    fits = fitted(found, groups)
    assert np.abs(fits.normals.T) == pytest.approx(np.array([(0, 0, 1), (0, 1, 0)]))
    assert fits.points == pytest.approx(np.array([(2, 1), (1, 3), (0, 1)]))
    assert fits.widths == pytest.approx([2, 2])
    assert np.abs(fits.off(found.corners, np.array([1, 0, 0]))) == pytest.approx(
        np.array([(3, 0, 0), (3, 0, 0), (1, 0, 2), (1, 0, 2)])
    )


def test_no_groups_have_no_planes() -> None:
    found = facets(np.empty((3, 4, 0)))
    assert fitted(found, np.empty(0, np.intp)).normals.shape == (3, 0)


def test_group_numbers_are_closed_up() -> None:
    assert renumbered(np.array([2, 2, 5, 9, 9])).tolist() == [0, 0, 1, 2, 2]
