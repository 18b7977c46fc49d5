from __future__ import annotations

import math
from pathlib import Path

import pytest

from autocolor import Flaps, Phong, Scene, Surface, read_scene
from autocolor.commands.settings import keys_after, with_settings
from autocolor.errors import UsageError
from autocolor.files.settings import SettingPlace, field_of, place_of, value_of
from autocolor.scene.changes import HalfSpaceChanges
from tests.autocolor.commands.conftest import Run


@pytest.fixture
def scene(folder: Path) -> Scene:
    return read_scene("scene")


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("2", 2),
        ("2.5", 2.5),
        ("[1, 2]", [1, 2]),
        ("true", True),
        ("#b01020", "#b01020"),
        ('"#b01020"', "#b01020"),
        ("gamma", "gamma"),
        ("", ""),
        ("{minimum = 0.5}", {"minimum": 0.5}),
        ("[[0, 0], [1, 2], [2, 3], [3, 3], [4, 5]]", [[0, 0], [1, 2], [2, 3], [3, 3], [4, 5]]),
        ("1\nother = 2", "1\nother = 2"),
        ("{a=" * 2000, "{a=" * 2000),
        ("[" * 2000, "[" * 2000),
        ("9" * 5000, "9" * 5000),
        ("a." * 2000, "a." * 2000),
        ("\udcff", "\udcff"),
    ],
)
def test_a_value_is_written_as_in_a_scene_file(text: str, value: object) -> None:
    assert value_of(text) == value


def test_every_kind_of_key_can_be_set(scene: Scene) -> None:
    changed = with_settings(
        scene,
        (
            "ambient=0.25",
            "scaling=object",
            "mapping=[[0,0],[0.5,0.75],[1,1]]",
            "contrast=floor",
            "background=#102030",
            "view.angle=10",
            "view.eye=[3, -4, 5]",
            "lights.key.intensity=2",
            " lights.key.aim = [1, 0, 0] ",
            "surfaces.side.exponent=40",
            "surfaces.side.light_color=[1, 2, 3]",
            "surfaces.side.levels=20",
            "parts.side.surface=front.low",
            "parts.side.stage=true",
        ),
    )
    assert (changed.ambient, changed.scaling, changed.contrast) == (0.25, "object", "floor")
    assert changed.mapping == ((0, 0), (0.5, 0.75), (1, 1))
    assert changed.background == (16, 32, 48)
    assert (changed.view.angle, changed.view.eye) == (10, (3, -4, 5))
    assert (changed.light("key").intensity, changed.light("key").aim) == (2, (1, 0, 0))
    side = changed.surface("side")
    assert (side.reflectance.exponent, side.paint.light_color, side.levels) == (40, (1, 2, 3), 20)
    assert changed.part("side").surface == "front.low"
    assert changed.part("side").stage


@pytest.mark.parametrize(
    ("setting", "key"),
    [
        ("base_reflectance=0.04", "base_reflectance"),
        ("refractive_index=1.5", "refractive_index"),
        ("fresnel_curve=[[0, 0.04], [90, 1]]", "fresnel_curve"),
    ],
)
def test_the_growth_of_s_is_set_in_any_way_unset_and_refused_beside_cook_and_torrance(
    scene: Scene, setting: str, key: str
) -> None:
    grown = with_settings(scene, (f"surfaces.side.{setting}",))
    model = grown.surface("side").reflectance.model
    assert isinstance(model, Phong)
    assert model.growth.largest == pytest.approx(25)
    assert with_settings(grown, (f"surfaces.side.{key}=none",)).surface("side") == scene.surface("side")
    with pytest.raises(UsageError) as refusal:
        with_settings(scene, (f"surfaces.side.{setting}", "surfaces.side.model=cook-torrance"))
    assert str(refusal.value) == (
        f"--set: surface 'side': {key} must go with model = 'phong' or 'blinn', not with 'cook-torrance';"
        " leave it out, or change the model"
    )


