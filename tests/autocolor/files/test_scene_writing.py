from __future__ import annotations

import dataclasses
import difflib
import errno
import os
import shutil
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given

from autocolor import (
    Flap,
    Flaps,
    InputError,
    Light,
    Mesh,
    MeshScalar,
    OutputError,
    Part,
    Scene,
    UsageError,
    WriteError,
    read_scene,
    render,
    scene_of,
    write_picture,
    write_scene,
)
from autocolor.files import scene_writing
from autocolor.files.scene_writing import write_scene_with_tables
from autocolor.scene.columns import with_values
from autocolor.testing import scenes
from tests.autocolor.strategies import of_mesh
from tests.small import cube

COUPE = Path(__file__).parents[3] / "scenes" / "coupe"

SCALARS = (
    MeshScalar("stress", np.array([np.nan, *range(7)])),
    MeshScalar("load", np.linspace(-1, 1, 6), "polygon"),
)


def test_a_scene_with_scalars_is_written_without_loss(tmp_path: Path) -> None:
    scene = scene_of(cube().with_scalars(*SCALARS), scalar={"name": "load", "limits": (-2, 2), "bands": 5})
    write_scene(tmp_path / "scene.toml", scene)
    again = read_scene(tmp_path / "scene.toml")
    assert again.scalar == scene.scalar
    assert [(each.name, each.of) for each in again.mesh.scalars] == [("stress", "node"), ("load", "polygon")]
    for one, other in zip(again.mesh.scalars, SCALARS, strict=True):
        assert np.array_equal(one.values, other.values, equal_nan=True)
    one_picture, other_picture = (render(each, 12, 16).scalar for each in (scene, again))
    assert one_picture is not None
    assert other_picture is not None
    assert one_picture.tobytes() == other_picture.tobytes()


def test_a_scalar_that_changes_is_written_to_a_new_file(tmp_path: Path) -> None:
    scene = scene_of(cube().with_scalars(*SCALARS))
    write_scene(tmp_path / "scene.toml", scene)
    mesh = read_scene(tmp_path / "scene.toml").mesh
    stronger = MeshScalar("stress", np.arange(8.0) * 2)
    write_scene(tmp_path / "scene.toml", scene.replace(mesh=mesh.with_scalars(stronger)), overwrite=True)
    (scalar,) = read_scene(tmp_path / "scene.toml").mesh.scalars
    assert scalar.values.tolist() == stronger.values.tolist()


