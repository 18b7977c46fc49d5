from __future__ import annotations

import numpy as np
import pytest

from autocolor import Mesh, Scene, Studio, scene_of
from autocolor.scene.arrangements import ARRANGEMENTS, arranged
from tests.small import cube

EVERY = pytest.mark.parametrize("name", ARRANGEMENTS)

CUBE = scene_of(cube(), stage="floor")


def seen_from(scene: Scene, axis: str) -> list[list[float]]:
    """The position of each light from the middle of the object: to the right, away and up, from the eye."""
    low, high = map(np.array, scene.object_bounds)
    turn = {"-y": np.eye(3), "+x": np.array([[0, 1, 0], [-1, 0, 0], [0, 0, 1]])}[axis]
    return [(turn @ (np.array(light.position) - (low + high) / 2)).tolist() for light in scene.lights]


@EVERY
def test_the_lights_are_aimed_at_the_object_from_above_the_floor(name: str) -> None:
    scene = arranged(CUBE, name)
    assert scene.replace(lights=CUBE.lights, ambient=CUBE.ambient).equals(CUBE)
    assert all(light.aim == (0.5, 0.5, 0.5) and light.position[2] > 0.9 for light in scene.lights)
    # All is seen, whatever the ranges were before.
    assert len(np.unique(Studio(scene, sends=False).words)) > 100


@EVERY
def test_lights_behind_the_object_leave_the_floor_dark_and_others_light_it(name: str) -> None:
    scene = arranged(CUBE.with_view(eye=(0.5, -4, 0.5), direction=(0, 1, 0)), name)
    for light in scene.lights:
        alone = Studio(scene.only_lights(light.name).replace(ambient=0), sends=False).picture
        floor = alone.surfaces.index("stage") + 1
        lit = [alone.relative[each.pixels].max() for each in alone.slices if each.surface_number == floor]
        assert (max(lit) > 0) == (light.flaps.z is None) == (light.position[1] < 2)


@EVERY
def test_an_arrangement_turns_with_the_eye_and_grows_with_the_object(name: str) -> None:
    front = CUBE.with_view(eye=(0.5, -4, 2), target=(0.5, 0.5, 0.5))
    places = seen_from(arranged(front, name), "-y")
    side = CUBE.with_view(eye=(5, 0.5, 2), target=(0.5, 0.5, 0.5))
    assert np.allclose(seen_from(arranged(side, name), "+x"), places, atol=0.02)
    large = scene_of(Mesh(cube().coordinates * 1000 + 7, cube().node_numbers), view=front.view)
    assert np.allclose(seen_from(arranged(large, name), "-y"), np.array(places) * 1000, atol=20)
