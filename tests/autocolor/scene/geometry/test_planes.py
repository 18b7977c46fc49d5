from __future__ import annotations

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import Mesh
from autocolor.scene.geometry import planes
from autocolor.scene.geometry.normals import group_numbers
from autocolor.scene.geometry.planes import (
    EXACT,
    Rounding,
    ScaledPolygons,
    SharedPlanes,
    coordinate_rounding,
    coplanar_groups,
    facets_of,
    levels,
    plane_cells,
    shared_planes,
)
from autocolor.testing import meshes
from tests.autocolor.decals import ROUNDINGS, decal_on_ground
from tests.small import cube, grid, sphere
from tests.tables import first

GROUND = grid(3, 2, (-1, 0, -1), (2, 0, 0), (0, 0, 2), "ground")
DECAL = grid(2, 2, (-0.4, 0, -0.3), (0.5, 0, 0.1), (-0.1, 0, 0.5), "decal")


def shared_by(*parts: Mesh) -> SharedPlanes | None:
    return Mesh.joined(parts).shared_planes


def moved(mesh: Mesh, coordinates: npt.NDArray[np.float64]) -> Mesh:
    return Mesh(coordinates, mesh.node_numbers, mesh.part_numbers, mesh.part_names)


def shifted(mesh: Mesh, *by: float) -> Mesh:
    return moved(mesh, mesh.coordinates + np.array(by))


@given(st.integers(0, 1 << 32), st.sampled_from(ROUNDINGS))
def test_a_decal_and_its_ground_share_a_plane_however_their_corners_are_rounded(
    seed: int, rounding: str
) -> None:
    mesh, _ = decal_on_ground(seed, rounding)
    shared = mesh.shared_planes
    assert shared is not None
    assert (shared.plane_of_polygon == 0).all()
    corners = mesh.coordinates[mesh.node_numbers]
    off = np.abs((corners - shared.points[:, 0]) @ shared.normals[:, 0])
    assert off.max() == pytest.approx(shared.distances[0], abs=1e-12)
    assert shared.distances[0] < {"none": 1e-12, "float32": 1e-6, "decimals": 2e-6}[rounding]


@given(st.integers(0, 1 << 32))
def test_a_polygon_is_turned_if_it_runs_the_other_way_round_than_its_plane(seed: int) -> None:
    mesh, _ = decal_on_ground(seed)
    reversed_ = np.random.default_rng(seed).random(len(mesh.node_numbers)) < 0.5
    rows = np.where(reversed_[:, None], mesh.node_numbers[:, ::-1], mesh.node_numbers)
    shared = shared_planes(mesh.coordinates, rows)
    assert shared is not None
    assert (shared.turned == reversed_).all() or (shared.turned == ~reversed_).all()


@pytest.mark.parametrize("factor", [2.0**-1000, 2.0**-60, 2.0**60])
def test_planes_are_found_alike_in_meshes_of_any_size(factor: float) -> None:
    mesh = Mesh.joined([cube(), shifted(DECAL, 0.5, 0, 0.5)])
    shared, other = mesh.shared_planes, moved(mesh, mesh.coordinates * factor).shared_planes
    assert shared is not None
    assert other is not None
    assert other.plane_of_polygon.tolist() == shared.plane_of_polygon.tolist()
    # The front of the cube and the decal.
    assert np.flatnonzero(shared.plane_of_polygon >= 0).tolist() == [2, 6, 7, 8, 9]


BESIDE = [shifted(DECAL, x, 0, z) for x in (0, 0.7, 1.4) for z in (0, 0.8)]


@pytest.mark.parametrize("mesh", [cube(), sphere(), sphere(300, 150), GROUND, Mesh.joined(BESIDE)])
def test_polygons_that_only_adjoin_or_lie_side_by_side_share_no_plane(mesh: Mesh) -> None:
    assert mesh.shared_planes is None
    # Nor do they if they repeat their nodes, or differ in winding.
    apart = mesh.coordinates[mesh.node_numbers].reshape(-1, 3)
    numbers = np.arange(len(apart)).reshape(-1, 4)
    numbers[::2] = numbers[::2, ::-1]
    assert shared_planes(apart, numbers) is None


