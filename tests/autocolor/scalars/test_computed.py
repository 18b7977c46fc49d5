from __future__ import annotations

import numpy as np
import pytest

from autocolor import Mesh
from autocolor.rendering import rendering
from autocolor.scalars.computed import COMPUTING
from autocolor.scene.scalars.computed_names import COMPUTED
from autocolor.scene.scalars.scalar import Scalar
from tests.autocolor.meshes import sphere, wall, wall_scene


def test_each_name_has_a_function() -> None:
    assert tuple(COMPUTING) == COMPUTED


@pytest.mark.parametrize("name", COMPUTED)
def test_every_point_has_a_single_and_the_range_is_two_singles(name: str) -> None:
    scene = wall_scene(sphere(12, 8))
    points = rendering(scene, 12, 16).points
    values, limits = COMPUTING[name](scene.mesh, Scalar(name), points)
    assert values.dtype == np.float32
    assert values.shape == points.pixels.shape
    assert np.isfinite(values).all()
    assert limits == tuple(float(np.float32(limit)) for limit in limits)
    assert limits[0] < limits[1]


@pytest.mark.parametrize("name", COMPUTED)
def test_a_view_that_sees_nothing_has_no_values(name: str) -> None:
    scene = wall_scene(wall()).with_view(target=(0.0, -9.0, 0.0))
    values, (low, high) = COMPUTING[name](scene.mesh, Scalar(name), rendering(scene, 6, 8).points)
    assert len(values) == 0
    assert low < high


@pytest.mark.parametrize("name", COMPUTED)
def test_a_mesh_without_polygons_has_a_range(name: str) -> None:
    empty = Mesh(np.zeros((0, 3)), np.zeros((0, 4), np.intp), np.zeros(0, np.intp))
    points = rendering(wall_scene(wall()).with_view(target=(0.0, -9.0, 0.0)), 6, 8).points
    values, (low, high) = COMPUTING[name](empty, Scalar(name), points)
    assert len(values) == 0
    assert low < high
