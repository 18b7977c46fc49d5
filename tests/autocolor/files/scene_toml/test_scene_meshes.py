from __future__ import annotations

import dataclasses
import gc
import os
import shutil
import tomllib
import weakref
from pathlib import Path

import numpy as np
import pytest

from autocolor import Mesh, OutputError, read_scene, render, write_picture
from autocolor.budget import MEMORY, allowing
from autocolor.errors import InputError
from autocolor.files.meshes.repair import MeshReport
from autocolor.files.scene_toml import scene_meshes
from autocolor.files.scene_toml.scene_meshes import (
    GROWTH,
    MeshSource,
    entries_of,
    keep_source,
    mesh_file,
    meshes_of,
    meshes_there,
    reports_of,
    source_of,
    written_mesh,
)
from autocolor.files.scene_toml.toml_text import SceneProblems
from autocolor.scene.scalar import MeshScalar
from tests.small import cube

CAR = "v 0 0 0\nv 1 0 0\nv 1 1 2\nv 0 1 0\ng hood\nf 1 2 3 4\n"
MESH = '[[mesh]]\nfile = "car.obj"\n'


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A scene's folder with car.obj, and the node table and the polygon table of a door."""
    made = tmp_path / "coupe"
    made.mkdir()
    (made / "car.obj").write_text(CAR)
    (made / "n.csv").write_text("x,y,z\n0,0,0\n1,0,0\n0,1,0\n")
    (made / "p.csv").write_text("part,node1,node2,node3,node4\ndoor,1,2,3,\n")
    return made


def read(folder: Path, text: str, outside: bool = False) -> tuple[list[MeshReport], SceneProblems]:
    """The meshes of the `[[mesh]]` of a scene file, and the problems noted."""
    document = tomllib.loads(text)
    problems = SceneProblems("scene.toml", text.encode(), document)
    return meshes_of(problems, document["mesh"], folder, outside=outside), problems


def refusal(folder: Path, text: str, outside: bool = False) -> list[str]:
    _, problems = read(folder, text, outside)
    with pytest.raises(InputError) as caught:
        problems.raise_any()
    return list(caught.value.problems)


def test_each_mesh_is_read_from_one_file_or_from_two_tables(folder: Path) -> None:
    reports, problems = read(folder, MESH + '[[mesh]]\nnodes = "n.csv"\npolygons = "p.csv"\n')
    problems.raise_any()
    assert [report.mesh.part_names for report in reports] == [("hood",), ("door",)]


def test_the_up_axis_is_of_each_mesh_and_the_crease_angle_of_all(folder: Path) -> None:
    reports, problems = read(folder, MESH + 'up = "y"\n' + MESH + "crease_angle = 60\n")
    problems.raise_any()
    assert [report.mesh.coordinates[2].tolist() for report in reports] == [[1, -2, 1], [1, 1, 2]]
    assert [report.mesh.crease_angle for report in reports] == [60, 60]


def test_equal_crease_angles_are_one_and_without_any_the_usual_one_is_taken(folder: Path) -> None:
    angle = "crease_angle = 60.0\n"
    reports, problems = read(folder, MESH + angle + MESH + angle)
    problems.raise_any()
    assert [report.mesh.crease_angle for report in reports] == [60, 60]
    reports, problems = read(folder, MESH)
    assert [report.mesh.crease_angle for report in reports] == [40]


@pytest.mark.parametrize(
    ("keys", "given"),
    [
        ("", "none of them"),
        ('nodes = "n.csv"\n', "nodes"),
        ('polygons = "p.csv"\n', "polygons"),
        ('file = "car.obj"\nnodes = "n.csv"\n', "file and nodes"),
        ('file = "car.obj"\nnodes = "n.csv"\npolygons = "p.csv"\n', "file and nodes and polygons"),
    ],
)
def test_a_mesh_has_a_file_or_two_tables_and_nothing_else(folder: Path, keys: str, given: str) -> None:
    assert refusal(folder, "[[mesh]]\n" + keys) == [
        f"scene.toml, line 1, mesh[1]: it must have a file, or nodes and polygons, not {given}; correct it"
    ]


