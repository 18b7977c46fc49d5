from __future__ import annotations

import dataclasses
import math
import pickle
from collections.abc import Sequence
from typing import Any

import numpy as np
import pytest
from hypothesis import given

from autocolor import (
    BlinnPhong,
    Flap,
    Flaps,
    HalfSpace,
    InputError,
    Light,
    Mesh,
    NamedView,
    Part,
    Phong,
    Reflectance,
    Scene,
    Surface,
    UsageError,
    View,
    demo,
    scene_of,
)
from autocolor.checks import either, listed
from autocolor.scene.columns import Tier, difference, keys_of
from autocolor.scene.creation import DISTANCE, SHARED, TURNS, new_light_of
from autocolor.scene.defaults import MAPPING_FIELDS, object_coordinates
from autocolor.scene.lights import Links
from autocolor.scene.reflection_models import SpecularGrowth
from autocolor.scene.scene import cost_of_edit
from autocolor.scene.surfaces import MOST_SURFACES
from autocolor.testing import scenes
from tests.small import cube, grid, wall_scene
from tests.tables import refused

PARTS = ("door", "hood", "pane")
VIEW = View((0, -9, 0), target=(0, 0, 0))


def car(names: Sequence[str] = PARTS) -> Mesh:
    """A square for each part, one behind the other."""
    return Mesh.joined(
        [grid(1, 1, (0, place, 0), (1, 0, 0), (0, 0, 1), name) for place, name in enumerate(names)]
    )


def many_parts(count: int) -> Mesh:
    """A cube and parts without polygons."""
    return dataclasses.replace(cube(), part_names=tuple(f"part {number}" for number in range(count)))


def surfaces_of_parts(scene: Scene) -> list[str]:
    return [part.surface for part in scene.parts]


def test_the_mapping_is_created_with_the_lights_and_not_without() -> None:
    created, given = scene_of(car()), scene_of(car(), lights=[Light("key", (1, 2, 3))])
    fields = scene_of(car(), lights=[], ambient=0.3)
    for name, value in MAPPING_FIELDS.items():
        assert getattr(created, name) == value
        assert getattr(given, name) == vars(Scene)[name] != value
    assert (fields.ambient, fields.scaling) == (0.3, "surface")


TWO = [Surface("door", levels=99), Surface("glass")]
TABLES = {"surfaces": TWO, "material_of_part": {"door": "red", "hood": "red"}}


@pytest.mark.parametrize(
    ("tables", "of_parts", "created"),
    [
        ({}, ["surface"] * 3, ["surface"]),
        ({"surfaces": TWO}, ["door", "surface", "surface"], ["surface"]),
        (TABLES, ["door", "red", "surface"], ["red", "surface"]),
        (
            {**TABLES, "parts": {"door": {"surface": "glass"}}},
            ["glass", "red", "surface"],
            ["red", "surface"],
        ),
        # What is named for a part may be another part, a material, or the shared surface.
        (
            {
                **TABLES,
                "parts": {"door": {"surface": "glass"}, "hood": {"surface": "pane"}},
                "surface_of_part": {"door": "red", "pane": "surface"},
            },
            ["red", "pane", "surface"],
            ["red", "pane", "surface"],
        ),
        (
            {"material_of_part": {"door": "red", "pane": "surface"}},
            ["red", "surface for all others", "surface"],
            ["red", "surface for all others", "surface"],
        ),
        (
            {"surfaces": "parts", "material_of_part": {"door": "red"}, "surface_of_part": {"pane": "hood"}},
            ["door", "hood", "hood"],
            ["door", "hood"],
        ),
    ],
)
def test_every_part_has_the_first_surface_that_there_is(
    tables: dict[str, Any], of_parts: list[str], created: list[str]
) -> None:
    scene = scene_of(car(), materials=[Surface("red", levels=77)], **tables)
    assert surfaces_of_parts(scene) == of_parts
    # The given ones come first and are as given; of the others only those in use are created.
    given = TWO if tables.get("surfaces") is TWO else []
    assert scene.surfaces[: len(given)] == tuple(given)
    assert [surface.name for surface in scene.surfaces[len(given) :]] == created
    # A part of its own surface has that of its material.
    of_red = "door" if tables.get("surfaces") == "parts" else "red"
    for surface in scene.surfaces[len(given) :]:
        assert surface.levels == (77 if surface.name == of_red else None)


