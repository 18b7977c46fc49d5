from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping, Sequence
from typing import Any, Literal

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import Light, Mesh, Part, Scene, Surface, View, scene_of
from autocolor.scene.changes import PartChanges
from autocolor.scene.creation import DISTANCE, SHARED, TURNS, new_light_of
from autocolor.scene.defaults import MAPPING_FIELDS
from autocolor.scene.surfaces import MOST_SURFACES
from autocolor.testing import scenes
from tests.small import cube, grid
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


def names_of(surfaces: Sequence[Surface]) -> list[str]:
    return [surface.name for surface in surfaces]


def test_the_mapping_is_created_with_the_lights_and_not_without() -> None:
    created, given = scene_of(car()), scene_of(car(), lights=[Light("key", (1, 2, 3))])
    fields = scene_of(car(), lights=[], ambient=0.3)
    for name, value in MAPPING_FIELDS.items():
        assert getattr(created, name) == value
        assert getattr(given, name) == vars(Scene)[name] != value
    assert (fields.ambient, fields.scaling) == (0.3, "surface")


def expected_surface(
    part: str,
    surfaces: Sequence[Surface] | Literal["materials", "parts"],
    parts: Mapping[str, PartChanges],
    surface_of_part: Mapping[str, str],
    material_of_part: Mapping[str, str],
) -> str:
    """The surface of a part: the first that there is, as `scene_of` says it."""
    if part in surface_of_part:
        return surface_of_part[part]
    if "surface" in parts.get(part, {}):
        return parts[part]["surface"]
    if not isinstance(surfaces, str) and part in names_of(surfaces):
        return part
    if surfaces == "parts":
        return part
    if part in material_of_part:
        return material_of_part[part]
    return "surface" if "surface" not in material_of_part.values() else "surface for all others"


some_parts = st.lists(st.sampled_from([*PARTS, "red", "surface"]), unique=True, min_size=1)
some_surfaces = st.sampled_from(["door", "hood", "red", "glass", "surface"])


@given(st.data(), some_parts, st.lists(some_surfaces, unique=True))
def test_every_part_has_the_first_surface_that_there_is(
    data: st.DataObject, part_names: list[str], given_names: list[str]
) -> None:
    surfaces: Any = data.draw(
        st.just([Surface(name, levels=99) for name in given_names]) | st.sampled_from(["materials", "parts"])
    )
    of_parts = st.sampled_from(part_names)
    material_of_part = data.draw(st.dictionaries(of_parts, st.sampled_from(["red", "glass", "surface"])))
    # Only these names may be named for a part.
    known = [*part_names, *material_of_part.values(), SHARED]
    known += [] if isinstance(surfaces, str) else given_names
    named = st.sampled_from(known)
    surface_of_part = data.draw(st.dictionaries(of_parts, named))
    fields_of_part: Any = st.fixed_dictionaries({}, optional={"surface": named})
    parts: dict[str, PartChanges] = data.draw(st.dictionaries(of_parts, fields_of_part))
    materials = [Surface(name, levels=77) for name in ("red", "surface")]
    scene = scene_of(
        car(part_names),
        surfaces=surfaces,
        parts=parts,
        surface_of_part=surface_of_part,
        material_of_part=material_of_part,
        materials=materials,
    )
    assert surfaces_of_parts(scene) == [
        expected_surface(name, surfaces, parts, surface_of_part, material_of_part) for name in part_names
    ]
    # The given ones come first and are as given; of the others only those in use are created.
    first = [] if isinstance(surfaces, str) else given_names
    created = names_of(scene.surfaces)[len(first) :]
    assert names_of(scene.surfaces)[: len(first)] == first
    assert created == [name for name in dict.fromkeys(surfaces_of_parts(scene)) if name not in first]
    for surface in scene.surfaces:
        is_own = surfaces == "parts" and surface.name in part_names
        material = material_of_part.get(surface.name) if is_own else surface.name
        described = material in ("red", "surface")
        if not is_own and material == "surface":
            described = "surface" in material_of_part.values()
        assert surface.levels == (99 if surface.name in first else 77 if described else None)


def test_more_parts_than_surface_numbers_share_the_last_surface() -> None:
    scene = scene_of(many_parts(300), surfaces="parts")
    assert names_of(scene.surfaces) == [f"part {number}" for number in range(MOST_SURFACES)]
    assert set(surfaces_of_parts(scene)[MOST_SURFACES:]) == {scene.surfaces[-1].name}


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
    assert scene.surface("cube").reflectance.diffuse == 0.2
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
    assert more.light(light.name) is light


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
        ({"surfaces": BODY * 2}, "surfaces[2].name must be unique, not the same as surfaces[1]; rename it"),
        (
            {"surfaces": 1, "view": 3, "parts": {"door": {"stage": 2}, "hood": {"stagee": True}}},
            "surfaces must be a list of Surface rows, not 1\n"
            "parts.door.stage must be true or false, not 2\n"
            "parts.hood: there is no field 'stagee'; did you mean 'stage'?\n"
            "view must be a table of eye, direction, target, angle and field_of_view, not 3",
        ),
    ],
)