def test_a_scalar_is_set_where_there_was_none_in_any_order_and_unset(scene: Scene) -> None:
    changed = with_settings(scene, ("scalar.bands=8", "scalar.limits=[0,250]", "scalar.name=z"))
    assert changed.scalar is not None
    assert (changed.scalar.name, changed.scalar.bands, changed.scalar.limits) == ("z", 8, (0.0, 250.0))
    other = with_settings(changed, ("scalar.scale=magma", "scalar.limits=none"))
    assert other.scalar == changed.with_scalar(scale="magma", limits=None).scalar
    assert with_settings(other, ("scalar=none",)).scalar is None


def test_flaps_are_set_whole_or_field_by_field(scene: Scene) -> None:
    flaps = with_settings(scene, ("lights.key.flaps.z.maximum=0.75",)).light("key").flaps
    assert flaps.z is not None
    assert (flaps.z.minimum, flaps.z.maximum) == (0, 0.75)
    flaps = with_settings(scene, ("lights.key.flaps.x={maximum = 0.25, on = false}",)).light("key").flaps
    assert flaps.x is not None
    assert flaps.z is not None
    assert (flaps.x.maximum, flaps.x.on, flaps.z.maximum) == (0.25, False, 0.5)


def test_a_light_is_linked_to_names_in_a_list_and_unlinked_by_none(scene: Scene) -> None:
    linked = with_settings(
        scene, ('lights.key.only_surfaces=["side", "front.low"]', 'lights.key.except_parts=["side"]')
    )
    links = linked.light("key").links
    assert (links.only_surfaces, links.except_parts) == (("side", "front.low"), ("side",))
    # One list takes the place of the other in one go.
    other = with_settings(linked, ("lights.key.except_surfaces=[]", "lights.key.only_surfaces=none"))
    assert other.light("key").links == links.replace(only_surfaces=None, except_surfaces=())
    with pytest.raises(UsageError) as refused:
        with_settings(scene, ('lights.key.only_surfaces=["sid"]',))
    sentence = "light 'key': only_surfaces 'sid' is not in the surface table; did you mean 'side'?"
    assert str(refused.value) == f"--set: {sentence}"


def test_the_order_of_the_settings_of_a_row_does_not_matter(scene: Scene) -> None:
    # Each alone would break a rule.
    settings = ("lights.key.2.concentration=5", "lights.key.2.aim=[0, 0, 0]")
    flaps = ("lights.key.flaps.z.minimum=2", "lights.key.flaps.z.maximum=3")
    for order in (settings, settings[::-1]):
        assert with_settings(scene, order).light("key.2").concentration == 5
    for order in (flaps, flaps[::-1]):
        assert with_settings(scene, order).light("key").flaps.z is not None


def test_the_last_of_two_settings_of_one_key_counts(scene: Scene) -> None:
    assert with_settings(scene, ("ambient=1", "ambient=2")).ambient == 2


@pytest.mark.parametrize("name", ["front.low", '"front.low"', "'front.low'"])
def test_a_name_may_hold_points_and_stand_in_quotes(scene: Scene, name: str) -> None:
    changed = with_settings(scene, (f"surfaces.{name}.blend=0.125",))
    assert changed.surface("front.low").paint.blend == 0.125


def test_of_two_names_the_longer_is_meant(scene: Scene) -> None:
    changed = with_settings(scene, ("lights.key.2.intensity=3", "lights.key.intensity=2"))
    assert [light.intensity for light in changed.lights] == [2, 3]


