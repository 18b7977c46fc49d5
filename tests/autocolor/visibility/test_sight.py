from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from autocolor import Light, Mesh, Scene, UsageError, View
from autocolor.lighting.light_drags import highlight_placed
from autocolor.rendering import rendering
from autocolor.visibility.sight import Sight, seen_at
from autocolor.visibility.visible_points import NORMAL
from tests.autocolor.meshes import grid, sphere, wall, wall_scene
from tests.autocolor.reference import dot, minus, plus, ray, times, unit
from tests.autocolor.sessions import car
from tests.autocolor.strategies import outside_views

LINES, ELEMENTS = 12, 16

pixels = st.tuples(st.integers(0, LINES - 1), st.integers(0, ELEMENTS - 1))


def sight_of(scene: Scene, block: int = 1) -> Sight:
    return Sight(scene, rendering(scene, LINES, ELEMENTS).points, block)


@given(outside_views(), pixels, st.booleans())
def test_on_a_wall_the_point_is_where_the_ray_meets_it_and_the_view_is_mirrored(
    view: View, pixel: tuple[int, int], two_sided: bool
) -> None:
    seen = seen_at(sight_of(wall_scene(wall(3, 2, half=2.0), view=view, two_sided=two_sided)), *pixel)
    assume(seen is not None)
    assert seen is not None
    toward = ray(view, LINES, ELEMENTS, *pixel)
    point = plus(view.eye, times(view.eye[1] / -toward[1], toward))
    facing = 1.0 if two_sided and view.eye[1] > 0 else -1.0
    assert seen.point == pytest.approx(point, abs=2e-5)
    assert seen.normal == pytest.approx((0.0, facing, 0.0), abs=1e-6)
    x, y, z = unit(minus(point, view.eye))
    assert seen.reflected_view == pytest.approx((x, -y, z), abs=2e-5)


@given(outside_views(), pixels)
def test_on_a_sphere_the_normal_is_the_direction_of_the_point(view: View, pixel: tuple[int, int]) -> None:
    seen = seen_at(sight_of(wall_scene(sphere(96, 48, radius=1.5), view=view)), *pixel)
    assume(seen is not None)
    assert seen is not None
    assert math.hypot(*seen.point) == pytest.approx(1.5, abs=0.01)
    assert seen.normal == pytest.approx(unit(seen.point), abs=0.02)
    assert math.hypot(*seen.normal) == pytest.approx(1.0, abs=1e-12)
    # N halves the angle between R and the direction to the eye.
    to_eye = unit(minus(view.eye, seen.point))
    assert math.hypot(*seen.reflected_view) == pytest.approx(1.0, abs=1e-12)
    assert dot(seen.reflected_view, seen.normal) == pytest.approx(dot(to_eye, seen.normal), abs=1e-6)
    half = plus(to_eye, seen.reflected_view)
    assert half == pytest.approx(times(2 * dot(to_eye, seen.normal), seen.normal), abs=1e-6)


def test_every_pixel_has_its_visible_point_polygon_part_and_surface() -> None:
    scene = car()
    sight = sight_of(scene)
    points = sight.points
    tables = (points.polygon_numbers, points.world_points, points.world_normals)
    at_pixel = dict(zip(points.pixels.tolist(), zip(*tables, strict=True), strict=True))
    assert 0 < len(at_pixel) < LINES * ELEMENTS
    numbers = rendering(scene, LINES, ELEMENTS).picture.surface_number
    for line in range(LINES):
        for element in range(ELEMENTS):
            seen = seen_at(sight, line, element)
            if seen is None:
                assert line * ELEMENTS + element not in at_pixel
                continue
            polygon, point, normal = at_pixel[line * ELEMENTS + element]
            part = scene.mesh.part_names[scene.mesh.part_numbers[polygon]]
            surface = scene.surfaces[numbers[line, element] - 1].name
            assert (seen.polygon, seen.part, seen.surface) == (polygon, part, surface)
            assert seen.point == pytest.approx(point.tolist(), abs=1e-12)
            assert seen.normal == pytest.approx(normal.tolist(), abs=1e-6)


def test_the_part_is_named_also_where_parts_share_a_surface() -> None:
    left, right = (
        grid(1, 1, (x, 0.0, -1.0), (1.0, 0.0, 0.0), (0.0, 0.0, 2.0), name)
        for x, name in ((-1.0, "left"), (0.0, "right"))
    )
    scene = wall_scene(Mesh.joined([left, right]))
    scene = scene.with_part("right", surface="left")
    seen = [seen_at(sight_of(scene), LINES // 2, element) for element in (4, 11)]
    assert [each and (each.part, each.surface) for each in seen] == [("left", "left"), ("right", "left")]


def test_where_the_normals_of_corners_cancel_there_is_a_point_but_no_highlight() -> None:
    sight = sight_of(wall_scene(lights=[Light("key", (1.0, -3.0, 2.0))]))
    rows = sight.points.rows.copy()
    rows[NORMAL] = 0
    canceled = Sight(sight.scene, dataclasses.replace(sight.points, rows=rows))
    seen = seen_at(canceled, LINES // 2, ELEMENTS // 2)
    assert seen is not None
    assert seen.normal == (0.0, 0.0, 0.0)
    assert seen[:4] == (seen_at(sight, LINES // 2, ELEMENTS // 2) or ())[:4]
    with pytest.raises(UsageError, match="a highlight must be placed where the normal faces the eye"):
        highlight_placed(canceled.scene, seen, "key")


def test_all_pixels_of_a_block_see_the_same_and_are_found_in_its_middle() -> None:
    scene = car()
    fine, coarse = sight_of(scene), sight_of(scene, block=4)
    for line, element in ((0, 0), (5, 7), (LINES - 1, ELEMENTS - 1)):
        seen = seen_at(fine, line, element)
        within = [
            seen_at(coarse, 4 * line + down, 4 * element + right) for down in (0, 3) for right in (0, 3)
        ]
        assert within == [seen] * 4
    assert coarse.pixels_of(np.array([0, ELEMENTS + 2])).tolist() == [[2, 2], [6, 10]]
    assert fine.pixels_of(np.array([0, ELEMENTS + 2])).tolist() == [[0, 0], [1, 2]]


@pytest.mark.parametrize(
    ("line", "element", "message"),
    [
        (-1, 0, "a line must be 0 to 23, not -1; choose another"),
        (24, 0, "a line must be 0 to 23, not 24; choose another"),
        (0, 32, "an element must be 0 to 31, not 32; choose another"),
        (0, -1, "an element must be 0 to 31, not -1; choose another"),
        (1.5, 0, "a line must be 0 to 23, not 1.5; choose another"),
        (0, True, "an element must be 0 to 31, not true; choose another"),
    ],
)
def test_a_pixel_outside_is_refused(line: int, element: int, message: str) -> None:
    with pytest.raises(UsageError) as caught:
        seen_at(sight_of(car(), block=2), line, element)
    assert str(caught.value) == message
