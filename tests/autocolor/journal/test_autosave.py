"""The journal in the state folder: when it is written, and what is left however a program ends."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import time
from pathlib import Path

import pytest

import autocolor
from autocolor import AutocolorError, InputError, read_journal, read_scene
from autocolor.files.state import lock_file
from autocolor.journal import autosave as autosave_module
from autocolor.journal.autosave import (
    JOURNAL,
    LOCK,
    Autosave,
    forget,
    left_sessions,
    refuse_links,
)
from autocolor.journal.history import History
from autocolor.journal.places import ScenePlace, Source
from tests.autocolor.journal.random_steps import journal_of, summary
from tests.small import car
from tests.tables import first

ROOT = Path(__file__).parents[3]


@pytest.fixture
def source(tmp_path: Path) -> Source:
    autocolor.write_scene(tmp_path / "car", car())
    return Source(str(tmp_path / "car"))


@pytest.fixture
def history(source: Source) -> History:
    return History(read_scene(source.path), ScenePlace(source))


@pytest.fixture
def left(history: History, state: Path) -> Path:
    """The folder of a session of one step that was left."""
    (state / "sessions").mkdir(parents=True)
    edit(history, 0.5)
    return journal_of(history, state / "sessions" / "left").parent


def edit(history: History, ambient: float, same_step: bool = False) -> None:
    history.take(history.scene.replace(ambient=ambient), same_step)


def journals(state: Path) -> list[Path]:
    return sorted(state.glob(f"sessions/*/{JOURNAL}"))


def test_nothing_is_written_before_the_first_step(history: History, state: Path) -> None:
    autosave = Autosave()
    autosave.update(history, at_once=True)
    autosave.end()
    assert not state.exists()


def test_the_journal_is_removed_when_the_session_ends(history: History, state: Path) -> None:
    autosave = Autosave()
    edit(history, 0.5)
    autosave.update(history)
    (path,) = journals(state)
    assert read_journal(path).history.scene.ambient == 0.5
    autosave.end()
    autosave.end()
    assert list((state / "sessions").iterdir()) == []


def test_lines_are_appended_once_a_second_and_only_after_steps(
    history: History, state: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    now = 100.0
    monkeypatch.setattr(time, "monotonic", lambda: now)
    autosave = Autosave()
    edit(history, 0.5)
    autosave.update(history)
    (path,) = journals(state)
    before, number = path.read_text(), path.stat().st_ino
    edit(history, 0.6)
    now = 100.9
    autosave.update(history)
    assert path.read_text() == before
    now = 101.0
    autosave.update(history)
    line = '{"step": "edit", "change": "replace", "row": null, "columns": {"ambient": 0.6}, "mesh": null, '
    assert path.read_text() == f'{before}{line}"joins": false}}\n'
    assert path.stat().st_ino == number
    path.unlink()
    now = 110.0
    autosave.update(history)
    assert not path.exists()
    autosave.end()


def test_a_first_scene_of_no_file_is_saved_beside_the_journal(state: Path) -> None:
    autosave = Autosave()
    unsaved = History(car().with_light("key", on=False))
    autosave.update(unsaved, at_once=True)
    assert journals(state) == []
    edit(unsaved, 0.7)
    autosave.update(unsaved, at_once=True)
    (path,) = journals(state)
    session = read_journal(path)
    assert session.source.path == str(path.parent / "scene")
    assert not session.history.scene.lights["key"].on
    assert session.history.scene.ambient == 0.7
    autosave.end()
    assert list((state / "sessions").iterdir()) == []


def test_a_session_is_left_when_no_program_has_its_lock(history: History, left: Path, state: Path) -> None:
    autosave = Autosave()
    autosave.update(history)
    assert len(journals(state)) == 2
    assert left_sessions() == [left]
    again = Autosave(left)
    assert left_sessions() == []
    for refused in (Autosave, forget):
        with pytest.raises(AutocolorError, match="another one does"):
            refused(left)
    for each in (autosave, again):
        each.end()
    assert journals(state) == []


def test_sessions_that_were_left_are_listed_the_last_first(history: History, left: Path) -> None:
    folders = [journal_of(history, left.with_name(name)).parent for name in ("c", "a", "d", "b")]
    for age, folder in enumerate((left, *folders)):
        os.utime(folder / JOURNAL, (1e9 - age, 1e9 - age))
    assert left_sessions() == [left, *folders]


def test_a_session_that_goes_on_has_its_journal_in_the_same_folder(left: Path, state: Path) -> None:
    journal = left / JOURNAL
    # The program was killed while it wrote a line.
    journal.write_bytes(journal.read_bytes() + b'{"step": "un')
    history = read_journal(journal).history
    autosave = Autosave(left)
    edit(history, 0.6)
    autosave.update(history)
    assert journals(state) == [journal]
    assert summary(read_journal(journal).history) == summary(history)
    autosave.end()
    assert not left.exists()


def test_a_journal_that_cannot_be_written_is_written_whole_by_the_next_update(
    history: History, state: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    state.parent.mkdir(parents=True, exist_ok=True)
    state.write_text("no folder")
    autosave = Autosave()
    edit(history, 0.5)
    with pytest.raises(AutocolorError) as refusal:
        autosave.update(history, at_once=True)
    assert str(refusal.value) == (
        "the journal of the session must be kept in the state folder, and cannot be (not a directory);"
        " save often"
    )
    assert left_sessions() == []
    state.unlink()
    autosave.update(history, at_once=True)
    (path,) = journals(state)

    def append_half(path: Path, data: bytes) -> None:
        path.write_bytes(path.read_bytes() + data[: len(data) // 2])
        raise OSError(28, "No space left on device")

    with monkeypatch.context() as patched:
        patched.setattr(autosave_module, "_append", append_half)
        edit(history, 0.6)
        with pytest.raises(AutocolorError, match="no space left on device"):
            autosave.update(history, at_once=True)
    assert read_journal(path).history.scene.ambient == 0.5
    edit(history, 0.7)
    autosave.update(history, at_once=True)
    assert summary(read_journal(path).history) == summary(history)
    autosave.end()


def test_folders_of_sessions_that_wrote_nothing_are_removed(state: Path) -> None:
    sessions = state / "sessions"
    for name in ("empty", "with a lock", "with a part", "in use", "with a scene"):
        (sessions / name).mkdir(parents=True)
    (sessions / "with a lock" / "lock").touch()
    (sessions / "with a part" / f".{JOURNAL}.0a1b.part").touch()
    (sessions / "with a scene" / "scene").mkdir()
    (sessions / "notes.txt").touch()
    lock = lock_file(sessions / "in use" / "lock")
    assert left_sessions() == [sessions / "with a scene"]
    assert sorted(os.listdir(sessions)) == ["in use", "notes.txt", "with a scene"]
    assert lock is not None
    os.close(lock)
    assert left_sessions() == [sessions / "with a scene"]
    assert sorted(os.listdir(sessions)) == ["notes.txt", "with a scene"]


def test_a_folder_that_is_removed_before_it_is_locked_is_made_anew(
    history: History, state: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    tries: list[Path] = []

    def swept(path: Path) -> int | None:
        """Another program removes the first folder when it has its lock, and the second before."""
        tries.append(path)
        if len(tries) == 2:
            path.parent.rmdir()
        lock = lock_file(path)
        if len(tries) == 1:
            shutil.rmtree(path.parent)
        return lock

    monkeypatch.setattr(autosave_module, "lock_file", swept)
    autosave = Autosave()
    edit(history, 0.5)
    autosave.update(history)
    assert [path.parent for path in journals(state)] == [tries[2].parent]
    autosave.end()


EDITING = """
import itertools, sys
from autocolor.journal.autosave import Autosave
from autocolor.journal.history import History
from autocolor.journal.places import Source, opened

