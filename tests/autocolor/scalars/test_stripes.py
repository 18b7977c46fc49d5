from __future__ import annotations

import math

import numpy as np
import pytest

from autocolor import View
from autocolor.rendering import rendering
from autocolor.scalars.stripes import zebra
from autocolor.scene.scalars.scalar import Scalar
from tests.autocolor.meshes import sphere, wall, wall_scene


def off(one: object, other: object) -> float:
    """The largest difference of two phases, around the turn."""
    difference = np.asarray(one, np.float64) - np.asarray(other, np.float64)
    return float(np.abs(difference - np.round(difference)).max())


def test_stripes_on_a_sphere_are_where_its_rays_are_reflected_to() -> None:
    scene = wall_scene(
        sphere(400, 200), view=View((0.0, -50.0, 0.0), target=(0.0, 0.0, 0.0), field_of_view=2)
    )
    points = rendering(scene, 60, 80).points
    scalar = Scalar("zebra", direction=(0.0, 0.0, 1.0), stripes=7)
    values, limits = zebra(scene.mesh, scalar, points)
    # The true sphere: the ray, where it meets it, and the mirrored ray.
    normals = points.world_points / np.linalg.norm(points.world_points, axis=1)[:, None]
    rays = points.world_points - (0.0, -50.0, 0.0)
    mirrored = rays - 2 * (rays * normals).sum(axis=1)[:, None] * normals
    wanted = np.arctan2(mirrored[:, 1], mirrored[:, 0]) * 7 / math.pi
    inside = np.abs(points.world_points[:, 1]) > 0.3
    # The axis that angles are counted from is free.
    assert off(values[inside], wanted[inside] + (values - wanted)[inside][0]) < 0.02
    assert limits == (0, 1)
    assert 0 <= values.min() < 0.05
    assert 0.95 < values.max() < 1


def test_a_mirror_turned_by_an_angle_moves_the_stripes_by_twice_as_much() -> None:
    phases = []
    for turn in (0.0, 10.0):
        angle = math.radians(turn)
        eye = (-200 * math.sin(angle), -200 * math.cos(angle), 0.0)
        scene = wall_scene(wall(), view=View(eye, target=(0.0, 0.0, 0.0), field_of_view=0.01))
        points = rendering(scene, 4, 4).points
        phases.append(float(zebra(scene.mesh, Scalar("zebra", stripes=9), points).values[0]))
    # Seen from another side the mirrored ray goes to the other by the same angle: 10 degrees of 180, times 9.
    assert off(phases[1] - phases[0], 0.5) < 1e-3


def test_the_sides_of_a_surface_have_the_same_stripes() -> None:
    scene = wall_scene(sphere(60, 30), two_sided=False)
    two_sided = scene.with_surface("sphere", two_sided=True)
    inside = View((0.0, 0.2, 0.1), target=(0.0, 1.0, 0.0), field_of_view=70)
    one, two = (
        zebra(
            each.mesh,
            Scalar("zebra"),
            rendering(each.with_view(eye=inside.eye, target=inside.target), 12, 16).points,
        )
        for each in (scene, two_sided)
    )
    assert one.values == pytest.approx(two.values, abs=1e-4)
    assert len(one.values) == 12 * 16


@pytest.mark.parametrize("direction", [(1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (1.0, -2.0, 3.0)])
def test_a_ray_along_the_lamps_has_a_phase(direction: tuple[float, float, float]) -> None:
    scene = wall_scene(sphere(30, 20))
    values, _ = zebra(scene.mesh, Scalar("zebra", direction=direction), rendering(scene, 31, 41).points)
    assert np.isfinite(values).all()
    assert values.min() >= 0
    assert values.max() < 1