def test_a_wrong_key_does_not_keep_the_file_from_being_read(folder: Path) -> None:
    (folder / "car.obj").write_text("v 0 0\n")
    assert refusal(folder, MESH + 'up = "w"\ncolor = 3\n') == [
        "car.obj, line 1: a node must have three coordinates x y z, not 2; add what is missing",
        "scene.toml, line 3, mesh[1]: up must be 'x', 'y' or 'z', not 'w'",
        "scene.toml, line 4, mesh[1]: there is no field 'color'; choose 'file', 'nodes', 'polygons', 'up',"
        " 'scale' or 'crease_angle'",
    ]


@pytest.mark.parametrize("rows", ["mesh = [1]\n", 'mesh = ["car.obj"]\n', "mesh = [[]]\n"])
def test_a_mesh_that_is_no_table_is_refused(folder: Path, rows: str) -> None:
    (sentence,) = refusal(folder, rows)
    assert sentence.startswith(
        "scene.toml, line 1, mesh[1]: must be a table of file, nodes, polygons, up, scale and"
    )


@pytest.mark.parametrize(
    "name",
    ["../car.obj", "/etc/passwd", "a\\\\b.obj", "file:car.obj", "http://x/car.obj", "link.obj", "a\\nb"],
)
def test_no_file_outside_the_folder_is_opened(folder: Path, name: str) -> None:
    (folder.parent / "car.obj").write_text(CAR)
    (folder / "link.obj").symlink_to(folder.parent / "car.obj")
    (sentence,) = refusal(folder, f'[[mesh]]\nfile = "{name}"\n')
    assert sentence.startswith("scene.toml, line 2, mesh[1]: file must ")


def test_a_file_outside_is_read_where_that_is_allowed(folder: Path) -> None:
    (folder.parent / "car.obj").write_text(CAR)
    reports, problems = read(folder, '[[mesh]]\nfile = "../car.obj"\n', outside=True)
    problems.raise_any()
    assert len(reports) == 1


def test_what_is_no_file_is_refused_without_waiting(folder: Path) -> None:
    os.mkfifo(folder / "pipe.obj")
    (folder / "folder.obj").mkdir()
    sentences = refusal(folder, '[[mesh]]\nfile = "pipe.obj"\n[[mesh]]\nfile = "folder.obj"\n')
    assert [sentence.rpartition(", not ")[2] for sentence in sentences] == [
        "a pipe; name a file",
        "a folder; name a file",
    ]


def test_all_meshes_together_have_a_bound_before_any_is_read(folder: Path) -> None:
    with allowing((2 * GROWTH * len(CAR) + 0.5) / MEMORY):
        assert len(read(folder, MESH * 2)[0]) == 2
        (sentence,) = refusal(folder, MESH * 3)
    assert sentence.startswith("scene.toml, line 1, mesh: the mesh files together must take at most 0.0 MB ")


def test_only_what_leads_to_the_mesh_is_kept_of_its_table() -> None:
    assert mesh_file({"file": "car.obj", "up": "y", "crease_angle": 60}) == {"file": "car.obj", "up": "y"}
    assert mesh_file({"polygons": "p.csv", "nodes": "n.csv"}) == {"nodes": "n.csv", "polygons": "p.csv"}


def test_differing_crease_angles_are_refused(folder: Path) -> None:
    assert refusal(folder, MESH + "crease_angle = 40\n" + MESH + "crease_angle = 50\n") == [
        "scene.toml, line 6, mesh[2]: crease_angle must be the same in all meshes, 40 as before, not 50;"
        " give one of them"
    ]


def test_too_many_meshes_are_refused(folder: Path) -> None:
    assert refusal(folder, MESH * 1001) == [
        "scene.toml, line 1, mesh must have at most 1,000 tables, not 1,001; join some"
    ]


CAR_2 = "v 0 0 0\nv 1 0 0\nv 1 1 0.1\nv 0 1 0\nf 1 2 3 4\n"


@pytest.fixture
def folder_2(tmp_path: Path) -> Path:
    (tmp_path / "car.obj").write_text(CAR_2)
    (tmp_path / "scene.toml").write_text('[[mesh]]\nfile = "car.obj"\nup = "y"\n')
    return tmp_path


