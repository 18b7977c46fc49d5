from __future__ import annotations

import tempfile
from pathlib import Path

import pytest

from autocolor import Reflectance
from autocolor.files.scene_report import SceneReport
from autocolor.files.scene_toml.scene_file import read_scene_file
from autocolor.scene.creation import SurfaceSource
from tests.tables import refused

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


def read_text(text: str | bytes) -> SceneReport:
    """The report of a scene file beside the mesh of a hood and a roof."""
    with tempfile.TemporaryDirectory() as made:
        (Path(made) / "car.obj").write_text(CAR)
        (Path(made) / "bad.obj").write_text("v 0 0\n")
        return read(Path(made), text)


def test_all_but_a_mesh_is_created(folder: Path) -> None:
    (folder / "car.obj").write_text(CAR + "f 1 1 1\n")
    report = read(folder, MESH)
    assert report.scene.name == "coupe"
    assert [(part.name, part.surface) for part in report.scene.parts] == [
        ("hood", "surface"),
        ("roof", "surface"),
    ]
    assert report.created == (
        "a view was created that frames the object",
        "4 studio lights were created",
        "surface 'surface' was created",
    )
    assert report.repairs == ("car.obj: 1 polygon with fewer than three different corners was dropped",)
    assert report.mesh_files == ({"file": "car.obj"},)
    assert (report.is_view_created, report.are_lights_created) == (True, True)


AT = "scene.toml, line"
VECTOR = "must be three finite numbers of at most 1e36, not"
LIGHT = MESH + '[[lights]]\nname = "key"\nposition = [0, 0, 1]\n'

test_what_is_refused = refused(
    read_text,
    [
        ("mesh = []\n", 'scene.toml, there must be a [[mesh]] with file = "NAME.obj", not none; add one'),
        ("mesh = 3\n", f"{AT} 1, mesh must be tables, each written [[mesh]], not 3"),
        ("parts = []\n" + MESH, f"{AT} 1, parts must be tables written [parts.NAME], not []"),
        # Every problem is in one report, in the order of the lines.
        (
            """ambient = true
[view]
eye = [0, 0]
target = [1, 0, 0]
[[mesh]]
file = "bad.obj"
[[mesh]]
file = "none.obj"
crease_angle = 200
[surfaces.body]
two_side = true
[[lights]]
name = "key"
[[lights]]
name = "key"
position = [1, 2, 3]
flaps.z = { minimum = 3, maximum = 2 }
[lights.half_spaces.'my door']
point = [0, 0]
direction = [0, 0, 1]
""",
            f"{AT} 1, ambient must be a finite number of at least 0, not true\n"
            f"{AT} 3, view.eye {VECTOR} [0, 0]\n"
            "bad.obj, line 1: a node must have three coordinates x y z, not 2; add what is missing\n"
            f"{AT} 9, mesh[2]: crease_angle must be a number from 0 to 180, not 200\n"
            f"{AT} 11, [surfaces.body]: there is no field 'two_side'; did you mean 'two_sided'?\n"
            f"{AT} 12, lights[1] 'key': position {VECTOR} missing; add it\n"
            f"{AT} 15, lights[2] 'key': name must be unique, not the same as lights[1]; rename it\n"
            f"{AT} 17, lights[2] 'key': flaps.z: the minimum must be at most the maximum, not 3 to 2;"
            " exchange them\n"
            f"{AT} 19, lights[2] 'key': half_spaces.'my door'.point {VECTOR} [0, 0]",
        ),
        (
            "parts = {hood = 1}\n" + MESH,
            f"{AT} 1, [parts.hood]: it must be a table, not 1; write keys and values",
        ),
        (MESH + "[parts.rof]\n", "scene.toml, there is no part 'rof'; did you mean 'roof'?"),
        (
            MESH + '[parts.hood]\nsurface = "bodi"\n[surfaces.body]\n',
            "scene.toml, part 'hood': surface 'bodi' is not in the surface table; did you mean 'body'?",
        ),
        (
            MESH + '[parts.roof]\nname = "roof"\n',
            f"{AT} 4, [parts.roof]: there is no field 'name'; choose 'surface' or 'stage'",
        ),
        (
            LIGHT + 'follows = "rim"\nonly_parts = ["hod"]\n',
            "scene.toml, light 'key': follows 'rim' is not in the light table; choose 'eye' or 'key'\n"
            "scene.toml, light 'key': only_parts 'hod' is not in the part table; did you mean 'hood'?",
        ),
        (
            MESH + "#" * (1 << 20),
            "scene.toml: a file must have at most 1,048,576 bytes, not more; split or simplify it",
        ),
        (
            b"\xef\xbb\xbf" + MESH.replace("\n", "\r\n").encode() + b"uq = 1\r\n",
            f"{AT} 3, mesh[1]: there is no field 'uq'; choose 'file', 'nodes', 'polygons', 'up', 'scale',"
            " 'normals' or 'crease_angle'",
        ),
    ],
)


@pytest.mark.parametrize(
    ("tables", "surfaces", "names"),
    [
        ("", "materials", ["red", "red"]),
        ("", "parts", ["hood", "door"]),
        ('[parts.hood]\nsurface = "body"\n[surfaces.body]\n', "materials", ["body", "red"]),
        ('[surfaces.red]\nobject_color = "#102030"\n', "materials", ["red", "red"]),
    ],
)
def test_surfaces_come_from_the_file_and_then_from_the_materials_of_the_mesh(
    folder: Path, tables: str, surfaces: SurfaceSource, names: list[str]
) -> None:
    (folder / "car.obj").write_text(
        "mtllib car.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\ng hood\nusemtl red\nf 1 2 3\ng door\nf 1 2 3\n"
    )
    (folder / "car.mtl").write_text("newmtl red\nKd 1 0 0\nKs 0\n")
    scene = read(folder, MESH + tables, surfaces=surfaces).scene
    assert [part.surface for part in scene.parts] == names
    if "red" in names:
        red = scene.surfaces["red"]
        assert red.paint.object_color == ((16, 32, 48) if "surfaces.red" in tables else (255, 0, 0))
        assert (red.reflectance == Reflectance()) == ("surfaces.red" in tables)
