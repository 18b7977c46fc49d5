from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from autocolor import Mesh, View
from autocolor.arrays import Floats
from autocolor.checks import Vector
from autocolor.testing import meshes, outside_views, views
from autocolor.visibility import camera as camera_module
from autocolor.visibility.camera import (
    CameraPolygons,
    camera_space,
    clipped_at_near_plane,
)
from tests.autocolor.twins.point import dot, minus
from tests.small import cube, grid


@given(meshes(), views() | outside_views())
def test_positions_are_along_right_down_and_forward_from_the_eye(mesh: Mesh, view: View) -> None:
    camera = camera_space(mesh, view)
    for node, coordinates in enumerate(mesh.coordinates.tolist()):
        from_eye = minus(coordinates, view.eye)
        expected = [dot(axis, from_eye) for axis in view.axes.tolist()]
        assert (camera.positions[:, node] * camera.unit).tolist() == pytest.approx(expected, abs=1e-12)


@given(meshes(), views() | outside_views())
def test_the_unit_is_a_power_of_two_that_the_object_fits_in(mesh: Mesh, view: View) -> None:
    camera = camera_space(mesh, view)
    assert math.frexp(camera.unit)[0] == 0.5
    used = camera.positions[:, mesh.node_numbers]
    assert np.abs(used).max() <= 1


@pytest.mark.parametrize("power", [-90, -3, 5, 90])
def test_an_object_of_any_size_has_the_same_positions_in_its_unit(power: int) -> None:
    cameras = []
    for size in (1.0, 2.0**power):
        view = View((0.5 * size, -4 * size, size), target=(0, 0, 0))
        cameras.append(camera_space(cube(size), view))
    assert cameras[0].positions.tobytes() == cameras[1].positions.tobytes()
    assert cameras[1].unit == cameras[0].unit * 2.0**power
    assert cameras[0].near == cameras[1].near


def test_the_near_plane_of_an_object_behind_the_eye_is_at_a_millionth_of_its_farthest_depth() -> None:
    camera = camera_space(cube(5.0), View((2.5, 1.0, 2.5), direction=(0, 1, 0)))
    assert camera.near * camera.unit == pytest.approx(4e-6)
    behind = camera_space(cube(), View((0.5, 3.0, 0.5), direction=(0, 1, 0)))
    assert behind.near == camera_module.LEAST_NEAR


@pytest.mark.parametrize("nearest", [1e-3, 1e-7, 1e-8])
@pytest.mark.parametrize("stray", [(), ((0.5, -9.0, 0.0),)])
def test_the_near_plane_clips_nothing_of_an_object_before_the_eye(
    nearest: float, stray: tuple[Vector, ...]
) -> None:
    mesh = Mesh.joined([cube(), cube(nearest)])
    # A node that no polygon uses may lie behind the eye.
    whole = Mesh(
        np.concatenate([mesh.coordinates, np.reshape(stray, (-1, 3))]),
        mesh.node_numbers,
        mesh.part_numbers,
        mesh.part_names,
    )
    camera = camera_space(whole, View((0.0, -nearest, 0.0), direction=(0, 1, 0)))
    used = camera.positions[2, camera.corners]
    assert 0 < camera.near <= used.min() == pytest.approx(nearest / camera.unit)


def test_the_near_plane_is_never_nearer_than_the_rounding_of_crossings_allows() -> None:
    camera = camera_space(cube(), View((0.5, -1e-12, 0.5), direction=(0, 1, 0)))
    assert camera.near == camera_module.LEAST_NEAR


def polygons_of(positions: Floats, corners: list[list[int]], near: float = 0.25) -> CameraPolygons:
    """Polygons whose normals are their positions, which clipping must interpolate alike."""
    numbers = np.array(corners, np.intp).T
    return CameraPolygons(
        1.0,
        near,
        float(positions[2].min()),
        positions,
        positions.astype(np.float32),
        numbers,
        numbers,
        np.arange(len(corners)),
    )


def area(polygons: CameraPolygons) -> float:
    """The area of all polygons, each as two triangles."""
    a, b, c, d = polygons.positions.T[polygons.corners]
    return float(
        sum(np.linalg.norm(np.cross(q - p, r - p), axis=1).sum() / 2 for p, q, r in ((a, b, c), (a, c, d)))
    )


def test_polygons_before_the_eye_are_left_as_they_are() -> None:
    camera = camera_space(cube(), View((0.5, -3, 0.5), direction=(0, 1, 0)))
    assert clipped_at_near_plane(camera) is camera


@given(meshes(), views())
def test_no_corner_is_nearer_than_the_near_plane(mesh: Mesh, view: View) -> None:
    clipped = clipped_at_near_plane(camera_space(mesh, view))
    assert (clipped.positions[2, clipped.corners] >= clipped.near).all()
    assert clipped.corner_normals.max(initial=-1) < clipped.normals.shape[1]


