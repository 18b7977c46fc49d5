from __future__ import annotations

import dataclasses
import tomllib
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import InputError, Light, Mesh, Surface, View
from autocolor.errors import MissingInputError
from autocolor.files.meshes.repair import MeshReport
from autocolor.files.scenes.scene_report import LONGEST_SENTENCE, MOST_PROBLEMS, SceneProblems, scene_report
from autocolor.scene.columns import Problem
from autocolor.scene.defaults import created_surface
from tests.autocolor.meshes import cube, wall_scene

VIEW = View((0, -4, 0), target=(0, 0, 0))


def read(mesh: Mesh, **fields: Any) -> list[MeshReport]:
    """That one mesh was read."""
    return [MeshReport(mesh, **fields)]


def mesh_of(parts: int) -> Mesh:
    """A cube and more parts, named 0, 1 and so on, the others without polygons."""
    return dataclasses.replace(cube(), part_names=tuple(map(str, range(parts))))


def created(parts: int = 1, **fields: Any) -> tuple[str, ...]:
    """What is said to be created where only a view and no lights are given, unless `fields` say otherwise."""
    given = {"view": VIEW, "lights": (), "surfaces": "parts", **fields}
    return scene_report(read(mesh_of(parts)), **given).created


def test_of_a_bare_mesh_everything_is_created_and_said() -> None:
    assert scene_report(read(cube())).created == (
        "a view was created that frames the object",
        "4 studio lights were created",
        "surface 'surface' was created",
    )


def test_nothing_is_said_of_what_was_given() -> None:
    report = scene_report(
        read(cube()), view=VIEW, lights=[Light("key", (0, -3, 0))], surfaces=[Surface("cube")]
    )
    assert report.created == ()
    assert report.scene.view == VIEW


def test_no_lights_are_lights_that_were_given() -> None:
    assert created() == ("surface '0' was created",)
    assert created(lights=None)[0] == "4 studio lights were created"


@given(st.integers(1, 30), st.data())
def test_as_many_surfaces_are_said_as_the_scene_has_beside_the_given(parts: int, data: st.DataObject) -> None:
    names = [str(part) for part in range(parts)]
    given_names = data.draw(st.sets(st.sampled_from(names)))
    report = scene_report(
        read(mesh_of(parts)),
        view=VIEW,
        lights=(),
        surfaces=[Surface(name) for name in sorted(given_names)],
        surface_of_part={name: name for name in names},
    )
    missing = [surface.name for surface in report.scene.surfaces if surface.name not in given_names]
    assert len(missing) == parts - len(given_names)
    if not missing:
        assert report.created == ()
    elif len(missing) == 1:
        assert report.created == (f"surface '{missing[0]}' was created",)
    else:
        (sentence,) = report.created
        assert sentence.startswith(f"{len(missing)} surfaces were created: '{missing[0]}', '{missing[1]}'")
        assert sentence.endswith(" more") == (len(missing) > 12)


def test_a_list_of_many_surfaces_is_cut_and_says_how_many_more() -> None:
    names = ", ".join(f"'{part}'" for part in range(12))
    assert created(parts=12) == (f"12 surfaces were created: {names}",)
    assert created(parts=14) == (f"14 surfaces were created: {names} and 2 more",)


def test_a_part_that_shares_a_surface_as_asked_is_not_counted() -> None:
    shared = {str(part): "0" for part in range(300)}
    assert created(parts=300, surface_of_part=shared) == ("surface '0' was created",)
    assert created(parts=300)[-1] == "46 parts share surface '254', because a scene has at most 255"


def test_the_repairs_and_mesh_files_are_handed_on() -> None:
    report = scene_report(read(cube(), repairs=("car.obj: a repair",)), mesh_files=({"file": "car.obj"},))
    assert report.repairs == ("car.obj: a repair",)
    assert report.mesh_files == ({"file": "car.obj"},)


def test_a_scene_that_breaks_a_rule_is_refused() -> None:
    with pytest.raises(InputError, match="ambient must be a finite number of at least 0, not -1"):
        scene_report(read(wall_scene().mesh), ambient=-1)


