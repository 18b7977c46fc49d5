from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import Flap, Flaps, HalfSpace, Light, Rig, Scene, render, scene_of
from autocolor.scene.columns import from_plain, to_plain
from autocolor.scene.following import detached
from autocolor.scene.lights import AXES
from autocolor.scene.rigs import mirrored
from autocolor.testing import coordinates, lights, scenes
from tests.small import cube
from tests.tables import call, refused


@given(scenes())
def test_a_rig_on_its_own_scene_gives_the_same_lights_exactly(scene: Scene) -> None:
    assert scene.replace(lights=()).with_rig(scene.rig).lights == scene.lights
    assert from_plain(Rig, to_plain(scene.rig)) == scene.rig


def test_a_rig_is_fitted_to_the_middle_and_the_size_of_the_object() -> None:
    rig = Rig(
        (0, 0, 0),
        (1, 1, 1),
        (
            Light(
                "key",
                (0.5, -3.5, 2.5),
                aim=(0.5, 0.5, 0.0),
                flaps=Flaps(y=Flap(0, 1, False), z=Flap(0.25)),
            ),
            Light("sun", (0.5, 0.5, 9.5), direction=(0, 1, -1)),
        ),
    )
    key, sun = rig.fitted((-1, -1, -1), (1, 1, 1))
    assert key == Light("key", (0, -8, 4), aim=(0, 0, -1), flaps=Flaps(z=Flap(-0.5), y=Flap(-1, 1, on=False)))
    assert sun == Light("sun", (0, 0, 18), direction=(0, 1, -1))


def test_an_object_twice_as_large_looks_the_same_with_a_fitted_rig() -> None:
    planes = (
        HalfSpace("across", (0.2, 0, 0.3), (1, 0, 1), edge_width=0.3),
        HalfSpace("door", (-0.1, 0, 0), (1, 0, 0), edge_width=0.2, carried=True),
    )
    flaps = Flaps(x=Flap(0.1, edge_width=0.4), z=Flap(0.3))
    key = Light("key", (-2, -3, 4), aim=(0.5, 0.2, 0.9), concentration=6, flaps=flaps, half_spaces=planes)
    small = scene_of(cube(), lights=[key, key.replace(name="bare", half_spaces=(), flaps=Flaps())])
    large = scene_of(cube(2.0), lights=()).with_rig(small.rig)
    one, other = (render(each, 60, 80).intensity for each in (small, large))
    assert np.ptp(one) > 0.1
    assert np.allclose(one, other, atol=1e-5)
    alone = (each.with_light("bare", on=False) for each in (small, large))
    one, other = (render(each, 60, 80).intensity for each in alone)
    assert np.ptp(one) > 0.01
    assert np.allclose(one, other, atol=1e-5)


def test_an_object_without_size_moves_the_lights_and_keeps_distances() -> None:
    rig = Rig((1, 1, 1), (1, 1, 1), (Light("key", (1, 1, 3)),))
    assert rig.fitted((0, 0, 0), (2, 2, 4))[0].position == (1, 1, 4)
    assert Rig((0, 0, 0), (2, 2, 4), rig.lights).fitted((1, 1, 1), (1, 1, 1))[0].position == (1, 1, 2)


def test_lights_that_follow_keep_their_place_in_sizes_of_the_object() -> None:
    rig = Rig(
        (0, 0, 0),
        (1, 1, 1),
        (
            Light("key", (0.5, -3.5, 2.5), aim=(0.5, 0.5, 0.0)),
            Light("beside", (0, 0, 2), aim=(1, 0, 0), follows="key"),
            Light("lamp", (0, 0, 0), follows="eye"),
            Light("left", (-1, 0, 0), direction=(1, 3, 0), follows="eye"),
        ),
    )
    _, beside, lamp, left = rig.fitted((-1, -1, -1), (1, 1, 1))
    assert beside == Light("beside", (0, 0, 4), aim=(2, 0, 0), follows="key")
    assert lamp == rig.lights[2]
    assert left == Light("left", (-2, 0, 0), direction=(1, 3, 0), follows="eye")
    small = scene_of(cube(), lights=rig.lights)
    large = scene_of(cube(2.0), lights=()).with_rig(small.rig)
    one, other = (render(each, 60, 80).intensity for each in (small, large))
    assert np.allclose(one, other, atol=1e-5)


@given(lights(), st.sampled_from(AXES), coordinates())
def test_the_half_spaces_of_a_mirrored_light_are_mirrored_in_the_world(
    light: Light, axis: str, about: float
) -> None:
    there = mirrored(light, "there", axis, about)
    number = AXES.index(axis)
    for plane, copy in zip(light.half_spaces, there.half_spaces, strict=True):
        assert copy.carried == plane.carried
        one, other = detached(plane, light), detached(copy, there)
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


test_a_rig_or_a_mirror_that_breaks_a_rule_is_refused = refused(
    call,
    [
        (
            lambda: Rig((0, 2, 0), (1, 1, 1)),
            "rig: the minimum of y must be at most the maximum, not 2 to 1; exchange them",
        ),
        (
            lambda: mirrored(Light("key", (0, 0, 0)), "other", "X", math.pi),
            "an axis must be 'x', 'y' or 'z', not 'X'",
        ),
        (
            lambda: Rig((0, 0, 0), (1e-300, 0, 0), (Light("key", (0, 0, 1)),)).fitted(
                (0, 0, 0), (1e30, 0, 0)
            ),
            "light 'key': position must be three finite numbers of at most 1e36, not (-inf, nan, inf)",
        ),
    ],
)
