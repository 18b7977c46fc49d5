from __future__ import annotations

import difflib
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import BlinnPhong, Phong, Reflectance
from autocolor.errors import InputError, MissingInputError
from autocolor.files.formats import mesh_suffixes, suffix_rule
from autocolor.files.scene_report import SceneReport
from autocolor.files.scene_toml.scene_file import read_scene_file
from autocolor.scene.creation import SurfaceSource
from autocolor.scene.curves import CURVES
from autocolor.scene.reflection_models import SpecularGrowth

CAR = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\ng hood\nf 1 2 3 4\ng roof\nf 1 2 3\n"
MESH = '[[mesh]]\nfile = "car.obj"\n'


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    made = tmp_path / "coupe"
    made.mkdir()
    (made / "car.obj").write_text(CAR)
    return made


def read(
    folder: Path, text: str | bytes, outside: bool = False, surfaces: SurfaceSource = "materials"
) -> SceneReport:
    path = folder / "scene.toml"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return read_scene_file(path, outside=outside, surfaces=surfaces)


def refusal(folder: Path, text: str | bytes) -> list[str]:
    with pytest.raises(InputError) as caught:
        read(folder, text)
    return list(caught.value.problems)


def test_all_but_a_mesh_is_created(folder: Path) -> None:
    report = read(folder, MESH)
    assert report.scene.name == "coupe"
    assert [(part.name, part.surface) for part in report.scene.parts] == [
        ("hood", "surface"),
        ("roof", "surface"),
    ]
    assert [light.name for light in report.scene.lights] == ["key", "fill", "top", "rim"]
    assert report.created == (
        "a view was created that frames the object",
        "4 studio lights were created",
        "surface 'surface' was created",
    )
    assert report.repairs == ()
    assert report.mesh_files == ({"file": "car.obj"},)


def test_every_key_arrives(folder: Path) -> None:
    scene = read(
        folder,
        """
ambient = 0.25
scaling = "object"
mapping = [[0, 0], [0.5, 0.75], [1, 1]]
contrast = "floor"
background = "#102030"
[view]
eye = [8, -10.5, 4]
target = [0, 0, 0.5]
angle = 15
field_of_view = 40.0
[[mesh]]
file = "car.obj"
up = "y"
crease_angle = 60
[parts.hood]
surface = "body"
[parts.roof]
surface = "body"
[surfaces.body]
diffuse = 0.8
specular = 0
exponent = 30
object_color = "#b01020"
light_color = "#fffffe"
blend = 0.25
light_percentage = 50
two_sided = false
levels = 200
[[lights]]
name = "key"
position = [4, -6.0, 5]
intensity = 2
on = false
aim = [0, 0, 0.5]
concentration = 10
cone_angle = 25
flaps.x = { minimum = -1 }
flaps.z = { minimum = 0.5, maximum = 1.0, on = false }
[[lights]]
name = "fill"
position = [1, 2, 3]
direction = [0, 0, -2]
""",
    ).scene
    assert (scene.ambient, scene.scaling, scene.contrast) == (0.25, "object", "floor")
    assert scene.mapping == ((0, 0), (0.5, 0.75), (1, 1))
    assert scene.background == (16, 32, 48)
    view = scene.view
    assert (view.eye, view.target, view.direction) == ((8, -10.5, 4), (0, 0, 0.5), None)
    assert (view.angle, view.field_of_view) == (15, 40)
    assert scene.mesh.crease_angle == 60
    assert scene.mesh.coordinates[2].tolist() == [1, 0, 1]
    assert [part.surface for part in scene.parts] == ["body", "body"]
    (body,) = scene.surfaces
    reflectance, paint = body.reflectance, body.paint
    assert (reflectance.diffuse, reflectance.specular, reflectance.exponent) == (0.8, 0, 30)
    assert (paint.object_color, paint.light_color) == ((176, 16, 32), (255, 255, 254))
    assert (paint.blend, paint.light_percentage) == (0.25, 50)
    assert (body.two_sided, body.levels) == (False, 200)
    key, fill = scene.lights
    assert (key.position, key.intensity, key.on, key.aim) == ((4, -6, 5), 2, False, (0, 0, 0.5))
    assert (key.concentration, key.cone_angle) == (10, 25)
    assert key.flaps.x is not None
    assert (key.flaps.x.minimum, key.flaps.x.maximum, key.flaps.x.on) == (-1, float("inf"), True)
    assert key.flaps.z is not None
    assert (key.flaps.z.minimum, key.flaps.z.maximum, key.flaps.z.on) == (0.5, 1, False)
    assert fill.direction == (0, 0, -2)


