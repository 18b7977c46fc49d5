"""Opening, keeping variants and saving in a studio, and what undo brings back."""

from __future__ import annotations

from pathlib import Path

import pytest

import autocolor
from autocolor import InputError, Studio, UsageError, read_scene
from autocolor.journal.reading import session_of
from ramtek_emu import Ramtek9300
from tests.autocolor.meshes import cube
from tests.autocolor.sessions import car, fresh, held, opened

OBJ = "v 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nv 0 1 0\ng front\nf 1 2 3 4\ng side\nf 1 4 5\n"


@pytest.fixture
def mesh_file(tmp_path: Path) -> Path:
    (tmp_path / "box.obj").write_text(OBJ)
    return tmp_path / "box.obj"


def test_opening_is_a_step_and_undoing_it_gives_the_first_picture_byte_for_byte(mesh_file: Path) -> None:
    studio, display = opened()
    first, ranges, scene = held(display), dict(studio.level_ranges), studio.scene
    studio.open(mesh_file, up="y", surfaces="parts")
    assert studio.scene.name == "box"
    assert [surface.name for surface in studio.scene.surfaces] == ["front", "side"]
    assert held(display) == fresh(studio.scene)
    second = held(display)
    studio.undo()
    assert (held(display), dict(studio.level_ranges)) == (first, ranges)
    assert studio.scene is scene
    studio.redo()
    assert held(display) == second


def test_a_file_that_cannot_be_opened_changes_nothing(mesh_file: Path) -> None:
    studio, display = opened()
    before = held(display), repr(studio), len(studio.history.steps)
    mesh_file.write_text("f 1 2 3\n")
    with pytest.raises(InputError):
        studio.open(mesh_file)
    with pytest.raises(InputError):
        studio.open(mesh_file.with_name("none.obj"))
    assert (held(display), repr(studio), len(studio.history.steps)) == before


def test_what_is_changed_is_known_for_each_opened_scene(mesh_file: Path) -> None:
    studio, _ = opened()
    studio.recolor("body", blend=0.25)
    assert studio.is_changed
    studio.open(mesh_file)
    assert not studio.is_changed
    assert studio.history.left_unsaved == ("scene",)
    studio.view(angle=5)
    assert studio.is_changed
    for _ in range(2):
        studio.undo()
    assert studio.is_changed
    assert studio.history.left_unsaved == ()
    studio.undo()
    assert not studio.is_changed


def test_a_variant_is_come_back_to_by_one_step() -> None:
    studio, display = opened()
    assert studio.keep_variant() == "A"
    first = held(display)
    studio.recolor("body", blend=0.25)
    studio.light("key", on=False)
    assert studio.keep_variant("night") == "night"
    night = held(display)
    studio.show_variant("A")
    assert held(display) == first
    studio.show_variant("A")
    studio.undo()
    assert held(display) == night
    assert list(studio.variants) == ["A", "night"]
    studio.drop_variant("A")
    assert list(studio.variants) == ["night"]
    with pytest.raises(UsageError):
        studio.show_variant("A")


def test_keeping_a_variant_leaves_what_can_be_redone() -> None:
    studio, _ = opened()
    studio.recolor("body", blend=0.25)
    studio.undo()
    studio.keep_variant()
    assert studio.redo()


def test_a_variant_brings_back_the_files_of_its_scene(mesh_file: Path, tmp_path: Path) -> None:
    studio, _ = opened()
    first = studio.save_session(tmp_path)
    studio.keep_variant("A")
    studio.open(mesh_file)
    second = studio.save_session(tmp_path)
    assert first.scene != second.scene
    studio.show_variant("A")
    assert studio.save_session(tmp_path) == first


def test_a_session_is_recovered_with_its_variants_its_names_and_what_is_saved(
    mesh_file: Path, tmp_path: Path
) -> None:
    autocolor.write_scene(tmp_path / "car", car())
    studio, _ = opened(read_scene(tmp_path / "car"))
    studio.keep_variant("A")
    studio.open(mesh_file, surfaces="parts")
    studio.recolor("front", blend=0.25)
    saved = studio.save_session(tmp_path)
    text = studio.journal(tmp_path / "car")
    session = session_of(text)
    again, display = Studio(session.history, Ramtek9300()), Ramtek9300()
    assert not again.is_changed
    assert list(again.variants) == ["A"]
    assert again.journal() == text
    Studio(studio.scene, display)
    assert (again.words == display.words).all()
    again.recolor("front", blend=0.5)
    assert again.is_changed
    assert again.save_session(tmp_path) == saved
    session = session_of(again.journal() + "studio.undo()\n")
    assert session.history.is_changed


def test_a_session_that_saved_over_the_file_it_opened_is_recovered(tmp_path: Path) -> None:
    autocolor.write_scene(tmp_path / "car", car())
    studio = Studio(car(), Ramtek9300())
    studio.open(tmp_path / "car")
    studio.recolor("body", blend=0.25)
    studio.save_session(tmp_path)
    studio.recolor("body", blend=0.5)
    autocolor.write_scene(tmp_path / "first", car())
    history = session_of(studio.journal(tmp_path / "first")).history
    assert history.scene.surface("body").paint.blend == 0.5
    assert history.is_changed
    history.undo()
    assert not history.is_changed
    history.undo()
    assert history.scene.surface("body").paint.blend == 1.0 or history.is_changed


def test_a_mesh_that_an_edit_changed_is_saved_beside_the_journal(tmp_path: Path) -> None:
    autocolor.write_scene(tmp_path / "car", car())
    studio = Studio(read_scene(tmp_path / "car"), Ramtek9300())
    studio.edit(autocolor.scene_of(cube()))
    studio.edit(studio.scene.replace(ambient=0.5))
    with pytest.raises(InputError, match="no folder is named for it; name one with beside="):
        studio.journal(tmp_path / "car")
    text = studio.journal(tmp_path / "car", beside=tmp_path / "kept")
    read = session_of(text).history
    other = Ramtek9300()
    again = Studio(read, other)
    assert (again.words == studio.words).all()
    assert (again.entries == studio.entries).all()
    assert again.journal(beside=tmp_path / "kept") == text


def test_a_journal_needs_the_path_of_its_first_scene() -> None:
    with pytest.raises(UsageError) as refusal:
        opened()[0].journal()
    assert str(refusal.value) == "a journal must name what its first scene was read from; give its path"


def test_ranges_that_are_given_are_held() -> None:
    studio, _ = opened()
    studio.hold_exposure({"object": (0.0, 2.0)})
    assert studio.scene.exposure == (("object", (0.0, 2.0)),)


def test_the_file_of_a_scene_is_read_again_by_one_step_to_undo(tmp_path: Path) -> None:
    studio, _ = opened()
    with pytest.raises(UsageError, match="the scene must be in a file to be read again, and it is in none"):
        studio.reopen()
    path = tmp_path / "car.sqlite"
    autocolor.write_scene(path, studio.scene)
    studio.open(path)
    assert studio.file == path
    assert not studio.reopen()
    autocolor.write_scene(path, studio.scene.replace(ambient=0.5), overwrite=True)
    before = studio.scene
    assert studio.reopen()
    assert studio.scene.ambient == 0.5
    assert studio.scene.mesh is before.mesh
    studio.undo()
    assert studio.scene is before