def test_a_mesh_is_from_the_files_that_it_was_read_from(folder_2: Path) -> None:
    entry = {"file": "car.obj", "up": "y"}
    assert source_of(read_scene(folder_2).mesh) == MeshSource(folder_2, (entry,), folder_2 / "scene.toml")
    bare = source_of(read_scene(folder_2 / "car.obj", up="y").mesh)
    assert bare == MeshSource(folder_2, (entry,), None)


def test_a_folder_of_tables_is_the_place_of_its_files(tmp_path: Path) -> None:
    (tmp_path / "nodes.csv").write_text("x,y,z\n0,0,0\n1,0,0\n1,1,0\n")
    (tmp_path / "polygons.csv").write_text("node1,node2,node3,node4\n1,2,3,\n")
    source = source_of(read_scene(tmp_path).mesh)
    assert source is not None
    assert source.folder == tmp_path
    assert source.entries == ({"nodes": "nodes.csv", "polygons": "polygons.csv", "up": "z"},)


def test_an_edit_of_the_scene_keeps_it_and_a_new_mesh_has_none(folder_2: Path) -> None:
    scene = read_scene(folder_2)
    assert source_of(scene.replace(ambient=0.5).mesh) == source_of(scene.mesh) is not None
    assert source_of(dataclasses.replace(scene.mesh)) is None
    assert source_of(cube()) is None


def test_the_mesh_of_a_picture_file_has_none(folder_2: Path) -> None:
    scene = read_scene(folder_2)
    write_picture(folder_2 / "car.npz", scene, render(scene, 12, 16))
    assert source_of(read_scene(folder_2 / "car.npz").mesh) is None