def test_the_only_surface_is_that_of_all_parts_if_no_part_has_it() -> None:
    ball = [Surface("ball", levels=99)]
    scene = scene_of(car(), surfaces=ball, material_of_part={"hood": "red"})
    assert (surfaces_of_parts(scene), scene.surfaces[:1]) == (["ball", "red", "ball"], tuple(ball))
    for parts in ({"door": "ball"}, {}):
        two = [*ball, Surface("box")] if not parts else ball
        assert surfaces_of_parts(scene_of(car(), surfaces=two, surface_of_part=parts))[1:] == ["surface"] * 2


def test_more_materials_than_surface_numbers_share_the_last_surface() -> None:
    mesh = many_parts(300)
    materials = {name: f"of {name}" for name in mesh.part_names}
    scene = scene_of(mesh, surfaces=[Surface("given")], material_of_part=materials)
    assert len(scene.surfaces) == MOST_SURFACES
    assert surfaces_of_parts(scene)[:254] == list(materials.values())[:254]
    assert set(surfaces_of_parts(scene)[254:]) == {"of part 253"}


def test_a_part_of_a_wrong_name_is_not_renamed_by_its_fields() -> None:
    scene = scene_of(car(), parts={"door": {"name": "gate", "stage": True}})
    assert scene.parts[0] == Part("door", SHARED, stage=True)


def test_created_lights_are_those_of_the_view_that_is_given() -> None:
    one, other = scene_of(car()), scene_of(car(), view=VIEW)
    assert other.view == VIEW
    assert [light.name for light in one.lights] == [light.name for light in other.lights]
    assert one.lights != other.lights
    assert scene_of(car(), lights=()).lights == ()


def test_tables_for_what_a_scene_is_made_of_are_taken() -> None:
    scene = scene_of(
        cube(),
        view={"eye": (5, 5, 5), "target": (0, 0, 0)},
        surfaces=[{"name": "cube", "diffuse": 0.2}],  # type: ignore[list-item]
        lights=[{"name": "key", "position": (1, 2, 3)}],  # type: ignore[list-item]
    )
    assert scene.view == View((5, 5, 5), target=(0, 0, 0))
    assert scene.surfaces["cube"].reflectance.diffuse == 0.2
    assert scene.lights == (Light("key", (1, 2, 3)),)


def test_as_many_surfaces_as_there_can_be_leave_none_to_create_and_share_the_last() -> None:
    full = [Surface(f"surface {number}") for number in range(MOST_SURFACES)]
    scene = scene_of(cube(), surfaces=full, surface_of_part={"cube": "surface 9"})
    assert scene.surfaces == tuple(full)
    assert scene_of(cube(), surfaces=full).parts[0].surface == full[-1].name


@given(scenes())
def test_a_new_light_can_be_added_to_any_scene(scene: Scene) -> None:
    light = new_light_of(scene)
    more = scene.replace(lights=(*scene.lights, light))
    assert more.lights[light.name] is light


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


BODY = [Surface("body")]
NOT_IN_TABLE = "part 'door': surface 'bod' is not in the surface table; did you mean 'body'?"

