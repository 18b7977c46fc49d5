from __future__ import annotations

import dataclasses
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import Flap, Flaps, InputError, Light, Scene
from autocolor.files.formats import read_mesh
from autocolor.files.meshes.repair import MeshReport
from autocolor.files.scene_sources import read_scene_with_report
from autocolor.files.scene_toml.scene_file import report_of_text
from autocolor.files.scene_toml.scene_text import (
    completed,
    edited_to,
    scene_text,
    with_crease_angle,
    with_meshes,
    without_parts,
)
from autocolor.scene.columns import with_values
from tests.autocolor.linked_scenes import linked_scenes
from tests.autocolor.strategies import of_mesh

NAMED_MESH = "v 0 0 0\nv 1 0 0\nv 1 1 0.1\nv 0 1 0\no {}\nf 1 2 3 4\no {}\nf 1 2 3\n"


def read_back(
    folder: Path, scene: Scene, mesh_files: tuple[dict[str, str], ...], without_defaults: bool = False
) -> Scene:
    text = scene_text(scene, mesh_files, without_defaults=without_defaults)
    (folder / "scene.toml").write_text(text, encoding="utf-8")
    report = read_scene_with_report(folder)
    assert without_defaults or report.created == ()
    return report.scene


def same(one: Scene, other: Scene) -> bool:
    fields = {field.name for field in dataclasses.fields(Scene)} - {"mesh", "name"}
    arrays = ("coordinates", "node_numbers", "part_numbers")
    return (
        all(getattr(one, name) == getattr(other, name) for name in fields)
        and all(np.array_equal(getattr(one.mesh, name), getattr(other.mesh, name)) for name in arrays)
        and one.mesh.part_names == other.mesh.part_names
        and one.mesh.crease_angle == other.mesh.crease_angle
    )


@pytest.mark.parametrize("without_defaults", [False, True])
@given(drawn=linked_scenes(), up=st.sampled_from("xyz"))
def test_a_scene_that_was_written_reads_back_equal(
    without_defaults: bool, drawn: Scene, up: str, tmp_path_factory: pytest.TempPathFactory
) -> None:
    folder = tmp_path_factory.mktemp("scene")
    (folder / "car.obj").write_text(NAMED_MESH.format(*drawn.mesh.part_names))
    mesh = read_scene_with_report(folder / "car.obj", up=up).scene.mesh
    angle = drawn.mesh.crease_angle
    scene = of_mesh(drawn, dataclasses.replace(mesh, crease_angle=angle))
    assert same(scene, read_back(folder, scene, ({"file": "car.obj", "up": up},), without_defaults))


@given(
    names=st.lists(
        # A backslash at the end of a line would continue it.
        st.text(min_size=1, max_size=20)
        .map(lambda name: name.strip().rstrip("\\").rstrip())
        .filter(lambda name: bool(name) and name.isprintable()),
        min_size=2,
        max_size=2,
        unique=True,
    )
)
def test_any_names_are_written(names: list[str], tmp_path_factory: pytest.TempPathFactory) -> None:
    folder = tmp_path_factory.mktemp("scene")
    (folder / "car.obj").write_text(NAMED_MESH.format(*names), encoding="utf-8")
    report = read_scene_with_report(folder / "car.obj")
    assert report.scene.mesh.part_names == tuple(names)
    assert same(report.scene, read_back(folder, report.scene, report.mesh_files))  # type: ignore[arg-type]


def test_what_was_created_is_written_out_and_read_back(tmp_path: Path) -> None:
    (tmp_path / "car.obj").write_text(NAMED_MESH.format("hood", "roof"))
    report = read_scene_with_report(tmp_path / "car.obj", surfaces="parts")
    assert len(report.created) == 3
    text = scene_text(report.scene, report.mesh_files)
    for table in ("[view]", "[[mesh]]", "[parts.hood]", "[surfaces.roof]", "[[lights]]"):
        assert table in text
    (tmp_path / "scene.toml").write_text(text)
    assert same(report.scene, read_scene_with_report(tmp_path).scene)


