from __future__ import annotations

import time
from pathlib import Path

import numpy as np
import pytest

from autocolor import read_scene
from autocolor.files.scene_writing import write_scene
from autocolor.files.store.store_file import write_store
from autocolor.journal.history import History
from autocolor.journal.places import Source, place_of
from autocolor.screens.files.file_on_disk import SECONDS_BETWEEN
from autocolor.screens.viewer import Viewer
from ramtek_emu import Ramtek9300
from tests.autocolor.files.store.stores import run, small_scene
from tests.autocolor.screens.test_viewer import control, is_true_to

BRIGHTER = "UPDATE lights SET intensity = 3 WHERE name = 'key'"


@pytest.fixture
def store(tmp_path: Path) -> Path:
    path = tmp_path / "small.sqlite"
    write_store(path, small_scene())
    return path


def shown(path: Path) -> Viewer:
    """A viewer of the scene of a file, as `autocolor view` shows it."""
    place = place_of(Source(str(path)))
    return Viewer(History(read_scene(path), place), Ramtek9300(), folder=path.parent)


def tick(viewer: Viewer) -> None:
    """Let the window come to its next look at the file."""
    viewer.session.disk._looked_at -= SECONDS_BETWEEN
    viewer.on_tick()


def test_a_change_of_another_program_is_shown_as_one_step_to_undo(store: Path) -> None:
    viewer = shown(store)
    before = viewer.studio.scene
    tick(viewer)
    assert viewer.message.startswith("F1")
    run(store, BRIGHTER, "UPDATE scene SET background = '#102030'")
    viewer.on_tick()
    assert viewer.studio.scene is before
    tick(viewer)
    assert viewer.studio.scene.light("key").intensity == 3
    assert viewer.message == "small.sqlite was changed elsewhere; undo goes back"
    assert is_true_to(viewer, read_scene(store))
    assert not viewer.studio.is_changed
    control(viewer, "z")
    assert viewer.studio.scene is before
    tick(viewer)
    assert viewer.studio.scene is before


def test_a_change_of_lights_keeps_what_was_computed_of_the_mesh(store: Path) -> None:
    viewer = shown(store)
    mesh = viewer.studio.scene.mesh
    run(store, BRIGHTER)
    tick(viewer)
    assert viewer.studio.scene.mesh is mesh
    run(store, "UPDATE nodes SET z = 0.5 WHERE node = 5")
    tick(viewer)
    assert viewer.studio.scene.mesh.coordinates[4, 2] == 0.5


def test_with_unsaved_edits_the_user_is_asked(store: Path) -> None:
    viewer = shown(store)
    viewer.studio.light("rim", intensity=0.25)
    mine = viewer.studio.scene
    run(store, BRIGHTER)
    tick(viewer)
    assert viewer.studio.scene is mine
    assert (
        viewer.message == "small.sqlite was changed elsewhere: Ctrl+R shows that, Ctrl+S saves yours beside"
    )
    control(viewer, "r")
    assert viewer.studio.scene.light("key").intensity == 3
    assert viewer.message == "read again; undo goes back"
    control(viewer, "z")
    assert viewer.studio.scene is mine


def test_edits_that_are_saved_instead_leave_the_change_of_the_other_program(store: Path) -> None:
    viewer = shown(store)
    viewer.studio.light("rim", intensity=0.25)
    run(store, BRIGHTER)
    tick(viewer)
    control(viewer, "s")
    assert "small.sqlite was changed since, and is left alone" in viewer.message
    assert read_scene(store).light("key").intensity == 3
    assert read_scene(store.parent / "small").light("rim").intensity == 0.25


def test_ctrl_s_saves_to_the_store_and_that_is_no_change_of_another(store: Path) -> None:
    viewer = shown(store)
    run(store, "CREATE TABLE notes (text)")
    tick(viewer)
    viewer = shown(store)
    viewer.studio.light("rim", intensity=0.25)
    control(viewer, "s")
    assert viewer.message.startswith("saved small.sqlite and small.npz")
    assert read_scene(store).light("rim").intensity == 0.25
    assert run(store, "SELECT count(*) FROM notes") == [(0,)]
    scene = viewer.studio.scene
    tick(viewer)
    assert viewer.studio.scene is scene
    assert viewer.message.startswith("saved")
    run(store, BRIGHTER)
    tick(viewer)
    assert viewer.studio.scene.light("key").intensity == 3


def test_a_store_that_is_wrong_for_a_while_is_told_and_the_scene_stays(store: Path) -> None:
    viewer = shown(store)
    before = viewer.studio.scene
    run(store, "UPDATE polygons SET node3 = 40 WHERE polygon = 2")
    tick(viewer)
    assert viewer.studio.scene is before
    assert viewer.message.startswith(
        "not shown: small.sqlite: polygons, row 2: node 40 is not in the node table"
    )
    message = viewer.session.news
    tick(viewer)
    assert viewer.session.news is message
    run(store, "UPDATE polygons SET node3 = 3 WHERE polygon = 2")
    tick(viewer)
    assert viewer.studio.scene.mesh.node_numbers[1].tolist() == [0, 1, 2, 2]


def test_a_scene_file_is_looked_at_as_well(tmp_path: Path) -> None:
    folder = tmp_path / "small"
    write_scene(folder, small_scene().replace(mesh=small_scene().mesh.with_scalars()))
    viewer = shown(folder)
    file = folder / "scene.toml"
    file.write_text(file.read_text() + '\n[[lights]]\nname = "third"\nposition = [1, 2, 3]\n')
    tick(viewer)
    assert [light.name for light in viewer.studio.scene.lights] == ["key", "rim", "third"]
    file.write_text("[[mesh]\n")
    tick(viewer)
    assert viewer.message.startswith("not shown: scene.toml")
    assert len(viewer.studio.scene.lights) == 3


def test_a_file_that_only_looks_changed_is_no_step(store: Path) -> None:
    viewer = shown(store)
    run(store, "CREATE TABLE notes (text)")
    before, news = viewer.studio.scene, viewer.session.news
    tick(viewer)
    assert viewer.studio.scene is before
    assert viewer.session.news is news
    assert viewer.studio.undo() is False


def test_a_scene_in_no_file_has_nothing_to_read_again(tmp_path: Path) -> None:
    viewer = Viewer(small_scene(), Ramtek9300(), folder=tmp_path)
    tick(viewer)
    control(viewer, "r")
    assert viewer.message == "the scene must be in a file to be read again, and it is in none; save it"


def test_a_look_takes_no_time(store: Path) -> None:
    viewer = shown(store)
    disk = viewer.session.disk
    seconds = []
    for _ in range(20):
        disk._looked_at -= SECONDS_BETWEEN
        begun = time.perf_counter()
        disk.was_changed()
        seconds.append(time.perf_counter() - begun)
    assert np.median(seconds) < 0.002
