from __future__ import annotations

from pathlib import Path

import pytest

from autocolor.errors import UsageError
from autocolor.screens.board.typing_line import TypingLine
from autocolor.widgets.bars import Bar
from autocolor.widgets.widget import Entry
from tests.autocolor.screens.boards import desk_viewer


@pytest.fixture
def typing(tmp_path: Path) -> TypingLine:
    session = desk_viewer(tmp_path).session
    session.has_keyboard = True
    return TypingLine(session)


def typed(typing: TypingLine, signs: str) -> None:
    for sign in signs:
        typing.key(sign, sign)


def test_the_first_character_replaces_the_text_and_an_arrowless_edit_keeps_it(typing: TypingLine) -> None:
    taken: list[str] = []
    entry = Entry("name", value="key", take=taken.append)
    typing.begin(entry)
    assert typing.shown == "name: key_"
    typed(typing, "ab")
    typing.key("backspace", "\b")
    typing.key("return", "\r")
    assert taken == ["a"]
    assert not typing.is_on


def test_a_text_that_was_not_changed_and_one_that_is_given_up_are_not_taken(typing: TypingLine) -> None:
    taken: list[str] = []
    for key in ("return", "escape"):
        typing.begin(Entry("name", value="key", take=taken.append))
        if key == "escape":
            typed(typing, "x")
        typing.key(key, "")
        assert not typing.is_on
    assert taken == []


def test_a_text_that_is_refused_stays(typing: TypingLine) -> None:
    typing.begin(Bar("ambient"), "-")
    typed(typing, "z")
    with pytest.raises(UsageError):
        typing.key("return", "\r")
    assert typing.shown == "ambient: -z_"


def test_numbers_begin_over_bars_that_can_be_used_alone(typing: TypingLine) -> None:
    assert typing.would_begin(Bar("ambient"), "7")
    assert not typing.would_begin(Bar("ambient"), "s")
    assert not typing.would_begin(Bar("ambient"), "")
    assert not typing.would_begin(Bar("ambient", why_not="no"), "7")
    assert not typing.would_begin(Entry("name"), "7")
