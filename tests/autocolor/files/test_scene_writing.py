from __future__ import annotations

import dataclasses
import difflib
import os
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor import (
    Flap,
    Flaps,
    InputError,
    Light,
    MeshScalar,
    OutputError,
    Scene,
    UsageError,
    WriteError,
    read_scene,
    scene_of,
    write_scene,
)
from autocolor.files import scene_writing
from autocolor.files.scene_toml import scene_text
from autocolor.scene.columns import with_values
from autocolor.testing import scenes
from tests.small import cube

HAND_WRITTEN = """\
# A car by hand.

ambient = 0.20   # as at dusk

[[mesh]]
file = "car.obj"
crease_angle = 30 # sharp

# Red all over.
[surfaces.paint]
object_color = "#B01020"  # Ferrari
specular=0.25

[parts]
hood.surface = "paint"
roof = { surface = "paint" }

[[lights]]
# The sun.
name = "sun"
position = [ 1, 2, 30 ]
flaps.x = { minimum = 0.10, on = true }

[[lights]]
name = "lamp"  # on the street
position = [ 5, 0, 3 ]
aim = [ 0, 0, 0 ]
"""
CAR = "v 0 0 0\nv 1 0 0\nv 1 1 0.1\nv 0 1 0\no hood\nf 1 2 3 4\no roof\nf 1 2 3\n"
MINE = '# Mine.\n[[mesh]]\nfile = "car.obj"\n'


def same(one: Scene, other: Scene) -> bool:
    """Whether two scenes are equal in every column but their names, the mesh by its tables."""
    tables = ("coordinates", "node_numbers", "part_numbers")
    return (
        with_values(one, {"mesh": other.mesh, "name": other.name}).equals(other)
        and all(np.array_equal(getattr(one.mesh, name), getattr(other.mesh, name)) for name in tables)
        and one.mesh.part_names == other.mesh.part_names
        and one.mesh.crease_angle == other.mesh.crease_angle
    )


def changed_lines(before: str, after: str) -> list[str]:
    lines = difflib.unified_diff(before.splitlines(), after.splitlines(), lineterm="", n=0)
    return [line for line in lines if line[:2] not in ("--", "++", "@@")]


@pytest.fixture
def car(tmp_path: Path) -> Path:
    """A folder with a scene file that was written by hand."""
    folder = tmp_path / "car"
    folder.mkdir()
    (folder / "car.obj").write_text(CAR)
    (folder / "scene.toml").write_text(HAND_WRITTEN)
    return folder


def saved(folder: Path, scene: Scene) -> str:
    """The text of the scene file of a folder when the scene was saved there, and is read back."""
    write_scene(folder, scene, overwrite=True)
    assert same(read_scene(folder), scene)
    return (folder / "scene.toml").read_text()


@given(scenes(), scenes(), st.booleans())
def test_every_column_of_a_scene_is_read_back_also_over_another_one(
    tmp_path_factory: pytest.TempPathFactory, first: Scene, second: Scene, complete: bool
) -> None:
    folder = tmp_path_factory.mktemp("scene")
    before = saved(folder, first)
    assert len(list(folder.iterdir())) == 2
    # Written again, nothing of it changes.
    assert saved(folder, read_scene(folder)) == before
    write_scene(folder, second, overwrite=True, complete=complete)
    assert same(read_scene(folder), second)


def test_only_what_was_changed_is_changed_in_its_place(car: Path) -> None:
    assert saved(car, read_scene(car)) == HAND_WRITTEN
    scene = read_scene(car).with_surface("paint", object_color="#00ff00").with_light("sun", intensity=2.5)
    scene = scene.with_light("sun", flaps={"x": {"minimum": 0.3}}).with_part("roof", stage=True)
    scene = scene.replace(mesh=dataclasses.replace(scene.mesh, crease_angle=50.0))
    assert changed_lines(HAND_WRITTEN, saved(car, scene.replace(ambient=0.25))) == [
        "-ambient = 0.20   # as at dusk",
        "+ambient = 0.25   # as at dusk",
        "-crease_angle = 30 # sharp",
        "+crease_angle = 50.0 # sharp",
        '-object_color = "#B01020"  # Ferrari',
        '+object_color = "#00ff00"  # Ferrari',
        '-roof = { surface = "paint" }',
        '+roof = { surface = "paint", stage = true }',
        "-flaps.x = { minimum = 0.10, on = true }",
        "+flaps.x = { minimum = 0.3, on = true }",
        "+intensity = 2.5",
    ]


