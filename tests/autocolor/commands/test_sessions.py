"""Real windows without a screen, which are killed, ended from outside, and gone on with."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from autocolor import UsageError, read_journal, read_scene
from autocolor.commands.sessions import autosaved_session, chosen_session
from autocolor.journal import autosave
from autocolor.journal.autosave import JOURNAL
from autocolor.journal.history import History
from autocolor.journal.places import Source, place_of
from autocolor.screens.viewer import Viewer
from ramtek_emu import Ramtek9300
from tests.autocolor.commands.conftest import ROOT, Run
from tests.autocolor.commands.test_view import monitors as monitors
from tests.autocolor.journal.random_steps import journal_of
from tests.small import SMALL, car
from tests.tables import first

WITHOUT_SCREEN = {"SDL_VIDEODRIVER": "dummy", "PYGAME_HIDE_SUPPORT_PROMPT": "1"}
"""Without the line that pygame prints, the first one is that of the first step."""

DRIVER = """
import sys, pygame
from autocolor.commands.autocolor import autocolor
from autocolor.screens.viewer import Viewer
from ramtek_emu.command_line import run_command

closes, on_tick = sys.argv.pop(1) == "close", Viewer.on_tick

def driven(self, *arguments):
    on_tick(self, *arguments)
    if closes:
        print(repr(self.studio), flush=True)
        pygame.event.post(pygame.event.Event(pygame.QUIT))
    else:
        # These steps were taken before this tick.
        print(len(self.studio.history.steps), flush=True)
        self.on_key("c", typed="c")

