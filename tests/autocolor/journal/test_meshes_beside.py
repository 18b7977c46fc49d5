"""Changed meshes beside a journal: each once, and exactly."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from autocolor import InputError, Mesh, Scene, read_scene
from autocolor.journal.meshes_beside import MeshesBeside
from tests.autocolor.sessions import car


def larger(scene: Scene, crease_angle: float = 40.0) -> Scene:
    mesh = scene.mesh
    return scene.replace(
        mesh=Mesh(mesh.coordinates * 1.1, mesh.node_numbers, mesh.part_numbers, mesh.part_names, crease_angle)
    )


def test_a_mesh_is_saved_once_and_read_back_as_it_was(tmp_path: Path) -> None:
    beside = MeshesBeside(tmp_path / "session")
    one, other = larger(car(), 17.0), larger(car())
    path = beside.path_of(one)
    assert path == tmp_path / "session" / "scene-2"
    assert beside.path_of(one.replace(ambient=0.9)) == path
    assert beside.path_of(other) == tmp_path / "session" / "scene-3"
    again = read_scene(path).mesh
    assert np.array_equal(again.coordinates, one.mesh.coordinates)
    assert np.array_equal(again.node_numbers, one.mesh.node_numbers)
    assert again.part_names == one.mesh.part_names
    assert again.crease_angle == 17.0


def test_a_mesh_that_was_read_from_there_is_not_saved_again(tmp_path: Path) -> None:
    path = MeshesBeside(tmp_path).path_of(larger(car()))
    before = sorted(tmp_path.iterdir())
    assert MeshesBeside(tmp_path).path_of(read_scene(path)) == path
    assert sorted(tmp_path.iterdir()) == before


def test_without_a_folder_a_changed_mesh_is_refused() -> None:
    with pytest.raises(InputError) as refusal:
        MeshesBeside().path_of(car())
    assert str(refusal.value) == (
        "a mesh that a session changed must be saved beside its journal, and no folder is named for it; name"
        " one with beside="
    )