@pytest.mark.parametrize(
    ("setting", "sentence"),
    [
        ("ambiet=1", "--set ambiet: there is no field 'ambiet'; did you mean 'ambient'?"),
        ("light.k.on=true", "--set light.k.on: there is no field 'light'; did you mean 'lights'?"),
        ("lights.kye.on=true", "--set lights.kye.on: there is no light 'kye'; did you mean 'key'?"),
        ("surfaces.sid.blend=1", "--set surfaces.sid.blend: there is no surface 'sid'; did you mean 'side'?"),
        ("parts.sid.surface=x", "--set parts.sid.surface: there is no part 'sid'; did you mean 'side'?"),
        ("lights=1", "--set lights: it must name a field; write it as in lights.key.intensity=2"),
        ("lights.key=1", "--set lights.key: it must name a field; write it as in lights.key.intensity=2"),
        ("scalar.=1", "--set scalar.: it must name a field; write it as in scalar.name=z"),
        ("view=1", "--set view: it must name a field; write it as in view.angle=10"),
        ("view.=1", "--set view.: it must name a field; write it as in view.angle=10"),
        ("ambient.x=1", "--set ambient.x: there is no field 'ambient.x'; did you mean 'ambient'?"),
        ("lights.key.name=a", "--set lights.key.name: a name cannot be set; change it in the scene file"),
        (
            "surfaces.side.name=a",
            "--set surfaces.side.name: a name cannot be set; change it in the scene file",
        ),
        (
            "lights.key.a.b.c.d.e=1",
            "--set lights.key.a.b.c.d.e: there is no such field; write it as in lights.key.intensity=2",
        ),
    ],
)
def test_a_key_that_names_nothing_is_refused(scene: Scene, setting: str, sentence: str) -> None:
    with pytest.raises(UsageError) as caught:
        with_settings(scene, (setting,))
    assert str(caught.value) == sentence


@pytest.mark.parametrize(
    ("setting", "sentence"),
    [
        ("view.angel=1", "view: there is no field 'angel'; did you mean 'angle'?"),
        ("lights.key.intesity=1", "light 'key': there is no field 'intesity'; did you mean 'intensity'?"),
        ("lights.key.a.x=1", "light 'key': there is no field 'a'; did you mean 'aim'?"),
        ("lights.key.on.x=1", "light 'key': on must be true or false, not {'x': 1}"),
        ("lights.key.flaps.z.min=1", "there is no field 'min'; did you mean 'minimum'?"),
        ("lights.key.flaps.w.minimum=1", "there is no field 'w'; choose 'x', 'y' or 'z'"),
        ("surfaces.side.difuse=1", "surface 'side': there is no field 'difuse'; did you mean 'diffuse'?"),
        ("mapping=gama", "not 'gama'; did you mean 'gamma'?"),
        ("scalar.bands=8", "scalar: name must be a string of at least one character, not missing; add it"),
        ("scalar=z", "scalar must be a table of name, limits, scale"),
        ("scalar.scale=virid", "not 'virid'; did you mean 'viridis'?"),
        ("ambient=-1", "ambient must be a finite number of at least 0, not -1"),
        ("ambient=nan", "ambient must be a finite number of at least 0, not nan"),
        ("background=rde", "not 'rde'; did you mean 'red'?"),
        ("lights.key.on=1", "light 'key': on must be true or false, not 1"),
        ("parts.side.surface=sid", "surface 'sid' is not in the surface table; did you mean 'side'?"),
    ],
)
def test_a_value_that_breaks_a_rule_is_refused(scene: Scene, setting: str, sentence: str) -> None:
    with pytest.raises(UsageError) as caught:
        with_settings(scene, (setting,))
    assert str(caught.value).startswith("--set: ")
    assert sentence in str(caught.value)


def test_a_setting_without_a_key_or_an_equals_sign_is_wrong_usage(scene: Scene) -> None:
    with pytest.raises(UsageError, match=r"must be KEY=VALUE, not '=0\.2'"):
        with_settings(scene, ("=0.2",))
    with pytest.raises(UsageError, match="--set must be KEY=VALUE, not 'ambient'"):
        with_settings(scene, ("ambient",))


