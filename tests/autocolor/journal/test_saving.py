"""Saving scene and picture under names that the program chooses; no file is lost."""

from __future__ import annotations

import os
import shutil
import sqlite3
from contextlib import closing
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest
from hypothesis import given
from hypothesis import strategies as st

import autocolor
from autocolor import OutputError, Studio, UsageError, WriteError, read_picture, read_scene, write_picture
from autocolor.files.paths import PACKAGE
from autocolor.journal.history import History
from autocolor.journal.places import ScenePlace, Source, opened
from autocolor.journal.saving import SavedFiles
from ramtek_emu import Ramtek9300
from tests.small import SMALL, car

COMMENT = "# The car of the fair.\n"


@pytest.fixture
def scene_file(tmp_path: Path) -> Path:
    """A scene file with a comment, in a folder beside the one in which is saved."""
    path = tmp_path / "scenes" / "car" / "scene.toml"
    path.parent.parent.mkdir()
    autocolor.write_scene(path, car())
    path.write_text(COMMENT + path.read_text())
    return path


@pytest.fixture
def work(tmp_path: Path) -> Path:
    (tmp_path / "work").mkdir()
    return tmp_path / "work"


def studio_of(path: Path) -> Studio:
    scene, place = opened(Source(str(path)))
    return Studio(History(scene, place), Ramtek9300(SMALL))


def contents(folder: Path) -> dict[str, bytes]:
    return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def test_a_scene_of_no_file_is_saved_to_new_names_and_then_to_the_same(work: Path) -> None:
    studio = Studio(car().replace(name="coupe"), Ramtek9300(SMALL))
    studio.recolor("body", blend=0.25)
    saved = studio.save_session(work)
    assert saved == SavedFiles(work / "coupe" / "scene.toml", work / "coupe.npz")
    assert saved.message(work) == "saved coupe/scene.toml and coupe.npz".replace("/", os.sep)
    assert not studio.is_changed
    studio.recolor("body", blend=0.5)
    assert studio.save_session(work) == saved
    assert read_scene(work / "coupe").surfaces["body"].paint.blend == 0.5
    assert read_picture(work / "coupe.npz").scene.surfaces["body"].paint.blend == 0.5
    assert sorted(path.name for path in work.iterdir()) == ["coupe", "coupe.npz"]


@pytest.mark.parametrize("there", ["car", "car.npz"])
def test_new_names_are_those_that_neither_file_has(work: Path, there: str) -> None:
    (work / there).write_text("mine")
    studio = Studio(car().replace(name="car"), Ramtek9300(SMALL))
    saved = studio.save_session(work)
    assert saved == SavedFiles(work / "car-2" / "scene.toml", work / "car-2.npz")
    assert (work / there).read_text() == "mine"


def test_a_scene_saved_under_a_name_belongs_to_the_new_files(scene_file: Path, work: Path) -> None:
    before = contents(scene_file.parent)
    studio = studio_of(scene_file)
    studio.recolor("body", blend=0.25)
    saved = studio.save_session(work, "red")
    assert saved == SavedFiles(work / "red" / "scene.toml", work / "red.npz")
    assert contents(scene_file.parent) == before
    assert (studio.scene.name, studio.file, studio.is_changed) == ("red", saved.scene, False)
    assert not studio.reopen()
    studio.recolor("body", blend=0.5)
    assert studio.save_session(scene_file.parent) == saved
    assert read_scene(saved.scene).surfaces["body"].paint.blend == 0.5
    assert read_picture(saved.picture).scene.name == "red"
    assert contents(scene_file.parent) == before


@pytest.mark.parametrize("there", ["red", "red.npz"])
def test_a_name_that_a_file_has_is_refused_and_nothing_is_written(
    scene_file: Path, work: Path, there: str
) -> None:
    (work / there).symlink_to(work / "nowhere")
    studio = studio_of(scene_file)
    before = studio.scene
    with pytest.raises(OutputError) as refusal:
        studio.save_session(work, "red")
    assert str(refusal.value) == (
        f"a new file must have a name of its own, and {there} exists; choose another"
    )
    assert [path.name for path in work.iterdir()] == [there]
    assert studio.scene is before
    assert studio.file == scene_file


