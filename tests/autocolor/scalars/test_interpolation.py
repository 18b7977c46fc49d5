from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from autocolor.rendering import rendering
from autocolor.scalars import interpolation
from autocolor.scalars.interpolation import corner_weights, interpolated, weighted_points
from autocolor.scene.scene import INVARIANT
from autocolor.testing import numbers, vectors
from tests.autocolor.reference import on_triangles, ray
from tests.autocolor.twins import level as plain
from tests.small import sphere, uneven_wall, wall_scene


def test_values_do_not_depend_on_the_chunks(monkeypatch: pytest.MonkeyPatch) -> None:
    scene = wall_scene(sphere(12, 8))
    points = rendering(scene, 24, 32).points
    node_rows = scene.mesh.node_numbers.T
    heights = scene.mesh.coordinates[:, 2]
    in_one: list[float] = []
    in_many: list[float] = []
    for found, most in ((in_one, 1 << 14), (in_many, 7)):
        monkeypatch.setattr(interpolation, "POINTS_AT_ONCE", most)
        found.extend(
            interpolated(scene.mesh, points, lambda polygons: heights[node_rows[:, polygons]]).tolist()
        )
        chunks = list(weighted_points(scene.mesh, points))
    assert in_one == in_many
    assert len(chunks) > 10
    # A sphere of polygons is hardly within the true one.
    assert in_one == pytest.approx(points.world_points[:, 2], abs=0.03)


@given(st.integers(0, 99), vectors())
def test_a_linear_scalar_is_linear_on_warped_quads_if_interpolation_is_invariant(
    seed: int, factors: tuple[float, float, float]
) -> None:
    scene = wall_scene(uneven_wall(seed)).replace(interpolation=INVARIANT)
    points = rendering(scene, 24, 32).points
    values = scene.mesh.coordinates @ np.array(factors)
    node_rows = scene.mesh.node_numbers.T
    found = interpolated(scene.mesh, points, lambda polygons: values[node_rows[:, polygons]])
    assert found == pytest.approx(points.world_points @ np.array(factors), abs=2e-5)


def test_scalars_are_weighted_as_the_triangles_of_quads_are() -> None:
    scene = wall_scene(uneven_wall(7)).replace(interpolation=INVARIANT)
    points = rendering(scene, 24, 32).points
    values = np.random.default_rng(1).uniform(-1, 1, len(scene.mesh.coordinates))
    node_rows = scene.mesh.node_numbers.T
    found = interpolated(scene.mesh, points, lambda polygons: values[node_rows[:, polygons]])
    starts = scene.mesh.diagonals.some(points.polygon_numbers).starts
    checked = 0
    for number, polygon in enumerate(points.polygon_numbers.tolist()):
        corners = scene.mesh.coordinates[node_rows[:, polygon]].tolist()
        direction = ray(scene.view, 24, 32, *divmod(int(points.pixels[number]), 32))
        hit = on_triangles(corners, int(starts[number]), scene.view.eye, direction)
        if hit is not None and hit.clear > 1e-4:
            assert found[number] == pytest.approx(
                np.array(hit.weights) @ values[node_rows[:, polygon]], abs=1e-5
            )
            checked += 1
    assert checked > 300


Array = npt.NDArray[np.float64]


def weights_at(corners: object, points: object) -> Array:
    """The weights of one polygon's corners, (points, 4)."""
    table = np.array(corners, np.float64)
    table = table[[0, 1, 2, 2]] if len(table) == 3 else table
    within = np.array(points, np.float64).T
    weights: Array = corner_weights(table.T[:, :, None], np.array([within.shape[1]]), within).T
    return weights


def on_a_circle(turns: list[float]) -> Array:
    """A convex quad in an oblique plane, far from the origin."""
    places = np.array([(math.cos(turn), 3 * math.sin(turn)) for turn in turns])
    corners: Array = places @ np.array([(1.0, 0.25, -0.5), (-0.25, 1.0, 2.0)]) + (5.0, -7.0, 11.0)
    return corners


shares = st.lists(numbers(0.02, 1), min_size=4, max_size=4)
turns = shares.map(lambda gaps: [2 * math.pi * sum(gaps[:count]) / sum(gaps) for count in range(4)])


@given(turns, shares)
def test_weights_in_a_convex_quad_are_wachspress_coordinates(around: list[float], share: list[float]) -> None:
    corners = on_a_circle(around)
    point = np.array(share) @ corners / sum(share)
    assert weights_at(corners, [point])[0] == pytest.approx(
        plain.corner_weights(corners.tolist(), point.tolist()), abs=1e-9
    )


@given(turns, shares)
def test_a_linear_function_stays_linear_in_a_convex_quad(around: list[float], share: list[float]) -> None:
    corners = on_a_circle(around)
    point = np.array(share) @ corners / sum(share)
    assert weights_at(corners, [point])[0] @ corners == pytest.approx(point, abs=1e-9)


