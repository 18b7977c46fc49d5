from __future__ import annotations

import copy
import pickle
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest

from autocolor import Light, Picture, Scene, Surface, View, render, scene_of
from autocolor.arrays import Floats
from autocolor.immutable import Immutable, read_only
from tests.small import cube

Copy = Callable[[Any], Any]

COPIES = {
    "pickle": lambda value: pickle.loads(pickle.dumps(value)),
    "deepcopy": copy.deepcopy,
    "copy": copy.copy,
}


@dataclass(frozen=True, eq=False, repr=False)
class Box(Immutable):
    numbers: Floats
    pair: tuple[Floats, str]
    name: str = "box"


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


def scene_and_picture() -> tuple[Scene, Picture]:
    """A scene and a picture of it, with everything computed that they keep."""
    scene = scene_of(cube())
    picture = render(scene, 12, 16)
    _ = scene.mesh.bounds, scene.object_coordinates, scene.view.axes
    _ = picture.intensity, picture.surface_number, picture.relative_ranges
    return scene, picture


@pytest.mark.parametrize("way", COPIES)
@pytest.mark.parametrize("which", [0, 1])
def test_the_arrays_of_a_scene_and_a_picture_are_read_only_in_copies_too(way: str, which: int) -> None:
    value = scene_and_picture()[which]
    copied = COPIES[way](value)
    originals, copies = dict(arrays_in(value)), dict(arrays_in(copied))
    assert len(copies) >= 6
    assert originals.keys() == copies.keys()
    for path, array in copies.items():
        assert (array == originals[path]).all()
        assert not array.flags.writeable, path
    assert [path for path, array in originals.items() if array.flags.writeable] == []


def test_a_copy_within_a_process_is_the_value_itself() -> None:
    scene, picture = scene_and_picture()
    for value in (scene, picture, scene.mesh, scene.view, scene.lights[0], scene.surfaces[0]):
        assert copy.deepcopy(value) is value
        assert copy.copy(value) is value
    assert copy.deepcopy([scene, picture])[0] is scene


def test_a_scene_from_a_pickle_renders_to_the_same_picture() -> None:
    scene, picture = scene_and_picture()
    again = pickle.loads(pickle.dumps(scene))
    assert again is not scene
    assert again.lights == scene.lights
    assert (render(again, 12, 16).intensity == picture.intensity).all()
    assert again.with_surface("surface", object_color="red").surface("surface").paint.object_color == (
        255,
        0,
        0,
    )


def test_an_array_is_shown_as_its_shape_and_type() -> None:
    box = Box(read_only(np.zeros((2, 3))), (np.ones(2), "b"))
    assert repr(box).startswith("Box(numbers=(2, 3) float64, pair=(array([1., 1.]), 'b'), name='box')")
    unpickled = Box.__new__(Box)
    unpickled.__setstate__({"numbers": np.zeros(2), "pair": (np.ones(2), "b"), "name": "other"})
    assert not unpickled.numbers.flags.writeable
    assert not unpickled.pair[0].flags.writeable


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
    from autocolor import Paint

    assert repr(value) == shown
    assert eval(shown, {"View": View, "Light": Light, "Surface": Surface, "Paint": Paint}) == value


def test_no_value_shows_more_than_a_line() -> None:
    scene, picture = scene_and_picture()
    for value in (scene, picture, scene.mesh, scene.mesh.normals, *picture.planes.values(), *scene.lights):
        assert len(repr(value)) < 200
        assert "\n" not in repr(value)