@pytest.mark.parametrize("name", ["", "a/b"])
def test_an_invalid_name_is_refused_and_nothing_is_written(work: Path, name: str) -> None:
    studio = Studio(car(), Ramtek9300(SMALL))
    with pytest.raises(UsageError, match="a name must be"):
        studio.save_session(work, name)
    assert not list(work.parent.rglob("*.npz"))
    assert list(work.iterdir()) == []


def test_a_scene_that_could_not_be_saved_under_a_name_keeps_its_own(
    scene_file: Path, work: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(*_: object, **__: object) -> None:
        raise WriteError("the disk is full")

    studio = studio_of(scene_file)
    studio.recolor("body", blend=0.25)
    before, steps = studio.scene, len(studio.history.to_undo)
    for name in ("red", before.name):
        with monkeypatch.context() as patch:
            patch.setattr("autocolor.journal.saving.write_scene", fail)
            with pytest.raises(WriteError, match="full"):
                studio.save_session(work, name)
        assert studio.scene is before
        assert len(studio.history.to_undo) == steps
        assert (studio.file, studio.is_changed) == (scene_file, True)


def test_a_scene_file_keeps_its_comments_and_has_one_backup(scene_file: Path, work: Path) -> None:
    before = scene_file.read_text()
    studio = studio_of(scene_file.parent)
    studio.recolor("body", blend=0.25)
    saved = studio.save_session(work)
    backup = scene_file.with_name("scene-2.toml")
    assert saved == SavedFiles(scene_file, work / "car.npz", (backup,))
    assert saved.message(work) == f"saved {scene_file} and car.npz; what was there is in {backup}"
    assert backup.read_text() == before
    assert scene_file.read_text().startswith(COMMENT)
    assert read_scene(scene_file).surfaces["body"].paint.blend == 0.25
    studio.recolor("body", blend=0.5)
    assert studio.save_session(work) == SavedFiles(scene_file, work / "car.npz")
    assert [path.name for path in scene_file.parent.glob("scene*")].count("scene-3.toml") == 0
    assert read_scene(scene_file).surfaces["body"].paint.blend == 0.5


def test_the_backup_of_a_store_has_the_changes_that_are_only_in_its_log(work: Path) -> None:
    open_path, path = work / "open.sqlite", work / "car.sqlite"
    autocolor.write_scene(open_path, car())
    with closing(sqlite3.connect(open_path, isolation_level=None)) as other:
        other.execute("PRAGMA journal_mode = WAL")
        other.execute("UPDATE view SET angle = 7")
        # As a program leaves them that is killed.
        for ending in ("", "-wal", "-shm"):
            shutil.copy(f"{open_path}{ending}", f"{path}{ending}")
    studio = studio_of(path)
    studio.recolor("body", blend=0.25)
    (backup,) = studio.save_session(work).backups
    assert read_scene(backup).view.angle == 7
    assert read_scene(path).surfaces["body"].paint.blend == 0.25


def test_a_picture_file_that_was_opened_is_saved_to_and_has_a_backup(work: Path) -> None:
    Studio(car(), Ramtek9300(SMALL)).save(work / "old.npz")
    before = (work / "old.npz").read_bytes()
    studio = studio_of(work / "old.npz")
    studio.recolor("body", blend=0.25)
    saved = studio.save_session(work)
    assert saved == SavedFiles(work / "scene" / "scene.toml", work / "old.npz", (work / "old-2.npz",))
    assert (work / "old-2.npz").read_bytes() == before
    assert read_picture(work / "old.npz").scene.surfaces["body"].paint.blend == 0.25


def test_a_picture_of_ours_needs_no_backup_even_if_its_scene_could_not_be_written(
    work: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    studio = Studio(car(), Ramtek9300(SMALL))
    saved = studio.save_session(work)

    def full(*_: object, **__: object) -> None:
        raise WriteError("no space")

    with monkeypatch.context() as patched:
        patched.setattr("autocolor.journal.saving.write_scene", full)
        studio.recolor("body", blend=0.25)
        with pytest.raises(WriteError, match="no space"):
            studio.save_session(work)
    studio.recolor("body", blend=0.5)
    assert studio.save_session(work) == saved
    assert read_picture(saved.picture).scene.surfaces["body"].paint.blend == 0.5


def test_a_file_that_was_changed_since_is_left_alone_and_told(scene_file: Path, work: Path) -> None:
    studio = studio_of(scene_file.parent)
    scene_file.write_text(scene_file.read_text() + "# mine\n")
    before = contents(scene_file.parent)
    saved = studio.save_session(work)
    assert saved == SavedFiles(work / "car" / "scene.toml", work / "car.npz", (), (scene_file,))
    assert saved.message(work).endswith(f"; {scene_file} was changed since, and is left alone")
    assert contents(scene_file.parent) == before
    # Nor is what this session saved, when another program changed it since.
    (work / "car.npz").write_bytes(b"theirs")
    saved = studio.save_session(work)
    assert (saved.scene, saved.picture) == (work / "car" / "scene.toml", work / "car-2.npz")
    assert (work / "car.npz").read_bytes() == b"theirs"


def test_a_file_that_was_removed_is_no_loss(work: Path) -> None:
    studio = Studio(car().replace(name="car"), Ramtek9300(SMALL))
    saved = studio.save_session(work)
    saved.picture.unlink()
    assert studio.save_session(work) == saved
    assert read_picture(saved.picture).scene.name == "car"


def test_a_folder_that_cannot_be_written_is_left_for_the_own_one(
    scene_file: Path, work: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    studio = studio_of(scene_file)
    before = contents(scene_file.parent)
    monkeypatch.setattr(os, "access", lambda path, _: Path(path) != scene_file.parent)
    saved = studio.save_session(work)
    assert saved == SavedFiles(work / "car" / "scene.toml", work / "car.npz")
    assert contents(scene_file.parent) == before


def test_the_demo_is_never_saved_to(work: Path, monkeypatch: pytest.MonkeyPatch, scene_file: Path) -> None:
    from autocolor.journal import places

    monkeypatch.setattr(places, "PACKAGE", scene_file.parent.parent.resolve())
    before = contents(scene_file.parent)
    studio = studio_of(scene_file.parent)
    assert studio.save_session(work).scene == work / "car" / "scene.toml"
    assert contents(scene_file.parent) == before
    assert PACKAGE.name == "autocolor"


def test_a_place_without_a_stamp_is_not_saved_to(scene_file: Path, work: Path) -> None:
    history = History(read_scene(scene_file), ScenePlace(Source(str(scene_file))))
    saved = Studio(history, Ramtek9300(SMALL)).save_session(work)
    assert saved.scene == work / "car" / "scene.toml"


session_moves = st.lists(
    st.sampled_from(
        ["edit", "save", "open scene", "open picture", "undo", "redo", "write scene", "write picture"]
    )
    | st.just("save"),
    max_size=12,
)


@given(session_moves)
def test_whatever_was_there_is_still_somewhere(made: list[str]) -> None:
    with TemporaryDirectory() as name:
        folder = Path(name)
        autocolor.write_scene(folder / "car", car())
        studio = Studio(car().replace(name="car"), Ramtek9300(SMALL))
        studio.save(folder / "pic.npz")
        files = {"scene": folder / "car" / "scene.toml", "picture": folder / "pic.npz"}
        foreign = set(contents(folder).values())
        for number, move in enumerate(made):
            verb, _, what = move.partition(" ")
            if verb == "edit":
                studio.edit(studio.scene.replace(ambient=0.2 + number / 100))
            elif verb == "save":
                saved = studio.save_session(folder)
                assert not studio.is_changed
                assert read_scene(saved.scene).ambient == studio.scene.ambient
                assert read_picture(saved.picture).scene.ambient == studio.scene.ambient
                if number % 2:
                    files = {"scene": saved.scene, "picture": saved.picture}
            elif verb == "open":
                studio.open(files[what])
            elif verb == "write":
                # Another program changes a file; what that one held is its own affair.
                foreign.discard(files[what].read_bytes())
                if what == "scene":
                    files[what].write_text(f"{files[what].read_text()}# {number}\n")
                else:
                    other = studio.scene.replace(name=f"theirs {number}")
                    write_picture(files[what], other, studio.picture, overwrite=True)
                foreign.add(files[what].read_bytes())
            else:
                getattr(studio, verb)()
            assert foreign <= set(contents(folder).values()), move