HAND_WRITTEN = """\
# A car by hand.

ambient = 0.20   # as at dusk

[[mesh]]
file = "car.obj"

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


@given(scenes())
def test_every_column_of_a_scene_of_arrays_is_read_back(
    tmp_path_factory: pytest.TempPathFactory, scene: Scene
) -> None:
    folder = tmp_path_factory.mktemp("scene")
    write_scene(folder, scene)
    again = read_scene(folder)
    assert same(again, scene)
    # Written again, nothing of it changes.
    before = (folder / "scene.toml").read_text()
    write_scene(folder, again, overwrite=True)
    assert (folder / "scene.toml").read_text() == before
    assert len(list(folder.iterdir())) == 2


@given(scenes(), scenes())
def test_a_scene_that_is_saved_over_another_one_is_read_back(
    tmp_path_factory: pytest.TempPathFactory, first: Scene, second: Scene
) -> None:
    folder = tmp_path_factory.mktemp("scene")
    write_scene(folder, first)
    write_scene(folder, second, overwrite=True)
    assert same(read_scene(folder), second)


@given(scenes())
def test_any_edit_of_a_file_that_says_little_is_read_back(
    tmp_path_factory: pytest.TempPathFactory, drawn: Scene
) -> None:
    folder = tmp_path_factory.mktemp("scene")
    (folder / "car.obj").write_text(CAR.replace("hood", "part 0").replace("roof", "part 1"))
    (folder / "scene.toml").write_text('# Mine.\n[[mesh]]\nfile = "car.obj"\n')
    scene = of_mesh(drawn, read_scene(folder).mesh)
    write_scene(folder, scene, overwrite=True)
    assert same(read_scene(folder), scene)
    assert (folder / "scene.toml").read_text().count("# Mine.") == 1
    assert not (folder / "mesh.obj").exists()


def test_what_was_not_changed_stays_as_it_was_written(car: Path) -> None:
    write_scene(car, read_scene(car), overwrite=True)
    assert (car / "scene.toml").read_text() == HAND_WRITTEN


def test_a_changed_value_is_changed_in_its_place(car: Path) -> None:
    scene = read_scene(car).with_surface("paint", object_color="#00ff00").with_light("sun", intensity=2.5)
    scene = scene.with_light("sun", flaps={"x": {"minimum": 0.3}}).with_part("roof", stage=True)
    write_scene(car, scene.replace(ambient=0.25), overwrite=True)
    assert changed_lines(HAND_WRITTEN, (car / "scene.toml").read_text()) == [
        "-ambient = 0.20   # as at dusk",
        "+ambient = 0.25   # as at dusk",
        '-object_color = "#B01020"  # Ferrari',
        '+object_color = "#00ff00"  # Ferrari',
        '-roof = { surface = "paint" }',
        '+roof = { surface = "paint", stage = true }',
        "-flaps.x = { minimum = 0.10, on = true }",
        "+flaps.x = { minimum = 0.3, on = true }",
        "+intensity = 2.5",
    ]
    assert same(read_scene(car), scene.replace(ambient=0.25))


def test_the_coupe_keeps_its_comments(tmp_path: Path) -> None:
    shutil.copytree(COUPE, tmp_path / "coupe")
    scene = read_scene(tmp_path / "coupe").with_light("side", intensity=0.9)
    scene = scene.with_surface("body", object_color="#0000ff")
    write_scene(tmp_path / "coupe" / "scene.toml", scene, overwrite=True)
    after = (tmp_path / "coupe" / "scene.toml").read_text()
    assert changed_lines((COUPE / "scene.toml").read_text(), after) == [
        '-object_color = "#d8142c"',
        '+object_color = "#0000ff"',
        "-intensity = 0.7",
        "+intensity = 0.9",
    ]
    assert same(read_scene(tmp_path / "coupe"), scene)
    assert sorted(os.listdir(tmp_path / "coupe")) == sorted(os.listdir(COUPE))


def test_a_removed_light_goes_with_its_comment_and_the_others_keep_theirs(car: Path) -> None:
    scene = read_scene(car)
    added = Light("moon", (9.0, 9.0, 9.0), flaps=Flaps(z=Flap(maximum=0.5)))
    write_scene(car, scene.replace(lights=(scene.light("lamp"), added)), overwrite=True)
    text = (car / "scene.toml").read_text()
    assert "The sun" not in text
    assert text.endswith(
        '[[lights]]\nname = "lamp"  # on the street\nposition = [ 5, 0, 3 ]\naim = [ 0, 0, 0 ]\n\n'
        '[[lights]]\nname = "moon"\nposition = [9.0, 9.0, 9.0]\nflaps.z = { maximum = 0.5 }\n'
    )


def test_lights_in_another_order_take_their_comments_along(car: Path) -> None:
    scene = read_scene(car)
    write_scene(car, scene.replace(lights=scene.lights[::-1]), overwrite=True)
    text = (car / "scene.toml").read_text()
    assert text.index("on the street") < text.index("# The sun.")
    assert [light.name for light in read_scene(car).lights] == ["lamp", "sun"]


def test_a_renamed_light_keeps_its_place_and_its_comment(car: Path) -> None:
    write_scene(car, read_scene(car).with_light("sun", name="moon"), overwrite=True)
    lines = changed_lines(HAND_WRITTEN, (car / "scene.toml").read_text())
    assert lines == ['-name = "sun"', '+name = "moon"']


def test_a_view_that_was_created_is_written_once_it_is_changed(car: Path) -> None:
    scene = read_scene(car)
    write_scene(car, scene, overwrite=True)
    assert "[view]" not in (car / "scene.toml").read_text()
    write_scene(car, scene.with_view(angle=10), overwrite=True)
    assert "[view]\neye = " in (car / "scene.toml").read_text()
    assert same(read_scene(car), scene.with_view(angle=10))


def test_lights_that_were_created_stay_when_the_view_is_changed(tmp_path: Path) -> None:
    (tmp_path / "car.obj").write_text(CAR)
    (tmp_path / "scene.toml").write_text('# Mine.\n[[mesh]]\nfile = "car.obj"\n')
    scene = read_scene(tmp_path)
    moved = scene.with_view(eye=(9.0, 9.0, 9.0), target=(0.0, 0.0, 0.0))
    write_scene(tmp_path, moved, overwrite=True)
    text = (tmp_path / "scene.toml").read_text()
    # Those that the new view would create are others.
    assert text.count("[[lights]]") == 4
    assert text.startswith("# Mine.\n")
    assert same(read_scene(tmp_path), moved)


def test_no_lights_are_written_as_none(car: Path) -> None:
    write_scene(car, read_scene(car).replace(lights=()), overwrite=True)
    text = (car / "scene.toml").read_text()
    assert "lights = []" in text
    assert "[[lights]]" not in text
    assert read_scene(car).lights == ()
    sun = Light("sun", (1.0, 2.0, 3.0))
    write_scene(car, read_scene(car).replace(lights=(sun,)), overwrite=True)
    assert read_scene(car).lights == (sun,)


def test_the_crease_angle_is_changed_where_the_file_gives_it(car: Path) -> None:
    (car / "scene.toml").write_text(HAND_WRITTEN.replace('"car.obj"', '"car.obj"\ncrease_angle = 30 # sharp'))
    scene = read_scene(car)
    mesh = dataclasses.replace(scene.mesh, crease_angle=50.0)
    write_scene(car, scene.replace(mesh=mesh), overwrite=True)
    assert "crease_angle = 50.0 # sharp\n" in (car / "scene.toml").read_text()
    assert read_scene(car).mesh.crease_angle == 50.0
    assert not (car / "mesh.obj").exists()


def test_a_changed_mesh_is_written_beside_and_the_comments_stay(car: Path) -> None:
    scene = read_scene(car)
    mesh = dataclasses.replace(scene.mesh, coordinates=scene.mesh.coordinates / 3)
    write_scene(car, scene.replace(mesh=mesh), overwrite=True)
    assert (car / "car.obj").read_text() == CAR
    text = (car / "scene.toml").read_text()
    lines = changed_lines(HAND_WRITTEN, text)
    assert [line for line in lines if line.startswith("-")] == ['-file = "car.obj"']
    # A view of the new mesh would be created otherwise.
    assert {'+file = "mesh.obj"', "+[view]"} <= set(lines)
    assert same(read_scene(car), scene.replace(mesh=mesh))


def test_a_file_of_the_same_object_is_told_by_the_parts_of_its_mesh(tmp_path: Path) -> None:
    (tmp_path / "car.obj").write_text(CAR)
    (tmp_path / "scene.toml").write_text('# Mine.\n[[mesh]]\nfile = "car.obj"\n')
    mesh = dataclasses.replace(read_scene(tmp_path).mesh, part_names=("hood", "door"))
    write_scene(tmp_path, scene_of(mesh), overwrite=True)
    assert (tmp_path / "scene.toml").read_text().startswith("# Mine.\n")
    assert same(read_scene(tmp_path), scene_of(mesh))


def test_parts_that_are_gone_go_from_the_file(car: Path) -> None:
    scene = read_scene(car)
    hood = Mesh(scene.mesh.coordinates, np.array([[0, 1, 2, 3]]), np.array([0]), ("hood",))
    scene = scene.replace(mesh=hood, parts=scene.parts[:1])
    write_scene(car, scene, overwrite=True)
    text = (car / "scene.toml").read_text()
    assert "roof" not in text
    assert "# The sun." in text
    assert same(read_scene(car), scene)


def test_over_the_file_of_another_object_nothing_of_it_is_kept(
    car: Path, caplog: pytest.LogCaptureFixture
) -> None:
    with caplog.at_level("WARNING", "autocolor"):
        write_scene(car, scene_of(cube()), overwrite=True)
    assert caplog.messages == [f"{car / 'scene.toml'}: written anew; its old content and comments are lost"]
    assert "by hand" not in (car / "scene.toml").read_text()
    assert same(read_scene(car), scene_of(cube()))


@pytest.mark.parametrize("text", ["", "ambient = ", "\0", "ambient = 1\n", '[[mesh]]\nfile = "no.obj"\n'])
def test_a_file_that_cannot_be_read_is_replaced_when_it_may_be(tmp_path: Path, text: str) -> None:
    (tmp_path / "scene.toml").write_text(text)
    with pytest.raises(OutputError, match="exists"):
        write_scene(tmp_path, scene_of(cube()))
    assert [path.name for path in tmp_path.iterdir()] == ["scene.toml"]
    write_scene(tmp_path, scene_of(cube()), overwrite=True)
    assert same(read_scene(tmp_path), scene_of(cube()))


def test_a_mesh_file_in_the_folder_is_named(tmp_path: Path) -> None:
    (tmp_path / "parts").mkdir()
    (tmp_path / "parts" / "car.obj").write_text(CAR)
    scene = read_scene(tmp_path / "parts" / "car.obj", up="y")
    write_scene(tmp_path / "scene.toml", scene)
    assert '[[mesh]]\nfile = "parts/car.obj"\nup = "y"\n' in (tmp_path / "scene.toml").read_text()
    assert same(read_scene(tmp_path), scene)
    assert not (tmp_path / "mesh.obj").exists()


def test_a_mesh_file_outside_of_the_folder_is_written_beside(car: Path, tmp_path: Path) -> None:
    for source in (car, car / "car.obj"):
        scene = read_scene(source)
        write_scene(tmp_path / source.name / "again", scene) if source.is_dir() else write_scene(
            tmp_path / "new", scene
        )
    assert same(read_scene(tmp_path / "new"), read_scene(car / "car.obj"))
    assert sorted(os.listdir(tmp_path / "new")) == ["mesh.obj", "scene.toml"]
    assert sorted(os.listdir(car / "again")) == ["mesh.obj", "scene.toml"]
    assert same(read_scene(car / "again"), read_scene(car))


def test_a_scene_that_names_a_file_outside_is_saved_with_its_mesh_inside(car: Path) -> None:
    (car.parent / "car.obj").write_text(CAR)
    (car / "scene.toml").write_text(HAND_WRITTEN.replace('"car.obj"', '"../car.obj" # shared'))
    scene = read_scene(car, outside=True).with_light("sun", intensity=3)
    write_scene(car, scene, overwrite=True)
    text = (car / "scene.toml").read_text()
    assert 'file = "mesh.obj"' in text
    assert "# The sun." in text
    assert same(read_scene(car), scene)


def test_a_mesh_file_that_was_changed_since_is_not_named(tmp_path: Path) -> None:
    (tmp_path / "car.obj").write_text(CAR)
    scene = read_scene(tmp_path / "car.obj")
    (tmp_path / "car.obj").write_text(CAR.replace("0.1", "0.2"))
    write_scene(tmp_path, scene)
    assert 'file = "mesh.obj"' in (tmp_path / "scene.toml").read_text()
    assert same(read_scene(tmp_path), scene)


def test_a_mesh_that_was_repaired_is_that_of_its_file(tmp_path: Path) -> None:
    (tmp_path / "car.obj").write_text(CAR + "f 1 1 2\nf 1 2 3 4 1 3\n")
    scene = read_scene(tmp_path) if (tmp_path / "scene.toml").exists() else read_scene(tmp_path / "car.obj")
    write_scene(tmp_path, scene)
    assert 'file = "car.obj"' in (tmp_path / "scene.toml").read_text()
    assert same(read_scene(tmp_path), scene)


def test_materials_become_surfaces(tmp_path: Path) -> None:
    (tmp_path / "car.obj").write_text("mtllib car.mtl\n" + CAR.replace("o roof", "usemtl red\no roof"))
    (tmp_path / "car.mtl").write_text("newmtl red\nKd 1 0.5 0\nKs 0.25 0.25 0.25\nNs 9\n")
    scene = read_scene(tmp_path / "car.obj")
    write_scene(tmp_path, scene)
    write_scene(tmp_path / "elsewhere", scene)
    assert same(read_scene(tmp_path), scene)
    assert same(read_scene(tmp_path / "elsewhere"), scene)
    assert "[surfaces.red]" in (tmp_path / "elsewhere" / "scene.toml").read_text()


def test_the_scene_of_a_picture_file_is_written_with_its_mesh(car: Path, tmp_path: Path) -> None:
    scene = read_scene(car)
    write_picture(tmp_path / "car.npz", scene, render(scene, 24, 32))
    again = read_scene(tmp_path / "car.npz")
    write_scene(tmp_path / "new", again)
    assert same(read_scene(tmp_path / "new"), scene)


@pytest.mark.parametrize(
    "name", ["a b", 'a"b', "a.b", "ö", " a", "a\n", "a\\", "#", "o\nv 0 0 0", "x" * 300, "\x7f", "="]
)
def test_names_of_any_characters_are_read_back(tmp_path: Path, name: str) -> None:
    scene = scene_of(dataclasses.replace(cube(), part_names=(name,)), surfaces="parts")
    scene = scene.with_light("key", name=name).replace(exposure={name: (0.0, 1.5)})
    write_scene(tmp_path, scene)
    assert same(read_scene(tmp_path), scene)
    write_scene(tmp_path, scene.with_surface(name, blend=0.125), overwrite=True)
    assert read_scene(tmp_path).surface(name).paint.blend == 0.125


def test_a_name_that_utf_8_lacks_is_refused(tmp_path: Path) -> None:
    with pytest.raises(
        InputError, match=r"light '\\ud800': a name in a file must be text in UTF-8; rename it"
    ):
        write_scene(tmp_path, scene_of(cube()).with_light("key", name="\ud800"))
    assert list(tmp_path.iterdir()) == []


def test_a_name_inside_a_row_that_utf_8_lacks_is_refused(tmp_path: Path) -> None:
    scene = scene_of(cube()).with_light(
        "key", half_spaces={"a\ud800": {"point": (0, 0, 0), "direction": (0, 0, 1)}}
    )
    with pytest.raises(InputError, match="light 'key': a name in a file must be text in UTF-8; rename it"):
        write_scene(tmp_path / "cube", scene)
    assert list(tmp_path.iterdir()) == []


def test_fields_at_their_defaults_are_left_out(tmp_path: Path) -> None:
    scene = scene_of(
        cube(),
        surfaces="parts",
        view={"eye": (0, -5, 0), "direction": (0, 1, 0)},
        lights=[Light("sun", (1.0, 2.0, 3.0))],
    )
    write_scene(tmp_path, scene.with_surface("cube", diffuse=0.7, specular=0.5, exponent=20))
    assert (tmp_path / "scene.toml").read_text() == (
        "[view]\neye = [0.0, -5.0, 0.0]\ndirection = [0.0, 1.0, 0.0]\n\n"
        '[[mesh]]\nfile = "mesh.obj"\n\n'
        '[parts.cube]\nsurface = "cube"\n\n'
        '[surfaces.cube]\nobject_color = "#f4a39b"\nblend = 0.88\nlight_percentage = 60.0\n\n'
        '[[lights]]\nname = "sun"\nposition = [1.0, 2.0, 3.0]\n'
    )


def test_what_was_created_is_written_out(tmp_path: Path) -> None:
    write_scene(tmp_path, scene_of(cube()))
    text = (tmp_path / "scene.toml").read_text()
    assert text.count("[[lights]]") == 4
    assert "[view]\neye" in text
    assert "ambient = 0.13\n" in text
    assert 'exposure = "99.5 %"\n' in text


def test_a_complete_file_has_all_keys_and_tells_what_was_written(car: Path) -> None:
    written = write_scene_with_tables(car, scene_of(cube()), overwrite=True)
    assert written == [car / "mesh.obj", car / "scene.toml"]
    assert "two_sided = true\n" in (car / "scene.toml").read_text()


def test_a_folder_that_does_not_exist_is_made_but_not_those_around_it(tmp_path: Path) -> None:
    write_scene(tmp_path / "cube", scene_of(cube()))
    write_scene(tmp_path / "other" / "cube.toml", scene_of(cube()))
    assert sorted(os.listdir(tmp_path / "other")) == ["cube.toml", "mesh.obj"]
    assert read_scene(tmp_path / "other" / "cube.toml").name == "cube"
    with pytest.raises(OutputError, match=r"a scene must have a folder to be in, and '.*/no/folder' cannot"):
        write_scene(tmp_path / "no" / "folder" / "scene.toml", scene_of(cube()))
    assert not (tmp_path / "no").exists()


@pytest.mark.parametrize("name", ["cube.obj", "cube.npz", "cube.PNG.npz", "there.txt"])
def test_a_path_of_another_kind_of_file_is_refused(tmp_path: Path, name: str) -> None:
    (tmp_path / "there.txt").write_text("mine")
    with pytest.raises(
        UsageError, match=r"a scene must be written to a folder or to a file that ends in \.toml"
    ):
        write_scene(tmp_path / name, scene_of(cube()), overwrite=True)
    assert [path.name for path in tmp_path.iterdir()] == ["there.txt"]


@pytest.mark.parametrize("name", ["a\0b", "a\0b.toml", "x" * 300, "x" * 300 + ".toml"])
def test_a_path_that_the_system_cannot_hold_is_refused(tmp_path: Path, name: str) -> None:
    with pytest.raises(OutputError):
        write_scene(tmp_path / name, scene_of(cube()))
    assert list(tmp_path.iterdir()) == []


def test_an_empty_path_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    with pytest.raises(
        UsageError, match=r"must have a place, not an empty name; for the current folder write '\.'"
    ):
        write_scene("", scene_of(cube()))
    assert list(tmp_path.iterdir()) == []


def test_a_value_that_is_no_scene_is_refused_in_words(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match=r"a scene must be a Scene, not '.*'; read a scene from files"):
        write_scene(tmp_path / "new", "scenes/coupe")  # type: ignore[arg-type]
    assert list(tmp_path.iterdir()) == []


def test_no_mesh_file_is_ever_overwritten(tmp_path: Path) -> None:
    (tmp_path / "mesh.obj").write_text(CAR)
    write_scene(tmp_path, scene_of(cube()))
    write_scene(tmp_path, scene_of(cube(2.0)), overwrite=True)
    assert (tmp_path / "mesh.obj").read_text() == CAR
    assert sorted(os.listdir(tmp_path)) == ["mesh-2.obj", "mesh-3.obj", "mesh.obj", "scene.toml"]
    assert same(read_scene(tmp_path), scene_of(cube(2.0)))


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


def test_a_folder_that_cannot_be_written_to_is_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*_: Any, **__: Any) -> None:
        raise OSError(errno.EROFS, os.strerror(errno.EROFS))

    monkeypatch.setattr(os, "open", refuse)
    with pytest.raises(OutputError, match=r"cannot be made \(read-only file system\); choose another place"):
        write_scene(tmp_path, scene_of(cube()))
    monkeypatch.undo()
    assert list(tmp_path.iterdir()) == []


def test_a_scene_of_too_many_parts_is_refused_and_nothing_is_left(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("autocolor.files.scene_writing.LARGEST_TEXT", 1_000)
    count = 40
    names = tuple(f"part {number}" for number in range(count))
    mesh = Mesh(cube().coordinates, np.tile([[0, 2, 3, 1]], (count, 1)), np.arange(count), names)
    with pytest.raises(OutputError, match=r"a scene file must have at most 1,000 bytes"):
        write_scene(tmp_path, scene_of(mesh))
    assert list(tmp_path.iterdir()) == []


def test_line_ends_of_other_systems_are_kept(car: Path) -> None:
    (car / "scene.toml").write_bytes(HAND_WRITTEN.replace("\n", "\r\n").encode())
    write_scene(car, read_scene(car).with_light("sun", intensity=3.0), overwrite=True)
    data = (car / "scene.toml").read_bytes()
    assert data.count(b"\r\n") == data.count(b"\n")
    assert b"intensity = 3.0\r\n" in data


def test_a_new_part_is_written_beside_the_others(car: Path) -> None:
    scene = read_scene(car)
    mesh = dataclasses.replace(scene.mesh, part_names=("hood", "door"))
    parts = (scene.parts[0], Part("door", "paint", stage=True))
    write_scene(car, scene.replace(mesh=mesh, parts=parts), overwrite=True)
    text = (car / "scene.toml").read_text()
    assert '[parts]\nhood.surface = "paint"\ndoor.surface = "paint"\ndoor.stage = true\n' in text