def test_a_key_of_a_surface_that_is_left_out_has_its_default(folder: Path) -> None:
    without = read(folder, MESH + "[surfaces.hood]\n").scene.surface("hood")
    given = read(folder, MESH + "[surfaces.hood]\nlevels = 99\n").scene.surface("hood")
    assert given == without.replace(levels=99)
    assert given.reflectance == Reflectance()


def test_lights_may_be_none(folder: Path) -> None:
    report = read(folder, "lights = []\n" + MESH)
    assert report.scene.lights == ()
    assert not any("lights" in sentence for sentence in report.created)


def test_parts_of_the_same_name_in_several_meshes_are_one(folder: Path) -> None:
    (folder / "n.csv").write_text("x,y,z\n0,0,0\n1,0,0\n0,1,0\n")
    (folder / "p.csv").write_text("part,node1,node2,node3,node4\ndoor,1,2,3,\n")
    tables = '[[mesh]]\nnodes = "n.csv"\npolygons = "p.csv"\n'
    report = read(folder, MESH + MESH + "crease_angle = 90\n" + tables)
    assert report.scene.mesh.part_names == ("hood", "roof", "door")
    assert len(report.scene.mesh.node_numbers) == 5
    assert report.scene.mesh.crease_angle == 90


def test_repairs_of_all_meshes_are_reported(folder: Path) -> None:
    (folder / "car.obj").write_text(CAR + "f 1 1 1\n")
    assert read(folder, MESH).repairs == (
        "car.obj: 1 polygon with fewer than three different corners was dropped",
    )


def test_every_problem_is_in_one_report_in_the_order_of_the_lines(folder: Path) -> None:
    (folder / "bad.obj").write_text(CAR + "f 1 2 9\nf x\n")
    text = """ambient = true
scaling = "surfac"
mapping = "linea"
colour = 3
background = "#12"
[view]
eye = [0, 0]
direction = [0.0, 0, 0]
angl = 3
[[mesh]]
file = "bad.obj"
[[mesh]]
file = "../car.obj"
[[mesh]]
file = "none.obj"
crease_angle = 200
[[mesh]]
file = "car.shape"
up = "z"
[[mesh]]
nodes = "n.csv"
[surfaces.body]
exponent = -1
diffuse = "1.0"
two_side = true
[[lights]]
name = "key"
positon = [1, 2, 3]
intensity = inf
[[lights]]
name = "key"
position = [1, 2, 3]
direction = [0, 0, 0]
flaps.z = { minimum = 3, maximum = 2 }
[[lights]]
name = ""
position = [1, 2, 3]
concentration = -1
"""
    place = "scene.toml, line"
    assert refusal(folder, text) == [
        f"{place} 1, ambient must be a finite number of at least 0, not true",
        f"{place} 2, scaling must be 'surface' or 'object', not 'surfac'; did you mean 'surface'?",
        f"{place} 3, mapping must be {', '.join(map(repr, CURVES))}, or rising points [x, y] from"
        " x = 0 to x = 1, not 'linea'; did you mean 'linear'?",
        f"{place} 4, there is no field 'colour'; choose 'mesh', 'parts', 'surfaces', 'lights', 'view',"
        " 'ambient', 'scaling', 'mapping', 'contrast', 'exposure', 'dither', 'division', 'words',"
        " 'interpolation', 'background', 'front', 'views' or 'scalar'",
        f'{place} 5, background must be "#rrggbb", a name such as "red", or three whole numbers from 0 to'
        " 255, not '#12'; write three or six hexadecimal digits after the #",
        f"{place} 7, [view]: eye must be three finite numbers of at most 1e36, not [0, 0]",
        f"{place} 8, [view]: direction must have a length above 0, not [0.0, 0, 0]; change it",
        f"{place} 9, [view]: there is no field 'angl'; did you mean 'angle'?",
        "bad.obj, line 9: a corner must be a node number from 1 to 4 or from -4 to -1, not 9; correct it",
        "bad.obj, line 10: a corner must be a node number, alone or with texture and normal numbers as in"
        " 7/1/3, not 'x'; correct it",
        f"{place} 13, mesh[2]: file must be the name of a file in the scene's folder, not '../car.obj';"
        " copy the file there",
        f"{place} 15, mesh[3]: {folder / 'none.obj'}: there is no such file or folder; check the name",
        f"{place} 16, mesh[3]: crease_angle must be a number from 0 to 180, not 200",
        f"car.shape: a mesh file must {suffix_rule(Path('car.shape'), mesh_suffixes())};"
        " export it as one of these",
        f"{place} 20, mesh[5]: it must have a file, or nodes and polygons, not nodes; correct it",
        f"{place} 23, [surfaces.body]: exponent must be a finite number of at least 0, not -1",
        f"{place} 24, [surfaces.body]: diffuse must be a finite number of at least 0, not '1.0'",
        f"{place} 25, [surfaces.body]: there is no field 'two_side'; did you mean 'two_sided'?",
        f"{place} 26, lights[1] 'key': position must be three finite numbers of at most 1e36, not missing;"
        " add it",
        f"{place} 28, lights[1] 'key': there is no field 'positon'; did you mean 'position'?",
        f"{place} 29, lights[1] 'key': intensity must be a finite number of at least 0, not inf",
        f"{place} 31, lights[2] 'key': name must be unique, not the same as lights[1]; rename it",
        f"{place} 33, lights[2] 'key': direction must have a length above 0, not [0, 0, 0]; change it",
        f"{place} 34, lights[2] 'key': flaps.z: the minimum must be at most the maximum, not 3 to 2;"
        " exchange them",
        f"{place} 36, lights[3] '': name must be a string of at least one character, not ''",
        f"{place} 38, lights[3] '': concentration must be a finite number of at least 0, not -1",
    ]


