from __future__ import annotations

from ramtek_emu import Ramtek9300, instructions
from ramtek_emu.memory.cursors import BLINK, VISIBLE, Cursor
from ramtek_emu.processor.processor import Status
from tests.ramtek_emu.displays import read
from tests.ramtek_emu.strategies import sent_words


def test_track_stays_on_and_enter_is_reported_once() -> None:
    display = Ramtek9300()
    display.joystick.move_to(320, 200)
    display.joystick.track = True
    display.joystick.press_enter()
    assert display.status == Status.READY | Status.CURSOR
    assert read(display, 0x1700) == [320, 200 | 0x3000]
    assert read(display, 0x1700) == [320, 200 | 0x1000]
    # The other cursor reports ENTER as well, independently.
    assert read(display, 0x1701) == [0, 0x3000]
    display.joystick.track = False
    assert read(display, 0x1701) == [0, 0]
    assert read(display, 0x2500) == [Status.CURSOR]
    assert display.status == Status.READY


def test_a_cursor_is_visible_and_blinks_by_its_bits() -> None:
    for state, is_visible, blinks in [
        (0, False, False), (VISIBLE, True, False), (BLINK, False, True), (VISIBLE | BLINK, True, True),
        (0xFFFF & ~(VISIBLE | BLINK), False, False),
    ]:  # fmt: skip
        cursor = Cursor(state=state)
        assert (cursor.is_visible, cursor.blinks) == (is_visible, blinks)


def test_reset_clears_an_unread_enter_and_leaves_the_cursors() -> None:
    display = Ramtek9300()
    display.send(sent_words([0x1600, 5, 0x406]))
    display.joystick.press_enter()
    display.send(instructions.reset())
    assert display.status == Status.READY
    assert read(display, 0x1700) == [5, 0x406]


def test_the_joystick_stays_on_the_screen_and_moves_its_cursors() -> None:
    display = Ramtek9300()
    display.joystick.move_to(10_000, -5)
    assert display.joystick.position == (639, 0)
    display.joystick.move_by(-9, 7)
    assert read(display, 0x1700, 0x1701) == [630, 7, 0, 0]
    display.send(sent_words([0x3300, 0x0002]))
    display.joystick.move_to(5, 6)
    assert read(display, 0x1700, 0x1701) == [630, 7, 5, 6]
    display.send(sent_words([0x3300, 0x0000]))
    display.joystick.move_to(50, 60)
    assert display.joystick.position == (0, 0)
    assert read(display, 0x1700, 0x1701) == [630, 7, 5, 6]
