from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given

from autocolor import Mesh
from autocolor.checks import Vector
from autocolor.scene.geometry import diagonals as module
from autocolor.scene.geometry.diagonals import NO_DIAGONAL, quad_diagonals
from autocolor.testing import meshes
from tests.small import grid, sphere

DART = [(0.0, 0.0, 0.0), (2.0, 5.0, 0.0), (4.0, 0.0, 0.0), (2.0, 1.0, 0.0)]
SQUARE = [(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (1.0, 1.0, 0.0), (0.0, 1.0, 0.0)]
LONG = [(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (3.0, 1.0, 0.0), (2.0, 1.0, 0.0)]
STRAIGHT = [(0.0, 0.0, 0.0), (3.0, 0.0, 0.0), (6.0, 0.0, 0.0), (3.0, 20.0, 0.0)]


def ends_and_warp(corners: list[Vector], polygon: list[int]) -> tuple[set[int], float]:
    """The nodes at the ends of the diagonal of one quad, and its warp."""
    (start,), (warp,) = Mesh(np.array(corners), np.array([polygon])).diagonals
    return {polygon[int(start)], polygon[int(start) + 2]}, float(warp)


@pytest.mark.parametrize("turn", range(4))
@pytest.mark.parametrize("backward", [False, True])
@pytest.mark.parametrize(
    ("corners", "ends", "convex"),
    [
        (DART, {1, 3}, False),
        (LONG, {1, 3}, True),
        # The shorter diagonal would leave a triangle without area.
        (STRAIGHT, {1, 3}, False),
        # Equally long: through the lowest node, in spite of the last digits.
        (SQUARE, {0, 2}, True),
        ([*SQUARE[:2], (1.0 + 1e-9, 1.0, 0.0), SQUARE[3]], {0, 2}, True),
        ([SQUARE[0], (1.0 + 1e-9, 0.0, 0.0), *SQUARE[2:]], {0, 2}, True),
    ],
)
def test_the_diagonal_lies_inside_and_is_the_shorter_one(
    corners: list[Vector], ends: set[int], convex: bool, turn: int, backward: bool
) -> None:
    polygon = np.roll([0, 1, 2, 3], turn)[:: -1 if backward else 1].tolist()
    assert ends_and_warp(corners, polygon) == (ends, 0 if convex else np.inf)


@pytest.mark.parametrize("size", [1e-30, 1.0, 1e30])
def test_the_warp_is_the_distance_between_the_diagonals(size: float) -> None:
    warped = [(x * size, y * size, z * size) for x, y, z in [*SQUARE[:2], (1.0, 1.0, 0.0), (0.0, 1.0, 0.1)]]
    (_,), (warp,) = Mesh(np.array(warped), np.array([[0, 1, 2, 3]])).diagonals
    # The lines from (0, 0, 0) along (1, 1, 0), and from (1, 0, 0) along (-1, 1, 0.1).
    normal = np.cross((1, 1, 0), (-1, 1, 0.1))
    assert warp == pytest.approx(size * abs(normal[0]) / np.linalg.norm(normal), rel=1e-6)


@pytest.mark.parametrize("place", range(4))
def test_a_triangle_is_not_cut_whichever_node_it_repeats(place: int) -> None:
    polygon = np.roll([0, 1, 2, 2], place)
    (start,), (warp,) = Mesh(np.array(SQUARE), polygon[None]).diagonals
    # Without a diagonal, it is the triangle of the first three corners.
    assert start == (NO_DIAGONAL if place < 2 else 0)
    halves = (
        [[0, 1, 2]]
        if start == NO_DIAGONAL
        else [[start, start + 1, start + 2], [start + 2, start + 3, start]]
    )
    assert [len({int(polygon[corner % 4]) for corner in half}) for half in halves].count(3) == 1
    assert warp == 0


def test_a_regular_grid_is_cut_in_one_direction() -> None:
    mesh = grid(9, 7, (-1, 0.1, -1), (2, 0.3, 0), (-0.3 / 7, 2 / 7, 0.7))
    assert len(set(mesh.diagonals.starts.tolist())) == 1


@given(meshes())
def test_diagonals_do_not_depend_on_the_chunks(mesh: Mesh) -> None:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(module, "POLYGONS_AT_ONCE", 2)
        in_chunks = quad_diagonals(mesh.coordinates, mesh.node_numbers)
    assert in_chunks.starts.tolist() == mesh.diagonals.starts.tolist()
    assert in_chunks.warps.tolist() == mesh.diagonals.warps.tolist()


def test_diagonals_are_shared_with_a_mesh_of_other_scalars() -> None:
    mesh = sphere()
    diagonals = mesh.diagonals
    assert mesh.with_scalars().diagonals is diagonals
