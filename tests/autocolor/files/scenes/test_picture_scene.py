from __future__ import annotations

from pathlib import Path

import pytest

from autocolor import InputError, MissingInputError, render, write_picture
from autocolor.files.scenes.formats import scene_format_named
from autocolor.files.scenes.picture_scene import PICTURE_FILE, read_picture_scene
from tests.autocolor.meshes import wall_scene


@pytest.fixture
def path(tmp_path: Path) -> Path:
    """A picture file of a wall in a dim light."""
    scene = wall_scene(ambient=0.25, name="lit wall")
    write_picture(tmp_path / "wall.npz", render(scene, 6, 8), scene)
    return tmp_path / "wall.npz"


def test_the_scene_of_a_picture_file_is_the_one_that_was_saved(path: Path) -> None:
    report = read_picture_scene(path)
    saved = wall_scene(ambient=0.25, name="lit wall")
    assert (report.scene.name, report.scene.ambient) == ("lit wall", 0.25)
    assert (report.scene.surfaces, report.scene.lights, report.scene.view) == (
        saved.surfaces,
        saved.lights,
        saved.view,
    )
    assert report.scene.mesh.coordinates.tolist() == saved.mesh.coordinates.tolist()


def test_nothing_is_repaired_or_created_for_it_and_it_names_no_mesh_file(path: Path) -> None:
    for outside in (False, True):
        report = read_picture_scene(path, outside=outside)
        assert (report.repairs, report.created, report.mesh_files) == ((), (), ())


def test_a_picture_file_is_the_format_of_its_name_and_of_its_first_bytes(path: Path) -> None:
    assert scene_format_named(path) is PICTURE_FILE
    assert PICTURE_FILE.begins is not None
    assert PICTURE_FILE.begins(path.read_bytes()[:4096])
    assert not PICTURE_FILE.begins(b"PK\x05\x06")


def test_what_is_no_picture_file_is_refused(path: Path) -> None:
    path.write_bytes(path.read_bytes()[:-1])
    with pytest.raises(InputError, match=r"^wall\.npz: a picture file must be whole"):
        read_picture_scene(path)
    with pytest.raises(MissingInputError):
        read_picture_scene(path.with_name("none.npz"))
