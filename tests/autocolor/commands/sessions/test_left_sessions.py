"""Sessions that did not end orderly: listed, chosen, forgotten, and gone on with in a window."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import pytest

from autocolor import MissingInputError, UsageError, read_scene
from autocolor.commands.sessions.left_sessions import NEWEST, chosen_session, forget_session
from autocolor.journal.autosave import JOURNAL
from autocolor.journal.history import History
from autocolor.journal.meshes_beside import MeshesBeside
from autocolor.journal.places import Source
from autocolor.journal.script import journal_text
from tests.autocolor.commands.conftest import Run
from tests.autocolor.commands.test_view import monitors as monitors


@pytest.fixture
def left(folder: Path, state: Path) -> Path:
    """The folder of three sessions: an older one, a newer one of two steps, and one that cannot be read."""
    for number, name in enumerate(("2026-01-01-a", "2026-01-02-b", "2026-01-02-c")):
        path = state / "sessions" / name / JOURNAL
        path.parent.mkdir(parents=True)
        history = History(read_scene(folder / "scene"))
        for ambient in range(number + 1):
            history.take(history.scene.replace(ambient=0.3 + ambient))
        text = journal_text(history, Source(str(folder / "scene")), MeshesBeside())
        path.write_text("print()\n" if name.endswith("c") else text)
        os.utime(path, (86400 * 400 + number, 86400 * 400 + number))
    return state / "sessions"


def test_the_newest_that_can_be_read_is_chosen(left: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder, session = chosen_session(NEWEST)
    assert folder == left / "2026-01-02-b"
    assert session.history.scene.ambient == 1.3
    assert "a journal must begin as autocolor writes it" in capsys.readouterr().err


def test_a_session_is_named_by_the_beginning_of_its_name(left: Path) -> None:
    assert chosen_session("2026-01-01")[1].history.scene.ambient == 0.3
    for name, found in (("2026-01", "several of these"), ("x", "none of these"), ("", "none of these")):
        with pytest.raises(UsageError) as refusal:
            chosen_session(name)
        assert str(refusal.value) == (
            f"a session must be named by the beginning of its name and no other's, and {name!r} is {found};"
            " `autocolor view --sessions` lists them"
        )


def test_sessions_are_listed_with_their_scene_and_steps(left: Path, folder: Path, run: Run) -> None:
    ran = run("view", "--sessions")
    lines = ran.out.splitlines()
    assert (ran.code, ran.err, len(lines)) == (0, "", 3)
    assert lines[0].startswith("2026-01-02-c  1971-02-0")
    assert lines[0].endswith("session.py: a journal must begin as autocolor writes it; choose another file")
    assert lines[1].endswith(f"  {folder / 'scene'}, 2 steps")
    assert lines[2].endswith(f"  {folder / 'scene'}, 1 step")


def test_a_session_is_forgotten_and_no_other(left: Path, run: Run) -> None:
    assert run("view", "--forget", "2026-01-02-c") == (0, "", "autocolor: 2026-01-02-c is removed\n")
    assert sorted(path.name for path in left.iterdir()) == ["2026-01-01-a", "2026-01-02-b"]
    with pytest.raises(UsageError):
        forget_session("2026-01-02-c")


def test_without_any_a_scene_is_asked_for() -> None:
    with pytest.raises(MissingInputError, match="--recover: there must be a session that did not end"):
        chosen_session(NEWEST)


def test_a_session_is_gone_on_with_in_full_screen_and_removed_when_it_ends(
    left: Path, run: Run, monitors: list[Any]
) -> None:
    assert run("view", "--recover", "2026-01-01", "--full-screen", "--fit").code == 0
    assert (monitors[1].full_screen, monitors[1].fit) == (True, True)
    assert monitors[1].caption.startswith("autocolor - scene* - ")
    assert not (left / "2026-01-01-a").exists()
    assert (left / "2026-01-02-b").exists()


@pytest.mark.parametrize(
    "arguments",
    [(), ("scene", "--recover"), ("--recover", "--sessions"), ("--sessions", "--forget", "2026")],
)
def test_a_scene_or_one_thing_with_sessions_is_asked_for(
    left: Path, run: Run, arguments: tuple[str, ...]
) -> None:
    ran = run("view", *arguments)
    count = sum(not each.startswith("2026") for each in arguments)
    assert (ran.code, ran.out) == (2, "")
    assert ran.err == (
        "autocolor: view must have one of SCENE, --recover, --sessions and --forget, not"
        f" {count}; name a scene\n"
    )


def test_what_is_set_is_set_in_a_scene(left: Path, run: Run) -> None:
    ran = run("view", "--set", "ambient=1", "--sessions")
    assert (ran.code, ran.err) == (2, "autocolor: --set is for SCENE, not for sessions; leave it out\n")
