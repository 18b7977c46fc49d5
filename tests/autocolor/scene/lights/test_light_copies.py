from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import Flap, Flaps, Light, UsageError, render
from autocolor.scene.lights.carried import set_down
from autocolor.scene.lights.light_copies import AXES, free_name, mirrored
from tests.autocolor.meshes import wall_scene
from tests.autocolor.strategies import lights, short


@given(
    st.lists(st.sampled_from(["key", "key 2", "key 3", "key 4", "rim"])), st.sampled_from(["key", "key 2"])
)
def test_a_free_name_is_not_taken_and_keeps_the_word(taken: list[str], name: str) -> None:
    free = free_name(name, taken)
    assert free not in taken
    assert free.startswith("key")
    assert (free == name) == (name not in taken)


def test_a_name_that_is_a_number_alone_is_kept_whole() -> None:
    assert free_name("2", ["2"]) == "2 2"


@given(lights(), st.sampled_from(AXES), short)
def test_a_light_mirrored_twice_is_where_it_was(light: Light, axis: str, about: float) -> None:
    there = mirrored(light, "there", axis, about)
    back = mirrored(there, light.name, axis, about)
    assert back.position == pytest.approx(light.position)
    assert (back.direction, back.intensity, back.cone_angle) == (
        light.direction,
        light.intensity,
        light.cone_angle,
    )
    for name in AXES:
        one, other = vars(light.flaps)[name], vars(back.flaps)[name]
        assert (one is None) == (other is None)
        if one is not None:
            assert (other.minimum, other.maximum) == pytest.approx((one.minimum, one.maximum))
            assert (other.on, other.edge_width) == (one.on, one.edge_width)
    assert [each.name for each in back.half_spaces] == [each.name for each in light.half_spaces]
    for plane, same in zip(light.half_spaces, back.half_spaces, strict=True):
        assert same.point == pytest.approx(plane.point)
        assert same == plane.replace(point=same.point)


@given(lights(), st.sampled_from(AXES), short)
def test_the_half_spaces_of_a_mirrored_light_are_mirrored_in_the_world(
    light: Light, axis: str, about: float
) -> None:
    there = mirrored(light, "there", axis, about)
    number = AXES.index(axis)
    for plane, copy in zip(light.half_spaces, there.half_spaces, strict=True):
        assert copy.carried == plane.carried
        one, other = set_down(plane, light), set_down(copy, there)
        point, direction = list(one.point), list(one.direction)
        point[number], direction[number] = 2 * about - point[number], -direction[number]
        assert other.point == pytest.approx(point, abs=1e-9)
        assert other.direction == pytest.approx(direction, abs=1e-9)


def test_position_aim_and_one_flap_are_mirrored_and_nothing_else() -> None:
    light = Light(
        "key", (1, 2, 3), aim=(0, 1, 0), concentration=4, flaps=Flaps(Flap(0, 1), Flap(minimum=0.5))
    )
    assert mirrored(light, "other", "y", 1.0) == Light(
        "other", (1, 0, 3), aim=(0, 1, 0), concentration=4, flaps=Flaps(Flap(0, 1), Flap(maximum=1.5))
    )
    directed = Light("key", (1, 2, 3), direction=(0, 1, -1))
    assert repr(mirrored(directed, "key", "x", 0.0).direction) == "(0.0, 1.0, -1.0)"
    assert mirrored(directed, "key", "z", 0.0).direction == (0, 1, 1)


def test_a_mirrored_picture_is_that_of_the_mirrored_light() -> None:
    scene = wall_scene(lights=[Light("key", (0.7, -1.5, 0.4), aim=(0.5, 0, 0), cone_angle=20)])
    other = scene.with_mirrored_light("key").without_light("key")
    one, mirror = (render(each, 40, 40).intensity for each in (scene, other))
    assert np.ptp(one) > 0
    assert np.allclose(one, mirror[:, ::-1], atol=1e-6)


@pytest.mark.parametrize("axis", ["w", "X", ""])
def test_an_unknown_axis_is_refused(axis: Any) -> None:
    with pytest.raises(UsageError, match=f"^an axis must be 'x', 'y' or 'z', not '{axis}'$"):
        mirrored(Light("key", (0, 0, 0)), "other", axis, math.pi)
