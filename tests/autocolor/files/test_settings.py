from __future__ import annotations

from typing import Any

import pytest
from hypothesis import given

from autocolor import Scene
from autocolor.commands.settings import key_parts
from autocolor.files.settings import field_of, place_of, scene_with, value_at
from autocolor.scene.lights import HalfSpace
from autocolor.testing import scenes
from tests.small import wall_scene
from tests.tables import refused


def keys_of_scene(scene: Scene) -> list[str]:
    """All keys of fields that completion offers."""
    return ["".join(parts)[:-1] for parts in key_parts(Scene, scene)]


def plain_at(scene: Scene, key: str) -> Any:
    """The plain value of a field; None if it is absent."""
    place = place_of(scene, key)
    field, value, name = field_of(place), value_at(scene, place), place.path[-1]
    assert field is not None
    return None if value is None else field.kind.to_plain(name, value)[name]


@given(scenes())
def test_the_value_of_each_field_set_again_leaves_the_scene_as_it_is(scene: Scene) -> None:
    for surface in scene.surfaces:
        # A color of a surface would reset its ramp.
        scene = scene.with_surface(surface.name, ramp=None)
    settings = {key: plain_at(scene, key) for key in keys_of_scene(scene)}
    # A model starts with its default parameters.
    present = {key: value for key, value in settings.items() if value is not None and key[-6:] != ".model"}
    assert len(present) > 20
    # Of several rows of a table one is enough.
    for key in {(place_of(scene, key).table, place_of(scene, key).path): key for key in present}.values():
        value = present[key]
        assert scene_with(scene, {key: value}).equals(scene), key


@pytest.mark.parametrize(
    ("key", "plain", "text"),
    [
        ("surfaces.wall.object_color", [1, 2, 3], "#010203"),
        ("lights.key.only_parts", ["wall"], "wall"),
        ("lights.key.flaps.x", {"minimum": 0.5}, "{minimum = 0.5}"),
        ("lights.key.cone_angle", None, "none"),
    ],
)
def test_a_plain_value_and_its_text_set_the_same(key: str, plain: object, text: str) -> None:
    scene = wall_scene().with_light("key", aim=None, direction=(0, 1, 0), cone_angle=20)
    changed = scene_with(scene, {key: plain})
    assert changed.equals(scene_with(scene, {key: text}))
    assert not changed.equals(scene)


def test_a_number_as_a_name_needs_no_quotes() -> None:
    scene = wall_scene()
    scene = scene.replace(surfaces=(*scene.surfaces, scene.surfaces[0].replace(name="2")))
    assert scene_with(scene, {"parts.wall.surface": "2"}).parts[0].surface == "2"
    assert scene_with(scene, {"lights.key.only_surfaces": "2"}).lights["key"].links.only_surfaces == ("2",)


@pytest.mark.parametrize(("whole", "bands"), [(None, 16), ({"name": "x", "bands": 4}, 4)])
def test_a_whole_row_is_set_before_its_fields_in_any_order(whole: object, bands: int) -> None:
    settings = {"scalar.name": "z", "scalar": whole}
    scene = wall_scene().with_scalar(name="y", bands=7)
    one, other = scene_with(scene, settings), scene_with(scene, dict(reversed(settings.items())))
    assert one.scalar == other.scalar
    assert one.scalar is not None
    assert (one.scalar.name, one.scalar.bands) == ("z", bands)


DOOR = (HalfSpace("door", (0, 0, 0), (1, 0, 0)),)
NAMED = "a name cannot be set; change it in the scene file"

HALF_SPACES = "lights.key.half_spaces"

test_what_is_refused = refused(
    lambda settings: scene_with(wall_scene().with_light("key", half_spaces=DOOR), settings),
    [
        (
            {"ambient": None},
            "ambient: it must be a finite number of at least 0, not none; only an optional field can be"
            " unset",
        ),
        ({"ambint": 1}, "ambint: there is no field 'ambint'; did you mean 'ambient'?"),
        ({"ambient.x": 1}, "ambient.x: there is no field 'ambient.x'; did you mean 'ambient'?"),
        ({"surfaces.wal.blend": 1}, "surfaces.wal.blend: there is no surface 'wal'; did you mean 'wall'?"),
        ({"surfaces.wall.blend": 2}, "surface 'wall': blend must be a number from 0 to 1, not 2"),
        ({"surfaces.wall.name": "a"}, f"surfaces.wall.name: {NAMED}"),
        ({f"{HALF_SPACES}.door.name": "a"}, f"{HALF_SPACES}.door.name: {NAMED}"),
        (
            {f"{HALF_SPACES}.dor.on": 1},
            f"{HALF_SPACES}.dor.on: there is no half-space 'dor'; did you mean 'door'?",
        ),
        (
            {"lights.key.flaps": None, "lights.key.flaps.z": {}},
            "lights.key.flaps.z: lights.key.flaps is also set, as a whole; leave one out",
        ),
    ],
)


def test_a_value_that_is_absent_is_none() -> None:
    scene = wall_scene()
    more = scene.with_new_light("nobody", position=(1, 1, 1))
    for key in ("lights.nobody.on", "lights.key.flaps.z.maximum", "scalar.name", "surfaces.wall.nothing"):
        assert value_at(scene, place_of(more, key)) is None
