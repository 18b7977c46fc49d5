"""How long a message stands, and what it leaves, is tried through the viewer, in test_viewer.py."""

from __future__ import annotations

import numpy as np

from autocolor.screens.board.message_line import MESSAGE, MOST_CHARACTERS, message_items
from autocolor.widgets.colors import BLACK, WHITE
from autocolor.widgets.items import filled, text
from ramtek_emu import Ramtek9300


def test_a_message_fills_its_line_and_nothing_else() -> None:
    display = Ramtek9300()
    for item in message_items("x" * 200, WHITE):
        assert MESSAGE.covers(item.area)
        display.send(np.frombuffer(item.stream, np.uint16))
    assert not display.words[: MESSAGE.top].any()
    assert set(np.unique(display.words[MESSAGE.top :])) == {BLACK, WHITE}


def test_a_message_that_is_too_long_is_cut() -> None:
    assert message_items("x" * 200, WHITE) == message_items("x" * (MOST_CHARACTERS - 2) + "..", WHITE)


def test_of_a_long_text_that_is_typed_the_end_is_seen() -> None:
    line = "name: " + "a" * MOST_CHARACTERS + "the end_"
    shown = ".." + line[-(MOST_CHARACTERS - 2) :]
    assert message_items(line, WHITE, ends=True) == message_items(shown, WHITE)
    assert message_items("short", WHITE, ends=True) == message_items("short", WHITE)


def test_an_empty_message_is_an_empty_line() -> None:
    assert message_items("", WHITE) == [filled(MESSAGE, BLACK)]
    assert text("a", 8, MESSAGE.top + 3, WHITE, BLACK) in message_items("a", WHITE)
