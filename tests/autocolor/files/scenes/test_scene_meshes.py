from __future__ import annotations

import os
import tomllib
from pathlib import Path

import pytest

from autocolor.errors import InputError
from autocolor.files.repair.polygons import MeshReport
from autocolor.files.scenes import scene_meshes
from autocolor.files.scenes.problems import SceneProblems
from autocolor.files.scenes.scene_meshes import mesh_file, meshes_of

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
        "scene.toml, line 4, mesh[1]: there is no 'color'; known are 'file', 'nodes', 'polygons', 'up',"
        " 'scale', 'crease_angle'",
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


def test_all_meshes_together_have_a_bound_before_any_is_read(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    size = len(CAR)
    monkeypatch.setattr(scene_meshes, "LARGEST_MESH_FILE", 2 * size)
    assert len(read(folder, MESH * 2)[0]) == 2
    assert refusal(folder, MESH * 3) == [
        f"scene.toml, line 1, mesh: the mesh files must have at most {2 * size:,} bytes together,"
        f" not {3 * size:,}; thin them out"
    ]


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
