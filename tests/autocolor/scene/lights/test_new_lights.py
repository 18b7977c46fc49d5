from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given

from autocolor import Light, Scene, View, scene_of
from autocolor.scene.lights.new_lights import DISTANCE, TURNS, new_light_of
from tests.autocolor.meshes import cube
from tests.autocolor.strategies import scenes


@given(scenes())
def test_a_new_light_can_be_added_to_any_scene(scene: Scene) -> None:
    light = new_light_of(scene)
    more = scene.replace(lights=(*scene.lights, light))
    assert more.light(light.name) is light


def test_a_new_light_is_above_the_eyes_side_and_aimed_at_the_middle() -> None:
    scene = scene_of(cube(), lights=[], view=View((-4, 0.5, 1.0), target=(0.5, 0.5, 0.5)))
    light = new_light_of(scene)
    assert light.name == "light"
    assert light.aim == pytest.approx((0.5, 0.5, 0.5))
    assert light.position[0] < -1
    assert light.position[1] == pytest.approx(0.5)
    assert light.position[2] > 1
    assert math.dist(light.position, (0.5, 0.5, 0.5)) == pytest.approx(DISTANCE * math.sqrt(3) / 2)


def test_new_lights_stand_apart_until_there_are_lights_all_around() -> None:
    scene = scene_of(cube(), lights=[])
    for _ in range(len(TURNS) + 2):
        scene = scene.replace(lights=(*scene.lights, new_light_of(scene)))
    assert [light.name for light in scene.lights[:3]] == ["light", "light 2", "light 3"]
    places = np.array([light.position for light in scene.lights[: len(TURNS)]])
    apart = np.linalg.norm(places[:, None] - places, axis=2) + 100 * np.eye(len(places))
    assert apart.min() >= math.sqrt(3) / 2
    assert scene.lights[-1].position == scene.lights[0].position


def test_a_larger_object_has_its_light_farther_away() -> None:
    near, far = (new_light_of(scene_of(cube(size), lights=[])) for size in (1.0, 10.0))
    middle = np.full(3, 5.0)
    assert np.array(far.position) - middle == pytest.approx((np.array(near.position) - 0.5) * 10)


def test_a_light_for_a_view_from_straight_above_is_there_too() -> None:
    scene = scene_of(
        cube(), lights=[Light("light", (9, 9, 9))], view=View((0.5, 0.5, 5), direction=(0, 0, -1))
    )
    light = new_light_of(scene)
    assert light.name == "light 2"
    assert light.position[2] > 0.5
