from __future__ import annotations

import pytest

from autocolor.rendering import rendering
from autocolor.scalars.computed import COMPUTING
from autocolor.scene.scalars.computed_names import COMPUTED
from autocolor.scene.scalars.scalar import Scalar
from tests.autocolor.meshes import sphere, wall_scene


def test_each_name_has_a_function() -> None:
    assert tuple(COMPUTING) == COMPUTED


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_coordinates_are_those_of_the_points(axis: int) -> None:
    scene = wall_scene(sphere())
    points = rendering(scene, 24, 32).points
    values, limits = COMPUTING["xyz"[axis]](scene.mesh, Scalar("x"), points)
    assert values == pytest.approx(points.world_points[:, axis], abs=1e-6)
    low, high = scene.mesh.bounds
    assert limits == pytest.approx((low[axis], high[axis]))
