from __future__ import annotations

import dataclasses
import gc
import shutil
import weakref
from pathlib import Path

import pytest

from autocolor import read_scene, render, write_picture
from autocolor.files.mesh_sources import MeshSource, keep_source, source_of
from tests.autocolor.meshes import cube

CAR = "v 0 0 0\nv 1 0 0\nv 1 1 0.1\nv 0 1 0\nf 1 2 3 4\n"


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "car.obj").write_text(CAR)
    (tmp_path / "scene.toml").write_text('[[mesh]]\nfile = "car.obj"\nup = "y"\n')
    return tmp_path


def test_a_mesh_is_from_the_files_that_it_was_read_from(folder: Path) -> None:
    entry = {"file": "car.obj", "up": "y"}
    assert source_of(read_scene(folder).mesh) == MeshSource(folder, (entry,), folder / "scene.toml")
    bare = source_of(read_scene(folder / "car.obj", up="y").mesh)
    assert bare == MeshSource(folder, (entry,), None)


def test_a_folder_of_tables_is_the_place_of_its_files(tmp_path: Path) -> None:
    (tmp_path / "nodes.csv").write_text("x,y,z\n0,0,0\n1,0,0\n1,1,0\n")
    (tmp_path / "polygons.csv").write_text("node1,node2,node3,node4\n1,2,3,\n")
    source = source_of(read_scene(tmp_path).mesh)
    assert source is not None
    assert source.folder == tmp_path
    assert source.entries == ({"nodes": "nodes.csv", "polygons": "polygons.csv", "up": "z"},)


def test_an_edit_of_the_scene_keeps_it_and_a_new_mesh_has_none(folder: Path) -> None:
    scene = read_scene(folder)
    assert source_of(scene.replace(ambient=0.5).mesh) == source_of(scene.mesh) is not None
    assert source_of(dataclasses.replace(scene.mesh)) is None
    assert source_of(cube()) is None


def test_the_mesh_of_a_picture_file_has_none(folder: Path) -> None:
    scene = read_scene(folder)
    write_picture(folder / "car.npz", render(scene, 12, 16), scene)
    assert source_of(read_scene(folder / "car.npz").mesh) is None


def test_a_relative_path_is_not_lost_when_the_process_goes_elsewhere(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(folder)
    source = source_of(read_scene("car.obj").mesh)
    assert source is not None
    assert source.folder == folder


def test_it_is_forgotten_with_the_mesh(folder: Path) -> None:
    mesh = cube()
    source = MeshSource(folder, ())
    keep_source(mesh, source)
    kept = weakref.ref(source)
    del source, mesh
    gc.collect()
    assert kept() is None
    shutil.rmtree(folder)