def test_patches_in_the_plane_of_one_that_is_there_twice_share_it() -> None:
    shared = shared_by(*BESIDE, BESIDE[1])
    assert shared is not None
    assert set(shared.plane_of_polygon.tolist()) == {0}


def test_a_polygon_folded_over_its_neighbor_shares_its_plane() -> None:
    corners = np.array([(0, 0, 0), (1, 0, 0), (1, 0, 1), (0.2, 0, 0.9)], np.float64)
    folded = shared_planes(corners, np.array([(0, 1, 2, 2), (0, 1, 3, 3)]))
    assert folded is not None
    assert folded.plane_of_polygon.tolist() == [0, 0]


@pytest.mark.parametrize(("height", "shares"), [(0.0, True), (1e-6, True), (1e-5, False)])
def test_a_decal_no_farther_from_its_ground_than_both_are_rounded_shares_its_plane(
    height: float, shares: bool
) -> None:
    mesh = Mesh.joined([GROUND, shifted(DECAL, 0, height, 0)])
    turn, _ = np.linalg.qr(np.random.default_rng(5).normal(size=(3, 3)))
    assert (moved(mesh, (mesh.coordinates @ turn).round(6)).shared_planes is not None) == shares


@pytest.mark.parametrize("sides", [12, 100, 1000])
def test_the_sides_of_two_coincident_cylinders_turned_a_little_share_no_plane(
    sides: int,
) -> None:
    def around(turn: float) -> Mesh:
        angle = (np.arange(sides) + turn) * (2 * np.pi / sides)
        ring = np.stack([np.cos(angle), np.sin(angle), np.zeros(sides)], axis=1)
        first, second = np.arange(sides), np.roll(np.arange(sides), -1)
        quads = np.stack([first, second, second + sides, first + sides], axis=1)
        return Mesh(
            np.concatenate([ring, ring + np.array([0, 0, 1])]),
            quads,
            np.zeros(sides, np.intp),
            (f"side {turn}",),
        )

    assert shared_by(around(0.0), around(0.5)) is None


@given(meshes())
def test_no_corner_is_farther_from_its_plane_than_the_distance_says(mesh: Mesh) -> None:
    shared = mesh.shared_planes
    if shared is not None:
        polygons = np.flatnonzero(shared.plane_of_polygon >= 0)
        plane = shared.plane_of_polygon[polygons]
        assert sorted(set(plane.tolist())) == list(range(len(shared.distances)))
        assert (np.bincount(plane) > 1).all()
        away = mesh.coordinates[mesh.node_numbers[polygons]] - shared.points.T[plane][:, None]
        off = np.abs((away * shared.normals.T[plane][:, None]).sum(axis=2)).max(axis=1)
        assert (off <= shared.distances[plane] + 1e-12).all()
        assert shared.distances.max() < 1e-4


def test_a_mesh_without_polygons_or_without_extent_has_no_shared_planes() -> None:
    assert shared_planes(np.empty((0, 3)), np.empty((0, 4), np.intp)) is None
    assert shared_planes(np.ones((3, 3)), np.array([[0, 1, 2, 2], [0, 1, 2, 2]])) is None


@pytest.mark.parametrize("distance", [1e-5, 1e-4, 2e-4, 1.9e-3])
@pytest.mark.parametrize("turn", [np.eye(3), np.linalg.qr(np.random.default_rng(1).normal(size=(3, 3)))[0]])
def test_posters_in_front_of_a_wall_in_a_large_scene_have_a_plane_of_their_own(
    distance: float, turn: npt.NDArray[np.float64]
) -> None:
    wall = grid(2, 2, (-10, 0, -10), (20, 0, 0), (0, 0, 20), "wall")
    posters = [grid(1, 1, (x, -distance, x), (1, 0, 0), (0, 0, 1), f"poster {x}") for x in (-5, 0, 3)]
    far = grid(1, 1, (-500, -500, -30), (1000, 0, 0), (0, 1000, 0), "ground")
    mesh = Mesh.joined([*posters, wall, far])
    mesh = moved(mesh, mesh.coordinates @ turn)
    assert mesh.shared_planes is None
    # Decals on the posters share their plane, and not that of the wall.
    decals = [shifted(poster, 0.1, 0, 0.1) for poster in posters]
    mesh = Mesh.joined([*posters, *decals, wall, far])
    shared = moved(mesh, mesh.coordinates @ turn).shared_planes
    assert shared is not None
    assert (shared.plane_of_polygon[6:] < 0).all()
    assert (shared.plane_of_polygon[:6] >= 0).all()


