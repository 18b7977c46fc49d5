from __future__ import annotations

import math

import numpy as np
import pytest

from autocolor import Mesh, Scene, View, scene_of
from autocolor.explanation.point import (
    Camera,
    PointExplained,
    corner_rows,
    dot,
    length,
    minus,
    point_at,
    unit,
)
from autocolor.visibility.visible_surfaces import visible_surfaces
from tests.autocolor.reference import ray
from tests.small import sphere

LINES, ELEMENTS = 24, 32


def every_point(scene: Scene) -> list[PointExplained]:
    """The points at all pixels that see a polygon."""
    points = visible_surfaces(scene.mesh, scene.view, (1,), LINES, ELEMENTS)
    camera = Camera(scene.view, LINES, ELEMENTS)
    return [
        point_at(scene, camera, polygon, *divmod(pixel, ELEMENTS))
        for pixel, polygon in zip(points.pixels.tolist(), points.polygon_numbers.tolist(), strict=True)
    ]


def plane_scene(eye: tuple[float, float, float], target: tuple[float, float, float]) -> Scene:
    """A large floor at z = 0, which reaches behind the eye."""
    corners = np.array([(-9.0, -9, 0), (9, -9, 0), (9, 9, 0), (-9, 9, 0)])
    return scene_of(Mesh(corners, np.array([[0, 1, 2, 3]])), view=View(eye, target=target))


@pytest.mark.parametrize("eye", [(0.3, -20.0, 4.0), (0.3, -4.0, 1.0)])
def test_a_point_is_where_the_ray_meets_the_plane_also_of_a_floor_behind_the_eye(
    eye: tuple[float, float, float],
) -> None:
    scene = plane_scene(eye, (0.0, 0.0, 0.0))
    points = visible_surfaces(scene.mesh, scene.view, (1,), LINES, ELEMENTS)
    found = every_point(scene)
    assert found
    for at, pixel in zip(found, points.pixels.tolist(), strict=True):
        direction = ray(scene.view, LINES, ELEMENTS, *divmod(pixel, ELEMENTS))
        depth = -eye[2] / direction[2]
        expected = [start + depth * each for start, each in zip(eye, direction, strict=True)]
        assert at.point == pytest.approx(expected, abs=1e-9)
        assert at.normal == pytest.approx((0, 0, 1))
        assert at.distance == pytest.approx(math.dist(eye, expected))


def test_the_normal_of_a_ball_points_away_from_its_middle() -> None:
    scene = scene_of(sphere(64, 32), view=View((1.0, -4.0, 2.0), target=(0.0, 0.0, 0.0)))
    for at in every_point(scene):
        assert dot(at.normal, unit(at.point)) == pytest.approx(1, abs=2e-3)
        assert not at.is_turned


def test_the_reflected_view_leaves_as_the_ray_comes() -> None:
    scene = scene_of(sphere(16, 8), view=View((1.0, -4.0, 2.0), target=(0.0, 0.0, 0.0)))
    for at in every_point(scene):
        to_eye = unit(minus(scene.view.eye, at.point))
        assert dot(at.reflected_view, at.normal) == pytest.approx(dot(to_eye, at.normal))
        assert length(at.reflected_view) == pytest.approx(1)


def test_a_normal_is_turned_to_the_eye_unless_the_surface_has_one_side() -> None:
    scene = plane_scene((0.3, -20.0, -4.0), (0.0, 0.0, 0.0))
    name = scene.surfaces[0].name
    one_sided = scene.with_surface(name, two_sided=False)
    assert {(at.is_turned, at.normal[2]) for at in every_point(scene)} == {(True, -1.0)}
    assert {(at.is_turned, at.normal[2]) for at in every_point(one_sided)} == {(False, 1.0)}


@pytest.mark.parametrize("angle", [0.0, 30.0, 90.0])
def test_the_points_and_normals_of_a_zigzag_are_those_of_the_renderer(angle: float) -> None:
    # A dart, which a line crosses four times, with a bent normal at each corner.
    corners = np.array([(-1.0, 0.2, 1.0), (0.0, 0.0, -0.4), (1.0, 0.1, 1.0), (0.0, 0.0, -1.0)])
    view = View((0.2, -5.0, 0.3), target=(0.0, 0.0, 0.0), angle=angle)
    scene = scene_of(Mesh(corners, np.array([[0, 1, 2, 3]]), crease_angle=180.0), view=view)
    points = visible_surfaces(scene.mesh, view, (1,), LINES, ELEMENTS)
    found = every_point(scene)
    assert np.array([at.point for at in found]) == pytest.approx(points.world_points, abs=1e-6)
    assert np.array([at.normal for at in found]) == pytest.approx(points.world_normals, abs=1e-6)


def test_a_triangle_has_three_corners_wherever_it_repeats_one() -> None:
    corners = np.eye(3)
    for nodes in ([0, 1, 2, 2], [0, 0, 1, 2], [0, 1, 1, 2], [0, 1, 2, 0]):
        assert sorted(node for node, _ in corner_rows(Mesh(corners, np.array([nodes])), 0)) == [0, 1, 2]
    assert len(corner_rows(Mesh(corners, np.array([[1, 1, 1, 1]])), 0)) == 1
