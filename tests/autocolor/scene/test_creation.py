from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping, Sequence
from typing import Any, Literal

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import InputError, Light, Mesh, Part, Scene, Surface, UsageError, View, render, scene_of
from autocolor.images import display_image
from autocolor.scene.changes import PartChanges
from autocolor.scene.creation import DISTANCE, SHARED, TURNS, new_light_of
from autocolor.scene.defaults import MAPPING_FIELDS, created_surface
from autocolor.scene.surfaces import MOST_SURFACES
from autocolor.testing import scenes
from tests.small import cube, grid

PARTS = ("door", "hood", "pane")
VIEW = View((0, -9, 0), target=(0, 0, 0))


def car(names: Sequence[str] = PARTS) -> Mesh:
    """A square for each part, one behind the other."""
    return Mesh.joined(
        [grid(1, 1, (0, place, 0), (1, 0, 0), (0, 0, 1), name) for place, name in enumerate(names)]
    )


def shifted(mesh: Mesh, x: float) -> Mesh:
    return dataclasses.replace(mesh, coordinates=mesh.coordinates + np.array((x, 0, 0)))


def many_parts(count: int) -> Mesh:
    """A cube and parts without polygons."""
    return dataclasses.replace(cube(), part_names=tuple(f"part {number}" for number in range(count)))


def surfaces_of_parts(scene: Scene) -> list[str]:
    return [part.surface for part in scene.parts]


def names_of(surfaces: Sequence[Surface]) -> list[str]:
    return [surface.name for surface in surfaces]


def test_a_mesh_alone_has_one_surface_that_all_parts_share() -> None:
    scene = scene_of(car())
    assert surfaces_of_parts(scene) == ["surface"] * 3
    assert names_of(scene.surfaces) == ["surface"]
    assert scene.surface_number_of_part == (1, 1, 1)


def test_with_surfaces_of_parts_each_part_has_one_of_its_own_name_and_color() -> None:
    scene = scene_of(car(), surfaces="parts", material_of_part={"door": "red"})
    assert surfaces_of_parts(scene) == names_of(scene.surfaces) == list(PARTS)
    assert len({surface.paint.object_color for surface in scene.surfaces}) == 3


def test_the_surface_of_a_material_is_created_where_none_describes_it() -> None:
    red = Surface("red", two_sided=False)
    scene = scene_of(
        car(), material_of_part={"door": "red", "pane": "glass"}, materials=(red, Surface("unused"))
    )
    assert surfaces_of_parts(scene) == ["red", SHARED, "glass"]
    assert names_of(scene.surfaces) == ["red", SHARED, "glass"]
    assert scene.surface("red") is red


def test_a_given_surface_counts_before_the_description_of_its_material() -> None:
    given_red = Surface("red", levels=20)
    scene = scene_of(
        car(), surfaces=[given_red], material_of_part={"door": "red"}, materials=(Surface("red", levels=30),)
    )
    assert scene.surface("red") is given_red
    assert surfaces_of_parts(scene) == ["red", SHARED, SHARED]


def test_a_material_of_the_name_of_the_shared_surface_is_not_shared() -> None:
    material = Surface(SHARED, levels=30)
    scene = scene_of(car(), material_of_part={"door": SHARED}, materials=(material,))
    assert scene.surfaces == (material, created_surface(f"{SHARED} for all others"))
    assert surfaces_of_parts(scene) == [SHARED, *[f"{SHARED} for all others"] * 2]


def test_surfaces_of_parts_are_like_those_of_their_materials() -> None:
    red = Surface("red", levels=30)
    of_material = {"door": "red", "hood": "red", "pane": "unknown"}
    scene = scene_of(car(), surfaces="parts", material_of_part=of_material, materials=(red,))
    assert scene.surfaces[:2] == (red.replace(name="door"), red.replace(name="hood"))
    assert scene.surfaces[2].name == "pane"
    assert scene.surfaces[2].levels is None


def test_the_mapping_is_created_with_the_lights_and_not_without() -> None:
    created, given = scene_of(car()), scene_of(car(), lights=[Light("key", (1, 2, 3))])
    fields = scene_of(car(), lights=[], ambient=0.3)
    for name, value in MAPPING_FIELDS.items():
        assert getattr(created, name) == value
        assert getattr(given, name) == vars(Scene)[name] != value
    assert (fields.ambient, fields.scaling) == (0.3, "surface")


def test_a_part_takes_the_surface_that_is_named_for_it_else_the_given_one_of_its_name_else_a_shared_one() -> (
    None
):
    scene = scene_of(
        car(), surface_of_part={"door": "body"}, surfaces=[Surface("body"), Surface("hood", two_sided=False)]
    )
    assert surfaces_of_parts(scene) == ["body", "hood", SHARED]
    assert names_of(scene.surfaces) == ["body", "hood", SHARED]
    assert not scene.surface("hood").two_sided
    assert scene.surface_number_of_part == (1, 2, 3)


def test_a_part_may_be_named_the_surface_of_another_part_that_is_then_created() -> None:
    scene = scene_of(car(), surface_of_part={"door": "pane"})
    assert surfaces_of_parts(scene) == ["pane", SHARED, SHARED]


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