@pytest.mark.parametrize(("setting", "code"), [("ambiet=1", 2), ("ambient", 2), ("ambient=x", 2)])
def test_a_wrong_setting_ends_before_anything_is_written(
    folder: Path, run: Run, setting: str, code: int
) -> None:
    ran = run("render", "two.obj", "--set", setting)
    assert ran.code == code
    assert len([line for line in ran.err.splitlines() if "set" in line or "ambient" in line]) >= 1
    assert not (folder / "two.png").exists()


@pytest.mark.parametrize(
    ("settings", "field", "held"),
    [
        (("lights.key.cone_angle=30", "lights.key.cone_angle=none"), "cone_angle", None),
        (("lights.key.aim=none", "lights.key.direction=[0, 1, 0]"), "aim", None),
        (("lights.key.aim = none ",), "aim", None),
        (("lights.key.aim=None",), "aim", None),
    ],
)
def test_none_unsets_a_field_of_a_light_that_may_be_absent(
    scene: Scene, settings: tuple[str, ...], field: str, held: object
) -> None:
    changed = with_settings(scene.with_light("key", cone_angle=20), ("lights.key.cone_angle=none", *settings))
    assert getattr(changed.light("key"), field) is held


def test_none_unsets_the_target_of_a_view_the_levels_of_a_surface_and_flaps(scene: Scene) -> None:
    scene = scene.with_view(target=(0, 0, 0)).with_surface("side", levels=20)
    settings = ("view.target=none", "view.direction=[0, 1, 0]", "surfaces.side.levels=none")
    changed = with_settings(scene, settings)
    assert (changed.view.target, changed.view.direction) == (None, (0, 1, 0))
    assert changed.surface("side").levels is None
    flaps = with_settings(scene, ("lights.key.flaps.z.maximum=none",)).light("key").flaps
    assert flaps.z is not None
    assert (flaps.z.minimum, flaps.z.maximum) == (0, math.inf)
    assert with_settings(scene, ("lights.key.flaps.z=none",)).light("key").flaps.z is None
    assert with_settings(scene, ("lights.key.flaps=none",)).light("key").flaps == Flaps()


def test_what_is_named_none_stays_a_name(scene: Scene) -> None:
    scene = scene.replace(surfaces=(*scene.surfaces, Surface("none")))
    assert with_settings(scene, ("parts.side.surface=none",)).part("side").surface == "none"
    with pytest.raises(UsageError, match="surface 'None' is not in the surface table"):
        with_settings(scene, ("parts.side.surface=None",))
    changed = with_settings(scene, ("surfaces.none.levels=9", "surfaces.none.levels=none"))
    assert changed.surface("none").levels is None


@pytest.mark.parametrize(
    ("setting", "sentence"),
    [
        (
            "ambient=none",
            "--set ambient: it must be a finite number of at least 0, not none; only an optional"
            " field can be unset",
        ),
        (
            "dither=none",
            "--set dither: it must be 'off' or 'ordered', not none; only an optional field can be unset",
        ),
        ("view.target=none", "--set: view: it must have either a direction or a target; give one of them"),
        ("lights.key.concentration=none", "--set lights.key.concentration: it must be a finite number"),
        ("surfaces.side.exponent=none", "--set surfaces.side.exponent: it must be a finite number"),
        ("view.angel=none", "--set: view: there is no field 'angel'; did you mean 'angle'?"),
        ('lights.key.cone_angle="none"', "cone_angle must be a number above 0 and at most 180, not 'none'"),
    ],
)
def test_a_field_that_must_have_a_value_cannot_be_unset(scene: Scene, setting: str, sentence: str) -> None:
    scene = scene.with_view(target=(0, 0, 0))
    with pytest.raises(UsageError) as caught:
        with_settings(scene, (setting,))
    assert sentence in str(caught.value)


def test_a_setting_colors_the_picture(folder: Path, run: Run) -> None:
    assert run("render", "scene", "-o", "one.png").code == 0
    setting = "surfaces.front.low.object_color=#00ff00"
    assert run("render", "scene", "--set", setting, "-o", "two.png").code == 0
    assert (folder / "one.png").read_bytes() != (folder / "two.png").read_bytes()


