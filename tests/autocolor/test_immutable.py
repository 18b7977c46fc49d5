from __future__ import annotations

import copy
import pickle
from collections.abc import Iterator, Mapping
from functools import cache
from typing import Any

import numpy as np
import pytest

from autocolor import Light, Paint, Picture, Scene, Surface, View, render, scene_of
from tests.small import cube


def arrays_in(value: object, path: str = "") -> Iterator[tuple[str, np.ndarray[Any, Any]]]:
    """Every array that a value holds, wherever inside, with its path."""
    if isinstance(value, np.ndarray):
        yield path, value
    elif isinstance(value, (tuple, list)):
        for row, each in enumerate(value):
            yield from arrays_in(each, f"{path}[{row}]")
    elif isinstance(value, Mapping):
        for key, each in value.items():
            yield from arrays_in(each, f"{path}[{key!r}]")
    elif hasattr(value, "__dict__") and not isinstance(value, type):
        for name, each in vars(value).items():
            yield from arrays_in(each, f"{path}.{name}")


@cache
def scene_and_picture() -> tuple[Scene, Picture]:
    """A scene and a picture of it, with everything computed that they keep."""
    scene = scene_of(cube())
    picture = render(scene, (16, 12))
    _ = scene.mesh.bounds, scene.object_coordinates, scene.view.axes
    _ = picture.intensity, picture.surface_number, picture.relative_ranges
    return scene, picture


@pytest.mark.parametrize("which", [0, 1])
def test_the_arrays_of_a_scene_and_a_picture_are_read_only_in_pickles_too(which: int) -> None:
    value = scene_and_picture()[which]
    originals, copies = dict(arrays_in(value)), dict(arrays_in(pickle.loads(pickle.dumps(value))))
    assert len(copies) >= 6
    assert originals.keys() == copies.keys()
    for path, array in copies.items():
        assert (array == originals[path]).all()
    assert [path for each in (originals, copies) for path in each if each[path].flags.writeable] == []


def test_a_copy_within_a_process_is_the_value_itself() -> None:
    scene, picture = scene_and_picture()
    for value in (scene, picture, scene.mesh, scene.view, scene.lights[0], scene.surfaces[0]):
        assert copy.deepcopy(value) is value
        assert copy.copy(value) is value


def test_a_scene_from_a_pickle_renders_to_the_same_picture_and_is_edited() -> None:
    scene, picture = scene_and_picture()
    again = pickle.loads(pickle.dumps(scene))
    assert again.lights == scene.lights
    assert (render(again, (16, 12)).intensity == picture.intensity).all()
    assert again.with_surface("surface", blend=0.25).surfaces["surface"].paint.blend == 0.25


@pytest.mark.parametrize(
    ("value", "shown"),
    [
        (View((0, -5, 1), target=(0, 0, 0)), "View(eye=(0.0, -5.0, 1.0), target=(0.0, 0.0, 0.0))"),
        (Light("key", (1, 2, 3), on=False), "Light(name='key', position=(1.0, 2.0, 3.0), on=False)"),
        (
            Surface("body").replace(object_color="red"),
            "Surface(name='body', paint=Paint(object_color=(255, 0, 0)))",
        ),
    ],
)
def test_a_row_shows_what_is_not_its_default_and_can_be_made_of_that(value: object, shown: str) -> None:
    assert repr(value) == shown
    assert eval(shown, {"View": View, "Light": Light, "Surface": Surface, "Paint": Paint}) == value


def test_no_value_shows_more_than_a_line_and_arrays_show_their_shape_and_type() -> None:
    scene, picture = scene_and_picture()
    for value in (scene, picture, scene.mesh, scene.mesh.normals, *picture.planes.values(), *scene.lights):
        assert len(repr(value)) < 200
        assert "\n" not in repr(value)
    planes = picture.planes["key"]
    assert repr(planes) == "LightPlane(diffuse=(12, 16) float32, specular=(12, 16) float32)"