def test_names_of_parts_and_surfaces_are_checked(folder: Path) -> None:
    text = MESH + '[parts.rof]\nsurface = "body"\n[parts.hood]\nsurface = "bodi"\n[surfaces.body]\n'
    assert refusal(folder, text) == [
        "scene.toml, line 3, [parts.rof]: no mesh has a part of this name; did you mean 'roof'?",
        "scene.toml, line 6, [parts.hood]: surface must be a surface, a part or a material of the"
        " scene, not 'bodi';"
        " did you mean 'body'?",
    ]


def test_rules_between_keys_are_checked(folder: Path) -> None:
    text = (
        "[view]\neye = [0, 0, 1]\ntarget = [0, 0, 1]\n"
        + MESH
        + '[[lights]]\nname = "a"\nposition = [0, 0, 0]\nconcentration = 2\n'
        + '[[lights]]\nname = "b"\nposition = [0, 0, 0]\naim = [1, 0, 0]\ndirection = [1, 0, 0]\n'
    )
    assert refusal(folder, text) == [
        "scene.toml, line 1, [view]: the target must differ from the eye, (0.0, 0.0, 1.0); move one of them",
        "scene.toml, line 9, lights[1] 'a': concentration must come with a direction or an aim, not with a"
        " point source; add an aim",
        "scene.toml, line 10, lights[2] 'b': it must have a direction or an aim, not both; leave one out",
    ]


@pytest.mark.parametrize(
    ("line", "growth"),
    [
        ("base_reflectance = 0.04", SpecularGrowth(base_reflectance=0.04)),
        ("refractive_index = 1.5", SpecularGrowth(refractive_index=1.5)),
        (
            "fresnel_curve = [[0, 0.04], [60, 0.1], [90, 1]]",
            SpecularGrowth(fresnel_curve=((0, 0.04), (60, 0.1), (90, 1))),
        ),
    ],
)
def test_s_grows_by_a_key_of_the_surface_with_the_models_that_have_no_fresnel_term(
    folder: Path, line: str, growth: SpecularGrowth
) -> None:
    assert read(folder, MESH + f"[surfaces.hood]\n{line}\n").scene.surface("hood").reflectance == (
        Reflectance(model=Phong(growth=growth))
    )
    blinn = read(folder, MESH + f'[surfaces.hood]\n{line}\nmodel = "blinn"\n').scene.surface("hood")
    assert blinn.reflectance.model == BlinnPhong(growth=growth)
    assert refusal(folder, MESH + f'[surfaces.hood]\n{line}\nmodel = "cook-torrance"\n') == [
        f"scene.toml, line 4, [surfaces.hood]: {line.partition(' ')[0]} must go with model = 'phong' or"
        " 'blinn', not with 'cook-torrance'; leave it out, or change the model"
    ]


