from __future__ import annotations

from typing import Any

import pytest
from hypothesis import given

from autocolor import Flap, Flaps, InputError, Light, Mesh, Part, Scene, UsageError, scene_of
from autocolor.scene.columns import Tier
from autocolor.scene.curves import CURVES
from autocolor.scene.defaults import object_coordinates
from autocolor.scene.scene import cost_of_edit
from autocolor.testing import scenes
from tests.small import cube, grid


def car() -> Mesh:
    return Mesh.joined(
        [grid(1, 1, (0, z, 0), (1, 0, 0), (0, 0, 1), name) for z, name in enumerate(("door", "hood", "pane"))]
    )


def car_scene() -> Scene:
    """A car on which every part has a surface of its own name."""
    return scene_of(car(), surfaces="parts")


@given(scenes())
def test_a_scene_replaced_by_nothing_shares_everything(scene: Scene) -> None:
    same = scene.replace()
    for name in ("mesh", "parts", "surfaces", "lights", "view", "views"):
        assert getattr(same, name) is getattr(scene, name)


def test_an_edit_shares_all_that_it_does_not_change() -> None:
    scene = scene_of(car(), lights=[Light("key", (0, -1, 0)), Light("fill", (0, -2, 0))])
    edited = scene.with_light("key", intensity=2)
    assert edited.mesh is scene.mesh
    assert edited.surfaces is scene.surfaces
    assert edited.lights[1] is scene.lights[1]
    assert (edited.light("key").intensity, scene.light("key").intensity) == (2.0, 1.0)


def test_a_light_is_added_after_the_others_and_removed_by_its_name() -> None:
    scene = car_scene()
    names = [light.name for light in scene.lights]
    more = scene.with_new_light("lamp", position=(0, 4, 3), cone_angle=None, flaps={"z": {"minimum": 0.1}})
    assert [light.name for light in more.lights] == [*names, "lamp"]
    assert more.light("lamp") == Light("lamp", (0, 4, 3), flaps=Flaps(z=Flap(0.1)))
    assert cost_of_edit(more.without_light("lamp"), scene) is None
    assert [light.name for light in more.without_light(names[0]).lights] == [*names[1:], "lamp"]
    assert more.mesh is scene.mesh
    assert cost_of_edit(scene, more) is Tier.MIX


def test_named_views_are_saved_taken_changed_and_removed_at_no_cost() -> None:
    scene = car_scene()
    saved = scene.with_saved_view("hood").with_view(angle=5).with_saved_view().with_saved_view()
    assert [row.name for row in saved.views] == ["hood", "view 1", "view 2"]
    assert [row.view.angle for row in saved.views] == [0, 5, 5]
    assert saved.with_taken_view("hood").view == scene.view
    again = saved.with_saved_view("hood")
    assert [(row.name, row.view.angle) for row in again.views] == [("hood", 5), ("view 1", 5), ("view 2", 5)]
    turned = saved.with_named_view("view 1", angle=7)
    assert [row.view.angle for row in turned.views] == [0, 7, 5]
    assert turned.view == saved.view
    fewer = turned.without_named_view("view 1")
    assert [row.name for row in fewer.views] == ["hood", "view 2"]
    edits = [(saved, again), (saved, turned), (turned, fewer), (scene, scene.with_saved_view())]
    assert {cost_of_edit(*edit) for edit in edits} == {Tier.NOTHING}
    assert cost_of_edit(saved, saved.with_named_view("hood", angle=0)) is None


def test_a_copied_light_stands_after_the_others_under_a_free_name() -> None:
    scene = scene_of(car(), lights=[Light("key", (0, -1, 0), 0.5), Light("rim", (0, 2, 0))])
    more = scene.with_copied_light("key").with_copied_light("key 2").with_copied_light("rim", "back")
    assert [light.name for light in more.lights] == ["key", "rim", "key 2", "key 3", "back"]
    assert more.light("key 3") == scene.light("key").replace(name="key 3")
    with pytest.raises(InputError, match="must be unique"):
        scene.with_copied_light("key", "rim")
    with pytest.raises(UsageError, match="there is no light 'kee'; did you mean 'key'"):
        scene.with_copied_light("kee")


