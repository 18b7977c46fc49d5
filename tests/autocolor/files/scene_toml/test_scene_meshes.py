from __future__ import annotations

import dataclasses
import tempfile
import tomllib
from pathlib import Path

import numpy as np
import pytest

from autocolor import Mesh, read_scene, render, write_picture
from autocolor.errors import InputError
from autocolor.files.scene_toml.scene_meshes import SOURCES, MeshSource, meshes_of, meshes_there, written_mesh
from autocolor.files.scene_toml.toml_text import SceneProblems
from tests.small import cube
from tests.tables import refused

CAR = "v 0 0 0\nv 1 0 0\nv 1 1 2\nv 0 1 0\ng hood\nf 1 2 3 4\n"
MESH = '[[mesh]]\nfile = "car.obj"\n'


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A scene's folder with car.obj, and the node table and the polygon table of a door."""
    made = tmp_path / "coupe"
    made.mkdir()
    (made / "car.obj").write_text(CAR)
    (made / "scene.toml").write_text(MESH + 'up = "y"\n')
    (made / "n.csv").write_text("x,y,z\n0,0,0\n1,0,0\n0,1,0\n")
    (made / "p.csv").write_text("part,node1,node2,node3,node4\ndoor,1,2,3,\n")
    return made


def read(folder: Path, text: str, outside: bool = False) -> list[Mesh]:
    """The meshes of the `[[mesh]]` of a scene file."""
    document = tomllib.loads(text)
    problems = SceneProblems("scene.toml", text.encode(), document)
    reports = meshes_of(problems, document["mesh"], folder, outside=outside)
    problems.raise_any()
    return [report.mesh for report in reports]


def refusal(folder: Path, text: str) -> list[str]:
    with pytest.raises(InputError) as caught:
        read(folder, text)
    return list(caught.value.problems)


def test_each_mesh_has_its_up_axis_and_all_have_one_crease_angle(folder: Path) -> None:
    tables = '[[mesh]]\nnodes = "n.csv"\npolygons = "p.csv"\n'
    meshes = read(
        folder, MESH + 'up = "y"\n' + MESH + "crease_angle = 60\n" + tables + "crease_angle = 60.0\n"
    )
    assert [mesh.part_names for mesh in meshes] == [("hood",), ("hood",), ("door",)]
    assert [mesh.coordinates[2].tolist() for mesh in meshes] == [[1, -2, 1], [1, 1, 2], [0, 1, 0]]
    assert [mesh.crease_angle for mesh in meshes] == [60, 60, 60]
    assert [mesh.crease_angle for mesh in read(folder, MESH)] == [40]
    assert refusal(folder, MESH + "crease_angle = 40\n" + MESH + "crease_angle = 50\n") == [
        "scene.toml, line 6, mesh[2]: crease_angle must be the same in all meshes, 40 as before, not 50;"
        " give one of them"
    ]


def refuse_text(text: str) -> None:
    """Raise the problems of the `[[mesh]]` of a scene file in an empty folder."""
    with tempfile.TemporaryDirectory() as empty:
        read(Path(empty), text)


NEEDS = "scene.toml, line 1, mesh[1]: it must have a file, or nodes and polygons, not"

test_what_is_refused = refused(
    refuse_text,
    [
        ('[[mesh]]\nnodes = "n.csv"\n', f"{NEEDS} nodes; correct it"),
        (
            MESH + 'nodes = "n.csv"\npolygons = "p.csv"\n',
            f"{NEEDS} file and nodes and polygons; correct it",
        ),
        (
            "mesh = [1]\n",
            "scene.toml, line 1, mesh[1]: must be a table of file, nodes, polygons, up, scale, normals and"
            " crease_angle, not 1",
        ),
        (MESH * 1001, "scene.toml, line 1, mesh must have at most 1,000 tables, not 1,001; join some"),
    ],
)


@pytest.mark.parametrize("name", ["../car.obj", "link.obj"])
def test_no_file_outside_the_folder_is_opened_unless_that_is_allowed(folder: Path, name: str) -> None:
    (folder.parent / "car.obj").write_text(CAR)
    (folder / "link.obj").symlink_to(folder.parent / "car.obj")
    (sentence,) = refusal(folder, f'[[mesh]]\nfile = "{name}"\n')
    assert sentence.startswith("scene.toml, line 2, mesh[1]: file must ")
    assert len(read(folder, '[[mesh]]\nfile = "../car.obj"\n', outside=True)) == 1


# What is remembered of a mesh.


def test_a_mesh_is_from_the_files_that_it_was_read_from(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    entry = {"file": "car.obj", "up": "y"}
    scene = read_scene(folder)
    assert SOURCES.get(scene.mesh) == MeshSource(folder, (entry,), folder / "scene.toml")
    assert SOURCES.get(scene.replace(ambient=0.5).mesh) == SOURCES.get(scene.mesh)
    assert SOURCES.get(dataclasses.replace(scene.mesh)) is None
    monkeypatch.chdir(folder)
    assert SOURCES.get(read_scene("car.obj", up="y").mesh) == MeshSource(folder, (entry,), None)
    write_picture("car.npz", scene, render(scene, (16, 12)))
    assert SOURCES.get(read_scene("car.npz").mesh) is None


# The files for a mesh that is saved.


@pytest.mark.parametrize(
    ("mesh", "name"),
    [
        (cube(), "mesh.obj"),
        (Mesh(np.eye(3), np.array([[0, 1, 2], [0, 1, 1]]), np.zeros(2, np.intp), ("a",)), "mesh.tables"),
        (Mesh(np.empty((0, 3)), np.empty((0, 4), np.intp), np.empty(0, np.intp), ()), "mesh.tables"),
    ],
)
def test_a_mesh_is_written_as_obj_or_as_arrays_where_obj_does_not_hold_it(
    tmp_path: Path, mesh: Mesh, name: str
) -> None:
    written: list[Path] = []
    meshes = written_mesh(tmp_path, mesh, written)
    assert meshes.entries == ({"file": name},)
    assert list(tmp_path.iterdir()) == written == [tmp_path / name]
    assert np.array_equal(meshes.reports[0].mesh.node_numbers, mesh.node_numbers)


def test_the_files_that_a_scene_file_names_come_first_unless_they_hold_another_mesh(folder: Path) -> None:
    (folder / "copy.obj").write_text(CAR)
    mesh = read_scene(folder / "car.obj", up="y", scale=0.25).mesh
    source = {"file": "car.obj", "up": "y", "scale": 0.25}
    copy = {"file": "copy.obj", "scale": 0.25, "crease_angle": 3, "up": "y"}
    named = '[[mesh]]\nfile = "copy.obj"\nscale = 0.25\ncrease_angle = 3\nup = "{}"\n'
    for place, text, entry in (
        (folder, named.format("y").encode(), copy),
        (folder, named.format("z").encode(), source),
        (folder, b"", source),
        (folder.parent, b"", {**source, "file": "coupe/car.obj"}),
    ):
        found = meshes_there(place, mesh, text)
        assert found is not None
        assert found.entries == (entry,)
    (folder / "car.obj").unlink()
    assert meshes_there(folder, mesh, b"") is None
