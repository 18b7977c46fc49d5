from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from autocolor import Scene, render, write_picture
from autocolor.errors import InputError, MissingInputError, UsageError
from autocolor.files.formats import recognized
from autocolor.files.scene_files import kind_of
from autocolor.files.scene_sources import SCENE_FORMATS, read_scene, read_scene_with_report
from autocolor.files.scene_writing import write_scene
from autocolor.scene.columns import fields_of
from autocolor.scene.defaults import MAPPING_FIELDS
from tests.autocolor.files.store.stores import is_equal, small_scene, small_store
from tests.small import wall_scene

CAR = "v 0 0 0\nv 1 0 0\nv 1 1 3\nv 0 1 0\ng hood\nf 1 2 3 4\n"


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    made = tmp_path / "coupe"
    made.mkdir()
    (made / "car.obj").write_text(CAR)
    (made / "scene.toml").write_text('ambient = 0.5\n[[mesh]]\nfile = "car.obj"\n')
    return made


def test_a_scene_comes_from_a_folder_a_scene_file_or_a_mesh_file(folder: Path) -> None:
    assert read_scene(folder).ambient == 0.5
    assert read_scene(str(folder / "scene.toml")).name == "coupe"
    (folder / "night.TOML").write_text('[[mesh]]\nfile = "car.obj"\n')
    assert read_scene(folder / "night.TOML").name == "night"
    assert read_scene(folder / "car.obj").name == "car"


def test_a_folder_of_two_tables_is_a_scene(tmp_path: Path) -> None:
    (tmp_path / "nodes.csv").write_text("x,y,z\n0,0,0\n1,0,0\n0,1,0\n")
    (tmp_path / "polygons.csv").write_text("node1,node2,node3,node4\n1,2,3,\n")
    report = read_scene_with_report(tmp_path)
    assert len(report.scene.mesh.node_numbers) == 1
    assert report.mesh_files == ({"nodes": "nodes.csv", "polygons": "polygons.csv", "up": "z"},)


def test_up_is_the_up_axis_of_a_bare_mesh(folder: Path) -> None:
    assert read_scene(folder / "car.obj", up="y").mesh.coordinates[2].tolist() == [1, -3, 1]
    with pytest.raises(UsageError, match="up must be 'x', 'y' or 'z', not '-z'"):
        read_scene(folder, up="-z")


def test_scale_is_a_factor_for_the_coordinates_of_a_bare_mesh(folder: Path) -> None:
    report = read_scene_with_report(folder / "car.obj", up="y", scale=0.5)
    assert report.scene.mesh.coordinates[2].tolist() == [0.5, -1.5, 0.5]
    assert report.mesh_files == ({"file": "car.obj", "up": "y", "scale": 0.5},)


@pytest.mark.parametrize("scale", [0, -1, float("nan"), float("inf"), 1e31, "2", True, None, 10**400])
def test_a_scale_is_a_finite_number_above_zero(folder: Path, scale: Any) -> None:
    with pytest.raises(UsageError, match=r"^scale must be .*, not .*; give a factor such as 0\.001$"):
        read_scene(folder / "car.obj", scale=scale)


def test_a_scale_that_makes_coordinates_too_large_is_refused(folder: Path) -> None:
    with pytest.raises(InputError, match="coordinates must be finite and at most 1e30 in size"):
        read_scene(folder / "car.obj", scale=1e30)


def test_parts_beyond_the_surfaces_share_one_and_it_is_said(tmp_path: Path) -> None:
    path = tmp_path / "car.obj"
    path.write_text("v 0 0 0\nv 1 0 0\nv 1 1 3\n" + "".join(f"o p{part}\nf 1 2 3\n" for part in range(300)))
    report = read_scene_with_report(path, surfaces="parts")
    assert len(report.scene.surfaces) == 255
    assert report.created[-1] == "46 parts share surface 'p254', because a scene has at most 255"


def test_strict_reading_refuses_repairs(folder: Path) -> None:
    read_scene(folder, strict=True)
    (folder / "car.obj").write_text(CAR + "f 1 2\n")
    assert len(read_scene(folder).mesh.node_numbers) == 1
    with pytest.raises(InputError) as caught:
        read_scene(folder, strict=True)
    assert str(caught.value) == (
        "car.obj: 1 polygon with fewer than three different corners was dropped; correct the"
        " file, or read it without strict"
    )


def test_what_is_not_there_is_missing_input(tmp_path: Path) -> None:
    for name in ("none", "none.obj", "none.toml", "none.npz", "none/none.obj"):
        with pytest.raises(MissingInputError) as caught:
            read_scene(tmp_path / name)
        assert str(caught.value) == f"{tmp_path / name}: there is no such file or folder; check the name"


def test_what_is_no_scene_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="a scene's folder must contain"):
        read_scene(tmp_path)
    (tmp_path / "a.shape").write_text("solid")
    with pytest.raises(InputError, match=r"end in \.\w+, .* or \.\w+, not in '\.shape'"):
        read_scene(tmp_path / "a.shape")
    (tmp_path / "x.obj").mkdir()
    with pytest.raises(InputError, match="a scene's folder"):
        read_scene(tmp_path / "x.obj")
    os.mkfifo(tmp_path / "p.obj")
    os.mkfifo(tmp_path / "scene.toml")
    for name in ("p.obj", "scene.toml", ""):
        with pytest.raises(InputError, match="not a pipe"):
            read_scene(tmp_path / name)
    with pytest.raises(InputError, match="must be valid on this system"):
        read_scene(tmp_path / "a\0b")