def test_a_mirrored_light_is_a_copy_on_the_other_side_of_the_object() -> None:
    scene = scene_of(car(), lights=[Light("key", (-1, -1, 3), aim=(0.25, 0, 0))])
    low, high = scene.object_bounds
    assert (low[0], high[0]) == (0.0, 1.0)
    more = scene.with_mirrored_light("key").with_mirrored_light("key")
    assert [light.name for light in more.lights] == ["key", "key mirrored", "key mirrored 2"]
    assert more.light("key mirrored") == Light("key mirrored", (2, -1, 3), aim=(0.75, 0, 0))
    assert scene.with_mirrored_light("key", "y", -1, "back").light("back").position == (-1, -1, 3)
    with pytest.raises(UsageError, match="an axis must be 'x', 'y' or 'z', not 'w'"):
        scene.with_mirrored_light("key", "w")


@given(scenes())
def test_all_lights_are_on_again_after_some_were_alone(scene: Scene) -> None:
    alone = scene.only_lights(*(light.name for light in scene.lights[:1]))
    assert all(light.on for light in alone.with_all_lights_on().lights)
    assert alone.with_all_lights_on().equals(scene.with_all_lights_on())


def test_a_rig_carries_the_lights_of_one_scene_to_another() -> None:
    scene = scene_of(car(), lights=[Light("key", (1, -2, 3))])
    assert scene.rig.lights == scene.lights
    assert (scene.rig.minimum, scene.rig.maximum) == scene.object_bounds
    assert scene_of(cube(3.0)).with_rig(scene.rig).rig.fitted(*scene.object_bounds)[0].position == (
        pytest.approx((1, -2, 3))
    )


def test_a_renamed_light_keeps_its_place_and_its_name_stays_unique() -> None:
    scene = scene_of(car(), lights=[Light("key", (0, -1, 0)), Light("rim", (0, 2, 0))])
    assert [light.name for light in scene.with_light("key", name="main").lights] == ["main", "rim"]
    with pytest.raises(InputError, match=r"lights\[2\]\.name must be unique, not the same as lights\[1\]"):
        scene.with_light("rim", name="key")


def test_every_row_is_changed_by_its_name() -> None:
    scene = scene_of(car(), surface_of_part={"door": "door", "pane": "hood", "hood": "hood"})
    assert scene.with_part("door", surface="hood").part("door").surface == "hood"
    assert scene.with_surface("hood", diffuse=0.1).surface("hood").reflectance.diffuse == 0.1
    assert scene.with_view(angle=5).view.angle == 5.0
    assert [light.on for light in scene.only_lights("fill").lights] == [False, True, False, False]


@pytest.mark.parametrize(
    ("written", "percentage"),
    [
        ("99.5 %", "99.5 %"),
        ("99.50%", "99.5 %"),
        ("050 %", "50 %"),
        ("100.00 %", "100 %"),
        ("97.25%", "97.25 %"),
    ],
)
def test_a_percentage_is_written_in_one_way(written: str, percentage: str) -> None:
    assert car_scene().replace(exposure=written).exposure == percentage


@pytest.mark.parametrize(
    ("ask", "sentence"),
    [
        (lambda scene: scene.light("keys"), "there is no light 'keys'; did you mean 'key'?"),
        (lambda scene: scene.surface("dor"), "there is no surface 'dor'; did you mean 'door'?"),
        (lambda scene: scene.part("x"), "there is no part 'x'; choose 'door', 'hood' or 'pane'"),
        (lambda scene: scene.only_lights("kee"), "there is no light 'kee'; did you mean 'key'?"),
        (lambda scene: scene.without_light("kee"), "there is no light 'kee'; did you mean 'key'?"),
        (
            lambda scene: scene.with_saved_view("hood").with_taken_view("hod"),
            "there is no named view 'hod'; did you mean 'hood'?",
        ),
    ],
)
def test_an_unknown_name_is_refused_with_the_nearest_right_one(ask: Any, sentence: str) -> None:
    with pytest.raises(UsageError) as refusal:
        ask(car_scene())
    assert str(refusal.value) == sentence