test_what_no_scene_is_made_of_is_refused = refused(
    lambda fields: scene_of(car(), **fields),
    [
        ({"surfaces": "part"}, "surfaces must be rows, 'materials' or 'parts', not 'part'"),
        ({"backgroud": "navy"}, "there is no field 'backgroud'; did you mean 'background'?"),
        ({"surface_of_part": {"dor": "body"}}, "there is no part 'dor'; did you mean 'door'?"),
        ({"parts": {"dor": {"stage": True}}}, "there is no part 'dor'; did you mean 'door'?"),
        ({"surfaces": BODY, "surface_of_part": {"door": "bod"}}, NOT_IN_TABLE),
        ({"surfaces": BODY, "parts": {"door": {"surface": "bod"}}}, NOT_IN_TABLE),
        (
            {"surfaces": 1, "view": 3, "parts": {"door": {"stage": 2}, "hood": {"stagee": True}}},
            "surfaces must be a list of Surface rows, not 1\n"
            "parts.door.stage must be true or false, not 2\n"
            "parts.hood: there is no field 'stagee'; did you mean 'stage'?\n"
            "view must be a table of eye, direction, target, angle and field_of_view, not 3",
        ),
    ],
)


def car_scene() -> Scene:
    """A car on which every part has a surface of its own name."""
    return scene_of(car(), surfaces="parts")


def test_an_edit_shares_all_that_it_does_not_change() -> None:
    scene = scene_of(car(), lights=[Light("key", (0, -1, 0)), Light("fill", (0, -2, 0))])
    edited = scene.with_light("key", intensity=2)
    assert edited.mesh is scene.mesh
    assert edited.surfaces is scene.surfaces
    assert edited.lights[1] is scene.lights[1]
    assert (edited.lights["key"].intensity, scene.lights["key"].intensity) == (2.0, 1.0)


def test_a_light_is_added_after_the_others_and_removed_by_its_name() -> None:
    scene = car_scene()
    names = [light.name for light in scene.lights]
    more = scene.with_new_light("lamp", position=(0, 4, 3), cone_angle=None, flaps={"z": {"minimum": 0.1}})
    assert [light.name for light in more.lights] == [*names, "lamp"]
    assert more.lights["lamp"] == Light("lamp", (0, 4, 3), flaps=Flaps(z=Flap(0.1)))
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
    assert more.lights["key 3"] == scene.lights["key"].replace(name="key 3")


def test_a_mirrored_light_is_a_copy_on_the_other_side_of_the_object() -> None:
    scene = scene_of(car(), lights=[Light("key", (-1, -1, 3), aim=(0.25, 0, 0))])
    low, high = scene.object_bounds
    assert (low[0], high[0]) == (0.0, 1.0)
    more = scene.with_mirrored_light("key").with_mirrored_light("key")
    assert [light.name for light in more.lights] == ["key", "key mirrored", "key mirrored 2"]
    assert more.lights["key mirrored"] == Light("key mirrored", (2, -1, 3), aim=(0.75, 0, 0))
    assert scene.with_mirrored_light("key", "y", -1, "back").lights["back"].position == (-1, -1, 3)


@given(scenes())
def test_all_lights_are_on_again_after_some_were_alone(scene: Scene) -> None:
    alone = scene.only_lights(*(light.name for light in scene.lights[:1]))
    assert all(light.on for light in alone.with_all_lights_on().lights)
    assert alone.with_all_lights_on().equals(scene.with_all_lights_on())


def test_a_scene_has_at_most_255_surfaces_and_64_named_views() -> None:
    scene = scene_of(cube())
    assert len(scene.replace(surfaces=surfaces(255)).surfaces) == 255
    assert len(scene.replace(views=views(64)).views) == 64


def surfaces(count: int) -> list[Surface]:
    return [Surface(name) for name in ("surface", *map(str, range(count - 1)))]


def views(count: int) -> list[NamedView]:
    view = View((0, -4, 0), target=(0, 0, 0))
    return [NamedView(str(number), view) for number in range(count)]


KEY = Light("key", (0, -1, 0))
LIGHT_TABLE = f"lights[1] must be a table of {listed(keys_of(Light))}, not 'key'"
NO_SELF = f"view: there is no field 'self'; choose {either(keys_of(View))}"


