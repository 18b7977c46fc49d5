from __future__ import annotations

import numpy as np
import pytest

from autocolor import Mesh
from autocolor.rendering import rendering
from autocolor.scalars.bending import (
    gaussian_curvature,
    largest_curvature,
    mean_curvature,
    smallest_curvature,
)
from autocolor.scene.scalars.scalar import Scalar
from autocolor.visibility.visible_points import VisiblePoints
from tests.autocolor.meshes import cube, grid, sphere, wall_scene
from tests.autocolor.scalars.test_angles import cone

ANY = Scalar("mean curvature")


def points_of(mesh: Mesh) -> VisiblePoints:
    return rendering(wall_scene(mesh), 30, 40).points


def test_a_ball_has_one_curvature_at_every_pixel() -> None:
    mesh = sphere(120, 60, radius=2.0)
    points = points_of(mesh)
    for found, wanted in (
        (mean_curvature, 0.5),
        (gaussian_curvature, 0.25),
        (largest_curvature, 0.5),
        (smallest_curvature, 0.5),
    ):
        values, limits = found(mesh, ANY, points)
        # The principal curvatures are a root apart, which is not exact where they are equal.
        assert values == pytest.approx(wanted, rel=0.03)
        assert limits[0] <= wanted * 1.001
        assert limits[1] >= wanted * 0.999


def test_a_cylinder_bends_one_way() -> None:
    mesh = cone(0.0)
    points = points_of(mesh)
    wanted = {mean_curvature: 0.25, gaussian_curvature: 0.0, largest_curvature: 0.5, smallest_curvature: 0.0}
    for found, number in wanted.items():
        assert found(mesh, ANY, points).values == pytest.approx(number, abs=1e-3)


def test_the_range_leaves_a_few_sharp_bends_out() -> None:
    ball, needle = sphere(120, 60), sphere(12, 8, radius=0.01)
    moved = Mesh(needle.coordinates + np.array([3.0, 0.0, 0.0]), needle.node_numbers, part_names=("needle",))
    mesh = Mesh.joined([ball, moved])
    _, (low, high) = mean_curvature(mesh, ANY, points_of(ball))
    assert mesh.curvatures.mean.max() > 50
    assert 0.4 < low < 1 < high < 2


def test_what_is_flat_but_for_rounding_has_the_middle_of_the_range() -> None:
    mesh = grid(9, 9, (0.1, 0.2, 0.3), (3.0, 0.7, -0.2), (-0.3, 2.0, 1.1))
    mesh = Mesh(mesh.coordinates.astype(np.float32), mesh.node_numbers, part_names=("wall",))
    points = points_of(mesh)
    assert mesh.curvatures.mean.any()
    for found in (mean_curvature, gaussian_curvature, largest_curvature, smallest_curvature):
        values, (low, high) = found(mesh, ANY, points)
        assert len(values) > 10
        assert np.abs((values - low) / (high - low) - 0.5).max() < 0.01


def test_the_sides_of_a_box_are_flat() -> None:
    mesh = cube()
    size = 3**0.5
    for found in (mean_curvature, gaussian_curvature, largest_curvature, smallest_curvature):
        values, limits = found(mesh, ANY, rendering(wall_scene(mesh), 12, 16).points)
        assert not np.any(np.abs(values) > 1e-9)
        least = (0.01 / size) ** (2 if found is gaussian_curvature else 1)
        assert limits == pytest.approx((-least, least))