def test_a_ramp_is_read_alone(folder: Path) -> None:
    text = MESH + '[surfaces.hood]\nramp = ["#200", "#f60", "#fff"]\n'
    ramp = read(folder, text).scene.surface("hood").paint.ramp
    assert ramp == ((34, 0, 0), (255, 102, 0), (255, 255, 255))
    line = "scene.toml, line 4, [surfaces.hood]: ramp"
    assert refusal(folder, text + "blend = 0.6\n") == [
        f"{line} must stand without object_color, light_color, blend and light_percentage, not beside them;"
        " leave out the ramp or these"
    ]
    assert refusal(folder, MESH + '[surfaces.hood]\nramp = ["#200"]\n') == [
        f"{line} must be a list of 2 to 1024 colors, not ['#200']; write them as in"
        ' ["#200", "#f60", "#fff"]'
    ]


def test_s_grows_in_one_way(folder: Path) -> None:
    text = MESH + "[surfaces.hood]\nrefractive_index = 1.5\nbase_reflectance = 0.04\n"
    assert refusal(folder, text) == [
        "scene.toml, line 4, [surfaces.hood]: refractive_index must stand without base_reflectance, not"
        " beside it; leave one out"
    ]


@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("ambient", '"0.1"'), ("ambient", "true"), ("ambient", "[1]"), ("ambient", "inf"), ("ambient", "nan"),
        ("ambient", "1979-05-27"), ("scaling", "1"), ("mapping", "1"), ("mapping", "[[0, 0]]"),
        ("mapping", '"Linear"'), ("background", "1"), ("background", '"#f0"'), ("view", "1"), ("view", "[]"),
        ("lights", "{}"), ("lights", "[1]"), ("lights", '"key"'), ("parts", "[]"), ("parts", "{hood = 1}"),
        ("surfaces", "1"), ("surfaces", "{hood = {levels = 2.0}}"), ("surfaces", "{hood = {two_sided = 1}}"),
        ("contrast", "'stretched'"), ("view", "{eye = [1, 2, 3]}"), ("surfaces", "{hood = {levels = true}}"),
        ("view", "{eye = [true, 2, 3], target = [0, 0, 0]}"), ("ambient", "-1"), ("surfaces", "{'' = {}}"),
        ("view", "{eye = [1e37, 2, 3], target = [0, 0, 0]}"), ("ambient", "0x" + "f" * 90),
    ],
)  # fmt: skip
def test_types_are_strict(folder: Path, key: str, value: str) -> None:
    if (key, value) == ("ambient", "0x" + "f" * 90):
        assert read(folder, f"{key} = {value}\n" + MESH).scene.ambient == float(int(value, 16))
        return
    problems = refusal(folder, f"{key} = {value}\n" + MESH)
    assert len(problems) == 1
    assert problems[0].startswith("scene.toml, line 1, ")


@pytest.mark.parametrize("text", ["", "ambient = 1\n", "mesh = []\n"])
def test_a_scene_must_have_a_mesh(folder: Path, text: str) -> None:
    assert refusal(folder, text) == [
        'scene.toml, there must be a [[mesh]] with file = "NAME.obj", not none; add one'
    ]


def test_only_missing_files_are_missing_input(folder: Path) -> None:
    text = '[[mesh]]\nfile = "a.obj"\n[[mesh]]\nfile = "b.obj"\n'
    with pytest.raises(MissingInputError) as caught:
        read(folder, text)
    assert len(caught.value.problems) == 2
    with pytest.raises(InputError) as other:
        read(folder, "ambient = -1\n" + text)
    assert other.type is InputError


def test_files_outside_the_folder_need_a_flag(folder: Path) -> None:
    (folder.parent / "car.obj").write_text(CAR)
    text = '[[mesh]]\nfile = "../car.obj"\n'
    assert len(refusal(folder, text)) == 1
    assert len(read(folder, text, outside=True).scene.parts) == 2


def test_a_thousand_problems_are_a_hundred_and_a_count(folder: Path) -> None:
    problems = refusal(folder, MESH + "".join(f"[parts.x{row}]\nsurface = 'y'\n" for row in range(1000)))
    assert len(problems) == 101
    assert problems[-1] == "scene.toml: there may be more problems; correct these first"