def test_three_hundred_parts_without_a_surface_share_one() -> None:
    assert names_of(scene_of(many_parts(300)).surfaces) == [SHARED]


@pytest.mark.parametrize(
    ("fields", "sentence"),
    [
        ({"surface_of_part": {"dor": "body"}}, "there is no part 'dor'"),
        ({"parts": {"dor": {"stage": True}}}, "there is no part 'dor'"),
    ],
)
def test_an_unknown_part_is_refused_with_the_nearest_right_name(
    fields: dict[str, Any], sentence: str
) -> None:
    with pytest.raises(InputError) as refused:
        scene_of(car(), surfaces=[Surface("body")], **fields)
    assert str(refused.value).startswith(sentence)
    assert str(refused.value).endswith("; did you mean 'door'?")


@pytest.mark.parametrize(
    "fields", [{"surface_of_part": {"door": "bod"}}, {"parts": {"door": {"surface": "bod"}}}]
)
def test_a_part_that_names_no_known_surface_is_refused_with_the_nearest_name(fields: dict[str, Any]) -> None:
    with pytest.raises(
        InputError, match=r"part 'door': surface 'bod' is not in the surface table; did you mean 'body'\?"
    ):
        scene_of(car(), surfaces=[Surface("body")], **fields)


def test_every_problem_of_the_parts_is_told_with_their_names() -> None:
    wrong: dict[str, Any] = {"door": {"stage": 1}, "hood": {"stagee": True}, "pane": {"surface": ""}}
    with pytest.raises(InputError) as refused:
        scene_of(car(), parts=wrong)
    for name, problem in zip(("door", "hood", "pane"), refused.value.problems, strict=True):
        assert name in problem
    assert "did you mean 'stage'?" in refused.value.problems[1]


def test_a_part_of_a_wrong_name_is_not_renamed_by_its_fields() -> None:
    scene = scene_of(car(), parts={"door": {"name": "gate", "stage": True}})
    assert scene.parts[0] == Part("door", SHARED, stage=True)


def test_surfaces_of_the_same_name_are_refused() -> None:
    with pytest.raises(InputError, match=r"surfaces\[2\].name must be unique"):
        scene_of(car(), surfaces=[Surface("body"), Surface("body")])


class Counted(dict[str, str]):
    """Counts how often it is asked, whole or for a key."""

    asked = 0

    def __getitem__(self, key: str) -> str:
        self.asked += 1
        return super().__getitem__(key)

    def __contains__(self, key: object) -> bool:
        self.asked += 1
        return super().__contains__(key)

    def get(self, key: str, default: Any = None) -> Any:
        self.asked += 1
        return super().get(key, default)


class CountedName(str):
    """A name that counts how often it is compared with another object of the same text."""

    __slots__ = ()
    compared = 0

    def __eq__(self, other: object) -> bool:
        CountedName.compared += 1
        return str.__eq__(self, other)

    __hash__ = str.__hash__


@pytest.mark.parametrize("count", [1_000, 10_000])
def test_the_work_is_in_proportion_to_the_number_of_parts(count: int) -> None:
    mesh = dataclasses.replace(
        cube(), part_names=tuple(CountedName(f"part {number}") for number in range(count))
    )
    surface_of_part = Counted({f"part {number}": "body" for number in range(count)})
    material_of_part = Counted({f"part {number}": "red" for number in range(count)})
    CountedName.compared = 0
    scene = scene_of(
        mesh,
        surfaces=[Surface("body")],
        surface_of_part=surface_of_part,
        material_of_part=material_of_part,
        view=VIEW,
        lights=(),
    )
    assert set(surfaces_of_parts(scene)) == {"body"}
    assert surface_of_part.asked <= 4 * count
    assert material_of_part.asked <= 4 * count
    assert CountedName.compared <= 20 * count


def test_how_intensities_are_shown_is_that_of_a_bare_mesh_unless_it_is_given() -> None:
    plain: dict[str, Any] = {name: vars(scene_of(car()))[name] for name in MAPPING_FIELDS}
    assert plain == MAPPING_FIELDS
    others: dict[str, Any] = {
        "scaling": "surface", "contrast": "stretch", "mapping": "gamma", "ambient": 0.375,
    }  # fmt: skip
    scene = scene_of(car(), **others)
    assert {name: vars(scene)[name] for name in others} == others


def test_created_lights_are_those_of_the_view_that_is_given() -> None:
    one, other = scene_of(car()), scene_of(car(), view=VIEW)
    assert other.view == VIEW
    assert names_of_lights(one) == names_of_lights(other)
    assert one.lights != other.lights
    assert scene_of(car(), lights=()).lights == ()


def names_of_lights(scene: Scene) -> list[str]:
    return [light.name for light in scene.lights]


def test_unused_nodes_do_not_matter_to_what_is_created() -> None:
    mesh = cube()
    with_stray = Mesh(
        np.concatenate([mesh.coordinates, [(1e25, 0, 0)]]),
        mesh.node_numbers,
        mesh.part_numbers,
        mesh.part_names,
    )
    assert scene_of(with_stray).view == scene_of(mesh).view
    assert scene_of(with_stray).lights == scene_of(mesh).lights