def test_a_relative_path_is_not_lost_when_the_process_goes_elsewhere(
    folder_2: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(folder_2)
    source = source_of(read_scene("car.obj").mesh)
    assert source is not None
    assert source.folder == folder_2


def test_it_is_forgotten_with_the_mesh(folder_2: Path) -> None:
    mesh = cube()
    source = MeshSource(folder_2, ())
    keep_source(mesh, source)
    kept = weakref.ref(source)
    del source, mesh
    gc.collect()
    assert kept() is None
    shutil.rmtree(folder_2)


QUAD = "v 0 0 0\nv 1 0 0\nv 1 1 0.1\nv 0 1 0\nf 1 2 3 4\n"


def test_a_mesh_is_written_as_obj_where_that_holds_it(tmp_path: Path) -> None:
    written: list[Path] = []
    meshes = written_mesh(tmp_path, cube(), written)
    assert meshes.entries == ({"file": "mesh.obj"},)
    assert written == [tmp_path / "mesh.obj"]
    assert meshes.reports[0].mesh.part_names == ("cube",)


@pytest.mark.parametrize(
    "mesh",
    [
        Mesh(np.eye(3), np.array([[0, 1, 2], [0, 1, 1]]), np.zeros(2, np.intp), ("a",)),
        Mesh(np.eye(3), np.array([[0, 1, 2]]), np.zeros(1, np.intp), ("a", "unused")),
        Mesh(np.eye(3), np.array([[0, 1, 2], [0, 2, 1]]), np.array([1, 0]), ("a", "b")),
        Mesh(np.eye(3), np.array([[0, 1, 2]]), np.zeros(1, np.intp), ("a\nb",)),
        Mesh(np.empty((0, 3)), np.empty((0, 4), np.intp), np.empty(0, np.intp), ()),
    ],
    ids=["no area", "unused part", "order of parts", "name", "empty"],
)
def test_what_obj_does_not_hold_is_written_as_arrays(tmp_path: Path, mesh: Mesh) -> None:
    written: list[Path] = []
    meshes = written_mesh(tmp_path, mesh, written)
    assert meshes.entries == ({"file": "mesh.tables"},)
    assert list(tmp_path.iterdir()) == written == [tmp_path / "mesh.tables"]
    assert np.array_equal(meshes.reports[0].mesh.node_numbers, mesh.node_numbers)


def test_a_mesh_with_scalars_is_written_as_arrays_and_is_there_again(tmp_path: Path) -> None:
    mesh = cube().with_scalars(MeshScalar("stress", np.array([np.nan, *range(7)])))
    written: list[Path] = []
    meshes = written_mesh(tmp_path, mesh, written)
    assert meshes.entries == ({"file": "mesh.tables"},)
    assert np.array_equal(meshes.reports[0].mesh.scalars[0].values, mesh.scalars[0].values, equal_nan=True)
    text = b'[[mesh]]\nfile = "mesh.tables"\n'
    assert meshes_there(tmp_path, mesh, text) is not None
    for other in (
        cube(),
        cube().with_scalars(MeshScalar("strain", mesh.scalars[0].values)),
        cube().with_scalars(MeshScalar("stress", np.arange(8.0))),
        cube().with_scalars(MeshScalar("stress", np.arange(6.0), "polygon")),
    ):
        assert meshes_there(tmp_path, other, text) is None


def test_a_mesh_that_no_format_holds_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(scene_meshes, "has_same_tables", lambda *_: False)
    written: list[Path] = []
    with pytest.raises(OutputError, match=r"one of 6 polygons is too large; leave parts out"):
        written_mesh(tmp_path, cube(), written)
    assert list(tmp_path.iterdir()) == written == []


def test_the_files_that_a_scene_file_names_come_first(tmp_path: Path) -> None:
    (tmp_path / "car.obj").write_text(QUAD)
    (tmp_path / "copy.obj").write_text(QUAD.replace("f", "o car\nf"))
    mesh = read_scene(tmp_path / "car.obj").mesh
    text = b'[[mesh]]\nfile = "copy.obj"\ncrease_angle = 3\n'
    found = meshes_there(tmp_path, mesh, text)
    assert found is not None
    assert found.entries == ({"file": "copy.obj", "crease_angle": 3},)
    found = meshes_there(tmp_path, mesh, None)
    assert found is not None
    assert found.entries == ({"file": "car.obj", "up": "z"},)


def test_a_file_is_named_with_the_up_axis_and_the_scale_that_it_was_read_with(tmp_path: Path) -> None:
    (tmp_path / "deeper").mkdir()
    (tmp_path / "deeper" / "car.obj").write_text(QUAD)
    mesh = read_scene(tmp_path / "deeper" / "car.obj", up="y", scale=0.25).mesh
    found = meshes_there(tmp_path, mesh, None)
    assert found is not None
    assert found.entries == ({"file": "deeper/car.obj", "up": "y", "scale": 0.25},)


def test_files_that_hold_another_mesh_or_none_are_left_alone(tmp_path: Path) -> None:
    (tmp_path / "car.obj").write_text(QUAD)
    mesh = read_scene(tmp_path / "car.obj").mesh
    moved = dataclasses.replace(mesh, coordinates=mesh.coordinates + 1)
    assert meshes_there(tmp_path, moved, b'[[mesh]]\nfile = "car.obj"\n') is None
    (tmp_path / "car.obj").unlink()
    assert meshes_there(tmp_path, mesh, b'[[mesh]]\nfile = "car.obj"\n') is None


def test_a_link_out_of_the_folder_is_not_followed(tmp_path: Path) -> None:
    (tmp_path / "car.obj").write_text(QUAD)
    (tmp_path / "scene").mkdir()
    (tmp_path / "scene" / "car.obj").symlink_to(tmp_path / "car.obj")
    mesh = read_scene(tmp_path / "scene" / "car.obj").mesh
    assert meshes_there(tmp_path / "scene", mesh, None) is None


@pytest.mark.parametrize("text", ["", "mesh = 3\n", "mesh = []\n"])
def test_a_text_may_name_no_mesh(text: str) -> None:
    assert entries_of(text.encode()) == ()


@pytest.mark.parametrize("entry", [{}, {"file": 3}, {"file": "no.obj"}, {"file": "../car.obj"}, {"up": "z"}])
def test_nothing_is_read_of_tables_with_problems(tmp_path: Path, entry: dict[str, object]) -> None:
    assert reports_of(tmp_path, (entry,)) == []