def test_ends_of_flaps_that_are_nowhere_are_left_out(tmp_path: Path) -> None:
    (tmp_path / "car.obj").write_text(NAMED_MESH.format("hood", "roof"))
    report = read_scene_with_report(tmp_path / "car.obj")
    scene = report.scene.with_light("key", flaps=Flaps(z=Flap(minimum=0.5), x=Flap(on=False)))
    text = scene_text(scene, report.mesh_files)
    assert "flaps.x = { on = false, edge_width = 0.0 }\n" in text
    assert "flaps.z = { minimum = 0.5, on = true, edge_width = 0.0 }\n" in text
    (tmp_path / "scene.toml").write_text(text)
    assert same(scene, read_scene_with_report(tmp_path).scene)


def test_half_spaces_have_a_line_each_and_links_are_lists(tmp_path: Path) -> None:
    (tmp_path / "car.obj").write_text(NAMED_MESH.format("hood", "roof"))
    report = read_scene_with_report(tmp_path / "car.obj")
    scene = report.scene.with_light(
        "key",
        half_spaces={
            "left": {"point": (1, 0, 0), "direction": (1, 0, 0)},
            "a door": {"point": (0, 0, 0), "direction": (0, 1, 0), "edge_width": 0.5, "on": False},
        },
        flaps=Flaps(z=Flap(minimum=0.5)),
        only_parts=["hood"],
        except_surfaces=[],
        follows="eye",
    )
    text = scene_text(scene, report.mesh_files, without_defaults=True)
    assert (
        """
flaps.z = { minimum = 0.5 }
half_spaces."a door" = { point = [0.0, 0.0, 0.0], direction = [0.0, 1.0, 0.0], edge_width = 0.5, on = false }
half_spaces.left = { point = [1.0, 0.0, 0.0], direction = [1.0, 0.0, 0.0] }
follows = "eye"
except_surfaces = []
only_parts = ["hood"]
"""
        in text
    )
    whole = scene_text(scene, report.mesh_files)
    assert "direction = [1.0, 0.0, 0.0], edge_width = 0.0, carried = false, on = true }\n" in whole


MESH = "v 0 0 0\nv 1 0 0\nv 1 1 0.1\nv 0 1 0\no part 0\nf 1 2 3 4\no part 1\nf 1 2 3\n"

INLINE = """\
# Mine.
lights = [ {name="key", position=[1,2,3]}, {name="b", position=[1,2,3], flaps={x={minimum=0}},\
 half_spaces={left={point=[0,0,0], direction=[1,0,0]}, b={point=[1,0,0], direction=[1,0,0], on=false}},\
 only_parts=["part 0"], follows="eye"} ]
mesh = [ {file="car.obj"} ]
view = { eye = [1,2,3], target=[0,0,0] }
views = [ {name="hood", eye=[1,2,3], target=[0,0,0]} ]
parts = { "part 0" = {surface="body"}, "part 1".surface = "glass" }
surfaces = { body = { diffuse = 0.5, model="blinn", exponent = 3 }, glass = {} }
scalar = { name = "z", limits = [0, 1] }
exposure = { body = [0.0, 1.0] }
"""

DOTTED = """\
# Mine.
view.eye = [1,2,3]
view.target = [0,0,0]
parts."part 0".surface = "body"
parts."part 1".surface = "glass"
surfaces.body.diffuse = 0.5
surfaces.glass.model = "cook-torrance"
scalar.name = "z"
scalar.scale = "turbo"
exposure.body = [0.0, 1.0]
exposure.object = [0.0, 1.0]
[[mesh]]
file = "car.obj"
[[lights]]
name = "fill"
position = [1,2,3]
direction = [1,2,3]
flaps.x.minimum = 0.5
flaps.z.on = false
half_spaces.left.point = [0,0,0]
half_spaces.left.direction = [1,0,0]
half_spaces."barn door" = { point = [1,0,0], direction = [1,0,0], edge_width = 0.1 }
except_surfaces = ["glass", "body"]
"""

