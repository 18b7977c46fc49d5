from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor.errors import UsageError
from autocolor.screens.message_line import (
    MESSAGE,
    MessagePart,
    TypingLine,
    lines_of_message,
    message_items,
)
from autocolor.widgets.bars import Bar
from autocolor.widgets.items import BLACK, WHITE, WIDTH, YELLOW, Area, filled, text
from autocolor.widgets.menu import MENU, MESSAGE_CHARACTERS
from autocolor.widgets.widget import Entry
from ramtek_emu import Ramtek9300
from tests.autocolor.screens.boards import desk_viewer

# How long a message stands, and what it leaves, is tried through the viewer, in test_viewer.py.


def test_a_message_that_fits_fills_its_line_and_nothing_else() -> None:
    display = Ramtek9300()
    for item in message_items([MessagePart("x" * MESSAGE_CHARACTERS, WHITE)], MENU.left):
        assert MESSAGE.covers(item.area)
        display.send(np.frombuffer(item.stream, np.uint16))
    assert not display.words[: MESSAGE.top].any()
    assert set(np.unique(display.words[MESSAGE.top :])) == {BLACK, WHITE}


@pytest.mark.parametrize("end", [WIDTH, MENU.left])
def test_a_longer_message_takes_a_second_line_that_ends_at_the_menu(end: int) -> None:
    _, ground, *lines = message_items([MessagePart("word " * 24, WHITE)], end)
    assert len(lines) == 2
    assert ground.area == Area(0, MESSAGE.top - 12, end - 1, MESSAGE.top - 1)
    assert all(item.area.right < end for item in lines)
    assert len(message_items([MessagePart("word " * 200, WHITE)], end)) == 4


@given(st.text("ab ", max_size=300), st.integers(0, 40), st.integers(10, 80))
def test_a_typed_text_is_shown_whole_or_to_its_end_with_its_selection(
    text: str, label: int, most: int
) -> None:
    line = "n" * label + ": " + text
    rows = lines_of_message(MessagePart(line, YELLOW, label + 2), most)
    shown = "".join(row.text for row in rows)
    assert all(len(row.text) <= most for row in rows)
    assert len(rows) <= 2
    if len(line) <= 2 * most:
        assert shown == line
        assert "".join(row.text[row.selected :] for row in rows) == text
    else:
        assert shown == ".." + line[2 - 2 * most :]


def test_an_empty_message_is_an_empty_line() -> None:
    assert message_items([MessagePart("", WHITE)]) == [filled(MESSAGE, BLACK)]
    assert text("a", 8, MESSAGE.top + 3, WHITE, BLACK) in message_items([MessagePart("a", WHITE)])


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
    assert typing.shown == MessagePart("name: key", YELLOW, 6)
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


def test_a_proposed_text_is_taken_unchanged_but_not_by_a_pick_elsewhere(typing: TypingLine) -> None:
    taken: list[str] = []
    entry = Entry("save as", value="car-2", take=taken.append, is_proposed=True)
    typing.begin(entry)
    typing.key("return", "")
    assert taken == ["car-2"]
    typing.begin(entry)
    typed(typing, "x")
    typing.leave()
    assert not typing.is_on
    assert taken == ["car-2"]


def test_a_text_that_is_refused_stays(typing: TypingLine) -> None:
    typing.begin(Bar("ambient"), "-")
    typed(typing, "z")
    with pytest.raises(UsageError):
        typing.key("return", "\r")
    assert typing.shown == MessagePart("ambient: -z", YELLOW, 9)
    typed(typing, "5")
    assert typing.shown.text == "ambient: 5_"


def test_numbers_begin_over_bars_that_can_be_used_alone(typing: TypingLine) -> None:
    assert typing.would_begin(Bar("ambient"), "7")
    assert not typing.would_begin(Bar("ambient"), "s")
    assert not typing.would_begin(Bar("ambient"), "")
    assert not typing.would_begin(Bar("ambient", why_not="no"), "7")
    assert not typing.would_begin(Entry("name"), "7")
