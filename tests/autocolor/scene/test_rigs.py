from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given

from autocolor import Flap, Flaps, HalfSpace, InputError, Light, Rig, Scene, render, scene_of
from autocolor.scene.columns import from_plain, to_plain
from tests.autocolor.meshes import cube
from tests.autocolor.strategies import scenes


@given(scenes())
def test_a_rig_on_its_own_scene_gives_the_same_lights_exactly(scene: Scene) -> None:
    assert scene.replace(lights=()).with_rig(scene.rig).lights == scene.lights
    assert from_plain(Rig, to_plain(scene.rig)) == scene.rig


@given(scenes(), scenes())
def test_a_rig_keeps_names_directions_and_intensities_on_any_scene(one: Scene, other: Scene) -> None:
    lights = other.with_rig(one.rig).lights
    told = [(light.name, light.direction, light.intensity, light.on, light.cone_angle) for light in lights]
    assert told == [
        (light.name, light.direction, light.intensity, light.on, light.cone_angle) for light in one.lights
    ]


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


@pytest.mark.parametrize("size", [5e-324, 1e-300])
def test_a_rig_that_cannot_be_fitted_is_refused(size: float) -> None:
    rig = Rig((0, 0, 0), (size, 0, 0), (Light("key", (0, 0, 1)),))
    with pytest.raises(InputError, match="light 'key': position must be three finite numbers"):
        rig.fitted((0, 0, 0), (1e30, 0, 0))


def test_a_rig_whose_minimum_is_above_its_maximum_is_refused_by_its_axis() -> None:
    with pytest.raises(InputError) as refusal:
        Rig((0, 2, 0), (1, 1, 1))
    assert (
        str(refusal.value) == "rig: the minimum of y must not be above the maximum, not 2 to 1; exchange them"
    )
    with pytest.raises(InputError, match="rig: minimum must be three finite numbers of at most 1e36, not 3"):
        Rig(3, (1, 1, 1))  # type: ignore[arg-type]


def test_lights_that_follow_keep_their_place_beside_what_they_follow_and_are_as_many_sizes_from_it() -> None:
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