HEADERS = """\
# Mine.
[view]
eye = [1,2,3]
target = [0,0,0]
[[views]]
name = "view 1"
eye = [1,2,3]
direction = [1,0,0]
[[views]]
name = "hood"
eye = [1,2,3]
target = [0,0,0]
[parts]
[parts."part 0"]
surface = "body"
[parts."part 1"]
surface = "glass"
[surfaces.glass]
[surfaces.body]
diffuse = 0.5
[exposure]
body = [0.0, 1.0]
[[lights]]
name = "rim"
position = [1,2,3]
[lights.flaps]
[lights.flaps.x]
minimum = 0.5
[lights.flaps.z]
on = false
[lights.half_spaces.right]
point = [0,0,0]
direction = [1,0,0]
[lights.half_spaces.b]
point = [0,0,0]
direction = [1,0,0]
[[lights]]
name = "key"
position = [1,2,3]
[[mesh]]
file = "car.obj"
"""


@pytest.fixture(scope="module")
def meshes(tmp_path_factory: pytest.TempPathFactory) -> list[MeshReport]:
    path = tmp_path_factory.mktemp("mesh") / "car.obj"
    path.write_text(MESH)
    return [read_mesh({"file": path})]


def read(text: bytes, meshes: list[MeshReport]) -> Scene:
    return report_of_text(text, Path("car", "scene.toml"), meshes=meshes).scene


def edited(text: str, scene: Scene, meshes: list[MeshReport]) -> str:
    data = edited_to(text.encode(), scene, lambda data: read(data, meshes))
    assert data is not None
    return data.decode()


@pytest.mark.parametrize("text", [INLINE, DOTTED, HEADERS])
@given(drawn=linked_scenes())
def test_a_file_in_any_style_is_changed_to_any_scene(
    text: str, drawn: Scene, meshes: list[MeshReport]
) -> None:
    scene = of_mesh(drawn, meshes[0].mesh)
    after = edited(text, scene, meshes)
    assert with_values(read(after.encode(), meshes), {"mesh": scene.mesh, "name": scene.name}).equals(scene)
    assert after.count("# Mine.") == 1
    # Once there, it stays.
    assert edited(after, scene, meshes) == after


@pytest.mark.parametrize("text", [INLINE, DOTTED, HEADERS])
def test_without_a_change_nothing_changes(text: str, meshes: list[MeshReport]) -> None:
    assert edited(text, read(text.encode(), meshes), meshes) == text


def test_a_scalar_is_edited_in_place_with_its_comments(meshes: list[MeshReport]) -> None:
    text = f'{HEADERS}\n# What is told.\n[scalar]\nname = "z"  # the height\nbands = 8\n'
    scene = read(text.encode(), meshes)
    after = edited(text, scene.with_scalar(bands=4, limits=[0, 1]), meshes)
    assert after == text.replace("bands = 8\n", "bands = 4\nlimits = [0.0, 1.0]\n")
    assert "scalar" not in edited(text, scene.without_scalar(), meshes)
    assert edited(HEADERS, read(HEADERS.encode(), meshes).with_scalar(name="z"), meshes) == HEADERS.replace(
        "[parts]\n", '\n[scalar]\nname = "z"\n\n[parts]\n'
    )


def test_named_views_come_and_go_with_their_comments(meshes: list[MeshReport]) -> None:
    start = '[[mesh]]\nfile = "car.obj"\n'
    scene = read(start.encode(), meshes)
    more = edited(start, scene.with_saved_view("hood").with_saved_view("roof"), meshes)
    assert more.startswith('[[views]]\nname = "hood"\neye = [')
    mine = more.replace('"roof"\n', '"roof" # from above\n').replace('"hood"\n', '"hood" # mine\n')
    turned = edited(mine, read(mine.encode(), meshes).with_named_view("roof", angle=3), meshes)
    assert turned == mine.replace("[[mesh]]", "angle = 3.0\n\n[[mesh]]", 1).replace("\n\nangle", "\nangle")
    fewer = edited(mine, read(mine.encode(), meshes).without_named_view("hood"), meshes)
    assert "# from above" in fewer
    assert "hood" not in fewer
    assert edited(fewer, scene, meshes) == start