@given(st.tuples(vectors(), vectors(), vectors()), shares)
def test_weights_in_a_triangle_are_barycentric(corners: list[tuple[float, ...]], share: list[float]) -> None:
    table = np.array(corners)
    assume(np.linalg.norm(np.cross(table[1] - table[0], table[2] - table[0])) > 1e-3)
    wanted = np.array(share[:3]) / sum(share[:3])
    assert weights_at(table, [wanted @ table])[0] == pytest.approx([*wanted, 0], abs=1e-9)


def test_each_corner_has_all_the_weight_at_itself_and_none_on_the_sides_across() -> None:
    quad = on_a_circle([0.1, 1.5, 2.8, 5.0])
    assert weights_at(quad, quad) == pytest.approx(np.eye(4), abs=1e-12)
    halfway = (quad[0] + quad[1]) / 2
    assert weights_at(quad, [halfway])[0] == pytest.approx([0.5, 0.5, 0, 0], abs=1e-12)


@pytest.mark.parametrize("first", range(4))
def test_a_quad_with_a_notch_is_split_at_it(first: int) -> None:
    dart = [(0.0, 1.0, 0.0), (-2.0, -1.0, 0.0), (0.0, 4.0, 0.0), (2.0, -1.0, 0.0)]
    turned = [dart[(first + corner) % 4] for corner in range(4)]
    # In the left half: corners 0, 1 and 2 of the dart.
    wanted = np.array([0.2, 0.3, 0.5, 0.0])
    found = weights_at(turned, [wanted @ np.array(dart)])[0]
    assert found == pytest.approx([wanted[(first + corner) % 4] for corner in range(4)], abs=1e-12)
    # In the right half: corners 2, 3 and 0.
    wanted = np.array([0.2, 0.0, 0.3, 0.5])
    found = weights_at(turned, [wanted @ np.array(dart)])[0]
    assert found == pytest.approx([wanted[(first + corner) % 4] for corner in range(4)], abs=1e-12)


quads = st.lists(vectors(), min_size=4, max_size=4)


@given(quads, st.lists(vectors(), min_size=1, max_size=5))
def test_weights_of_any_polygon_at_any_point_are_shares(
    corners: list[tuple[float, ...]], points: list[tuple[float, ...]]
) -> None:
    weights = weights_at(corners, points)
    assert (weights >= 0).all()
    assert weights.sum(axis=1) == pytest.approx(1)


@pytest.mark.parametrize("thickness", [1e-3, 1e-6, 1e-9])
def test_a_sliver_has_weights_in_single_precision(thickness: float) -> None:
    corners = np.array([(0.0, 0.0), (2.0, 0.0), (1.5, 1.0), (0.5, 1.0)]) * (1, thickness)
    corners = np.concatenate([corners, np.zeros((4, 1))], axis=1)
    wanted = np.array([0.4, 0.3, 0.2, 0.1])
    place = (wanted @ corners)[:, None].astype(np.float32)
    weights = corner_weights(corners.T[:, :, None], np.array([1]), place)[:, 0]
    assert weights.dtype == np.float32
    assert weights @ corners[:, 0] == pytest.approx(place[0, 0], rel=1e-5)
    assert weights @ corners[:, 1] == pytest.approx(place[1, 0], rel=1e-5)


def test_a_warped_quad_is_seen_along_its_normal() -> None:
    warped = [(0.0, 0.0, 0.1), (1.0, 0.0, -0.1), (1.0, 1.0, 0.1), (0.0, 1.0, -0.1)]
    flat = [(x, y, 0.0) for x, y, _ in warped]
    assert weights_at(warped, [(0.2, 0.7, 0.05)]) == pytest.approx(weights_at(flat, [(0.2, 0.7, 0)]))


def test_polygons_of_all_kinds_can_be_mixed() -> None:
    square = [(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (1.0, 1.0, 0.0), (0.0, 1.0, 0.0)]
    triangle = [*square[:3], square[2]]
    dart = [(0.0, 1.0, 0.0), (-2.0, -1.0, 0.0), (0.0, 4.0, 0.0), (2.0, -1.0, 0.0)]
    points = [(0.25, 0.5, 0.0), (0.75, 0.5, 0.0), (0.75, 0.25, 0.0), (0.5, 1.0, 0.0)]
    corners = np.array([square, triangle, dart]).transpose(2, 1, 0)
    together = corner_weights(corners, np.array([2, 1, 1]), np.array(points).T).T
    alone = [
        *weights_at(square, points[:2]),
        *weights_at(triangle, points[2:3]),
        *weights_at(dart, points[3:]),
    ]
    assert together == pytest.approx(np.array(alone))
