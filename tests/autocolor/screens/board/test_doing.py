from __future__ import annotations

from functools import partial
from pathlib import Path

import pytest

from autocolor.errors import UsageError
from autocolor.scene.columns.column import Tier
from autocolor.screens.board.doing import Doing
from autocolor.screens.session import Session
from tests.autocolor.screens.boards import desk_viewer


@pytest.fixture
def session(tmp_path: Path) -> Session:
    return desk_viewer(tmp_path).session


def test_what_continues_is_one_step_and_what_does_not_another(session: Session) -> None:
    doing, before = Doing(session), session.scene
    for value, source, continues in ((0.1, "a", True), (0.2, "a", True), (0.3, "b", True), (0.4, "b", False)):
        change = partial(session.edit, session.scene.replace(ambient=value))
        assert doing.do((source, 0), change, continues, False)
        assert doing.was_by((source, 0))
        assert doing.kind == source
        assert doing.costs is Tier.MIX
    seen = []
    while session.studio.undo():
        seen.append(session.scene.ambient)
    assert seen == [0.3, 0.2, 0.0]
    assert session.scene is before


def test_an_error_is_a_message_and_what_does_nothing_leaves_the_last_one(session: Session) -> None:
    doing = Doing(session)

    def refuse() -> None:
        raise UsageError("a number must be one\nchoose it")

    assert doing.do(None, refuse, False, False)
    assert (session.message, session.news.is_warning) == ("a number must be one; choose it", True)
    assert not doing.do(None, lambda: False, False, False)
    assert session.message == "a number must be one; choose it"
    assert doing.do(None, lambda: None, False, False)
    assert session.message == ""
    assert doing.kind is None


def test_unsaved_changes_are_announced_once(session: Session) -> None:
    doing = Doing(session)
    session.has_keyboard = True
    assert not doing.warns_of_changes("again")
    session.edit(session.scene.replace(ambient=0.5))
    assert doing.warns_of_changes("again")
    assert session.message == "not saved: Ctrl+S saves, again"
    assert not doing.warns_of_changes("again")
    doing.do(None, lambda: None, False, False)
    assert doing.warns_of_changes("again")