@pytest.mark.parametrize(
    "text", [INLINE, DOTTED, HEADERS, HEADERS.replace("[surfaces.g", "[surfaces]\n[surfaces.g")]
)
def test_surfaces_in_another_order_are_written_in_that_order(text: str, meshes: list[MeshReport]) -> None:
    scene = read(text.encode(), meshes)
    new = scene.surfaces[0].replace(name="new")
    for surfaces in (
        scene.surfaces[::-1],
        (*scene.surfaces, new),
        (scene.surfaces[1], new, scene.surfaces[0]),
    ):
        wanted = scene.replace(surfaces=surfaces)
        after = edited(text, wanted, meshes)
        assert read(after.encode(), meshes).surfaces == surfaces
        assert after.startswith("# Mine.\n")


def test_a_new_model_takes_its_parameters_along(meshes: list[MeshReport]) -> None:
    scene = read(HEADERS.encode(), meshes).with_surface("body", model="cook-torrance", roughness=0.5)
    after = edited(HEADERS, scene, meshes)
    # What has its default need not be told.
    assert '[surfaces.body]\ndiffuse = 0.5\nmodel = "cook-torrance"\nroughness = 0.5\n' in after
    back = scene.with_surface("body", model="blinn", exponent=7)
    assert 'diffuse = 0.5\nmodel = "blinn"\nexponent = 7.0\n' in edited(after, back, meshes)


def test_an_aim_takes_the_place_of_a_direction(meshes: list[MeshReport]) -> None:
    scene = read(DOTTED.encode(), meshes).with_light("fill", aim=(0, 0, 9))
    after = edited(DOTTED, scene, meshes)
    assert "direction = [1,2,3]\n" not in after
    assert "aim = [0.0, 0.0, 9.0]\n" in after


def test_a_new_light_has_its_flaps(meshes: list[MeshReport]) -> None:
    scene = read(DOTTED.encode(), meshes)
    new = Light("new", (1.0, 1.0, 1.0), flaps=Flaps(y=Flap(), z=Flap(0.5, on=False)))
    after = edited(DOTTED, scene.replace(lights=(*scene.lights, new)), meshes)
    assert after == DOTTED + (
        '\n[[lights]]\nname = "new"\nposition = [1.0, 1.0, 1.0]\n'
        "flaps.y = {}\nflaps.z = { minimum = 0.5, on = false }\n"
    )


def test_a_text_that_cannot_be_read_is_not_changed(meshes: list[MeshReport]) -> None:
    scene = read(DOTTED.encode(), meshes)

    def refuse(_: bytes) -> Scene:
        raise InputError("no")

    assert edited_to(DOTTED.encode(), scene, refuse) is None


def test_a_text_that_never_gives_the_scene_is_given_up(meshes: list[MeshReport]) -> None:
    scene = read(DOTTED.encode(), meshes)
    assert edited_to(DOTTED.encode(), scene.replace(ambient=0.7), lambda _: scene) is None


def test_mesh_tables_are_replaced_where_they_are() -> None:
    text = '# A.\n[[mesh]]\nfile = "a.obj" # old\n[[mesh]]\nfile = "b.obj"\n[view]\n'
    after = with_meshes(text.encode(), ({"file": "c.obj", "up": "y"}, {"file": "d.obj", "up": "z"}))
    assert after == b'# A.\n[[mesh]]\nfile = "c.obj"\nup = "y"\n\n[[mesh]]\nfile = "d.obj"\n\n[view]\n'
    assert with_meshes(b'mesh = [{file="a"}]\n', ({"file": "c"},)) == b'[[mesh]]\nfile = "c"\n'


def test_a_crease_angle_is_set_where_one_is() -> None:
    text = '[[mesh]]\nfile = "a"\n[[mesh]]\nfile = "b"\ncrease_angle = 3 # deg\n'
    assert with_crease_angle(text.encode(), 7.5).decode() == text.replace("3 #", "7.5 #")
    assert with_crease_angle(b'[[mesh]]\nfile = "a"\n', 7.5) == b'[[mesh]]\nfile = "a"\ncrease_angle = 7.5\n'