def test_a_mesh_is_read_without_a_window_or_a_command(folder: Path) -> None:
    program = (
        "import sys, autocolor;"
        "assert not {'numpy', 'tomllib'} & set(sys.modules);"
        f"autocolor.read_scene({str(folder / 'car.obj')!r});"
        "assert not {'pygame', 'PIL', 'click'} & set(sys.modules)"
    )
    subprocess.run([sys.executable, "-c", program], check=True, env={**os.environ, "PYTHONPATH": os.getcwd()})


def test_an_up_axis_and_a_scale_go_with_a_mesh_alone(tmp_path: Path) -> None:
    (tmp_path / "square.obj").write_text("v 0 0 0\nv 1 0 0\nv 1 0 1\nf 1 2 3\n")
    (tmp_path / "scene.toml").write_text('[[mesh]]\nfile = "square.obj"\n')
    with pytest.raises(UsageError, match=r"up is for mesh files, not for .*scene\.toml, which gives"):
        read_scene(tmp_path, up="y")
    with pytest.raises(UsageError, match=r"scale is for mesh files, not for .*scene\.toml, which gives"):
        read_scene(tmp_path, scale=2)


def test_surfaces_are_those_of_materials_or_of_parts(folder: Path) -> None:
    (folder / "car.obj").write_text(CAR.replace("g hood\n", "g hood\nusemtl red\n"))
    for name in ("car.obj", "scene.toml", ""):
        assert [surface.name for surface in read_scene(folder / name).surfaces] == ["red"]
        assert [part.surface for part in read_scene(folder / name, surfaces="parts").parts] == ["hood"]
    wrong: Any = "part"
    with pytest.raises(UsageError, match="surfaces must be 'materials' or 'parts', not 'part'"):
        read_scene(folder, surfaces=wrong)


def test_a_scene_file_that_leaves_out_how_intensities_are_shown_means_the_defaults_of_a_scene(
    folder: Path,
) -> None:
    (folder / "scene.toml").write_text('[[mesh]]\nfile = "car.obj"\n')
    scene, bare = read_scene(folder), read_scene(folder / "car.obj")
    fields = fields_of(Scene)
    assert {name: vars(scene)[name] for name in MAPPING_FIELDS} == {
        name: default() for name in MAPPING_FIELDS if (default := fields[name].default) is not None
    }
    assert {name: vars(bare)[name] for name in MAPPING_FIELDS} == MAPPING_FIELDS


@pytest.mark.parametrize(
    ("name", "data", "found"),
    [
        ("night.TOML", b"", "scene file"),
        ("car.toml.npz", b"", "picture file"),
        ("saved", b"PK\x03\x04 and more", "picture file"),
        ("saved", b"PK\x05\x06", None),
        ("notes", b'[[mesh]]\nfile = "car.obj"\n', None),
        ("short", b"PK", None),
        ("tables.bin", b"SQLite format 3\0", "store"),
        ("toml", b"", None),
        (".toml", b"", None),
        ("car.toml.bak", b"", None),
    ],
)
def test_a_scene_is_known_by_its_suffix_or_its_first_bytes(
    tmp_path: Path, name: str, data: bytes, found: str | None
) -> None:
    (tmp_path / name).write_bytes(data)
    scene_format = recognized(tmp_path / name, SCENE_FORMATS)
    assert (scene_format.name if scene_format else None) == found


def test_a_picture_file_gives_the_scene_that_was_saved_and_needs_nothing_else(tmp_path: Path) -> None:
    scene, path = wall_scene(ambient=0.25, name="lit wall"), tmp_path / "wall.npz"
    write_picture(path, scene, render(scene, 6, 8))
    for outside in (False, True):
        report = read_scene_with_report(path, outside=outside)
        assert (report.repairs, report.created, report.mesh_files) == ((), (), ())
        assert (report.scene.name, report.scene.ambient) == ("lit wall", 0.25)
        assert (report.scene.surfaces, report.scene.lights) == (scene.surfaces, scene.lights)
        assert report.scene.view == scene.view
        assert report.scene.mesh.coordinates.tolist() == scene.mesh.coordinates.tolist()
    path.write_bytes(path.read_bytes()[:-1])
    with pytest.raises(InputError, match=r"^wall\.npz: a picture file must be whole"):
        read_scene(path)


@pytest.mark.parametrize("name", ["scene.sqlite", "scene.db", "SCENE.DB"])
def test_a_scene_is_written_to_a_store_and_read_from_it_by_its_name(tmp_path: Path, name: str) -> None:
    path = tmp_path / name
    write_scene(path, small_scene())
    assert is_equal(read_scene(path), small_scene())
    assert kind_of(path) == "store"


def test_a_store_of_another_name_is_read_and_gives_its_own_up_axis(tmp_path: Path) -> None:
    path = tmp_path / "tables.bin"
    shutil.copy(small_store(tmp_path), path)
    assert is_equal(read_scene(path), small_scene())
    with pytest.raises(UsageError, match="up is for mesh files"):
        read_scene(path, up="y")