def test_a_file_of_the_same_object_is_told_by_the_parts_of_its_mesh(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    (tmp_path / "car.obj").write_text(CAR)
    (tmp_path / "scene.toml").write_text(MINE)
    mesh = dataclasses.replace(read_scene(tmp_path).mesh, part_names=("hood", "door"))
    with caplog.at_level("WARNING", "autocolor"):
        assert saved(tmp_path, scene_of(mesh)).startswith("# Mine.\n")
        assert caplog.messages == []
        assert "# Mine." not in saved(tmp_path, scene_of(cube()))
    file = tmp_path / "scene.toml"
    assert caplog.messages == [f"{file}: written anew; its old content and comments are lost"]


@pytest.mark.parametrize("text", ["ambient = ", '[[mesh]]\nfile = "no.obj"\n'])
def test_a_file_that_cannot_be_read_is_replaced_when_it_may_be(tmp_path: Path, text: str) -> None:
    (tmp_path / "scene.toml").write_text(text)
    with pytest.raises(OutputError, match="exists"):
        write_scene(tmp_path, scene_of(cube()))
    assert [path.name for path in tmp_path.iterdir()] == ["scene.toml"]
    saved(tmp_path, scene_of(cube()))


def test_a_mesh_file_in_the_folder_is_named_also_if_it_was_repaired(tmp_path: Path) -> None:
    (tmp_path / "parts").mkdir()
    (tmp_path / "parts" / "car.obj").write_text(CAR + "f 1 1 2\nf 1 2 3 4 1 3\n")
    text = saved(tmp_path, read_scene(tmp_path / "parts" / "car.obj", up="y"))
    assert '[[mesh]]\nfile = "parts/car.obj"\nup = "y"\n' in text
    assert not (tmp_path / "mesh.obj").exists()


def test_a_mesh_file_outside_of_the_folder_is_written_beside(car: Path, tmp_path: Path) -> None:
    for folder, source in ((tmp_path / "new", car / "car.obj"), (car / "again", car)):
        saved(folder, read_scene(source))
        assert sorted(os.listdir(folder)) == ["mesh.obj", "scene.toml"]
    (tmp_path / "car.obj").write_text(CAR)
    (car / "scene.toml").write_text(HAND_WRITTEN.replace('"car.obj"', '"../car.obj" # shared'))
    text = saved(car, read_scene(car, outside=True).with_light("sun", intensity=3))
    assert 'file = "mesh.obj"' in text
    assert "# The sun." in text


def test_a_name_that_utf_8_lacks_is_refused_and_nothing_is_written(tmp_path: Path) -> None:
    space = {"\ud800": {"point": (0, 0, 0), "direction": (0, 0, 1)}}
    for fields in ({"name": "\ud800"}, {"half_spaces": space}):
        with pytest.raises(InputError, match=r"must be valid in UTF-8, not '\\ud800'; rename it"):
            write_scene(tmp_path / "cube", scene_of(cube()).with_light("key", **fields))
    assert list(tmp_path.iterdir()) == []


def test_fields_at_their_defaults_are_left_out_and_rows_of_a_light_have_a_line_each(tmp_path: Path) -> None:
    scene = scene_of(
        cube(),
        surfaces="parts",
        view={"eye": (0, -5, 0), "direction": (0, 1, 0)},
        lights=[Light("sun", (1.0, 2.0, 3.0))],
    )
    scene = scene.with_light(
        "sun",
        half_spaces={"a door": {"point": (0, 0, 0), "direction": (0, 1, 0), "on": False}},
        flaps=Flaps(z=Flap(minimum=0.5), x=Flap(on=False)),
        only_parts=["cube"],
        except_surfaces=[],
    )
    assert saved(tmp_path, scene.with_surface("cube", diffuse=0.7, specular=0.5, exponent=20)) == (
        "[view]\neye = [0.0, -5.0, 0.0]\ndirection = [0.0, 1.0, 0.0]\n\n"
        '[[mesh]]\nfile = "mesh.obj"\n\n'
        '[parts.cube]\nsurface = "cube"\n\n'
        '[surfaces.cube]\nobject_color = "#f4a39b"\nblend = 0.88\nlight_percentage = 60.0\n\n'
        '[[lights]]\nname = "sun"\nposition = [1.0, 2.0, 3.0]\n'
        "flaps.x = { on = false }\nflaps.z = { minimum = 0.5 }\n"
        'half_spaces."a door" = { point = [0.0, 0.0, 0.0], direction = [0.0, 1.0, 0.0], on = false }\n'
        'except_surfaces = []\nonly_parts = ["cube"]\n'
    )


def test_a_complete_file_has_all_keys_and_tells_what_was_written(car: Path) -> None:
    write = partial(write_scene, car, scene_of(cube()), overwrite=True, complete=True)
    assert write() == [car / "mesh.obj", car / "scene.toml"]
    text = (car / "scene.toml").read_text()
    for line in ("two_sided = true", "crease_angle = 40.0", 'exposure = "99.5 %"'):
        assert f"{line}\n" in text
    guarded: list[str] = []
    assert write(guard=lambda path: lambda: guarded.append(path.read_text())) == [car / "scene.toml"]
    assert guarded == [text]
    assert (car / "scene.toml").read_text() == text


def test_no_file_of_another_kind_is_replaced_and_no_name_is_too_odd_to_be_refused(tmp_path: Path) -> None:
    (tmp_path / "mine.txt").write_text("mine")
    for name in ("mine.txt", "cube.obj", "a.npz"):
        with pytest.raises(
            UsageError, match=r"^a scene must be written to a folder or to a file that ends in"
        ):
            write_scene(tmp_path / name, scene_of(cube()), overwrite=True)
    with pytest.raises(UsageError, match="a scene must have a place, not an empty name"):
        write_scene("", scene_of(cube()))
    for name in ("a\0b", "a\0b.toml", "x" * 300, "x" * 300 + ".toml"):
        with pytest.raises(OutputError):
            write_scene(tmp_path / name, scene_of(cube()), overwrite=True)
    assert [path.name for path in tmp_path.iterdir()] == ["mine.txt"]


def test_no_mesh_file_is_ever_overwritten(tmp_path: Path) -> None:
    (tmp_path / "mesh.obj").write_text(CAR)
    saved(tmp_path, scene_of(cube()))
    saved(tmp_path, scene_of(cube().with_scalars(MeshScalar("load", np.arange(8.0)))))
    assert [scalar.name for scalar in read_scene(tmp_path).mesh.scalars] == ["load"]
    assert (tmp_path / "mesh.obj").read_text() == CAR
    assert sorted(os.listdir(tmp_path)) == ["mesh-2.obj", "mesh.obj", "mesh.tables", "scene.toml"]


@pytest.mark.parametrize("is_new", [True, False])
def test_if_the_scene_file_cannot_be_written_nothing_is_changed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, is_new: bool
) -> None:
    folder = tmp_path / "cube"
    if not is_new:
        write_scene(folder, scene_of(cube()))

    def full(*_: Any, **__: Any) -> None:
        raise WriteError("an output must be written whole, and the disk is full; make room")

    monkeypatch.setattr(scene_writing, "write_atomically", full)
    before = {path: path.read_bytes() for path in tmp_path.rglob("*.*")}
    with pytest.raises(WriteError):
        write_scene(folder, scene_of(cube(2.0)), overwrite=True)
    assert {path: path.read_bytes() for path in tmp_path.rglob("*.*")} == before
    assert folder.exists() != is_new


def test_a_scene_file_that_would_be_too_long_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    scene = scene_of(cube(), lights=())
    size = len(saved(tmp_path / "cube", scene))
    monkeypatch.setattr(scene_text, "LARGEST_TEXT", size)
    saved(tmp_path / "cube", scene)
    saved(tmp_path / "again", scene)
    monkeypatch.setattr(scene_text, "LARGEST_TEXT", size - 1)
    with pytest.raises(OutputError, match="bytes and give the same scene"):
        write_scene(tmp_path / "new", scene)
    assert not (tmp_path / "new").exists()