history, autosave = History(*opened(Source(sys.argv[1]))), Autosave()
for number in itertools.count(1):
    history.take(history.scene.replace(ambient=number % 1000 / 1000 + 0.5))
    autosave.update(history, at_once=True)
    print(number, flush=True)
"""


@pytest.mark.skipif(os.name == "nt", reason="Windows ends programs without a signal")
@pytest.mark.parametrize("count", first(1, [20, 1, 90]))
def test_a_program_that_is_killed_leaves_every_step_that_was_written(
    source: Source, tmp_path: Path, count: int
) -> None:
    environment = {**os.environ, "XDG_STATE_HOME": str(tmp_path / "state"), "PYTHONPATH": str(ROOT)}
    command = [sys.executable, "-c", EDITING, source.path]
    with subprocess.Popen(command, env=environment, stdout=subprocess.PIPE, text=True) as program:
        assert program.stdout is not None
        lines = [program.stdout.readline() for _ in range(count)]
        program.kill()
        # Unlike `communicate`, this also returns lines that have arrived already.
        lines += program.stdout.readlines()
    (path,) = (tmp_path / "state").glob(f"autocolor/sessions/*/{JOURNAL}")
    steps = len(read_journal(path).history.steps)
    written = [int(line) for line in lines if line.endswith("\n")]
    assert written[-1] <= steps <= written[-1] + 1


@pytest.mark.parametrize("name", ["", JOURNAL, LOCK])
def test_a_session_that_is_a_link_or_holds_one_is_refused(tmp_path: Path, name: str) -> None:
    folder, elsewhere = tmp_path / "session", tmp_path / "elsewhere"
    if name:
        folder.mkdir()
    refuse_links(folder)
    (folder / name).symlink_to(elsewhere)
    with pytest.raises(InputError, match="it must not be a link; `autocolor view"):
        refuse_links(folder)
