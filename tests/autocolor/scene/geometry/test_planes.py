from __future__ import annotations

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import Mesh
from autocolor.scene.geometry.planes import SharedPlanes, shared_planes
from autocolor.testing import meshes
from tests.autocolor.decals import ROUNDINGS, decal_on_ground
from tests.small import cube, grid, sphere

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


@pytest.mark.parametrize("mesh", [cube(), sphere(), sphere(300, 150), GROUND])
def test_polygons_that_only_adjoin_share_no_plane(mesh: Mesh) -> None:
    assert mesh.shared_planes is None
    # Nor do they if they repeat their nodes, or differ in winding.
    apart = mesh.coordinates[mesh.node_numbers].reshape(-1, 3)
    numbers = np.arange(len(apart)).reshape(-1, 4)
    numbers[::2] = numbers[::2, ::-1]
    assert shared_planes(apart, numbers) is None


def test_a_polygon_folded_over_its_neighbor_shares_its_plane() -> None:
    corners = np.array([(0, 0, 0), (1, 0, 0), (1, 0, 1), (0.2, 0, 0.9)], np.float64)
    folded = shared_planes(corners, np.array([(0, 1, 2, 2), (0, 1, 3, 3)]))
    assert folded is not None
    assert folded.plane_of_polygon.tolist() == [0, 0]


@pytest.mark.parametrize(("height", "shares"), [(0.0, True), (1e-6, True), (5e-5, False)])
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


@pytest.mark.parametrize("distance", [2e-4, 1.9e-3])
@pytest.mark.parametrize("turn", [np.eye(3), np.linalg.qr(np.random.default_rng(1).normal(size=(3, 3)))[0]])
def test_posters_in_front_of_a_wall_in_a_large_scene_share_a_plane_with_their_decals_alone(
    distance: float, turn: npt.NDArray[np.float64]
) -> None:
    wall = grid(2, 2, (-10, 0, -10), (20, 0, 0), (0, 0, 20), "wall")
    posters = [grid(1, 1, (x, -distance, x), (1, 0, 0), (0, 0, 1), f"poster {x}") for x in (-5, 0, 3)]
    decals = [shifted(poster, 0.1, 0, 0.1) for poster in posters]
    far = grid(1, 1, (-500, -500, -30), (1000, 0, 0), (0, 1000, 0), "ground")
    mesh = Mesh.joined([*posters, *decals, wall, far])
    shared = moved(mesh, mesh.coordinates @ turn).shared_planes
    assert shared is not None
    assert shared.plane_of_polygon.tolist() == 6 * [0] + 5 * [-1]


def test_a_third_polygon_at_an_edge_shares_the_plane_of_the_two_others() -> None:
    # Two halves of a square, and a smaller triangle at their diagonal.
    corners = np.array([(0, 0, 0), (1, 0, 0), (1, 0, 1), (0, 0, 1), (0.4, 0, 0.6)], np.float64)
    numbers = np.array([(0, 1, 2, 2), (0, 2, 3, 3), (0, 2, 4, 4)])
    for order in ([0, 1, 2], [2, 0, 1], [0, 2, 1]):
        shared = shared_planes(corners, numbers[order])
        assert shared is not None
        over = shared.plane_of_polygon[np.argsort(order)].tolist()
        assert over[1:] == [0, 0]


def test_a_finely_divided_ground_with_decals_is_one_plane() -> None:
    # No polygon is large enough to tell the plane of all others, and corners are rounded to float32.
    random = np.random.default_rng(19)
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


@pytest.mark.parametrize("size", [1e-2, 1.0, 1e3])
def test_a_decal_of_six_digits_shares_the_plane_of_its_ground_whatever_the_unit(size: float) -> None:
    shares = 0
    for seed in range(20):
        mesh, _ = decal_on_ground(seed)
        digits = [float(f"{value:.6g}") for value in (mesh.coordinates * size).ravel().tolist()]
        shared = moved(mesh, np.array(digits).reshape(-1, 3)).shared_planes
        shares += shared is not None and bool((shared.plane_of_polygon == 0).all())
    assert shares >= 19


def test_polygons_without_area_and_warped_ones_have_their_own_depth() -> None:
    corners = np.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 1, 0.1)], np.float64)
    shared = shared_planes(corners, np.array([(0, 1, 2, 3), (0, 1, 2, 4), (0, 1, 1, 1), (0, 1, 2, 2)]))
    assert shared is not None
    assert shared.plane_of_polygon.tolist() == [0, -1, -1, 0]


def test_a_wide_plane_is_found_in_a_chunk_and_among_small_polygons() -> None:
    # More polygons than a chunk in one cell, and more than are compared with all others.
    mesh = Mesh.joined([grid(200, 100, (-1, 0, -1), (2, 0, 0), (0, 0, 2)), shifted(DECAL, 0.001, 0, 0.001)])
    shared = mesh.shared_planes
    assert shared is not None
    assert set(shared.plane_of_polygon.tolist()) == {0}


def test_six_decimals_are_enough_for_small_things_at_the_origin_of_a_large_scene() -> None:
    far = grid(1, 1, (9, 9, 9), (1, 0, 0), (0, 1, 0), "far")
    turn, _ = np.linalg.qr(np.random.default_rng(5).normal(size=(3, 3)))
    small = Mesh.joined([GROUND, DECAL])
    shared = shared_by(moved(small, (small.coordinates @ turn * 0.1).round(6)), far)
    assert shared is not None
    assert shared.plane_of_polygon.tolist() == 10 * [0] + [-1]


def test_a_poster_in_front_of_a_wall_keeps_its_depth_however_far_they_are_from_the_origin() -> None:
    poster = shifted(DECAL, 0, -6e-5, 0)
    assert shared_by(*(shifted(part, 500_000, 5_000_000, 0) for part in (poster, GROUND))) is None