def test_a_table_and_its_fields_are_not_both_set_in_either_order(scene: Scene) -> None:
    settings = ("lights.key.flaps.x={maximum = 1}", "lights.key.flaps.x.minimum=0")
    for order in (settings, settings[::-1]):
        with pytest.raises(UsageError, match=r"also set.*; leave one out"):
            with_settings(scene, order)


def test_the_last_value_of_a_field_counts(scene: Scene) -> None:
    assert with_settings(scene, ("ambient=0.1", "ambient=0.2")).ambient == 0.2


DOOR = "{point = [0, 0, 0], direction = [1, 0, 0]}"
WHOLE = (
    f"lights.key.half_spaces.left={DOOR}",
    f"lights.key.half_spaces.barn door={DOOR}",
    f'lights.key.half_spaces."a.b"={DOOR}',
)


def test_half_spaces_are_added_set_field_by_field_and_removed(scene: Scene) -> None:
    added = with_settings(scene, WHOLE)
    assert [row.name for row in added.light("key").half_spaces] == ["a.b", "barn door", "left"]
    changed = with_settings(
        added,
        (
            "lights.key.half_spaces.left.on=false",
            "lights.key.half_spaces.barn door.edge_width=0.5",
            'lights.key.half_spaces."barn door".carried=true',
            "lights.key.half_spaces.a.b=none",
        ),
    )
    door, left = changed.light("key").half_spaces
    assert (door.name, door.edge_width, door.carried, left.name, left.on) == (
        "barn door", 0.5, True, "left", False,
    )  # fmt: skip
    same = with_settings(added, ("lights.key.half_spaces.a.b.on=false",)).light("key").half_spaces
    assert [row.on for row in same] == [False, True, True]
    assert with_settings(added, ("lights.key.half_spaces=none",)).light("key").half_spaces == ()


@pytest.mark.parametrize(
    "text",
    ["side,front.low", "side, front.low", "[side, front.low]", '["side", "front.low"]', "side,'front.low'"],
)
def test_a_list_of_names_needs_neither_brackets_nor_quotes(scene: Scene, text: str) -> None:
    links = with_settings(scene, (f"lights.key.only_surfaces={text}",)).light("key").links
    assert links.only_surfaces == ("side", "front.low")


def test_a_list_may_be_one_name_none_of_them_or_absent(scene: Scene) -> None:
    named = with_settings(scene, ("lights.key.except_parts=side",))
    assert named.light("key").links.except_parts == ("side",)
    assert with_settings(named, ("lights.key.except_parts=[]",)).light("key").links.except_parts == ()
    assert with_settings(named, ("lights.key.except_parts=none",)).light("key").links.except_parts is None
    comma = scene.replace(surfaces=(*scene.surfaces, Surface("a, b")))
    assert with_settings(comma, ("lights.key.only_surfaces=a, b",)).light("key").links.only_surfaces == (
        "a, b",
    )


def test_a_light_follows_a_word_a_name_or_nothing(scene: Scene) -> None:
    for text, held in (("eye", "eye"), ('"eye"', "eye"), ("key", "key"), ("none", None), ("None", None)):
        found = with_settings(scene, ("lights.key.2.follows=eye", f"lights.key.2.follows={text}"))
        assert found.light("key.2").follows == held
    called_none = scene.with_new_light("none", position=(0, 0, 1), aim=(0, 0, 0))
    assert with_settings(called_none, ("lights.key.follows=none",)).light("key").follows == "none"