def test_a_row_is_found_by_number_or_by_name_after_every_edit() -> None:
    scene = car_scene().with_saved_view("hood").with_saved_view("wheel")
    edited = [
        scene,
        scene.with_light("key", intensity=2),
        scene.with_light_in_world("key", follows="eye"),
        scene.with_paint("door", blend=1),
        scene.with_surface("door", diffuse=0.5),
        scene.with_part("hood", stage=True),
        scene.without_named_view("wheel"),
        scene.between(scene.with_light("key", intensity=2), 0.5),
        pickle.loads(pickle.dumps(scene)),
    ]
    for each in edited:
        for rows in (each.lights, each.surfaces, each.parts, each.views, each.lights_in_world):
            assert [rows[row.name] for row in rows] == [*rows]
            assert [row.name in rows for row in rows] == [row in rows for row in rows] == [True] * len(rows)
    lights = scene.lights
    assert lights == tuple(lights)
    assert hash(lights) == hash(tuple(lights))
    assert type(lights[:1]) is tuple
    assert lights[0] is lights["key"]
    unknown: object = "keys"
    assert unknown not in lights


test_a_name_that_is_not_in_its_table_is_refused_with_the_nearest_right_one = refused(
    lambda ask: ask(car_scene()),
    [
        (lambda scene: scene.lights["keys"], "there is no light 'keys'; did you mean 'key'?"),
        (
            lambda scene: scene.replace(lights=()).lights["key"],
            "there is no row 'key'; the table has no rows",
        ),
        (
            lambda scene: scene.replace(lights=()).with_light("key", on=False),
            "there is no light 'key'; the table has no rows",
        ),
        (lambda scene: scene.lights[None], "there is no light None; choose 'key', 'fill', 'top' or 'rim'"),
        (
            lambda scene: scene.only_lights(["kee"]),
            "there is no light ['kee']; choose 'key', 'fill', 'top' or 'rim'",
        ),
        (lambda scene: scene.surfaces["dor"], "there is no surface 'dor'; did you mean 'door'?"),
        (lambda scene: scene.parts["x"], "there is no part 'x'; choose 'door', 'hood' or 'pane'"),
        (lambda scene: scene.only_lights("kee"), "there is no light 'kee'; did you mean 'key'?"),
        (lambda scene: scene.without_light("kee"), "there is no light 'kee'; did you mean 'key'?"),
        (lambda scene: scene.with_copied_light("kee"), "there is no light 'kee'; did you mean 'key'?"),
        (lambda scene: scene.with_paint("dor", blend=1), "there is no surface 'dor'; did you mean 'door'?"),
        (
            lambda scene: scene.with_paint("door", "red"),
            "a recoloring must name its fields, not give 'red' alone; write it as in recolor('door',"
            " object_color='red')",
        ),
        (
            lambda scene: scene.with_rig("rig.toml"),
            "a rig must be a Rig, not 'rig.toml'; read one from a file with `read_rig`",
        ),
        (
            lambda scene: scene.with_saved_view("hood").with_taken_view("hod"),
            "there is no named view 'hod'; did you mean 'hood'?",
        ),
    ],
    UsageError,
)

test_a_scene_that_breaks_a_rule_is_refused = refused(
    lambda edit: edit(car_scene()),
    [
        (
            lambda scene: scene.replace(surfaces=[*scene.surfaces, *surfaces(253)]),
            "surfaces must be at most 255, not 256; let parts share a surface",
        ),
        (
            lambda scene: scene.replace(views=views(65)),
            "views must be at most 64, not 65; remove named views",
        ),
        (
            lambda scene: scene.replace(parts=scene.parts[::-1]),
            "the part table must have the mesh's parts in their order ['door', 'hood', 'pane'], not ['pane',"
            " 'hood', 'door']",
        ),
        (
            lambda scene: scene.with_part("door", surface="dor"),
            "part 'door': surface 'dor' is not in the surface table; did you mean 'door'?",
        ),
        (
            lambda scene: scene.replace(exposure={"dor": [0, 1], "object": [0, 1]}),
            "exposure 'dor' is not in the surface table; did you mean 'door'?",
        ),
        (
            lambda scene: scene.replace(lights=[KEY, KEY]),
            "lights[2].name must be unique, not the same as lights[1]; rename it",
        ),
        (lambda scene: scene.replace(mesh=None), "mesh must be a Mesh, not None"),
        (lambda scene: scene.replace(lights=["key"]), LIGHT_TABLE),
        (lambda scene: scene.with_view(**{"self": 1}), NO_SELF),
    ],
    InputError,
)


