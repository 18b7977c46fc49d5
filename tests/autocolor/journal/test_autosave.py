"""What is kept of a session in the state folder, and when."""

from __future__ import annotations

import os
import random
import shutil
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

import autocolor
from autocolor import AutocolorError, Mesh, Studio, read_journal, read_scene
from autocolor.journal import autosave
from autocolor.journal.autosave import JOURNAL, Autosave, forget, left_sessions
from autocolor.journal.history import History
from autocolor.journal.opening import checksum_of, opened
from autocolor.journal.places import Place, Source
from ramtek_emu import Ramtek9300
from tests.autocolor.sessions import SMALL, car

ROOT = Path(__file__).parents[3]


@pytest.fixture
def source(tmp_path: Path) -> Source:
    autocolor.write_scene(tmp_path / "car", car())
    return Source(str(tmp_path / "car"))


@pytest.fixture
def history(source: Source) -> History:
    return History(read_scene(source.path), Place(source))


def take(history: History, ambient: float) -> None:
    history.take(history.scene.replace(ambient=ambient))


def journals(state: Path) -> list[Path]:
    return sorted(state.glob(f"sessions/*/{JOURNAL}"))


def test_nothing_is_written_before_the_first_step(source: Source, history: History, state: Path) -> None:
    kept = Autosave()
    kept.update(history, at_once=True)
    kept.end()
    assert not state.exists()


def test_what_is_kept_is_the_session_and_goes_when_it_ends(
    source: Source, history: History, state: Path
) -> None:
    kept = Autosave()
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
    kept = Autosave()
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
    studio = Studio(History(read_scene(source.path), Place(source)), Ramtek9300(SMALL))
    kept = Autosave()

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


def test_a_scene_of_no_file_is_saved_beside(state: Path) -> None:
    kept = Autosave()
    unsaved = History(car().with_light("key", on=False))
    kept.update(unsaved, at_once=True)
    assert journals(state) == []
    take(unsaved, 0.7)
    kept.update(unsaved, at_once=True)
    (path,) = journals(state)
    session = read_journal(path)
    assert session.source.path == str(path.parent / "scene")
    assert not session.history.scene.light("key").on
    assert session.history.scene.ambient == 0.7
    kept.end()
    assert list((state / "sessions").iterdir()) == []


def test_a_session_is_left_when_its_program_is_gone(source: Source, history: History, state: Path) -> None:
    assert left_sessions() == []
    kept = Autosave()
    take(history, 0.5)
    kept.update(history)
    assert left_sessions() == []
    (path,) = journals(state)
    (state / "sessions" / "left").mkdir()
    (state / "sessions" / "left" / JOURNAL).write_bytes(path.read_bytes())
    (state / "sessions" / "empty").mkdir()
    assert left_sessions() == [state / "sessions" / "left"]
    again = Autosave(left_sessions()[0])
    assert left_sessions() == []
    with pytest.raises(AutocolorError, match="another one does"):
        Autosave(state / "sessions" / "left")
    for each in (kept, again):
        each.end()
    assert not (state / "sessions" / "left").exists()


def test_a_session_that_is_gone_on_with_is_kept_where_it_was(
    source: Source, history: History, state: Path
) -> None:
    left = state / "sessions" / "left"
    left.mkdir(parents=True)
    take(history, 0.5)
    kept = Autosave(left)
    kept.update(history)
    assert journals(state) == [left / JOURNAL]
    kept.end()


