from __future__ import annotations

from typing import Any

import pytest
from hypothesis import given

from autocolor import InputError, Scene, UsageError
from autocolor.commands.settings import keys_after
from autocolor.files.settings import field_of, place_of, scene_with, value_at
from autocolor.testing import scenes
from tests.small import wall_scene


def keys_of_scene(scene: Scene) -> list[str]:
    """All keys of fields that completion offers."""
    starts = [""]
    keys: list[str] = []
    while starts:
        for each in keys_after(scene, starts.pop()):
            (keys if each.endswith("=") else starts).append(each)
    return [key[:-1] for key in keys]


def plain_at(scene: Scene, key: str) -> Any:
    """The plain value of a field; None if it is absent."""
    place = place_of(scene, key)
    field, value, name = field_of(place), value_at(scene, place), place.path[-1]
    assert field is not None
    return None if value is None else field.column.kind.to_plain(name, value)[name]


@given(scenes())
def test_the_value_of_each_field_set_again_leaves_the_scene_as_it_is(scene: Scene) -> None:
    for surface in scene.surfaces:
        # A color of a surface would reset its ramp.
        scene = scene.with_surface(surface.name, ramp=None)
    settings = {key: plain_at(scene, key) for key in keys_of_scene(scene)}
    present = {key: value for key, value in settings.items() if value is not None}
    assert len(present) > 20
    for key, value in present.items():
        if key.endswith(".model"):
            # A model starts with its default parameters.
            continue
        assert scene_with(scene, {key: value}).equals(scene), key


@pytest.mark.parametrize(
    ("key", "plain", "text"),
    [
        ("ambient", 0.25, "0.25"),
        ("surfaces.wall.object_color", [1, 2, 3], "#010203"),
        ("lights.key.position", (1, 2, 3), "[1, 2, 3]"),
        ("lights.key.only_parts", ["wall"], "wall"),
        ("lights.key.flaps.x", {"minimum": 0.5}, "{minimum = 0.5}"),
        ("lights.key.cone_angle", None, "none"),
        ("exposure", {"object": [0, 2]}, "{object = [0, 2]}"),
        ("view.angle", 10, "10"),
    ],
)
def test_a_plain_value_and_its_text_set_the_same(key: str, plain: object, text: str) -> None:
    scene = wall_scene().with_light("key", aim=None, direction=(0, 1, 0), cone_angle=20)
    changed = scene_with(scene, {key: plain})
    assert changed.equals(scene_with(scene, {key: text}))
    assert not changed.equals(scene)


def test_a_name_that_is_a_number_needs_no_quotes() -> None:
    scene = wall_scene()
    scene = scene.replace(surfaces=(*scene.surfaces, scene.surfaces[0].replace(name="2")))
    assert scene_with(scene, {"parts.wall.surface": "2"}).parts[0].surface == "2"


@pytest.mark.parametrize("whole", [None, {"name": "x", "bands": 4}])
def test_a_whole_row_is_set_before_its_fields_in_any_order(whole: object) -> None:
    settings = {"scalar.name": "z", "scalar": whole}
    scene = wall_scene().with_scalar(name="y")
    one, other = scene_with(scene, settings), scene_with(scene, dict(reversed(settings.items())))
    assert one.scalar == other.scalar
    assert one.scalar is not None
    assert one.scalar.name == "z"


def test_a_color_shares_everything_else_with_the_scene() -> None:
    scene = wall_scene()
    changed = scene_with(scene, {"surfaces.wall.object_color": "red"})
    assert (changed.mesh, changed.view, changed.lights) == (scene.mesh, scene.view, scene.lights)
    assert scene_with(scene, {}) is scene


@pytest.mark.parametrize(
    ("settings", "error", "sentence"),
    [
        ({"surfaces.wal.blend": 1}, UsageError, "surfaces.wal.blend: there is no surface 'wal'; did you"),
        ({"ambient": None}, UsageError, "ambient: it must be a finite number of at least 0, not none"),
        ({"surfaces.wall.blend": 2}, InputError, "surface 'wall': blend must be a number from 0 to 1, not 2"),
        ({"view.eye": [1, 2]}, InputError, "view: eye must be three finite numbers"),
    ],
)
def test_a_refusal_names_the_key_or_the_row(
    settings: dict[str, object], error: type[Exception], sentence: str
) -> None:
    with pytest.raises(error) as refused:
        scene_with(wall_scene(), settings)
    assert str(refused.value).startswith(sentence)


@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("surfaces.wall.exponent", 20.0),
        ("lights.key.flaps.z.maximum", None),
        ("lights.nobody.on", None),
        ("scalar.name", None),
        ("surfaces.wall.nothing", None),
    ],
)
def test_the_value_of_a_field_is_found_wherever_it_is_and_none_if_it_is_absent(
    key: str, value: object
) -> None:
    scene = wall_scene()
    place = place_of(scene.with_new_light("nobody", position=(1, 1, 1)), key)
    assert value_at(scene, place) == value
