from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import Mesh, View
from autocolor.visibility import camera_space as room
from autocolor.visibility.camera_space import camera_space, rotated
from tests.autocolor import reference
from tests.autocolor.meshes import cube, sphere
from tests.autocolor.strategies import Vector, meshes, outside_views, vectors, views


@given(meshes(), views() | outside_views())
def test_positions_are_along_right_down_and_forward_from_the_eye(mesh: Mesh, view: View) -> None:
    camera = camera_space(mesh, view)
    for node, coordinates in enumerate(mesh.coordinates.tolist()):
        from_eye = reference.minus(coordinates, view.eye)
        expected = [reference.dot(axis, from_eye) for axis in view.axes.tolist()]
        assert (camera.positions[:, node] * camera.unit).tolist() == pytest.approx(expected, abs=1e-12)


@given(meshes(), views() | outside_views())
def test_normals_are_turned_and_not_moved(mesh: Mesh, view: View) -> None:
    camera = camera_space(mesh, view)
    assert camera.normals.dtype == np.float32
    for number, normal in enumerate(mesh.normals.vectors.tolist()):
        expected = [reference.dot(axis, normal) for axis in view.axes.tolist()]
        assert camera.normals[:, number].tolist() == pytest.approx(expected, abs=1e-6)


@given(meshes(), outside_views())
def test_every_polygon_keeps_its_corners_and_its_number(mesh: Mesh, view: View) -> None:
    camera = camera_space(mesh, view)
    assert camera.corners.T.tolist() == mesh.node_numbers.tolist()
    assert camera.corner_normals.T.tolist() == mesh.normals.numbers.tolist()
    assert camera.polygon_numbers.tolist() == list(range(len(mesh.node_numbers)))


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


def test_the_near_plane_of_what_reaches_behind_the_eye_is_a_millionth_of_its_farthest_depth() -> None:
    camera = camera_space(cube(5.0), View((2.5, 1.0, 2.5), direction=(0, 1, 0)))
    assert camera.near * camera.unit == pytest.approx(4e-6)
    behind = camera_space(cube(), View((0.5, 3.0, 0.5), direction=(0, 1, 0)))
    assert behind.near == room.LEAST_NEAR


@pytest.mark.parametrize("nearest", [1e-3, 1e-7, 1e-8])
@pytest.mark.parametrize("stray", [(), ((0.5, -9.0, 0.0),)])
def test_the_near_plane_clips_nothing_of_what_lies_wholly_before_the_eye(
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
    assert camera.near == room.LEAST_NEAR


@given(vectors(), st.sampled_from([1, 7, 1000]))
def test_points_are_rotated_alike_in_chunks_of_any_size(
    origin: tuple[float, float, float], at_once: int
) -> None:
    axes = View((0, 0, 0), direction=(1, 2, 3), angle=20).axes
    points = sphere().coordinates.T
    whole = rotated(axes, points, origin)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(room, "POINTS_AT_ONCE", at_once)
        assert rotated(axes, points, origin).tobytes() == whole.tobytes()
    assert whole == pytest.approx(axes @ (points - np.array(origin)[:, None]), abs=1e-12)