def test_a_crease_angle_is_set_also_in_an_inline_array() -> None:
    assert with_crease_angle(b'mesh = [{file="a"}, {file="b"}] # two\n', 7.5) == (
        b'mesh = [{ file = "a", crease_angle = 7.5 }, { file = "b" }] # two\n'
    )


def test_parts_are_removed() -> None:
    assert without_parts(b'[parts]\na.surface = "x"\nb.stage = true\n', {"a"}) == (
        b"[parts]\nb.stage = true\n"
    )


@pytest.mark.parametrize("text", [INLINE, DOTTED, HEADERS, '# Mine.\n[[mesh]]\nfile = "car.obj"\n'])
def test_a_text_is_completed_with_all_that_it_does_not_tell(text: str, meshes: list[MeshReport]) -> None:
    scene = read(text.encode(), meshes)
    after = completed(text.encode(), scene)
    again = report_of_text(after, Path("car", "scene.toml"), meshes=meshes)
    assert again.scene.replace(mesh=scene.mesh).equals(scene)
    assert again.created == ()
    assert after.count(b"# Mine.") == 1
    assert after.count(b"two_sided") == len(scene.surfaces)
    assert completed(after, scene) == after


LEFT = "{ point = [0,0,0], direction = [1,0,0] }  # the left door"
FORMS = {
    "lines": f"""\
half_spaces.left = {LEFT}
# the roof
half_spaces.top = {{point=[0,0,1],direction=[0,0,-1]}}
""",
    "inline": """\
half_spaces = { left = {point=[0,0,0],direction=[1,0,0]}, top = {point=[0,0,1],direction=[0,0,-1]} } # mine
""",
    "dotted": """\
half_spaces.left.point = [0,0,0]
half_spaces.left.direction = [1,0,0] # the left door
half_spaces.top.point = [0,0,1]
# the roof
half_spaces.top.direction = [0,0,-1]
""",
    "headers": """\
[lights.half_spaces.left]
point = [0,0,0] # of the left door
direction = [1,0,0]

# the roof
[lights.half_spaces.top]
point = [0,0,1]
direction = [0,0,-1]
""",
    "header": """\
[lights.half_spaces] # mine
left = { point = [0,0,0], direction = [1,0,0] }
top = { point = [0,0,1], direction = [0,0,-1] }
""",
}
BEFORE = """\
# Mine.
[[mesh]]
file = "car.obj"
[[lights]]
name = "key"
position = [1,2,3]
"""
AFTER = """\
[[lights]]
# the other
name = "fill"
position = [3,2,1]
"""


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize(
    ("changes", "old", "new"),
    [
        ({"left": {"point": (0, 0, 2)}}, "[0,0,0]", "[0.0, 0.0, 2.0]"),
        ({"top": {"direction": (0, 1, -1)}}, "[0,0,-1]", "[0.0, 1.0, -1.0]"),
    ],
)
def test_a_key_of_a_half_space_is_changed_where_it_stands(
    form: str, changes: dict[str, object], old: str, new: str, meshes: list[MeshReport]
) -> None:
    text = BEFORE + FORMS[form] + AFTER
    after = edited(text, read(text.encode(), meshes).with_light("key", half_spaces=changes), meshes)  # type: ignore[arg-type]
    assert after == text.replace(old, new)


NEW = {"point": (1.0, 1.0, 1.0), "direction": (0.0, 0.0, 1.0)}
NEW_TEXT = "{ point = [1.0, 1.0, 1.0], direction = [0.0, 0.0, 1.0] }"