def test_of_parts_and_materials_of_several_meshes_the_first_count() -> None:
    red, blue = Surface("red"), Surface("red", two_sided=False)
    reports = [
        *read(wall_scene().mesh, material_of_part={"wall": "red"}, materials=(red,)),
        *read(wall_scene().mesh, material_of_part={"wall": "glass"}, materials=(blue,)),
        *read(cube(), material_of_part={"cube": "red"}),
    ]
    report = scene_report(reports, view=VIEW, lights=())
    assert [part.surface for part in report.scene.parts] == ["red", "red"]
    assert report.scene.surfaces == (red,)
    assert report.created == ("surface 'red' was created",)


def test_the_repairs_of_all_meshes_are_told_in_their_order() -> None:
    reports = [MeshReport(cube(), ("one", "two")), MeshReport(wall_scene().mesh, ("three",))]
    assert scene_report(reports).repairs == ("one", "two", "three")


def test_materials_of_one_name_that_differ_are_kept_apart() -> None:
    def report(part: str, color: tuple[int, int, int]) -> MeshReport:
        material = created_surface("Material", color)
        mesh = dataclasses.replace(cube(), part_names=(part,))
        return MeshReport(mesh, material_of_part={part: "Material"}, materials=(material,))

    read = [report("hood", (255, 0, 0)), report("door", (0, 0, 255)), report("roof", (255, 0, 0))]
    scene = scene_report(read).scene
    assert [part.surface for part in scene.parts] == ["Material", "Material 2", "Material"]
    assert [surface.paint.object_color for surface in scene.surfaces] == [(255, 0, 0), (0, 0, 255)]


def test_a_part_of_several_meshes_has_the_first_material_and_the_others_are_told() -> None:
    read = [
        MeshReport(cube()),
        MeshReport(cube(), material_of_part={"cube": "red"}),
        MeshReport(cube(), material_of_part={"cube": "blue"}),
    ]
    report = scene_report(read)
    assert report.scene.parts[0].surface == "red"
    assert report.repairs == ("part 'cube' is in several meshes: it has material 'red'",)


TEXT = """ambient = 1
scaling = "object"
[view]
eye = [1, 2, 3]
[[mesh]]
file = "car.obj"
[surfaces."my body"]
blend = 0.5
[[lights]]
name = "key"
position = [1, 2, 3]
flaps.z = { minimum = 0 }
[[lights]]
position = [1, 2, 3]
"""


def problems_of(text: str = TEXT) -> SceneProblems:
    return SceneProblems("scene.toml", text.encode(), tomllib.loads(text))


def sentences_of(problems: SceneProblems) -> tuple[str, ...]:
    with pytest.raises(InputError) as caught:
        problems.raise_any()
    return caught.value.problems


@pytest.mark.parametrize(
    ("path", "sentence"),
    [
        ((), "scene.toml, must be so"),
        (("ambient",), "scene.toml, line 1, ambient must be so"),
        (("view",), "scene.toml, line 3, view must be so"),
        (("view", "eye"), "scene.toml, line 4, [view]: eye must be so"),
        (("mesh", 0, "file"), "scene.toml, line 6, mesh[1]: file must be so"),
        (("surfaces", "my body", "blend"), "scene.toml, line 8, [surfaces.my body]: blend must be so"),
        (("lights", 0, "position"), "scene.toml, line 11, lights[1] 'key': position must be so"),
        (
            ("lights", 0, "flaps", "z", "minimum"),
            "scene.toml, line 12, lights[1] 'key': flaps.z.minimum must be so",
        ),
        (("lights", 1, "position"), "scene.toml, line 14, lights[2]: position must be so"),
        (("lights", 1, "name"), "scene.toml, line 13, lights[2]: name must be so"),
        (("parts", "hood", "surface"), "scene.toml, [parts.hood]: surface must be so"),
    ],
)
def test_a_problem_has_the_line_the_table_and_the_key(path: tuple[str | int, ...], sentence: str) -> None:
    problems = problems_of()
    problems.note(path, "must be so")
    assert sentences_of(problems) == (sentence,)


