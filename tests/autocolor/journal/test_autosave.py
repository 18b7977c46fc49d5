"""What is kept of a session in the state folder, and when."""

from __future__ import annotations

import time
from pathlib import Path

import pytest

import autocolor
from autocolor import AutocolorError, Studio, read_journal, read_scene
from autocolor.journal import autosave
from autocolor.journal.autosave import JOURNAL, Autosave, left_sessions
from autocolor.journal.history import History
from autocolor.journal.script import Source
from ramtek_emu import Ramtek9300
from tests.autocolor.sessions import SMALL, car


@pytest.fixture
def source(tmp_path: Path) -> Source:
    autocolor.write_scene(tmp_path / "car", car())
    return Source(str(tmp_path / "car"))


@pytest.fixture
def history(source: Source) -> History:
    return History(read_scene(source.path))


def take(history: History, ambient: float) -> None:
    history.take(history.scene.replace(ambient=ambient))


def journals(state: Path) -> list[Path]:
    return sorted(state.glob(f"sessions/*/{JOURNAL}"))


def test_nothing_is_written_before_the_first_step(source: Source, history: History, state: Path) -> None:
    kept = Autosave(source)
    kept.update(history, at_once=True)
    kept.end()
    assert not state.exists()


def test_what_is_kept_is_the_session_and_goes_when_it_ends(
    source: Source, history: History, state: Path
) -> None:
    kept = Autosave(source)
    take(history, 0.5)
    kept.update(history)
    (path,) = journals(state)
    assert read_journal(path).history.scene.ambient == 0.5
    kept.end()
    kept.end()
    assert list((state / "sessions").iterdir()) == []


def test_it_is_written_once_a_second_and_only_after_steps(
    source: Source, history: History, state: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    now = 100.0
    monkeypatch.setattr(time, "monotonic", lambda: now)
    kept = Autosave(source)
    take(history, 0.5)
    kept.update(history)
    (path,) = journals(state)
    first = path.read_text()
    take(history, 0.6)
    now = 100.9
    kept.update(history)
    assert path.read_text() == first
    now = 101.0
    kept.update(history)
    assert path.read_text() == f"{first}studio.edit(studio.scene.replace(ambient=0.6))\n"
    path.unlink()
    now = 110.0
    kept.update(history)
    assert not path.exists()
    kept.end()


def test_every_text_is_that_of_the_session_whatever_was_taken(
    source: Source, state: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(autosave, "SECONDS_BETWEEN", 0.0)
    studio = Studio(read_scene(source.path), Ramtek9300(SMALL))
    kept = Autosave(source)

    def check() -> None:
        kept.update(studio.history)
        (path,) = journals(state)
        assert path.read_text() == studio.journal(source.path)

    studio.recolor("body", blend=0.25)
    check()
    for angle in (1, 2, 0, 3, 0, 4):
        studio.edit(studio.scene.with_view(angle=angle), same_step=angle != 1)
        check()
    for move in (studio.undo, studio.undo, studio.redo):
        move()
        check()
    kept.end()


def test_a_scene_of_no_file_is_saved_beside(source: Source, history: History, state: Path) -> None:
    kept = Autosave(source)
    take(history, 0.5)
    kept.update(history, at_once=True)
    opened = History(car().with_light("key", on=False))
    kept.update(opened, at_once=True)
    assert journals(state) == []
    take(opened, 0.7)
    kept.update(opened, at_once=True)
    (path,) = journals(state)
    session = read_journal(path)
    assert session.source.path == str(path.parent / "scene")
    assert not session.history.scene.light("key").on
    assert session.history.scene.ambient == 0.7
    kept.end()
    assert list((state / "sessions").iterdir()) == []


def test_a_session_is_left_when_its_program_is_gone(source: Source, history: History, state: Path) -> None:
    assert left_sessions() == []
    kept = Autosave(source)
    take(history, 0.5)
    kept.update(history)
    assert left_sessions() == []
    (path,) = journals(state)
    (state / "sessions" / "left").mkdir()
    (state / "sessions" / "left" / JOURNAL).write_bytes(path.read_bytes())
    (state / "sessions" / "empty").mkdir()
    assert left_sessions() == [state / "sessions" / "left"]
    again = Autosave(source, left_sessions()[0])
    assert left_sessions() == []
    with pytest.raises(AutocolorError, match="another one does"):
        Autosave(source, state / "sessions" / "left")
    for each in (kept, again):
        each.end()
    assert not (state / "sessions" / "left").exists()


def test_a_session_that_is_gone_on_with_is_kept_where_it_was(
    source: Source, history: History, state: Path
) -> None:
    left = state / "sessions" / "left"
    left.mkdir(parents=True)
    take(history, 0.5)
    kept = Autosave(source, left)
    kept.update(history)
    assert journals(state) == [left / JOURNAL]
    kept.end()


def test_a_state_folder_that_cannot_be_written_is_told_and_tried_again(
    source: Source, history: History, state: Path
) -> None:
    state.parent.mkdir(parents=True, exist_ok=True)
    state.write_text("no folder")
    kept = Autosave(source)
    take(history, 0.5)
    with pytest.raises(AutocolorError) as refusal:
        kept.update(history, at_once=True)
    assert str(refusal.value) == (
        "the journal of the session must be kept in the state folder, and cannot be (not a directory);"
        " save often"
    )
    assert left_sessions() == []
    state.unlink()
    kept.update(history, at_once=True)
    assert len(journals(state)) == 1
    kept.end()