def test_at_most_a_hundred_problems_of_references_are_told() -> None:
    names = [f"part {number}" for number in range(101)]
    mesh = Mesh(np.eye(3), [[0, 1, 2]], [0], tuple(names))  # type: ignore[arg-type]
    scene = scene_of(mesh)
    with pytest.raises(InputError) as refusal:
        scene.replace(parts=[Part(name, "none") for name in names])
    assert len(refusal.value.problems) == 100


def test_scenes_are_equal_where_every_column_is_and_the_mesh_is_the_same() -> None:
    scene = scene_of(cube(), surfaces="parts")
    assert scene.equals(scene.replace(ambient=scene.ambient))
    assert not scene.equals(scene.replace(ambient=3))
    assert not scene.equals(scene.with_surface("cube", blend=0.1))
    assert not scene.equals(scene.replace(mesh=cube()))


def test_a_change_of_paint_is_that_of_the_surface_and_the_same_paint_is_the_same_scene() -> None:
    scene = scene_of(cube(), surfaces="parts")
    blue = {"object_color": "#0000ff", "blend": 0.25}
    assert scene.with_paint("cube", **blue).equals(scene.with_surface("cube", **blue))  # type: ignore[arg-type]
    paint = scene.surfaces["cube"].paint
    assert scene.with_paint("cube", blend=paint.blend) is scene


@given(scenes())
def test_the_coordinates_of_the_object_follow_an_edit_of_the_stage(scene: Scene) -> None:
    edited = scene.with_part("part 0", stage=not scene.parts["part 0"].stage)
    for each in (scene, edited):
        assert each.object_coordinates.tolist() == object_coordinates(each.mesh, each.parts).tolist()


def test_to_make_a_part_stage_costs_no_visible_surface_and_no_light() -> None:
    scene = scene_of(car())
    assert cost_of_edit(scene, scene.with_part("door", stage=True)) == Tier.MIX


def test_as_in_1983_sets_what_the_paper_does_not_describe_and_nothing_else() -> None:
    flap = Flap(0, 1, edge_width=0.2)
    lamp = Light(
        "lamp",
        (0, -4, 2),
        aim=(0, 0, 0),
        cone_angle=30,
        inner_angle=10,
        falloff="linear",
        reach=9,
        flaps=Flaps(z=flap),
        half_spaces=(HalfSpace("door", (0, 0, 0), (1, 0, 0)),),
        links=Links(only_surfaces=("wall",)),
    )
    model = BlinnPhong(40.0, SpecularGrowth(refractive_index=1.5))
    scene = wall_scene(
        reflectance=Reflectance(0.7, 0.5, model),
        lights=[lamp],
        ambient=0.3,
        interpolation="invariant",
        mapping="gamma",
        contrast="floor",
        exposure="99.5 %",
        dither="ordered",
        words="normals",
    )
    paper = scene.as_in_1983()
    of_levels = {"mapping", "contrast", "exposure", "dither", "words"}
    assert set(difference(scene, paper)) == {"interpolation", "surfaces", "lights", *of_levels}
    of_light = {"inner_angle", "falloff", "flaps", "half_spaces", "only_surfaces"}
    assert set(difference(lamp, paper.lights[0])) == of_light
    assert paper.surfaces[0].reflectance == Reflectance(0.7, 0.5, Phong(10.0))
    assert paper.as_in_1983().equals(paper)
    coupe = demo()
    assert set(difference(coupe, coupe.as_in_1983())) == {"interpolation", "contrast", "exposure", "lights"}