def test_what_is_opened_and_a_changed_mesh_are_kept_once_and_recovered(
    source: Source, history: History, state: Path
) -> None:
    kept = Autosave()
    mesh = history.scene.mesh
    larger = Mesh(mesh.coordinates * 2, mesh.node_numbers, mesh.part_numbers, mesh.part_names)
    history.take(history.scene.replace(mesh=larger))
    opened_again = opened(source)
    history.open(opened_again, source)
    kept.update(history, at_once=True)
    (path,) = journals(state)
    session = read_journal(path)
    assert np.array_equal(session.history.to_undo[1].mesh.coordinates, larger.coordinates)
    assert checksum_of(session.history.scene) == checksum_of(opened_again.scene)
    folders = sorted(each.name for each in path.parent.iterdir())
    assert folders == ["lock", "scene-2", "session.py"]
    # A session that is gone on with saves no mesh again.
    text = path.read_text()
    left = state / "sessions" / "left"
    shutil.copytree(path.parent, left)
    (left / JOURNAL).write_text(text.replace(str(path.parent), str(left)))
    again = Autosave(left)
    recovered = read_journal(left / JOURNAL).history
    again.update(recovered, at_once=True)
    assert sorted(each.name for each in left.iterdir()) == folders
    assert (left / JOURNAL).read_text() == text.replace(str(path.parent), str(left))
    for each in (kept, again):
        each.end()


def test_a_session_that_was_left_can_be_forgotten(source: Source, history: History, state: Path) -> None:
    left = state / "sessions" / "left"
    left.mkdir(parents=True)
    (left / JOURNAL).write_text("")
    forget(left)
    assert left_sessions() == []
    assert not left.exists()
    kept = Autosave()
    take(history, 0.5)
    kept.update(history)
    with pytest.raises(AutocolorError, match="another one does"):
        forget(journals(state)[0].parent)
    assert len(journals(state)) == 1
    kept.end()


EDITING = """
import itertools, sys, time
import autocolor
from autocolor.journal.autosave import Autosave
from autocolor.journal.history import History
from autocolor.journal.places import Source
from autocolor.journal.opening import opened

scene, place = opened(Source(sys.argv[1]))
history, kept = History(scene, place), Autosave()
for number in itertools.count():
    history.take(history.scene.replace(ambient=number % 1000 / 1000 + 0.5))
    print(time.time(), len(history.steps), flush=True)
    kept.update(history)
    time.sleep(0.005)
"""


@pytest.mark.skipif(os.name == "nt", reason="Windows ends programs without a signal")
def test_programs_that_are_killed_at_any_moment_lose_at_most_two_seconds(
    source: Source, tmp_path: Path
) -> None:
    programs = []
    for number in range(4):
        environment = {**os.environ, "XDG_STATE_HOME": str(tmp_path / f"{number}"), "PYTHONPATH": str(ROOT)}
        programs.append(
            subprocess.Popen(
                [sys.executable, "-c", EDITING, source.path],
                env=environment,
                stdout=subprocess.PIPE,
                text=True,
            )
        )
    # Each has begun when it tells its first step.
    told = [[program.stdout.readline()] for program in programs if program.stdout is not None]
    killed = []
    # The last one lives long enough to have much to lose.
    moments = [*sorted(random.uniform(0.05, 3.0) for _ in programs[1:]), random.uniform(3.0, 4.0)]
    for program, after in zip(programs, moments, strict=True):
        time.sleep(max(0.0, after - (time.time() - float(told[0][0].split()[0]))))
        killed.append(time.time())
        program.kill()
    for number, program in enumerate(programs):
        rest = program.communicate(timeout=30)[0].splitlines(keepends=True)
        rows = [line.split() for line in told[number] + rest if line.endswith("\n")]
        due = max((int(steps) for when, steps in rows if float(when) <= killed[number] - 2), default=0)
        found = list((tmp_path / f"{number}").glob(f"autocolor/sessions/*/{JOURNAL}"))
        steps = len(read_journal(found[0]).history.steps) if found else 0
        assert due <= steps <= int(rows[-1][1]) + 1
    assert due > 0


def test_a_state_folder_that_cannot_be_written_is_told_and_tried_again(
    source: Source, history: History, state: Path
) -> None:
    state.parent.mkdir(parents=True, exist_ok=True)
    state.write_text("no folder")
    kept = Autosave()
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
