from __future__ import annotations

import dataclasses
from pathlib import Path

import numpy as np
import pytest

from autocolor import Mesh, OutputError, read_scene
from autocolor.files import mesh_writing
from autocolor.files.mesh_writing import entries_of, meshes_there, reports_of, written_mesh
from autocolor.scene.scalar import MeshScalar
from tests.autocolor.meshes import cube

CAR = "v 0 0 0\nv 1 0 0\nv 1 1 0.1\nv 0 1 0\nf 1 2 3 4\n"


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
    monkeypatch.setattr(mesh_writing, "has_same_tables", lambda *_: False)
    written: list[Path] = []
    with pytest.raises(OutputError, match=r"one of 6 polygons is too large; leave parts out"):
        written_mesh(tmp_path, cube(), written)
    assert list(tmp_path.iterdir()) == written == []


def test_the_files_that_a_scene_file_names_come_first(tmp_path: Path) -> None:
    (tmp_path / "car.obj").write_text(CAR)
    (tmp_path / "copy.obj").write_text(CAR.replace("f", "o car\nf"))
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
    (tmp_path / "deeper" / "car.obj").write_text(CAR)
    mesh = read_scene(tmp_path / "deeper" / "car.obj", up="y", scale=0.25).mesh
    found = meshes_there(tmp_path, mesh, None)
    assert found is not None
    assert found.entries == ({"file": "deeper/car.obj", "up": "y", "scale": 0.25},)


def test_files_that_hold_another_mesh_or_none_are_left_alone(tmp_path: Path) -> None:
    (tmp_path / "car.obj").write_text(CAR)
    mesh = read_scene(tmp_path / "car.obj").mesh
    moved = dataclasses.replace(mesh, coordinates=mesh.coordinates + 1)
    assert meshes_there(tmp_path, moved, b'[[mesh]]\nfile = "car.obj"\n') is None
    (tmp_path / "car.obj").unlink()
    assert meshes_there(tmp_path, mesh, b'[[mesh]]\nfile = "car.obj"\n') is None


def test_a_link_out_of_the_folder_is_not_followed(tmp_path: Path) -> None:
    (tmp_path / "car.obj").write_text(CAR)
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
