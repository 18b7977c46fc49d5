from __future__ import annotations

import math
from functools import cache
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import Light, Scene, Studio, View
from autocolor.lighting.far_away import (
    cosines_from_afar,
    direction,
    direction_to_eye,
    direction_to_light,
    middle_of,
    seen_from_afar,
)
from autocolor.rendering import rendering
from ramtek_emu import Ramtek9300
from tests.autocolor.meshes import sphere, wall_scene
from tests.autocolor.reference import dot, minus, times

VIEW = View((1.0, -4.0, 1.5), target=(0.0, 0.0, 0.0), field_of_view=35.0)

KINDS: list[dict[str, Any]] = [
    {},
    {"aim": (0.3, 0.2, 0.1)},
    {"direction": (0.2, 0.9, -0.4)},
    {"direction": (0.2, 0.9, -0.4), "at_infinity": True},
    {"aim": (0.3, 0.2, 0.1), "at_infinity": True},
]


def ball(kind: dict[str, Any]) -> Scene:
    lights = [Light("key", (1.0, -2.0, 2.0), **kind)]
    return wall_scene(sphere(96, 48), view=VIEW, lights=lights).replace(words="normals")


def test_the_direction_between_two_points_is_a_unit_vector_or_zero() -> None:
    assert direction((0, 0, 0), (3e200, 0, 4e200)) == pytest.approx((0.6, 0.0, 0.8))
    assert direction((0, 0, 0), (3e-200, 0, 4e-200)) == pytest.approx((0.6, 0.0, 0.8))
    assert direction((1, 2, 3), (1, 2, 3)) == (0.0, 0.0, 0.0)


def test_a_light_is_in_its_direction_from_the_middle_and_one_at_infinity_along_its_axis() -> None:
    assert middle_of(ball({})) == pytest.approx((0, 0, 0), abs=1e-12)
    assert direction_to_light(Light("a", (0, 0, 2)), (0, 0, -3)) == (0.0, 0.0, 1.0)
    sun = Light("sun", (5, 5, 5), direction=(0, -2, 0), at_infinity=True)
    assert direction_to_light(sun, (0, 0, 0)) == pytest.approx((0, 1, 0))


def test_the_eye_is_in_its_direction_from_the_middle_in_camera_space() -> None:
    assert direction_to_eye(ball({})) == pytest.approx([0, 0, -1], abs=1e-9)


def test_what_is_seen_from_afar_is_in_the_middle_with_its_own_normal() -> None:
    studio = Studio(ball({}), Ramtek9300())
    seen = studio.seen_at(220, 300)
    assert seen is not None
    far = seen_from_afar(studio.scene, seen)
    to_eye = direction((0, 0, 0), VIEW.eye)
    assert far.normal == seen.normal
    assert far.point == pytest.approx((0, 0, 0), abs=1e-12)
    expected = minus(times(2 * dot(seen.normal, to_eye), seen.normal), to_eye)
    assert far.reflected_view == pytest.approx(expected)


def test_the_cosines_are_those_of_reflected_view_and_light_far_away() -> None:
    scene = ball({})
    rendered = rendering(scene, 48, 64)
    (surface,) = rendered.points.slices
    cosines = cosines_from_afar(scene, scene.lights[0], rendered.points, surface.pixels)
    to_eye, to_light = direction((0, 0, 0), VIEW.eye), direction((0, 0, 0), scene.lights[0].position)
    for normal, cosine in zip(rendered.points.world_normals.tolist(), cosines.tolist(), strict=True):
        reflected = minus(times(2 * dot(normal, to_eye), normal), to_eye)
        behind = dot(normal, to_light) <= 0
        assert cosine == pytest.approx(-1 if behind else dot(reflected, to_light), abs=1e-5) or (
            abs(dot(normal, to_light)) < 1e-6
        )


@cache
def studio_of(number: int) -> Studio:
    """A studio for lights of one of the kinds, made once."""
    return Studio(ball(KINDS[number]), Ramtek9300())


@pytest.mark.parametrize("number", range(len(KINDS)))
@given(line=st.integers(150, 330), element=st.integers(230, 410))
def test_where_words_stand_for_normals_a_highlight_is_where_it_is_placed(
    number: int, line: int, element: int
) -> None:
    studio = studio_of(number)
    seen = studio.seen_at(line, element)
    assert seen is not None
    before = studio.scene.light("key")
    studio.place_highlight("key", line, element)
    found = studio.highlight_of("key")
    assert found is not None
    assert math.dist(found, (line, element)) < 3
    light = studio.scene.light("key")
    assert math.dist(light.position, (0, 0, 0)) == pytest.approx(math.dist(before.position, (0, 0, 0)))
    # The brightest word is at the pixel, or in a cell beside it.
    brightness = studio.entries[studio.words].sum(axis=2, dtype=np.int64)
    around = brightness[line - 12 : line + 13, element - 12 : element + 13]
    assert around.max() == brightness.max()
