from __future__ import annotations

import numpy as np
import pytest

from autocolor import View
from autocolor.rendering import rendering
from autocolor.scalars.places import coordinate, distance, unit_vector
from autocolor.scene.scalars.scalar import Scalar
from tests.autocolor.meshes import grid, sphere, wall_scene


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_coordinates_are_those_of_the_points(axis: int) -> None:
    scene = wall_scene(sphere())
    points = rendering(scene, 24, 32).points
    values, limits = coordinate(axis, scene.mesh, Scalar("x"), points)
    assert values == pytest.approx(points.world_points[:, axis], abs=1e-6)
    low, high = scene.mesh.bounds
    assert limits == pytest.approx((low[axis], high[axis]))


def test_a_distance_is_measured_along_the_direction_whatever_its_length() -> None:
    scene = wall_scene(sphere(40, 20, radius=2.0))
    points = rendering(scene, 24, 32).points
    direction = np.array([1.0, -2.0, 2.0])
    wanted = points.world_points @ direction / 3
    for length in (1e-30, 1.0, 1e30):
        scalar = Scalar("distance", direction=tuple((direction * length).tolist()))
        assert unit_vector(scalar) == pytest.approx(direction / 3)
        values, limits = distance(scene.mesh, scalar, points)
        assert values == pytest.approx(wanted, abs=1e-6)
        assert limits == pytest.approx((-2, 2), abs=0.03)


def test_the_height_of_a_level_plate_is_in_the_middle_of_its_range() -> None:
    mesh = grid(3, 3, (-1.0, -1.0, 1e-9), (2.0, 0.0, 1e-8), (0.0, 2.0, -1e-8))
    points = rendering(wall_scene(mesh, view=View((0.0, 0.1, 4.0), target=(0.0, 0.0, 0.0))), 12, 16).points
    for values, (low, high) in (
        coordinate(2, mesh, Scalar("z"), points),
        distance(mesh, Scalar("distance"), points),
    ):
        assert np.abs((values - low) / (high - low) - 0.5).max() < 0.05


def test_the_range_is_that_of_the_object_and_not_of_what_is_seen() -> None:
    scene = wall_scene(sphere())
    near = rendering(scene.with_view(field_of_view=2), 12, 16).points
    values, limits = coordinate(0, scene.mesh, Scalar("x"), near)
    assert limits == pytest.approx((-1, 1))
    assert np.abs(values).max() < 0.2
