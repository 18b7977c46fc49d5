from __future__ import annotations

import dataclasses
import math
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from autocolor import Flap, Flaps, HalfSpace, Light, Mesh, View, render, scene_of
from autocolor.checks import Vector
from autocolor.lighting.controls import (
    FARTHEST,
    falloff_share,
    flaps_of,
    is_inside,
    side_of,
    sides_of,
    soft_cone_share,
)
from autocolor.lighting.light import is_within, shares_of
from autocolor.lighting.rays import camera_light, fast_rays
from autocolor.scene.lights import Links
from autocolor.testing import directions, lights, numbers, vectors
from autocolor.visibility.visible_points import POINT, VisiblePoints
from autocolor.visibility.visible_surfaces import visible_surfaces
from tests.small import cube, sphere, wall, wall_scene

# test_shading.py compares what all controls leave with their closed forms.

LIGHT = Light("light", (0, -1, 0))


def wall_points() -> VisiblePoints:
    return visible_surfaces(wall(), View((1, -4, 1), target=(0, 0, 0)), (1,), 12, 12)


@given(lights())
def test_a_light_has_the_controls_that_its_fields_ask_for(light: Light) -> None:
    expected = {f"flap {axis}" for axis, flap in flaps_of(light).items() if flap is not None and flap.on}
    expected |= {f"half-space {half_space.name}" for half_space in light.half_spaces if half_space.on}
    expected |= {"concentration"} if light.concentration > 0 else set()
    expected |= {"cone"} if light.cone_angle is not None else set()
    expected |= {"falloff"} if light.falloff != "none" else set()
    points = wall_points()
    ready = camera_light(light, points)
    rays, _ = fast_rays(ready, points.rows, points.radius)
    assert {name for name, _ in shares_of(ready, rays)} == expected


@pytest.mark.parametrize(
    "fields",
    [
        {"flaps": Flaps(x=Flap(0, 1, on=False))},
        {"flaps": Flaps(x=Flap(), y=Flap())},
        {"half_spaces": (HalfSpace("left", (0, 0, 0), (1, 0, 0), edge_width=0.2, on=False),)},
    ],
)
def test_flaps_and_half_spaces_that_are_off_or_without_limits_are_no_control(fields: dict[str, Any]) -> None:
    assert sides_of(LIGHT.replace(**fields), wall_points()) == {}


@pytest.mark.parametrize(("least", "inside"), [(1e300, False), (-1e300, True), (1e36, False)])
def test_a_plane_may_be_farther_than_a_single_can_hold(least: float, inside: bool) -> None:
    points = wall_points()
    side = side_of(points, "far", (1.0, 0.0, 0.0), least, 0.0)
    assert abs(side.row[3]) == pytest.approx(FARTHEST)
    assert is_inside(side, points.rows[POINT]).tolist() == [inside] * len(points.pixels)


@pytest.mark.parametrize(
    "fields",
    [
        *({"half_spaces": (HalfSpace("wall", (5.0, 0.0, 3.0), (0, y, 0)),)} for y in (-1, 1)),
        *({"flaps": Flaps(y=flap)} for flap in (Flap(0.0, 0.0), Flap(minimum=0.0), Flap(maximum=0.0))),
    ],
)
def test_a_wall_that_lies_on_a_plane_is_lit_and_at_a_soft_edge_it_is_dark(fields: dict[str, Any]) -> None:
    view = View((1.0, -7.0, 2.0), target=(0.0, 0.0, 0.0))
    points = visible_surfaces(wall(), view, (1,), 30, 40)
    (side, *others) = sides_of(LIGHT.replace(**fields), points).values()
    assert all(is_inside(each, points.rows[POINT]).all() for each in (side, *others))
    picture = render(wall_scene(view=view, lights=[LIGHT.replace(**fields)]), (40, 30))
    whole = render(wall_scene(view=view, lights=[LIGHT]), (40, 30))
    assert picture.intensity.tobytes() == whole.intensity.tobytes()
    if "half_spaces" in fields:
        soft = LIGHT.replace(half_spaces=[fields["half_spaces"][0].replace(edge_width=1e-3)])
        dark = render(wall_scene(view=view, lights=[soft]), (40, 30))
        assert dark.intensity.max() < 1e-5 * whole.intensity.max()