@pytest.mark.parametrize(
    ("form", "changes", "old", "new"),
    [
        # A key that was left out.
        ("lines", {"left": {"edge_width": 0.1}}, "[1,0,0] }", "[1,0,0], edge_width = 0.1 }"),
        ("inline", {"left": {"edge_width": 0.1}}, "[1,0,0]}", "[1,0,0], edge_width = 0.1 }"),
        (
            "dotted",
            {"left": {"edge_width": 0.1}},
            "# the left door\n",
            "# the left door\nhalf_spaces.left.edge_width = 0.1\n",
        ),
        ("headers", {"left": {"edge_width": 0.1}}, "[1,0,0]\n", "[1,0,0]\nedge_width = 0.1\n"),
        ("header", {"left": {"edge_width": 0.1}}, "[1,0,0] }", "[1,0,0], edge_width = 0.1 }"),
        # Another one, whose name is before the others or after them.
        ("lines", {"back": NEW}, "[0,0,-1]}\n", f"[0,0,-1]}}\nhalf_spaces.back = {NEW_TEXT}\n"),
        ("inline", {"back": NEW}, "[0,0,-1]} }", f"[0,0,-1]}}, back = {NEW_TEXT} }}"),
        ("dotted", {"z": NEW}, "[0,0,-1]\n", f"[0,0,-1]\nhalf_spaces.z = {NEW_TEXT}\n"),
        (
            "headers",
            {"my door": NEW},
            "[0,0,-1]\n",
            f'[0,0,-1]\n[lights.half_spaces]\n"my door" = {NEW_TEXT}\n\n',
        ),
        ("header", {"z": NEW}, "[0,0,-1] }\n", f"[0,0,-1] }}\nz = {NEW_TEXT}\n"),
        # One that is taken away.
        ("lines", {"left": None}, f"half_spaces.left = {LEFT}\n", ""),
        (
            "inline",
            {"left": None},
            "{ left = {point=[0,0,0],direction=[1,0,0]}, top = {point=[0,0,1],direction=[0,0,-1]} }",
            "{ top = {point=[0,0,1],direction=[0,0,-1]} }",
        ),
        (
            "dotted",
            {"left": None},
            "half_spaces.left.point = [0,0,0]\nhalf_spaces.left.direction = [1,0,0] # the left door\n",
            "",
        ),
        (
            "headers",
            {"left": None},
            "[lights.half_spaces.left]\npoint = [0,0,0] # of the left door\ndirection = [1,0,0]\n\n",
            "",
        ),
        ("header", {"left": None}, "left = { point = [0,0,0], direction = [1,0,0] }\n", ""),
    ],
)
def test_half_spaces_come_and_go_among_the_others(
    form: str, changes: dict[str, object], old: str, new: str, meshes: list[MeshReport]
) -> None:
    text = BEFORE + FORMS[form] + AFTER
    after = edited(text, read(text.encode(), meshes).with_light("key", half_spaces=changes), meshes)  # type: ignore[arg-type]
    assert old in text
    assert after == text.replace(old, new)


def test_the_first_half_space_and_a_soft_flap_have_lines_of_their_own(meshes: list[MeshReport]) -> None:
    text = BEFORE + "flaps.z.minimum = 0.5 # the roof\nflaps.x = { maximum = 1 }\n" + AFTER
    scene = read(text.encode(), meshes).with_light(
        "key",
        half_spaces={"a b": NEW},  # type: ignore[dict-item]
        flaps={"z": {"edge_width": 0.25}, "x": {"edge_width": 0.5}, "y": {"minimum": 0}},
        only_surfaces=[],
        follows="eye",
    )
    after = edited(text, scene, meshes)
    assert (
        after
        == BEFORE
        + (
            "flaps.z.minimum = 0.5 # the roof\nflaps.z.edge_width = 0.25\n"
            "flaps.x = { maximum = 1, edge_width = 0.5 }\nflaps.y = { minimum = 0.0 }\n"
            f'half_spaces."a b" = {NEW_TEXT}\nfollows = "eye"\nonly_surfaces = []\n'
        )
        + AFTER
    )
    back = scene.with_light(
        "key",
        half_spaces=(),
        only_surfaces=None,
        follows=None,
        flaps={"z": {"edge_width": 0.0}, "x": {"edge_width": 0.0}, "y": None},
    )
    assert edited(after, back, meshes) == (
        text.replace("the roof\n", "the roof\nflaps.z.edge_width = 0.0\n").replace(
            " 1 }", " 1, edge_width = 0.0 }"
        )
    )
