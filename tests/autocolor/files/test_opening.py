from __future__ import annotations

import os
import shutil
from functools import partial
from pathlib import Path
from typing import Any

import pytest

from autocolor.errors import InputError, UsageError
from autocolor.files.opening import (
    TWO_TABLES,
    kind_of,
    openables_of,
    read_scene,
    read_scene_with_report,
    stays_within,
)
from tests.autocolor.files.refusals import refusal
from tests.autocolor.files.store.stores import is_equal, small_scene, small_store
from tests.tables import call, refused

CAR = "v 0 0 0\nv 1 0 0\nv 1 1 3\nv 0 1 0\ng hood\nf 1 2 3 4\n"


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    made = tmp_path / "coupe"
    made.mkdir()
    (made / "car.obj").write_text(CAR)
    (made / "scene.toml").write_text('ambient = 0.5\n[[mesh]]\nfile = "car.obj"\n')
    return made


def test_a_scene_comes_from_a_folder_a_scene_file_a_mesh_file_or_two_tables(folder: Path) -> None:
    assert read_scene(folder).ambient == 0.5
    assert read_scene(str(folder / "scene.toml")).name == "coupe"
    (folder / "night.TOML").write_text('[[mesh]]\nfile = "car.obj"\n')
    assert read_scene(folder / "night.TOML").name == "night"
    assert read_scene(folder / "car.obj").name == "car"
    (folder / "scene.toml").unlink()
    (folder / "nodes.csv").write_text("x,y,z\n0,0,0\n1,0,0\n0,1,0\n")
    (folder / "polygons.csv").write_text("node1,node2,node3,node4\n1,2,3,\n")
    report = read_scene_with_report(folder)
    assert (len(report.scene.mesh.node_numbers), report.scene.name) == (1, "coupe")
    assert report.mesh_files == ({"nodes": "nodes.csv", "polygons": "polygons.csv", "up": "z"},)


def test_up_and_scale_are_of_the_coordinates_of_a_bare_mesh(folder: Path) -> None:
    assert read_scene(folder / "car.obj", up="y").mesh.coordinates[2].tolist() == [1, -3, 1]
    report = read_scene_with_report(folder / "car.obj", up="y", scale=0.5)
    assert report.scene.mesh.coordinates[2].tolist() == [0.5, -1.5, 0.5]
    assert report.mesh_files == ({"file": "car.obj", "up": "y", "scale": 0.5},)
    with pytest.raises(InputError, match="coordinates must be finite and at most 1e30 in size"):
        read_scene(folder / "car.obj", scale=1e30)


WRONG: Any = "part"
SCALE = "scale must be a number above 0 and at most 1e+30, not 0; choose another"

test_options_that_cannot_be_are_refused = refused(
    call,
    [
        (lambda: read_scene("a", up="-z"), "up must be 'x', 'y' or 'z', not '-z'; choose another"),
        (lambda: read_scene("a", scale=0), SCALE),
        (
            lambda: read_scene("a", surfaces=WRONG),
            "surfaces must be 'materials' or 'parts', not 'part'; choose another",
        ),
    ],
)


def test_an_up_axis_and_a_scale_go_with_a_mesh_alone(tmp_path: Path) -> None:
    path = shutil.copy(small_store(tmp_path), tmp_path / "tables.bin")
    for name, value in (("up", "y"), ("scale", 2)):
        with pytest.raises(UsageError, match=rf"^{name} is for mesh files, not for .*; leave it out$"):
            read_scene(path, **{name: value})  # type: ignore[arg-type]
    assert is_equal(read_scene(path), small_scene())


def test_strict_reading_refuses_repairs(folder: Path) -> None:
    read_scene(folder, strict=True)
    (folder / "car.obj").write_text(CAR + "f 1 2\n")
    assert len(read_scene(folder).mesh.node_numbers) == 1
    assert refusal(partial(read_scene, strict=True), folder) == (
        "car.obj: 1 polygon with fewer than three different corners was dropped; correct the"
        " file, or read it without strict"
    )


