from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import Light, View
from autocolor.checks import Vector
from autocolor.lighting.controls import FARTHEST
from autocolor.lighting.light import Rays, exact_rays_to
from autocolor.lighting.rays import camera_light, direction_to_light, fast_rays, middle_of
from autocolor.testing import directions, numbers, outside_views, vectors
from autocolor.visibility.visible_points import REFLECTED_VIEW, VisiblePoints
from autocolor.visibility.visible_surfaces import visible_surfaces
from tests.autocolor.twins.point import dot, minus, times, unit
from tests.small import cube, sphere, wall_scene

BALL = sphere(12, 8)


def rays_of(light: Light, points: VisiblePoints) -> Rays:
    rays, _ = fast_rays(camera_light(light, points), points.rows, points.radius)
    return rays


def points_of(view: View) -> VisiblePoints:
    return visible_surfaces(BALL, view, (1,), 9, 12)


@given(outside_views(), vectors(numbers(-3, 3)), directions())
def test_lengths_and_cosines_agree_with_the_rays(view: View, position: Vector, direction: Vector) -> None:
    points = points_of(view)
    light = Light("light", position, direction=direction, concentration=1)
    rays = rays_of(light, points)
    assert rays.cos_light is not None
    cos_incidence, cos_eye = rays.cos_incidence, rays.cos_eye
    reflected = points.rows[REFLECTED_VIEW].T.astype(np.float64) @ view.axes
    for number, point in enumerate(points.world_points.tolist()):
        ray = minus(position, point)
        length = math.sqrt(dot(ray, ray))
        if length < 1e-3:
            continue
        # The point itself is rounded to float32.
        error = 2e-6 + 1e-6 / length
        assert rays.length[number] * points.unit == pytest.approx(length, abs=1e-5)
        assert rays.cos_light[number] == pytest.approx(-dot(unit(ray), unit(direction)), abs=error)
        normal = points.world_normals[number].tolist()
        assert cos_incidence[number] == pytest.approx(dot(unit(ray), normal), abs=error)
        assert cos_eye[number] == pytest.approx(dot(unit(ray), reflected[number].tolist()), abs=error)


@given(st.sampled_from([1.02, 1.05, 1.1, 1.2, 2.0, 30.0, 1e3]), directions(), outside_views())
def test_cosines_near_1_are_off_by_at_most_the_rounding(distance: float, side: Vector, view: View) -> None:
    points = visible_surfaces(BALL, view, (1,), 30, 40)
    light = Light("light", times(distance, unit(side)), aim=(0.1, 0.0, 0.05), concentration=1)
    ready = camera_light(light, points)
    rays, rounding = fast_rays(ready, points.rows, points.radius)
    exact = exact_rays_to(ready, points.rows).cos_light
    assert rays.cos_light is not None
    assert exact is not None
    near = np.flatnonzero(exact > 0.9)
    assert (np.abs(rays.cos_light - exact)[near] <= 1.1 * rounding).all()


def test_a_ray_to_a_light_at_the_point_itself_has_a_length() -> None:
    points = points_of(View((0, -5, 0), target=(0, 0, 0)))
    for point in points.world_points.tolist():
        rays = rays_of(Light("light", tuple(point)), points)
        assert (rays.length > 0).all()
        assert np.isfinite(rays.cos_incidence).all()


@given(directions(), st.sampled_from([1e16, 1e25, 1e36]))
def test_the_rays_to_a_light_beyond_all_are_parallel(toward: Vector, distance: float) -> None:
    points = points_of(View((1, -5, 2), target=(0, 0, 0)))
    far = times(distance, unit(toward))
    light = Light("light", (far[0], far[1], far[2]))
    rays = rays_of(light, points)
    assert float(rays.length.max()) <= FARTHEST * 1.8
    expected = points.world_normals @ np.array(unit(toward))
    assert rays.cos_incidence == pytest.approx(expected, abs=1e-5)


@given(outside_views(), vectors(numbers(-9, 9)), directions())
def test_the_rays_to_a_light_at_infinity_are_against_its_axis_wherever_it_is(
    view: View, position: Vector, direction: Vector
) -> None:
    points = points_of(view)
    light = Light("light", position, direction=direction, at_infinity=True, concentration=1)
    rays = rays_of(light, points)
    assert rays.cos_light is not None
    assert (rays.cos_light == 1).all()
    toward = np.array(times(-1, unit(direction)))
    assert rays.cos_incidence == pytest.approx(points.world_normals @ toward, abs=1e-6)
    reflected = points.rows[REFLECTED_VIEW].T.astype(np.float64) @ view.axes
    assert rays.cos_eye == pytest.approx(reflected @ toward, abs=1e-6)
    assert rays_of(light.replace(concentration=0), points).cos_light is None


@given(outside_views(), st.sampled_from([(0, 0, -1), (0, 0, 1), (1, 0, 0), (0, 1, -1), (1, 0, 1)]))
def test_parallel_rays_do_not_light_the_faces_that_they_run_along(view: View, direction: Vector) -> None:
    points = visible_surfaces(cube(), view, (1,), 9, 12)
    light = Light("light", (3, -3, 3), direction=direction, at_infinity=True)
    cosines = rays_of(light, points).cos_incidence
    expected = np.round(points.world_normals) @ -np.array(unit(direction))
    assert cosines == pytest.approx(expected, abs=1e-6)
    assert (np.sign(cosines) == np.sign(expected)).all()


def test_a_light_is_in_its_direction_from_the_middle_and_one_at_infinity_along_its_axis() -> None:
    assert middle_of(wall_scene(BALL)) == pytest.approx((0, 0, 0), abs=1e-12)
    assert direction_to_light(Light("a", (0, 0, 2)), (0, 0, -3)) == (0.0, 0.0, 1.0)
    sun = Light("sun", (5, 5, 5), direction=(0, -2, 0), at_infinity=True)
    assert direction_to_light(sun, (0, 0, 0)) == pytest.approx((0, 1, 0))