def test_of_many_unknown_keys_few_get_the_closest_key(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    compared: list[str] = []

    def compare(name: str, names: list[str], n: int) -> list[str]:
        compared.append(name)
        return []

    monkeypatch.setattr(difflib, "get_close_matches", compare)
    text = "".join(f"qq{number} = 1\n" for number in range(5000))
    assert len(refusal(folder, text + MESH)) == 101
    assert len(compared) == 100


def test_too_many_surfaces_are_refused(folder: Path) -> None:
    for count in (254, 255):
        scene = read(folder, MESH + "".join(f"[surfaces.x{row}]\n" for row in range(count))).scene
        assert len(scene.surfaces) >= count
    assert len(refusal(folder, MESH + "".join(f"[surfaces.x{row}]\n" for row in range(256)))) == 1
    assert refusal(folder, MESH + "".join(f"[surfaces.x{row}]\n" for row in range(300))) == [
        "scene.toml, line 3, surfaces must be at most 255, not 300; let parts share a surface"
    ]


def test_a_scene_file_of_more_than_a_mebibyte_is_refused(folder: Path) -> None:
    assert refusal(folder, MESH + "#" * (1 << 20)) == [
        "scene.toml: a file must have at most 1,048,576 bytes, not more; split or simplify it"
    ]


def test_windows_line_ends_and_a_byte_order_mark_are_no_matter(folder: Path) -> None:
    assert read(folder, b"\xef\xbb\xbf" + MESH.replace("\n", "\r\n").encode()).repairs == ()
    assert refusal(folder, b"\xef\xbb\xbf" + MESH.replace("\n", "\r\n").encode() + b"uq = 1\r\n") == [
        "scene.toml, line 3, mesh[1]: there is no field 'uq'; choose 'file', 'nodes', 'polygons', 'up',"
        " 'scale' or 'crease_angle'"
    ]


VALUES = st.sampled_from(
    [
        "1",
        "-1",
        "0.5",
        "true",
        '"x"',
        '"#102030"',
        "[]",
        "[1, 2, 3]",
        "{}",
        "inf",
        "[[0, 0], [1, 1]]",
        '"hood"',
    ]
)
KEYS = st.sampled_from(
    [
        "ambient",
        "mapping",
        "eye",
        "target",
        "name",
        "position",
        "aim",
        "flaps.z.minimum",
        "flaps.q",
        "surface",
        "diffuse",
        "levels",
        "object_color",
        "file",
        "up",
        "nodes",
        "x",
        "'a.b'",
        "lights",
        "view",
        "flaps",
    ]
)
HEADERS = st.sampled_from(
    ["[view]", "[[mesh]]", "[[lights]]", "[surfaces.hood]", "[parts.hood]", "[parts]", "[mesh]", "[a.b.c]"]
)
LINES = st.tuples(KEYS, VALUES).map(" = ".join) | HEADERS


@given(lines=st.lists(LINES, max_size=12), whole=st.booleans())
def test_any_keys_with_any_values_are_read_or_refused(
    lines: list[str], whole: bool, tmp_path_factory: pytest.TempPathFactory
) -> None:
    folder = tmp_path_factory.getbasetemp()
    (folder / "car.obj").write_text(CAR)
    try:
        read(folder, "\n".join(lines) + ("\n" + MESH if whole else ""))
    except InputError as error:
        problems = error.problems
    else:
        problems = ()
    assert len(set(problems)) == len(problems)


def test_a_part_of_the_stage_needs_no_surface_and_is_not_framed(folder: Path) -> None:
    (folder / "floor.obj").write_text("v -50 -50 0\nv 50 -50 0\nv 50 50 0\nv -50 50 0\no floor\nf 1 2 3 4\n")
    both = MESH + '[[mesh]]\nfile = "floor.obj"\n'
    alone, whole = read(folder, MESH).scene, read(folder, both).scene
    scene = read(folder, both + "[parts.floor]\nstage = true\n").scene
    assert [(part.name, part.surface, part.stage) for part in scene.parts] == [
        ("hood", "surface", False),
        ("roof", "surface", False),
        ("floor", "surface", True),
    ]
    assert (scene.view, scene.lights) == (alone.view, alone.lights)
    assert whole.view != alone.view


def test_stage_is_true_or_false(folder: Path) -> None:
    assert refusal(folder, MESH + "[parts.hood]\nstage = 1\n") == [
        "scene.toml, line 4, [parts.hood]: stage must be true or false, not 1"
    ]


MATERIALS = "mtllib car.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\ng hood\nusemtl red\nf 1 2 3\ng door\nf 1 2 3\n"


@pytest.mark.parametrize(
    ("tables", "surfaces", "names"),
    [
        ("", "materials", ["red", "red"]),
        ("", "parts", ["hood", "door"]),
        ("[surfaces.hood]\n", "materials", ["hood", "red"]),
        ("[surfaces.red]\n", "parts", ["hood", "door"]),
        ('[parts.hood]\nsurface = "red"\n', "parts", ["red", "door"]),
        ('[parts.hood]\nsurface = "body"\n[surfaces.body]\n', "materials", ["body", "red"]),
        ('[parts.hood]\nsurface = "door"\n', "materials", ["door", "red"]),
        ("[parts.hood]\nstage = true\n", "materials", ["red", "red"]),
    ],
)
def test_surfaces_come_from_the_file_and_then_from_the_materials_of_the_mesh(
    folder: Path, tables: str, surfaces: SurfaceSource, names: list[str]
) -> None:
    (folder / "car.obj").write_text(MATERIALS)
    (folder / "car.mtl").write_text("newmtl red\nKd 1 0 0\n")
    scene = read(folder, MESH + tables, surfaces=surfaces).scene
    assert [part.surface for part in scene.parts] == names
    if "red" in names and "surfaces.red" not in tables:
        assert scene.surface("red").paint.object_color == (255, 0, 0)


def test_a_surface_that_the_file_gives_counts_before_the_material_of_its_name(folder: Path) -> None:
    (folder / "car.obj").write_text(MATERIALS)
    (folder / "car.mtl").write_text("newmtl red\nKd 1 0 0\nKs 0\n")
    scene = read(folder, MESH + '[surfaces.red]\nobject_color = "#102030"\n').scene
    assert [surface.name for surface in scene.surfaces] == ["red"]
    assert scene.surface("red").paint.object_color == (16, 32, 48)
    assert scene.surface("red").reflectance == Reflectance()


def test_what_is_wrong_in_half_spaces_and_links_is_told_with_its_line(folder: Path) -> None:
    text = MESH + (
        '[[lights]]\nname = "key"\nposition = [0, 0, 1]\n'
        "half_spaces.left = { point = [0, 0, 0], direction = [1, 0, 0], edge = 1 }\n"
        "half_spaces.'my door' = { point = [0, 0], direction = [0, 0, 0] }\n"
        "half_spaces.new.point = [0, 0, 0]\n"
        "half_spaces.roof = 3\n"
        'half_spaces.top = { name = "floor", point = [0, 0, 0], direction = [1, 0, 0] }\n'
        'only_parts = "hood"\n'
        "[lights.half_spaces.below]\npoint = [0, 0, 0]\ndirection = [0, 0, 1]\nedge_width = -1\n"
    )
    key = "lights[1] 'key': half_spaces"
    first = text.splitlines().index("position = [0, 0, 1]") + 1
    lines = [
        "left: there is no field 'edge'; did you mean 'edge_width'?",
        "'my door'.point must be three finite numbers of at most 1e36, not [0, 0]",
        "'my door'.direction must have a length above 0, not [0, 0, 0]; change it",
        "new: direction must be three finite numbers of at most 1e36, not missing; add it",
        "roof must be a table of point, direction, edge_width, carried and on, not 3",
        "top.name must be the name of its table, 'top', not 'floor'; leave it out",
        "only_parts must be a list of names, not 'hood'",
        "below.edge_width must be a finite number of at least 0, not -1",
    ]
    places = [1, 2, 2, 3, 4, 5, 6, 10]
    expected = [
        f"scene.toml, line {first + at}, {key}.{told}" for at, told in zip(places, lines, strict=True)
    ]
    expected[6] = expected[6].replace("half_spaces.", "")
    assert refusal(folder, text) == expected


def test_a_list_of_half_spaces_is_refused_with_the_form_that_they_have(folder: Path) -> None:
    text = MESH + '[[lights]]\nname = "key"\nposition = [0, 0, 1]\n[[lights.half_spaces]]\nname = "left"\n'
    (told,) = refusal(folder, text)
    assert (
        "lights[1] 'key': half_spaces must be a table of half-spaces by name, not [{'name': 'left'}]" in told
    )


def test_names_that_no_table_has_are_refused_in_links(folder: Path) -> None:
    text = MESH + (
        '[[lights]]\nname = "key"\nposition = [0, 0, 1]\nonly_parts = ["hod"]\nexcept_surfaces = ["bdy"]\n'
        'follows = "rim"\n'
    )
    assert refusal(folder, text) == [
        "scene.toml, light 'key': follows 'rim' is not in the light table; choose 'eye' or 'key'",
        "scene.toml, light 'key': except_surfaces 'bdy' is not in the surface table; choose 'surface'",
        "scene.toml, light 'key': only_parts 'hod' is not in the part table; did you mean 'hood'?",
    ]