@given(vectors(numbers(-1e30, 1e30)), directions(), st.sampled_from([0.0, 1e-300, 1e-60, 1e-30, 1.0, 1e30]))
def test_planes_however_far_and_edges_of_any_width_leave_finite_light(
    point: Vector, direction: Vector, edge_width: float
) -> None:
    assume(any(point))
    plane = HalfSpace("far", point, direction, edge_width=edge_width)
    light = Light("light", (0.2, -1, 0.1), direction=(0, 1, 0), concentration=2, half_spaces=(plane,))
    picture = render(wall_scene(lights=[light]), (16, 12))
    assert np.isfinite(picture.intensity).all()
    assert picture.intensity.min() >= 0


@pytest.mark.parametrize(
    ("cosine", "cone_angle", "lit"),
    [
        (0.5, 60.0, True),
        (0.49999, 60.0, False),
        (-0.5, 121.0, True),
        (0.0, 90.0, True),
        (-1.0, 180.0, True),
        (1.0, 0.001, True),
    ],
)
def test_a_point_is_in_the_cone_up_to_its_rim(cosine: float, cone_angle: float, lit: bool) -> None:
    points = wall_points()
    rays, _ = fast_rays(camera_light(LIGHT, points), points.rows, points.radius)
    for kind in (np.float32, np.float64):
        assert is_within(dataclasses.replace(rays, cos_light=np.array([cosine], kind)), cone_angle) == [lit]


@given(numbers(1, 180), numbers(0, 1))
def test_all_is_left_up_to_the_inner_angle_and_nothing_at_the_rim(cone_angle: float, share: float) -> None:
    inner = share * (cone_angle - 1)
    angles = np.radians([0, inner / 2, inner, cone_angle, 180])
    cosines = np.add(np.cos(angles), [0, 0, 1e-6, -1e-6, 0]).astype(np.float32)
    left = soft_cone_share(cosines, inner, cone_angle)
    assert left[:3] == pytest.approx(1, abs=1e-6)
    assert left[3:].tolist() == [0, 0]


@pytest.mark.parametrize(("outer", "inner"), [(1e-6, 0.0), (180.0, math.nextafter(180.0, 0.0)), (30.0, 0.0)])
def test_the_share_stays_within_0_and_1_however_narrow_the_edge(outer: float, inner: float) -> None:
    cosines = np.linspace(-1.0000002, 1.0000002, 1001).astype(np.float32)
    left = soft_cone_share(cosines, inner, outer)
    assert ((left >= 0) & (left <= 1)).all()


def test_a_light_falls_to_a_half_and_to_a_quarter_at_half_its_reach() -> None:
    distances = np.array([0, 0.5, 1, 2, 4], np.float32)
    for falloff, expected in (("linear", [1, 0.75, 0.5, 0, 0]), ("quadratic", [1, 0.5625, 0.25, 0, 0])):
        light = Light("light", (0, 0, 0), falloff=falloff, reach=9)
        assert falloff_share(light, 2.0, distances).tolist() == pytest.approx(expected, abs=1e-6)


@pytest.mark.parametrize(("distance", "reach"), [(1e12, 3), (1e20, 3), (1e36, 3), (1, 1e-60)])
def test_a_light_beyond_all_that_falls_gives_nothing_here(distance: float, reach: float) -> None:
    light = Light("light", (0, -distance, 0), falloff="linear", reach=reach)
    assert not render(wall_scene(lights=[light]), (4, 4)).intensity.any()


@pytest.mark.parametrize(
    ("links", "lit"),
    [
        ({"only_parts": ("cube",)}, {2}),
        ({"except_parts": ("cube",)}, {1}),
        ({"only_parts": ()}, set()),
        ({"except_parts": ()}, {1, 2}),
    ],
)
def test_a_light_linked_to_parts_is_the_light_of_all_where_they_are_and_nothing_elsewhere(
    links: dict[str, Any], lit: set[int]
) -> None:
    light = Light("light", (3, -4, 3))
    scene = scene_of(Mesh.joined([sphere(12, 8), cube(1.4)]), lights=[light]).replace(ambient=0.0)
    free = render(scene, (32, 24))
    linked = render(scene.replace(lights=(light.replace(links=Links(**links)),)), (32, 24))
    for number in (1, 2):
        here = free.part_number == number
        expected = free.intensity[here] if number in lit else np.zeros(np.count_nonzero(here))
        assert free.intensity[here].any()
        assert linked.intensity[here] == pytest.approx(expected, rel=1e-5)
