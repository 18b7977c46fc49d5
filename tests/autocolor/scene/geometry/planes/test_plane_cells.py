from __future__ import annotations

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor.scene.geometry.planes import plane_cells as room
from autocolor.scene.geometry.planes.plane_cells import coplanar_groups, facets, plane_cells
from autocolor.scene.geometry.planes.scaled_nodes import as_they_are
from autocolor.scene.geometry.union_find import group_numbers
from tests.autocolor.meshes import decal_on_ground


def groups_of(
    rows: npt.NDArray[np.float64], node_rows: npt.NDArray[np.intp], tolerance: float
) -> npt.NDArray[np.intp]:
    nodes = as_they_are(rows)
    cells = plane_cells(nodes, node_rows, tolerance)
    return group_numbers(coplanar_groups(nodes, node_rows, cells, tolerance))


def test_the_width_of_a_facet_is_across_the_longer_diagonal_or_the_longer_of_two_sides() -> None:
    corners = np.array([(0, 0, 0), (2, 0, 0), (2, 1, 0), (0, 1, 0), (3, 3, 0)], np.float64)
    found = facets(corners.T[:, np.array([(0, 1, 2, 3), (0, 1, 2, 2), (0, 2, 1, 1), (0, 1, 1, 1)]).T])
    assert found.normals[:, :3].T.tolist() == [[0, 0, 1], [0, 0, 1], [0, 0, -1]]
    assert found.widths.tolist() == pytest.approx([4 / 5**0.5, 2 / 5**0.5, 1, 0])
    assert found.areas.tolist() == pytest.approx([4, 2, 2, 0])
    assert found.normals[:, 3].tolist() == [0, 0, 0]


@given(st.integers(0, 1 << 32), st.integers(64, 200))
def test_parallel_planes_in_one_cell_are_told_apart(seed: int, at_once: int) -> None:
    mesh, _ = decal_on_ground(seed)
    rows = (mesh.coordinates / 8).T
    normal = facets(rows[:, mesh.node_numbers.T]).normals[:, 0]
    heights = (0, 1e-4, 3e-4)
    layers = np.concatenate([rows + height * normal[:, None] for height in heights], axis=1)
    nodes, count = rows.shape[1], len(mesh.node_numbers)
    numbers = np.concatenate([mesh.node_numbers + layer * nodes for layer in range(len(heights))])
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(room, "POLYGONS_AT_ONCE", at_once)
        groups = groups_of(layers, numbers.T, 2e-6)
    assert groups.tolist() == np.repeat([0, 1, 2], count).tolist()


def test_polygons_without_area_and_warped_ones_stay_alone() -> None:
    corners = np.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 1, 0.1)], np.float64)
    numbers = np.array([(0, 1, 2, 3), (0, 1, 2, 4), (0, 1, 1, 1), (0, 1, 2, 2)])
    assert groups_of(corners.T, numbers.T, 1e-6).tolist() == [0, 1, 2, 0]


def test_only_the_widest_polygons_are_grounds() -> None:
    mesh, _ = decal_on_ground(3)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(room, "MOST_GROUNDS", 1)
        groups = groups_of((mesh.coordinates / 8).T, mesh.node_numbers.T, 2e-6)
    # All lie in the plane of the widest.
    assert groups.tolist() == [0] * len(groups)


@given(st.integers(0, 1 << 32))
def test_a_large_mesh_keeps_the_low_bits_of_hashes_and_finds_the_same_groups(seed: int) -> None:
    mesh, _ = decal_on_ground(seed)
    rows, node_rows = (mesh.coordinates / 8).T, mesh.node_numbers.T
    whole = groups_of(rows, node_rows, 2e-6)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(room, "LARGE", 0)
        nodes = as_they_are(rows)
        cells = plane_cells(nodes, node_rows, 2e-6)
        assert cells.hashes.dtype == np.uint32
        assert groups_of(rows, node_rows, 2e-6).tolist() == whole.tolist()
    kept = plane_cells(nodes, node_rows, 2e-6)
    every = np.arange(len(mesh.node_numbers))
    for grid in range(len(room.SHIFTS)):
        keys = cells.keys(nodes, node_rows, every, grid)
        assert keys.tolist() == kept.hashes[grid].tolist()
        assert keys.astype(np.uint32).tolist() == cells.hashes[grid].tolist()