@pytest.mark.parametrize(
    ("setting", "sentence"),
    [
        (
            "lights.key.half_spaces.lft.on=false",
            "--set lights.key.half_spaces.lft.on: there is no half-space 'lft'; did you mean 'left'?",
        ),
        (
            "lights.key.2.half_spaces.left.on=false",
            "--set lights.key.2.half_spaces.left.on: there is no half-space 'left'; add a half-space"
            " with all its keys in a table",
        ),
        (
            "lights.key.half_spaces.lft=none",
            "--set: light 'key': half_spaces.lft: there is no half-space of this name; did you mean 'left'?",
        ),
        (
            "lights.key.half_spaces.left.edge_width=-1",
            "--set: light 'key': half_spaces.left.edge_width must be a finite number of at least 0, not -1",
        ),
        (
            "lights.key.half_spaces.left.width=1",
            "--set: light 'key': half_spaces.left: there is no field 'width'; did you mean 'edge_width'?",
        ),
        (
            "lights.key.half_spaces.left.name=right",
            "--set lights.key.half_spaces.left.name: a name cannot be set; change it in the scene file",
        ),
        (
            "lights.key.half_spaces.left.on=none",
            "--set lights.key.half_spaces.left.on: it must be true or false, not none; only an optional"
            " field can be unset",
        ),
        (
            "lights.key.half_spaces=left",
            "--set: light 'key': half_spaces must be a table of half-spaces by name, not 'left'",
        ),
        (
            "lights.key.half_spaces.barn door.x.y=1",
            "--set lights.key.half_spaces.barn door.x.y: there is no half-space 'barn door'",
        ),
        (
            "lights.key.only_surfaces=sde",
            "--set: light 'key': only_surfaces 'sde' is not in the surface table; did you mean 'side'?",
        ),
        (
            "lights.key.only_parts=3",
            "--set: light 'key': only_parts must be a list of names, not 3",
        ),
        (
            "lights.key.follows=ey",
            "--set: light 'key': follows 'ey' is not in the light table; did you mean 'eye'?",
        ),
    ],
)
def test_a_wrong_half_space_or_name_is_told_with_the_nearest(
    scene: Scene, setting: str, sentence: str
) -> None:
    with pytest.raises(UsageError) as refused:
        with_settings(with_settings(scene, WHOLE[:1]), (setting,))
    assert str(refused.value).startswith(sentence)


def test_a_half_space_and_its_fields_are_not_both_set(scene: Scene) -> None:
    both = ("lights.key.half_spaces.left=none", "lights.key.half_spaces.left.on=false")
    for settings in (both, both[::-1]):
        with pytest.raises(UsageError, match="also set"):
            with_settings(with_settings(scene, WHOLE), settings)


@pytest.fixture
def linked(folder: Path) -> Scene:
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
def test_a_key_leads_to_a_table_a_row_and_a_path_in_it(linked: Scene, key: str, place: SettingPlace) -> None:
    assert place_of(linked, key) == place
    assert field_of(place_of(linked, key)) is not None


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
def test_a_field_is_found_wherever_it_is_inside_its_row(linked: Scene, key: str, default: object) -> None:
    field = field_of(place_of(linked, key))
    assert field is not None
    assert field.default is not None
    assert field.default() == default


def test_a_key_that_its_row_has_not_has_no_field() -> None:
    assert field_of(SettingPlace("lights", "key", ("brightness",))) is None
    assert field_of(SettingPlace("lights", "key", ("on", "off"))) is None


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
def test_the_keys_after_a_start_are_those_of_its_table(linked: Scene, start: str, some: set[str]) -> None:
    found = keys_after(linked, start)
    assert some <= set(found)
    assert all(each.startswith(start) for each in found)
    assert not {"lights.key.name=", "lights.key.half_spaces.a.b.name="} & set(found)


def test_every_key_that_is_offered_can_be_set(linked: Scene) -> None:
    starts = [""]
    keys: list[str] = []
    while starts:
        for each in keys_after(linked, starts.pop()):
            (keys if each.endswith("=") else starts).append(each)
    assert len(keys) > 60
    for key in keys:
        assert field_of(place_of(linked, key[:-1])) is not None
