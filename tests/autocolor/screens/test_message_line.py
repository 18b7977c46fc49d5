from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor.screens.message_line import (
    MESSAGE,
    MessagePart,
    lines_of_message,
    message_items,
)
from autocolor.widgets.items import BLACK, WHITE, WIDTH, YELLOW, Area, filled, text
from autocolor.widgets.menu import MENU, MESSAGE_CHARACTERS
from ramtek_emu import Ramtek9300
from tests.autocolor.screens.boards import desk_hand

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


@pytest.mark.parametrize(
    ("keys", "name"),
    [
        (["return"], "scene"),
        (["a", "b", "backspace", "return"], "a"),
        (["end", "a", "return"], "scenea"),
        (["right", "backspace", "return"], "scen"),
        (["backspace", "x", "enter"], "x"),
        (["x", "tab"], "x"),
        (["x", "escape"], "scene"),
    ],
)
def test_the_first_character_replaces_the_text_unless_an_arrow_goes_to_its_end(
    tmp_path: Path, keys: list[str], name: str
) -> None:
    hand = desk_hand(tmp_path)
    hand.viewer.session.has_keyboard = True
    hand.pick("name")
    assert hand.hint == "name: scene"
    hand.press(*keys)
    assert hand.scene.name == name
    assert hand.hint != f"name: {name}"
    assert bool(hand.viewer.studio.history.to_undo) == (name != "scene")


def test_numbers_begin_over_bars_alone(tmp_path: Path) -> None:
    hand = desk_hand(tmp_path)
    for row, key in (("ambient", "7"), ("ambient", "-"), ("ambient", "."), ("ambient", "x"), ("name", "7")):
        hand.move(*hand.middle(row))
        hand.press(key)
        assert (hand.hint == f"{row}: {key}_") == (row == "ambient" and key != "x")
        hand.press("escape")
        hand.go_to("desk")