@given(meshes(), views())
def test_polygons_stay_in_the_order_of_the_polygon_table(mesh: Mesh, view: View) -> None:
    camera = camera_space(mesh, view)
    clipped = clipped_at_near_plane(camera)
    assert (np.diff(clipped.polygon_numbers) >= 0).all()
    depths = camera.positions[2, camera.corners]
    expected = np.flatnonzero((depths >= camera.near).any(axis=0))
    assert np.unique(clipped.polygon_numbers).tolist() == expected.tolist()


@given(st.integers(0, 1 << 32), st.integers(1, 2))
def test_a_triangle_keeps_the_area_that_lies_behind_the_near_plane(seed: int, before: int) -> None:
    corners = np.random.default_rng(seed).uniform(-1, 1, (3, 3))
    corners[2] = 0.25 + np.abs(corners[2]) + 0.01
    corners[2, :before] = 0.2 - corners[2, :before]
    whole = polygons_of(corners, [[0, 1, 2, 2]])
    assume(area(whole) > 1e-3)
    # What one corner leaves or takes is a smaller triangle: the product of its fractions of two sides.
    alone = 0 if before == 1 else 2
    others = [corner for corner in range(3) if corner != alone]
    depth = corners[2]
    fractions = [(0.25 - depth[alone]) / (depth[other] - depth[alone]) for other in others]
    small = fractions[0] * fractions[1]
    assert area(clipped_at_near_plane(whole)) == pytest.approx(
        area(whole) * (1 - small if before == 1 else small), rel=1e-9
    )


@pytest.mark.parametrize("before", [1, 2, 3])
def test_a_square_keeps_the_area_that_lies_behind_the_near_plane(before: int) -> None:
    # It stands on the diagonal: its lowest corner is at depth 0, two at 1/2 and one at 1.
    square = np.array([[0.0, 0.5, 0.0, -0.5], [0.0, 0.0, 0.0, 0.0], [0.0, 0.5, 1.0, 0.5]])
    near = {1: 0.25, 2: 0.5 + 1e-12, 3: 0.75}[before]
    expected = {1: 0.5 - 0.25**2, 2: 0.25, 3: 0.25**2}[before]
    clipped = clipped_at_near_plane(polygons_of(square, [[0, 1, 2, 3]], near))
    assert area(clipped) == pytest.approx(expected, abs=1e-9)
    assert set(clipped.polygon_numbers.tolist()) == {0}


@given(st.integers(0, 1 << 32))
def test_new_corners_get_interpolated_normals(seed: int) -> None:
    positions = np.random.default_rng(seed).uniform(-1, 1, (3, 8))
    clipped = clipped_at_near_plane(polygons_of(positions, [[0, 1, 2, 3], [3, 2, 4, 5], [5, 6, 7, 7]]))
    at_corners = clipped.normals[:, clipped.corner_normals]
    assert at_corners == pytest.approx(clipped.positions[:, clipped.corners], abs=1e-6)


def test_polygons_that_share_an_edge_through_the_near_plane_share_its_new_node() -> None:
    floor = grid(4, 4, (-2, -2, 0), (4, 0, 0), (0, 4, 0))
    view = View((0.1, 0.05, 0.7), direction=(0.05, 1.0, -0.2), field_of_view=80)
    clipped = clipped_at_near_plane(camera_space(floor, view))
    on_plane = np.isclose(clipped.positions[2, np.unique(clipped.corners)], clipped.near, rtol=1e-9)
    # One node for each edge of the floor that runs through the near plane, and no more.
    before = (floor.coordinates - np.array(view.eye)) @ view.axes[2] / clipped.unit < clipped.near
    ends = np.stack([floor.node_numbers, np.roll(floor.node_numbers, -1, axis=1)], axis=2).reshape(-1, 2)
    edges = {tuple(sorted(edge)) for edge in ends.tolist() if before[edge[0]] != before[edge[1]]}
    assert on_plane.sum() == len(edges) > 4


def test_polygons_wholly_before_the_near_plane_are_dropped_and_add_no_node() -> None:
    positions = np.array([[0.0, 1, 1, 0.0, 1, 1], [0, 0, 1, 0, 0, 1], [0.1, 0.1, 0.1, 2, 2, 2]])
    clipped = clipped_at_near_plane(polygons_of(positions, [[0, 1, 2, 2], [3, 4, 5, 5]]))
    assert clipped.polygon_numbers.tolist() == [1]
    assert clipped.positions is positions
    nothing = dataclasses.replace(polygons_of(positions, [[0, 1, 2, 2]]), near=3.0)
    assert clipped_at_near_plane(nothing).corners.shape == (4, 0)
