"""A studio and its files, which other programs may change: nothing is lost unasked."""

from __future__ import annotations

import os
import re
import sqlite3
from collections.abc import Iterator
from contextlib import closing
from pathlib import Path

import pytest

import autocolor
from autocolor import OutputError, read_picture, read_scene, scene_of
from autocolor.files.stamps import stamp_of
from autocolor.files.store import store_file
from autocolor.journal.places import checksum_of
from tests.autocolor.meshes import cube
from tests.autocolor.sessions import car, opened


def outside_toml(path: Path) -> None:
    """Another program edits a scene file."""
    text = re.sub("^angle = .*\n", "", path.read_text(), flags=re.MULTILINE)
    path.write_text(text.replace("[view]", "[view]\nangle = 7.0"))


def outside_row(path: Path) -> None:
    """Another program changes a row of a store."""
    with closing(sqlite3.connect(path)) as other, other:
        other.execute("UPDATE view SET angle = 7")


def outside_log(path: Path) -> None:
    """Another program changes a row of a store in WAL mode, and leaves it in the log."""
    with closing(sqlite3.connect(path)) as other, other:
        other.execute("PRAGMA journal_mode = WAL")
    OPEN.append(sqlite3.connect(path))
    with OPEN[-1]:
        OPEN[-1].execute("UPDATE view SET angle = 7")


def outside_mesh(path: Path) -> None:
    """Another program changes the mesh beside a scene file."""
    (mesh,) = (each for each in path.parent.iterdir() if each != path)
    autocolor.write_scene(path.parent.parent / "other", MOVED)
    (other,) = (each for each in (path.parent.parent / "other").iterdir() if each.suffix == mesh.suffix)
    os.replace(other, mesh)


OPEN: list[sqlite3.Connection] = []
MOVED = scene_of(cube(2.0))
OUTSIDE = {
    "a scene file": ("box/scene.toml", outside_toml),
    "a mesh": ("box/scene.toml", outside_mesh),
    "a store": ("box.sqlite", outside_row),
    "the log of a store": ("box.db", outside_log),
}


@pytest.fixture
def _closed() -> Iterator[None]:
    yield
    while OPEN:
        OPEN.pop().close()


@pytest.mark.usefixtures("_closed")
@pytest.mark.parametrize("has_saved", [False, True])
@pytest.mark.parametrize("what", OUTSIDE)
def test_a_change_of_another_program_is_never_overwritten_silently(
    tmp_path: Path, what: str, has_saved: bool
) -> None:
    name, change = OUTSIDE[what]
    path = tmp_path / name
    autocolor.write_scene(path, scene_of(cube()))
    studio, _ = opened()
    studio.open(path.parent if path.suffix == ".toml" else path)
    if has_saved:
        studio.view(angle=3)
        studio.save_scene(path, overwrite=True)
    change(path)
    theirs = read_scene(path)
    studio.view(angle=5)
    mine, before = studio.scene, stamp_of(path)
    with pytest.raises(OutputError) as refusal:
        studio.save_scene(path, overwrite=True)
    assert "reopen()" in str(refusal.value)
    saved = studio.save_session(tmp_path)
    assert (saved.changed, stamp_of(path)) == ((path,), before)
    studio.undo()
    studio.open(path)
    assert checksum_of(studio.scene) == checksum_of(theirs)
    studio.undo()
    studio.redo()
    assert not studio.is_changed
    studio.edit(mine)
    studio.save_scene(path, overwrite=True)
    assert read_scene(path).view.angle == 5


def test_a_change_that_was_read_again_may_be_overwritten(tmp_path: Path) -> None:
    autocolor.write_scene(tmp_path / "car", car())
    path = tmp_path / "car" / "scene.toml"
    studio, _ = opened()
    studio.open(path)
    studio.light("key", on=False)
    outside_toml(path)
    assert studio.reopen()
    assert studio.scene.view.angle == 7
    studio.undo()
    assert studio.is_changed
    studio.save_scene(path, overwrite=True)
    assert not studio.is_changed
    assert not read_scene(path).light("key").on
    # A comment is no other scene, and the file may be saved to after it was read again.
    path.write_text(path.read_text() + "# mine\n")
    studio.light("key", on=True)
    with pytest.raises(OutputError, match="another program changed"):
        studio.save_scene(path, overwrite=True)
    studio.undo()
    assert not studio.reopen()
    studio.redo()
    studio.save_scene(path, overwrite=True)
    assert path.read_text().endswith("# mine\n")


