from __future__ import annotations

import numpy as np
import pytest
from autocolor.screens.message_line import MOST_CHARACTERS, TOP, MessageLine, draw_message

from ramtek_emu import Ramtek9300, instructions

PICTURE = np.arange(480 * 640, dtype=np.uint16).reshape(480, 640) % 1000


class Screen:
    """A display that shows a picture, with a message line."""

    def __init__(self) -> None:
        self.display = Ramtek9300()
        self.line = MessageLine(self.display, self.draw)
        self.draw()

    def draw(self) -> None:
        self.display.send(instructions.write_image(PICTURE))

    @property
    def has_message(self) -> bool:
        assert np.array_equal(self.display.words[:TOP], PICTURE[:TOP])
        return not np.array_equal(self.display.words, PICTURE)


def test_a_message_stands_for_a_while_and_what_it_covered_is_drawn_again(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    screen = Screen()
    monkeypatch.setattr("time.monotonic", lambda: 100.0)
    screen.line.text = "saved"
    screen.line.update(False, PICTURE)
    assert not screen.has_message
    screen.line.update(True, PICTURE)
    assert screen.has_message
    written = screen.display.frame_buffer.written
    screen.line.update(True, PICTURE)
    assert screen.display.frame_buffer.written == written
    monkeypatch.setattr("time.monotonic", lambda: 106.0)
    screen.line.update(True, PICTURE)
    assert not screen.has_message


def test_an_empty_message_takes_the_last_one_away() -> None:
    screen = Screen()
    for text in ("saved", "", "saved"):
        screen.line.text = text
        screen.line.update(True, PICTURE)
        assert screen.has_message is bool(text)
    screen.line.update(False, PICTURE)
    assert not screen.has_message


def test_a_message_is_drawn_again_over_what_was_drawn_anew() -> None:
    screen = Screen()
    screen.line.text = "saved"
    screen.line.update(True, "before")
    screen.draw()
    screen.line.update(True, "after")
    assert screen.has_message
    # Nothing is to be restored where the line was drawn over.
    screen.draw()
    written = screen.display.frame_buffer.written
    screen.line.text = ""
    screen.line.update(True, "anew")
    assert screen.display.frame_buffer.written == written
    assert not screen.has_message


def test_a_message_that_is_too_long_is_cut() -> None:
    one, other = Ramtek9300(), Ramtek9300()
    draw_message(one, "x" * 200)
    draw_message(other, "x" * (MOST_CHARACTERS - 2) + "..")
    assert np.array_equal(one.words, other.words)
