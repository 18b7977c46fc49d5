from __future__ import annotations

from pathlib import Path

import pytest

from autocolor import Scene, read_scene
from autocolor.commands.setting_keys import Place, field_of, keys_after, place_of
from autocolor.scene.changes import HalfSpaceChanges


@pytest.fixture
def scene(folder: Path) -> Scene:
    plane: HalfSpaceChanges = {"point": (0, 0, 0), "direction": (0, 0, 1)}
    rows = {"left": plane, "a.b": plane}
    return read_scene("scene").with_light("key", half_spaces=rows, only_parts=["side"])


@pytest.mark.parametrize(
    ("key", "place"),
    [
        ("ambient", ("", "", ("ambient",))),
        ("view.eye", ("view", "", ("eye",))),
        ("scalar.name", ("scalar", "", ("name",))),
        ("scalar", ("", "", ("scalar",))),
        ("lights.key.aim", ("lights", "key", ("aim",))),
        ("lights.key.2.aim", ("lights", "key.2", ("aim",))),
        ('surfaces."front.low".blend', ("surfaces", "front.low", ("blend",))),
        ("lights.key.flaps.z.minimum", ("lights", "key", ("flaps", "z", "minimum"))),
        ("lights.key.half_spaces", ("lights", "key", ("half_spaces",))),
        ("lights.key.half_spaces.left", ("lights", "key", ("half_spaces", "left"))),
        ("lights.key.half_spaces.new", ("lights", "key", ("half_spaces", "new"))),
        ("lights.key.half_spaces.'ne.w'", ("lights", "key", ("half_spaces", "ne.w"))),
        ("lights.key.half_spaces.a.b.on", ("lights", "key", ("half_spaces", "a.b", "on"))),
        ("lights.key.only_parts", ("lights", "key", ("only_parts",))),
    ],
)
def test_a_key_leads_to_a_table_a_row_and_a_path_in_it(scene: Scene, key: str, place: Place) -> None:
    assert place_of(scene, key) == place
    assert field_of(place_of(scene, key)) is not None


@pytest.mark.parametrize(
    ("key", "default"),
    [
        ("ambient", 0.1),
        ("lights.key.cone_angle", None),
        ("lights.key.flaps.z", None),
        ("lights.key.flaps.z.on", True),
        ("lights.key.half_spaces.left.edge_width", 0.0),
        ("lights.key.half_spaces.a.b.on", True),
        ("lights.key.follows", None),
        ("lights.key.except_surfaces", None),
        ("surfaces.side.blend", 0.6),
        ("surfaces.side.diffuse", 0.7),
        ("surfaces.side.exponent", 20.0),
        ("surfaces.side.roughness", 0.3),
        ("surfaces.side.base_reflectance", None),
        ("surfaces.side.refractive_index", None),
        ("surfaces.side.fresnel_curve", None),
    ],
)
def test_a_field_is_found_wherever_it_is_inside_its_row(scene: Scene, key: str, default: object) -> None:
    field = field_of(place_of(scene, key))
    assert field is not None
    assert field.default is not None
    assert field.default() == default


def test_a_key_that_its_row_has_not_has_no_field() -> None:
    assert field_of(Place("lights", "key", ("brightness",))) is None
    assert field_of(Place("lights", "key", ("on", "off"))) is None


@pytest.mark.parametrize(
    ("start", "some"),
    [
        ("", {"ambient=", "view.", "lights.", "parts.", "surfaces.", "background="}),
        ("lights.", {"lights.key.", "lights.key.2."}),
        ("surfaces.", {"surfaces.front.low.", "surfaces.side."}),
        ("surfaces.front.low.", {"surfaces.front.low.blend=", "surfaces.front.low.exponent="}),
        ("lights.key.", {"lights.key.aim=", "lights.key.flaps.", "lights.key.cone_angle="}),
        ("lights.key.flaps.", {"lights.key.flaps.x.", "lights.key.flaps.y.", "lights.key.flaps.z."}),
        ("lights.key.flaps.z.", {"lights.key.flaps.z.minimum=", "lights.key.flaps.z.on="}),
        ("lights.key.", {"lights.key.half_spaces.", "lights.key.follows=", "lights.key.only_parts="}),
        ("lights.key.2.", {"lights.key.2.half_spaces="}),
        ("lights.key.half_spaces.", {"lights.key.half_spaces.a.b.", "lights.key.half_spaces.left."}),
        (
            "lights.key.half_spaces.a.b.",
            {"lights.key.half_spaces.a.b.point=", "lights.key.half_spaces.a.b.on="},
        ),
        ("lights.key.half_spaces.left.on=", {"lights.key.half_spaces.left.on=false"}),
        ("lights.key.half_spaces.left.edge_width=", {"lights.key.half_spaces.left.edge_width=0.0"}),
        ("lights.key.follows=", {"lights.key.follows=eye", "lights.key.follows=key.2"}),
        ("lights.key.only_parts=", {"lights.key.only_parts=side", "lights.key.only_parts=front.low"}),
        ("parts.side.surface=", {"parts.side.surface=side", "parts.side.surface=front.low"}),
        ("view.", {"view.eye=", "view.field_of_view="}),
        ("scalar.", {"scalar.name=", "scalar.limits=", "scalar.bands="}),
        ("scalar.name=", {"scalar.name=x", "scalar.name=mean curvature"}),
        ("scalar.scale=", {"scalar.scale=viridis", "scalar.scale=zebra_r"}),
        ("dither=", {"dither=off", "dither=ordered"}),
        ("ambient=", {"ambient=0.1"}),
        ("lights.key.on=", {"lights.key.on=true", "lights.key.on=false"}),
        ("lights.key.flaps.z.maximum=", {"lights.key.flaps.z.maximum=0.5"}),
        ("surfaces.side.model=", {"surfaces.side.model=phong", "surfaces.side.model=blinn"}),
    ],
)
def test_the_keys_after_a_start_are_those_of_its_table(scene: Scene, start: str, some: set[str]) -> None:
    found = keys_after(scene, start)
    assert some <= set(found)
    assert all(each.startswith(start) for each in found)
    assert not {"lights.key.name=", "lights.key.half_spaces.a.b.name="} & set(found)


def test_every_key_that_is_offered_can_be_set(scene: Scene) -> None:
    starts = [""]
    keys: list[str] = []
    while starts:
        for each in keys_after(scene, starts.pop()):
            (keys if each.endswith("=") else starts).append(each)
    assert len(keys) > 60
    for key in keys:
        assert field_of(place_of(scene, key[:-1])) is not None
