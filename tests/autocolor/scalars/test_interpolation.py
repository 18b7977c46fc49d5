from __future__ import annotations

import numpy as np
import pytest

from autocolor.rendering import rendering
from autocolor.scalars import interpolation
from autocolor.scalars.interpolation import interpolated, polygon_runs, weighted_points
from tests.autocolor.meshes import sphere, wall, wall_scene


def test_runs_are_the_polygons_of_the_points() -> None:
    points = rendering(wall_scene(sphere(12, 8)), 24, 32).points
    polygons, counts = polygon_runs(points)
    assert np.repeat(polygons, counts).tolist() == points.polygon_numbers.tolist()
    assert (polygons[1:] != polygons[:-1]).all()


def test_a_view_that_sees_nothing_has_no_runs() -> None:
    scene = wall_scene(wall()).with_view(target=(0.0, -9.0, 0.0))
    points = rendering(scene, 6, 8).points
    assert len(polygon_runs(points).polygons) == 0
    assert list(weighted_points(scene.mesh, points)) == []


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