def test_a_wrong_name_is_told_the_nearest_right_one() -> None:
    problems = problems_of()
    problems.note(("parts", "hod"), "no mesh has a part of this name", ("hod", ["hood", "roof"]))
    assert sentences_of(problems) == (
        "scene.toml, [parts.hod]: no mesh has a part of this name; did you mean 'hood'?",
    )


def test_problems_of_a_row_are_noted_under_its_path() -> None:
    problems = problems_of()
    problems.note_all(
        [Problem(("name",), "must be so"), Problem((), "it must have an aim")], path=("lights", 1)
    )
    assert sentences_of(problems) == (
        "scene.toml, line 13, lights[2]: name must be so",
        "scene.toml, line 13, lights[2]: it must have an aim",
    )


def test_problems_stand_in_the_order_of_the_lines_and_of_noting() -> None:
    problems = problems_of()
    for path, text in ((("view", "eye"), "must a"), (("ambient",), "must b"), (("view", "eye"), "must c")):
        problems.note(path, text)
    assert [sentence[-1] for sentence in sentences_of(problems)] == ["b", "a", "c"]


def test_without_a_problem_nothing_is_raised() -> None:
    problems_of().raise_any()


def test_a_mesh_file_has_places_of_its_own() -> None:
    problems = problems_of()
    problems.note(("lights", 0, "position"), "must be so")
    problems.note_file(("mesh", 0, "file"), InputError(["car.obj, line 1: one", "car.obj, line 2: two"]))
    assert sentences_of(problems) == (
        "car.obj, line 1: one",
        "car.obj, line 2: two",
        "scene.toml, line 11, lights[1] 'key': position must be so",
    )


def test_files_are_missing_input_only_where_nothing_else_is_wrong() -> None:
    missing = MissingInputError("car.obj: there is no such file")
    problems = problems_of()
    problems.note_file(("mesh", 0, "file"), missing)
    with pytest.raises(MissingInputError) as caught:
        problems.raise_any()
    assert str(caught.value) == "scene.toml, line 6, mesh[1]: car.obj: there is no such file"
    problems.note(("ambient",), "must be so")
    with pytest.raises(InputError) as other:
        problems.raise_any()
    assert other.type is InputError
    assert len(other.value.problems) == 2


@given(st.integers(1, 3 * MOST_PROBLEMS), st.integers(0, 3 * MOST_PROBLEMS))
def test_a_report_has_at_most_so_many_problems_and_says_if_there_may_be_more(own: int, of_mesh: int) -> None:
    problems = problems_of()
    for _ in range(own):
        problems.note(("ambient",), "must be so")
    problems.note_file(("mesh", 0, "file"), InputError("car.obj: wrong" for _ in range(of_mesh)))
    sentences = sentences_of(problems)
    assert problems.count == own + of_mesh
    assert problems.full == (own + of_mesh >= MOST_PROBLEMS)
    if problems.full:
        assert len(sentences) == MOST_PROBLEMS + 1
        assert sentences[-1] == "scene.toml: there may be more problems; correct these first"
    else:
        assert len(sentences) == own + of_mesh


@given(st.text(min_size=1, max_size=2000))
def test_a_sentence_is_short_whatever_a_file_holds(text: str) -> None:
    problems = problems_of()
    problems.note(("surfaces", text, text), text)
    (sentence,) = sentences_of(problems)
    assert len(sentence) <= LONGEST_SENTENCE + len("scene.toml, line 14, [surfaces.]: ...") + 60


@pytest.mark.parametrize("text", ["lights = 3\n", "lights = [1]\n", "[lights]\nname = 'x'\n"])
def test_a_table_that_is_no_table_still_has_a_place(text: str) -> None:
    problems = problems_of(text)
    problems.note(("lights", 0, "name"), "must be so")
    (sentence,) = sentences_of(problems)
    assert sentence == "scene.toml, line 1, lights[1]: name must be so"