def test_a_third_polygon_at_an_edge_shares_the_plane_of_the_two_others() -> None:
    # Two halves of a square, and a smaller triangle at their diagonal.
    corners = np.array([(0, 0, 0), (1, 0, 0), (1, 0, 1), (0, 0, 1), (0.4, 0, 0.6)], np.float64)
    numbers = np.array([(0, 1, 2, 2), (0, 2, 3, 3), (0, 2, 4, 4)])
    for order in ([0, 1, 2], [2, 0, 1], [0, 2, 1]):
        shared = shared_planes(corners, numbers[order])
        assert shared is not None
        over = shared.plane_of_polygon[np.argsort(order)].tolist()
        assert over[1:] == [0, 0]


@pytest.mark.parametrize("seed", first(1, [19, 31, 35, 48]))
def test_a_finely_divided_ground_with_decals_is_one_plane(seed: int) -> None:
    # No polygon is large enough to tell the plane of all others, and corners are rounded to float32.
    random = np.random.default_rng(seed)
    flat = grid(170, 170, (-1, -1, 0), (2, 0, 0), (0, 2, 0), "ground")
    moves = random.uniform(-0.4, 0.4, (len(flat.coordinates), 2)) * (2 / 170)
    ground = moved(flat, flat.coordinates + np.c_[moves, np.zeros(len(moves))])
    decals = [
        grid(1, 1, (x, y, 0), (0.02, 0.002 * k, 0), (-0.002 * k, 0.02, 0), f"decal {k}")
        for k, (x, y) in enumerate(random.uniform(-0.8, 0.8, (40, 2)))
    ]
    mesh = Mesh.joined([ground, *decals])
    turn, _ = np.linalg.qr(random.normal(size=(3, 3)))
    rounded = (mesh.coordinates @ turn + random.normal(size=3)).astype(np.float32).astype(np.float64)
    shared = moved(mesh, rounded).shared_planes
    assert shared is not None
    assert set(shared.plane_of_polygon.tolist()) == {0}


RANDOM = np.random.default_rng(7).uniform(-3, 3, (3, 30))
LARGEST = float(np.abs(RANDOM).max())


def test_random_numbers_are_exact_but_for_a_few_units_in_the_last_place() -> None:
    assert coordinate_rounding(RANDOM).most == pytest.approx(EXACT * LARGEST)


@given(st.integers(-100, 100))
def test_numbers_rounded_to_single_precision_are_rounded_by_half_a_unit_in_the_last_place(power: int) -> None:
    scaled = RANDOM * 2.0**power
    singles = scaled.astype(np.float32).astype(np.float64)
    rounding = coordinate_rounding(singles)
    assert (np.abs(singles - scaled) <= rounding.most).all()
    assert (np.abs(singles - scaled) <= rounding.fraction * np.abs(scaled)).all()
    assert rounding.most <= 2.0**-23 * np.abs(scaled).max()


@given(st.integers(0, 9), st.integers(0, 1 << 32))
def test_numbers_with_some_decimals_are_rounded_by_half_a_unit_in_the_last(decimals: int, seed: int) -> None:
    exact = np.random.default_rng(seed).uniform(-100, 100, (3, 30)) + 0.123456789
    rounding = coordinate_rounding(exact.round(decimals))
    # Whole numbers are numbers in single precision, too.
    expected = 10.0**-decimals / 2 if decimals else 2.0**-24 * np.abs(exact.round()).max()
    assert rounding.most == pytest.approx(expected)
    assert rounding.fraction == (EXACT if decimals else 2.0**-24)


def test_numbers_that_were_moved_after_they_were_rounded_show_it() -> None:
    moved = RANDOM.round(6) + np.array([[1 / 3], [0.1], [-5]])
    assert coordinate_rounding(moved).most == pytest.approx(5e-7)
    assert not coordinate_rounding(moved * (1 / 3)).known