def test_a_picture_that_another_program_changed_is_not_overwritten(tmp_path: Path) -> None:
    studio, other = opened()[0], opened(car().replace(ambient=0.5))[0]
    path = tmp_path / "car.npz"
    for _ in range(2):
        studio.save(path, overwrite=True)
    other.save(path, overwrite=True)
    with pytest.raises(OutputError, match="another program changed"):
        studio.save(path, overwrite=True)
    assert read_picture(path).scene.ambient == 0.5
    studio.open(path)
    studio.undo()
    studio.save(path, overwrite=True)


def test_a_place_that_the_studio_never_read_is_overwritten_if_asked(tmp_path: Path) -> None:
    autocolor.write_scene(tmp_path / "car", car())
    outside_toml(tmp_path / "car" / "scene.toml")
    studio, _ = opened()
    studio.save_scene(tmp_path / "car", overwrite=True)
    (tmp_path / "car" / "scene.toml").unlink()
    studio.save_scene(tmp_path / "car")


@pytest.mark.skipif(os.name == "nt", reason="links need permissions there")
def test_a_file_is_known_by_its_links_and_a_link_to_another_file_is_a_change(tmp_path: Path) -> None:
    for name in ("one", "two"):
        autocolor.write_scene(tmp_path / name, car().replace(ambient=0.3 if name == "one" else 0.6))
    (tmp_path / "link").symlink_to("one")
    studio, _ = opened()
    studio.open(tmp_path / "link")
    outside_toml(tmp_path / "one" / "scene.toml")
    for name in ("link", "one"):
        with pytest.raises(OutputError, match="another program changed"):
            studio.save_scene(tmp_path / name, overwrite=True)
    studio.reopen()
    (tmp_path / "link").unlink()
    (tmp_path / "link").symlink_to("two")
    with pytest.raises(OutputError, match="another program changed"):
        studio.save_scene(tmp_path / "link", overwrite=True)
    assert read_scene(tmp_path / "two").ambient == 0.6


def test_a_change_while_the_save_waits_for_the_store_is_seen(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "box.sqlite"
    autocolor.write_scene(path, scene_of(cube()))
    studio, _ = opened()
    studio.open(path)
    begun = store_file.connected_to_change

    def connected(store: Path) -> sqlite3.Connection:
        outside_row(store)
        return begun(store)

    monkeypatch.setattr(store_file, "connected_to_change", connected)
    with pytest.raises(OutputError, match="another program changed"):
        studio.save_scene(path, overwrite=True)
    assert read_scene(path).view.angle == 7


def test_four_undos_after_a_reload_and_a_save_leave_the_scene_unsaved(tmp_path: Path) -> None:
    autocolor.write_scene(tmp_path / "car", car())
    studio, _ = opened()
    studio.open(tmp_path / "car")
    studio.recolor("body", blend=0.1)
    assert studio.reopen()
    studio.recolor("body", blend=0.2)
    studio.recolor("body", blend=0.3)
    saved = studio.save_session(tmp_path)
    for _ in range(3):
        studio.undo()
    assert studio.history.left_unsaved == ()
    studio.undo()
    assert studio.is_changed
    assert studio.save_session(tmp_path).scene == saved.scene
    assert not studio.is_changed
    assert read_scene(saved.scene).surface("body").paint.blend == studio.scene.surface("body").paint.blend
    studio.redo()
    assert studio.is_changed


def test_a_scene_that_was_shown_when_its_file_was_left_for_another_is_unsaved(tmp_path: Path) -> None:
    mesh_file = tmp_path / "box.obj"
    mesh_file.write_text("v 0 0 0\nv 1 0 0\nv 1 0 1\nf 1 2 3\n")
    autocolor.write_scene(tmp_path / "car", car())
    studio, _ = opened()
    for _ in range(2):
        studio.open(tmp_path / "car")
    first = studio.scene
    studio.recolor("body", blend=0.2)
    studio.save_session(tmp_path)
    assert studio.history.left_unsaved == ()
    studio.undo()
    studio.undo()
    assert studio.scene.equals(first)
    studio.keep_variant("A")
    studio.open(mesh_file)
    assert studio.history.left_unsaved == ("car",)
    assert studio.history.unsaved_variants == ("A",)
