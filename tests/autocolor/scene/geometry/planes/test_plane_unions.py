from __future__ import annotations

import numpy as np
import numpy.typing as npt
import pytest

from autocolor.scene.geometry.planes.plane_cells import plane_cells
from autocolor.scene.geometry.planes.plane_unions import unite_in_fitted_planes
from autocolor.scene.geometry.planes.scaled_nodes import as_they_are
from autocolor.scene.geometry.union_find import group_numbers
from tests.autocolor.meshes import grid

TOLERANCE = 2e-6
FLAT = grid(8, 6, (-0.5, -0.4, 0), (1, 0, 0.2), (0, 0.8, 0.1))


def united(
    rows: npt.NDArray[np.float64], node_rows: npt.NDArray[np.intp], parents: list[int]
) -> npt.NDArray[np.intp]:
    nodes, found = as_they_are(rows), np.array(parents)
    cells = plane_cells(nodes, node_rows, TOLERANCE)
    unite_in_fitted_planes(nodes, node_rows, found, cells, TOLERANCE)
    return group_numbers(found)


def halves(height: float) -> npt.NDArray[np.intp]:
    # The two halves are apart, so that they share no node.
    rows, numbers = FLAT.coordinates.T, FLAT.node_numbers
    both = np.concatenate([rows, rows + height * np.array([[0], [0], [1]])], axis=1)
    nodes = np.concatenate([numbers[:24], numbers[24:] + rows.shape[1]]).T
    return united(both, nodes, [0] * 24 + [24] * 22 + [46, 47])


def test_groups_in_one_plane_are_united_and_so_are_polygons_that_were_left_out() -> None:
    assert halves(0.0).tolist() == [0] * 48


@pytest.mark.parametrize("height", [1e-5, 1e-3])
def test_groups_in_planes_apart_are_not_united(height: float) -> None:
    assert halves(height).tolist() == [0] * 24 + [1] * 24


def test_polygons_that_are_all_alone_stay_alone() -> None:
    rows, node_rows = FLAT.coordinates.T, FLAT.node_numbers.T
    assert united(rows, node_rows, list(range(48))).tolist() == list(range(48))