Viewer.on_tick = driven
run_command(autocolor, "autocolor")
"""


def start(how: str, *arguments: str, folder: Path) -> subprocess.Popen[str]:
    """The command, driven: it makes a step with each tick, or closes its window."""
    return subprocess.Popen(
        [sys.executable, "-c", DRIVER, how, *arguments],
        cwd=folder,
        env={**os.environ, "PYTHONPATH": str(ROOT), **WITHOUT_SCREEN},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


def ended(process: subprocess.Popen[str], number: int, state: Path) -> tuple[int, str]:
    """Send a signal to a program that edits once there is a journal; returns its steps and its stderr."""
    assert process.stdout is not None
    assert process.stderr is not None
    lines = [process.stdout.readline()]
    while not left(state) or lines[-1] == "0\n":
        lines.append(process.stdout.readline())
        assert lines[-1]
    process.send_signal(number)
    with process:
        # Unlike `communicate`, this also returns lines that have arrived already.
        lines += process.stdout.readlines()
        err = process.stderr.read()
    return max(int(line) for line in lines if line.endswith("\n")), err


def left(state: Path) -> list[Path]:
    return sorted(state.glob(f"sessions/*/{JOURNAL}"))


@pytest.mark.skipif(os.name == "nt", reason="Windows ends programs without a signal")
@pytest.mark.parametrize("name", first(1, ["SIGTERM", "SIGHUP"]))
def test_a_program_that_is_killed_or_ended_leaves_its_steps_to_be_recovered(
    folder: Path, state: Path, name: str
) -> None:
    process = start("work", "view", "scene", folder=folder)
    made, _ = ended(process, signal.SIGKILL, state)
    assert process.returncode == -signal.SIGKILL
    assert 0 < len(read_journal(left(state)[0]).history.steps) <= made + 1
    shutil.rmtree(state / "sessions")

    number = getattr(signal, name)
    process = start("work", "view", "two.obj", "--surfaces", "parts", folder=folder)
    made, err = ended(process, number, state)
    assert (process.returncode, err) == (128 + number, f"autocolor: ended by {name}\n")
    (path,) = left(state)
    steps = len(read_journal(path).history.steps)
    assert steps >= made > 0

    process = start("close", "view", "--recover", folder=folder)
    out, err = process.communicate(timeout=60)
    assert (process.returncode, err) == (0, "")
    assert f"Studio('two', to undo {steps}, to redo 0)" in out
    assert list((state / "sessions").iterdir()) == []


NONE_LEFT = (
    "there must be a session that was not closed and can be read, and there is none; open a scene instead"
)


def test_a_session_that_cannot_be_read_is_reported_and_the_session_before_is_tried(
    run: Run, state: Path
) -> None:
    for number, name in enumerate(("older", "newer")):
        (state / "sessions" / name).mkdir(parents=True)
        (state / "sessions" / name / JOURNAL).write_text("print()\n")
        os.utime(state / "sessions" / name / JOURNAL, (number, number))
    ran = run("view", "--recover")
    assert (ran.code, ran.out) == (66, "")
    newer, older, last = ran.err.splitlines()
    assert newer.startswith(f"autocolor: {state / 'sessions' / 'newer'}: session.jsonl: ")
    assert older.startswith(f"autocolor: {state / 'sessions' / 'older'}: session.jsonl: ")
    assert last == f"autocolor: {NONE_LEFT}"
    assert len(left(state)) == 2


def test_a_journal_that_cannot_be_written_is_told_once_and_the_session_goes_on(
    state: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    state.parent.mkdir(parents=True)
    state.write_text("no folder")
    viewer = Viewer(car(), Ramtek9300(SMALL))
    with autosaved_session(viewer) as update:
        viewer.on_key("c", typed="c")
        update()
        assert viewer.message.startswith("the journal of the session must be kept in the state folder, and")
        viewer.on_key("c", typed="c")
        message = viewer.message
        monkeypatch.setattr(autosave, "SECONDS_BETWEEN", 0.0)
        update()
        assert viewer.message == message
    assert len(viewer.studio.history.steps) == 2


# Sessions that were left: listed, chosen, forgotten, and recovered in a window.


@pytest.fixture
def sessions(folder: Path, state: Path) -> Path:
    """The folder of three sessions: an older one, a newer one of two steps, and one that cannot be read."""
    source = Source(str(folder / "scene"))
    for number, name in enumerate(("2026-01-01-a", "2026-01-02-b", "2026-01-02-c")):
        (state / "sessions").mkdir(parents=True, exist_ok=True)
        history = History(read_scene(source.path), place_of(source))
        for ambient in range(number + 1):
            history.take(history.scene.replace(ambient=0.3 + ambient))
        path = journal_of(history, state / "sessions" / name)
        if name.endswith("c"):
            path.write_text("print()\n")
        os.utime(path, (86400 * 400 + number, 86400 * 400 + number))
    return state / "sessions"


def test_a_session_is_named_by_the_beginning_of_its_name(sessions: Path) -> None:
    assert chosen_session("2026-01-01")[1].history.scene.ambient == 0.3
    for name, count in (("2026-01", 3), ("2026-01-02", 2), ("x", 0), ("", 0)):
        with pytest.raises(UsageError) as caught:
            chosen_session(name)
        assert str(caught.value) == (
            f"SESSION must begin the name of one session, and {name!r} begins {count}; choose a name from"
            " `autocolor view --sessions`"
        )


def test_sessions_are_listed_with_their_scene_and_steps(sessions: Path, folder: Path, run: Run) -> None:
    ran = run("view", "--sessions")
    lines = ran.out.splitlines()
    assert (ran.code, ran.err, len(lines)) == (0, "", 3)
    assert lines[0].startswith("2026-01-02-c  1971-02-0")
    assert "  session.jsonl: " in lines[0]
    assert lines[1].endswith(f"  {folder / 'scene'}, 2 steps")
    assert lines[2].endswith(f"  {folder / 'scene'}, 1 step")


def link_folder(session: Path, precious: Path) -> None:
    shutil.rmtree(session)
    session.symlink_to(precious)


def make_pipe(session: Path, _: Path) -> None:
    (session / JOURNAL).unlink()
    os.mkfifo(session / JOURNAL)


HOSTILE: dict[str, tuple[Callable[[Path, Path], object], str]] = {
    "a link": (link_folder, "hostile: it must not be a link; "),
    "no journal": (lambda session, _: (session / JOURNAL).rename(session / "x"), "there is no such file"),
    "a journal that is a pipe": (make_pipe, "must be a regular file"),
    "an endless time": (lambda session, _: os.utime(session / JOURNAL, (1 << 60, 1 << 60)), ", 1 step"),
}


@pytest.mark.skipif(os.name == "nt", reason="links need permissions there")
@pytest.mark.parametrize("name", HOSTILE)
def test_a_hostile_session_is_listed_and_forgotten_and_no_link_is_followed(
    sessions: Path, run: Run, tmp_path: Path, name: str
) -> None:
    session, precious = sessions / "hostile", tmp_path / "precious"
    shutil.copytree(sessions / "2026-01-01-a", session)
    shutil.copytree(session, precious)
    hostile, reason = HOSTILE[name]
    hostile(session, precious)
    before = {path: path.read_bytes() for path in precious.iterdir()}
    ran = run("view", "--sessions")
    assert (ran.code, ran.err, len(ran.out.splitlines())) == (0, "", 4)
    (line,) = (line for line in ran.out.splitlines() if line.startswith("hostile  "))
    assert reason in line
    assert run("view", "--forget", "hostile") == (0, "", "autocolor: hostile is removed\n")
    assert not os.path.lexists(session)
    assert {path: path.read_bytes() for path in precious.iterdir()} == before
    assert len(run("view", "--sessions").out.splitlines()) == 3


def test_a_session_that_was_left_is_mentioned_where_a_scene_is_shown(
    sessions: Path, run: Run, monitors: list[Any]
) -> None:
    told = "; `autocolor view --recover` opens the last session, `--sessions` lists them, `--forget SESSION`"
    ran = run("view", "scene")
    assert ran.err.startswith("autocolor: 3 sessions were not closed, last written 1971-02-0")
    assert ran.err.endswith(f"{told} removes a session\n")
    assert "a session was not closed: file, recover opens it; " in monitors[1].caption
    for name in ("2026-01-01", "2026-01-02-c"):
        assert run("view", "--forget", name).code == 0
    assert run("view", "scene").err.startswith("autocolor: a session was not closed, last written 1971-02-0")


def test_a_session_is_gone_on_with_in_full_screen_and_removed_when_it_ends(
    sessions: Path, run: Run, monitors: list[Any]
) -> None:
    assert run("view", "--recover", "2026-01-01", "--full-screen", "--fit").code == 0
    assert (monitors[1].full_screen, monitors[1].glass.fit) == (True, True)
    assert monitors[1].caption.startswith("autocolor - scene* - ")
    assert not (sessions / "2026-01-01-a").exists()
    assert (sessions / "2026-01-02-b").exists()