def groups_of(
    rows: npt.NDArray[np.float64], node_rows: npt.NDArray[np.intp], tolerance: float
) -> npt.NDArray[np.intp]:
    mesh = ScaledPolygons(rows, node_rows)
    return group_numbers(coplanar_groups(mesh, plane_cells(mesh, tolerance), tolerance))


@given(st.integers(0, 1 << 32), st.integers(64, 200))
def test_parallel_planes_in_one_cell_are_told_apart(seed: int, at_once: int) -> None:
    mesh, _ = decal_on_ground(seed)
    rows = (mesh.coordinates / 8).T
    normal = facets_of(rows[:, mesh.node_numbers.T]).normals[:, 0]
    heights = (0, 1e-4, 3e-4)
    layers = np.concatenate([rows + height * normal[:, None] for height in heights], axis=1)
    nodes, count = rows.shape[1], len(mesh.node_numbers)
    numbers = np.concatenate([mesh.node_numbers + layer * nodes for layer in range(len(heights))])
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(planes, "POLYGONS_AT_ONCE", at_once)
        groups = groups_of(layers, numbers.T, 2e-6)
    assert groups.tolist() == np.repeat([0, 1, 2], count).tolist()


def test_polygons_without_area_and_warped_ones_stay_alone() -> None:
    corners = np.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 1, 0.1)], np.float64)
    numbers = np.array([(0, 1, 2, 3), (0, 1, 2, 4), (0, 1, 1, 1), (0, 1, 2, 2)])
    assert groups_of(corners.T, numbers.T, 1e-6).tolist() == [0, 1, 2, 0]


WALL = grid(4, 3, (-0.5, 0, -0.4), (1, 0, 0), (0, 0, 0.8))
POSTER = grid(1, 1, (-0.1, 0, -0.2), (0.3, 0, 0), (0, 0, 0.2))
NONE = Rounding(EXACT, EXACT)


def levels_of(
    heights: list[float],
    noise: float,
    turn: npt.NDArray[np.float64],
    rounding: Rounding = NONE,
    beside: float = 0.0,
) -> list[int]:
    """The levels of a wall and posters at some heights; the corners are noisy, and then turned."""
    random = np.random.default_rng(len(heights))
    posters = [
        POSTER.coordinates + np.array([beside + 0.05 * k, height, 0]) for k, height in enumerate(heights)
    ]
    corners = np.concatenate([WALL.coordinates, *posters])
    corners[:, 1] += random.uniform(-noise, noise, len(corners))
    first_nodes = range(len(WALL.coordinates), len(corners), 4)
    numbers = np.concatenate([WALL.node_numbers, *(POSTER.node_numbers + first for first in first_nodes)])
    patches = np.array([0] * len(WALL.node_numbers) + list(range(1, len(heights) + 1)))
    given_levels = levels(
        facets_of((corners @ turn).T[:, numbers.T]),
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


@given(st.integers(0, 1 << 32))
def test_patches_farther_than_they_are_scattered_have_levels_of_their_own(seed: int) -> None:
    heights = [1e-6, 0.0, -2e-6, 1e-6, 0.0]
    assert levels_of(heights, 1e-8, turned(seed), Rounding(1e-8, EXACT)) in ([1, 0, 2, 1, 0], [2, 0, 1, 2, 0])


def test_the_farther_a_patch_is_from_the_largest_the_less_its_distance_counts() -> None:
    rounding = Rounding(1e-6, EXACT)
    # The wall is 1 x 0.8: ten units beside it, its plane is off by some 25 times the rounding of a corner.
    found = [levels_of([height], 0.0, turned(3), rounding, 10.0) for height in (6e-5, 3e-4)]
    assert found == [[0], [1]]
    assert levels_of([6e-5], 0.0, turned(3), rounding) == [1]


def test_less_than_the_rounding_of_a_corner_is_no_distance_unless_along_an_axis() -> None:
    rounding = Rounding(1e-6, EXACT)
    assert levels_of([1e-6], 0.0, turned(3), rounding) == [0]
    assert levels_of([1e-6], 0.0, np.eye(3), rounding) == [1]
    assert levels_of([0.0], 0.0, np.eye(3), rounding) == [0]
    # Exact corners have levels however close.
    assert levels_of([1e-10, 0.0, 1e-10], 0.0, turned(3)) == [1, 0, 1]