def test_what_is_no_scene_is_refused(tmp_path: Path) -> None:
    for name in ("none", "none.toml", "none/none.obj"):
        sentence = f"{tmp_path / name}: there is no such file or folder; check the name"
        assert refusal(read_scene, tmp_path / name) == sentence
    assert refusal(read_scene, tmp_path) == (
        f"{tmp_path}: a scene's folder must contain a scene.toml or nodes.csv and polygons.csv or nodes.npy"
        " and polygons.npy, and this one does not; name a mesh file to read it alone"
    )
    (tmp_path / "a.shape").write_text("solid")
    assert "must be a folder, or end in .3mf, " in refusal(read_scene, tmp_path / "a.shape")
    (tmp_path / "n.csv").touch()
    assert refusal(read_scene, tmp_path / "n.csv") == (
        f"{tmp_path / 'n.csv'}: a mesh must have a table of nodes and a table of polygons, not one of the"
        f" two; {TWO_TABLES}"
    )
    os.mkfifo(tmp_path / "scene.toml")
    assert "not a pipe" in refusal(read_scene, tmp_path)


def test_what_can_be_opened_is_listed_in_natural_order_with_folders_last(tmp_path: Path) -> None:
    texts = {
        "both.toml": 'minimum = [0, 0, 0]\n[[mesh]]\nfile = "car.obj"',
        "broken.toml": "minimum = [",
        "lights.toml": "minimum = [0, 0, 0]",
        "other.toml": "ambient = 0.5",
    }
    files = "car10.obj car2.obj Car3.OBJ notes.txt .hidden.obj a.npz a.db b.GPL d.csv"
    for name in (*files.split(), *texts):
        (tmp_path / name).write_text(texts.get(name, ""))
    for name in ("b", "a scene", "a mesh", ".git"):
        (tmp_path / name).mkdir()
    (tmp_path / "a scene" / "scene.toml").write_text("")
    for name in ("nodes.csv", "polygons.csv"):
        (tmp_path / "a mesh" / name).write_text("")
    assert [(path.name, kind) for path, kind in openables_of(tmp_path)] == [
        ("a mesh", "mesh"),
        ("a scene", "scene"),
        ("a.db", "store"),
        ("a.npz", "picture"),
        ("b.GPL", "paints"),
        ("both.toml", "scene"),
        ("broken.toml", "scene"),
        ("car2.obj", "mesh"),
        ("Car3.OBJ", "mesh"),
        ("car10.obj", "mesh"),
        ("lights.toml", "rig"),
        ("b", "folder"),
    ]


def test_what_is_no_folder_or_regular_file_cannot_be_opened(tmp_path: Path) -> None:
    (tmp_path / "broken.obj").symlink_to(tmp_path / "gone.obj")
    os.mkfifo(tmp_path / "pipe.obj")
    assert kind_of(tmp_path / ("long" * 100 + ".obj")) == ""
    assert openables_of(tmp_path) == []
    assert refusal(openables_of, tmp_path / "pipe.obj").startswith(
        "pipe.obj: a folder must be readable, and is not ("
    )


def test_links_are_followed_before_a_path_is_within_a_folder(tmp_path: Path) -> None:
    inside, outside = tmp_path / "inside", tmp_path / "outside"
    for folder in (inside / "a", inside / "scene", inside / "mesh", outside):
        folder.mkdir(parents=True)
    for name in ("car.obj", "scene.toml", "nodes.csv", "polygons.csv"):
        (outside / name).touch()
    for name in ("car.obj", "scene/scene.toml", "mesh/nodes.csv", "mesh/polygons.csv"):
        (inside / name).symlink_to(outside / Path(name).name)
    (inside / "to a").symlink_to(inside / "a")
    for path in (".", "to a", "a/../a"):
        assert stays_within(inside / path, inside), path
    # A folder is not within if its scene file or a table is a link to outside.
    for path in ("car.obj", "..", "a/../..", "scene", "mesh"):
        assert not stays_within(inside / path, inside), path