def test_a_part_of_the_stage_does_not_matter_to_the_view_and_the_lights_that_are_created() -> None:
    floor = grid(1, 1, (-50, -50, 0), (100, 0, 0), (0, 100, 0), "floor")
    alone = scene_of(cube())
    whole = scene_of(Mesh.joined([cube(), floor]))
    staged = scene_of(Mesh.joined([cube(), floor]), parts={"floor": {"stage": True}})
    assert (staged.view, staged.lights) == (alone.view, alone.lights)
    assert whole.view != alone.view
    assert [part.stage for part in staged.parts] == [False, True]


def test_tables_for_what_a_scene_is_made_of_are_taken_or_refused_in_a_sentence() -> None:
    scene = scene_of(
        cube(),
        view={"eye": (5, 5, 5), "target": (0, 0, 0)},
        surfaces=[{"name": "cube", "diffuse": 0.2}],  # type: ignore[list-item]
        lights=[{"name": "key", "position": (1, 2, 3)}],  # type: ignore[list-item]
    )
    assert scene.view == View((5, 5, 5), target=(0, 0, 0))
    assert scene.surface("cube").reflectance.diffuse == 0.2
    assert scene.lights == (Light("key", (1, 2, 3)),)
    wrong: list[dict[str, Any]] = [{"surfaces": [1]}, {"surfaces": 5}, {"view": 3}, {"lights": "key"}]
    for fields in wrong:
        with pytest.raises(InputError, match="must be"):
            scene_of(cube(), **fields)


def test_a_word_for_surfaces_that_is_none_of_the_two_is_refused() -> None:
    wrong: Any = "part"
    with pytest.raises(UsageError, match="surfaces must be rows, 'materials' or 'parts', not 'part'"):
        scene_of(cube(), surfaces=wrong)


def test_a_field_that_a_scene_does_not_have_is_refused_with_the_nearest_one() -> None:
    with pytest.raises(InputError) as refusal:
        scene_of(cube(), backgroud="navy")  # type: ignore[call-arg]
    assert str(refusal.value) == "there is no field 'backgroud'; did you mean 'background'?"


def test_problems_of_the_view_and_of_the_surfaces_are_told_together() -> None:
    wrong: dict[str, Any] = {"surfaces": [1], "view": 3, "parts": {"cube": {"stage": 2}}}
    with pytest.raises(InputError) as refused:
        scene_of(cube(), **wrong)
    assert len(refused.value.problems) == 3


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


def test_a_larger_object_has_its_light_farther_away() -> None:
    near, far = (new_light_of(scene_of(cube(size), lights=[])) for size in (1.0, 10.0))
    middle = np.full(3, 5.0)
    assert np.array(far.position) - middle == pytest.approx((np.array(near.position) - 0.5) * 10)


def test_a_light_for_a_view_from_straight_above_is_there_too() -> None:
    scene = scene_of(
        cube(), lights=[Light("light", (9, 9, 9))], view=View((0.5, 0.5, 5), direction=(0, 0, -1))
    )
    light = new_light_of(scene)
    assert light.name == "light 2"
    assert light.position[2] > 0.5


def test_what_is_seen_through_a_crack_is_bright_and_leaves_the_rest_as_bright_as_without_it() -> None:
    cubes = Mesh.joined([shifted(cube(), -1.01), shifted(cube(), 0.01)])
    view = View(eye=(0, -5, 0.8), target=(0, 0, 0.5))
    closed = scene_of(cubes, view=view, mapping="linear")
    # A plate behind the crack mirrors the key light to the eye.
    middle = np.array((0.0, 0.5, 0.5))
    to_key, to_eye = (np.array(each) - middle for each in (closed.lights[0].position, view.eye))
    normal = to_key / np.linalg.norm(to_key) + to_eye / np.linalg.norm(to_eye)
    across = np.cross(normal, (0, 0, 1))
    up = np.cross(across, normal)
    across, up = across / np.linalg.norm(across), 0.4 * up / np.linalg.norm(up)
    plate = grid(1, 1, tuple(middle - (across + up) / 2), tuple(across), tuple(up), "plate")
    cracked = scene_of(Mesh.joined([cubes, plate]), view=view, mapping="linear")
    assert cracked.lights == closed.lights

    picture = render(cracked)
    specks = picture.part_number == 1 + picture.parts.index("plate")
    outside = (picture.part_number > 0) & ~specks
    assert 100 < np.count_nonzero(specks) < 0.005 * np.count_nonzero(picture.part_number)
    assert picture.intensity[specks].min() > 1.5 * picture.intensity[outside].max()

    def median(scene: Scene) -> float:
        return float(np.median(display_image(scene, render(scene)).words[outside]))

    words = display_image(cracked, picture).words
    assert (words[specks] == words.max()).all()
    assert median(cracked) > 0.9 * median(closed)
    assert median(cracked.replace(exposure="auto")) < 0.7 * median(closed)