@pytest.mark.parametrize(
    ("fields", "sentence"),
    [
        *(
            (
                {"exposure": percentage},
                "exposure must be 'auto', a percentage such as '99.5 %' from 50 to 100, or a table of ranges"
                " [minimum, maximum] from 0 to 3.4e38 by the names of surfaces and 'object',"
                f" not {percentage!r}",
            )
            for percentage in (
                "49 %",
                "100.5 %",
                "99.555 %",
                "99.5",
                "99,5 %",
                "-60 %",
                "5e1 %",
                "99  %",
                "none",
            )
        ),
        ({"ambient": -0.1}, "ambient must be a finite number of at least 0, not -0.1"),
        ({"scaling": "whole"}, "scaling must be 'surface' or 'object', not 'whole'"),
        ({"scaling": ["object"]}, "scaling must be 'surface' or 'object', not ['object']"),
        ({"contrast": "high"}, "contrast must be 'stretch' or 'floor', not 'high'"),
        (
            {"mapping": "log"},
            f"mapping must be {', '.join(map(repr, CURVES))}, or rising points [x, y] from x = 0"
            " to x = 1, not 'log'; did you mean 'logarithm'?",
        ),
        (
            {"background": "blak"},
            'background must be "#rrggbb", a name such as "red", or three whole numbers from 0 to 255, not'
            " 'blak'; did you mean 'black'?",
        ),
        (
            {"lights": [Light("a", (0, 0, 0))] * 2},
            "lights[2].name must be unique, not the same as lights[1]; rename it",
        ),
        ({"parts": [Part("door", "door")]}, "the part table must have the mesh's parts in their order"),
    ],
)
def test_a_scene_that_breaks_a_rule_is_refused(fields: dict[str, Any], sentence: str) -> None:
    with pytest.raises(InputError) as refusal:
        scene_of(car()).replace(**fields)
    assert str(refusal.value).startswith(sentence)


@pytest.mark.parametrize(
    "curve",
    [
        (),
        ((0, 0),),
        ((0, 0), (0.5, 1)),
        ((0, 0), (0.5, 0.2), (0.5, 0.3), (1, 1)),
        ((0, 1), (1, 0)),
        ((0, -1), (1, 1)),
        ((0, 0), (1, 2)),
        ((0, 0), (float("nan"), 0.5), (1, 1)),
        3,
    ],
)
def test_a_curve_that_falls_or_does_not_span_the_range_is_refused(curve: Any) -> None:
    with pytest.raises(
        InputError, match=r"mapping must be .*, or rising points \[x, y\] from x = 0 to x = 1, not"
    ):
        scene_of(cube(), mapping=curve)


@pytest.mark.parametrize(
    "rows", [{"lights": ["key"]}, {"surfaces": [None]}, {"parts": 3}, {"view": "front"}, {"mesh": None}]
)
def test_a_table_of_something_else_is_refused(rows: dict[str, Any]) -> None:
    with pytest.raises(InputError, match="must be"):
        scene_of(cube()).replace(**rows)


def test_scenes_are_equal_where_every_column_is_and_the_mesh_is_the_same() -> None:
    scene = scene_of(cube(), surfaces="parts")
    assert scene.equals(scene.replace(ambient=scene.ambient))
    assert not scene.equals(scene.replace(ambient=3))
    assert not scene.equals(scene.with_surface("cube", blend=0.1))
    assert not scene.equals(scene.replace(mesh=cube()))


def test_an_unknown_field_of_a_scene_is_refused() -> None:
    with pytest.raises(InputError, match=r"there is no field 'ambiant'; did you mean 'ambient'\?"):
        scene_of(cube()).replace(ambiant=1)  # type: ignore[call-arg]


def test_a_change_of_paint_is_that_of_the_surface_and_the_same_paint_is_the_same_scene() -> None:
    scene = scene_of(cube(), surfaces="parts")
    blue = {"object_color": "#0000ff", "blend": 0.25}
    assert scene.with_paint("cube", **blue).equals(scene.with_surface("cube", **blue))  # type: ignore[arg-type]
    paint = scene.surface("cube").paint
    assert scene.with_paint("cube", blend=paint.blend) is scene
    with pytest.raises(InputError, match="surface 'cube': blend must be a number from 0 to 1, not 2"):
        scene.with_paint("cube", blend=2)
    with pytest.raises(UsageError, match=r"there is no surface 'cub'; did you mean 'cube'\?"):
        scene.with_paint("cub", blend=0.5)


def test_self_is_no_field() -> None:
    fields: dict[str, Any] = {"self": 1}
    with pytest.raises(InputError, match="view: there is no field 'self'"):
        scene_of(cube()).with_view(**fields)


@given(scenes())
def test_the_coordinates_of_the_object_follow_an_edit_of_the_stage(scene: Scene) -> None:
    edited = scene.with_part("part 0", stage=not scene.part("part 0").stage)
    for each in (scene, edited):
        assert each.object_coordinates.tolist() == object_coordinates(each.mesh, each.parts).tolist()


def test_to_make_a_part_stage_costs_no_visible_surface_and_no_light() -> None:
    scene = scene_of(car())
    assert cost_of_edit(scene, scene.with_part("door", stage=True)) == Tier.MIX
