from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from autocolor.screens.input import LEFT, MARK, MIDDLE, POINTER, SLOP, Gesture, Mouse, Unit, turn_between
from ramtek_emu import Ramtek9300


def test_the_degrees_of_a_drag_do_not_depend_on_its_steps() -> None:
    places, total = [(100, 100), (130, 90), (90, 140), (160, 80)], [0.0, 0.0]
    for before, after in pairwise(places):
        right, up = turn_between(*before, *after)
        total = [total[0] + right, total[1] + up]
    assert total == pytest.approx(turn_between(*places[0], *places[-1]))


def acts(mouse: Mouse, element: int, action: str, button: int = LEFT) -> list[tuple[str, int, int]]:
    """The kinds, the elements and the buttons of the gestures of an action with Shift."""
    gestures = mouse.gestures(action, Gesture("hover", element, 10, button, shift=True))
    assert all(each.shift for each in gestures)
    return [(each.kind, each.element, each.button) for each in gestures]


def test_a_click_is_a_pick_even_if_the_hand_is_not_quite_still() -> None:
    mouse = Mouse()
    assert acts(mouse, 10, "press") == acts(mouse, 10 + SLOP, "move") == []
    assert acts(mouse, 10 + SLOP, "release") == [("pick", 10 + SLOP, LEFT)]


def test_a_drag_is_grabbed_where_the_button_was_pressed_and_dropped_at_its_release() -> None:
    mouse = Mouse()
    acts(mouse, 10, "press", MIDDLE)
    assert acts(mouse, 20, "move") == [("grab", 10, MIDDLE), ("drag", 20, MIDDLE)]
    # Back within the slop it is a drag still.
    assert acts(mouse, 10, "move") == [("drag", 10, MIDDLE)]
    assert acts(mouse, 10, "release", LEFT) == []
    assert acts(mouse, 10, "release", MIDDLE) == [("drop", 10, MIDDLE)]
    assert acts(mouse, 10, "move") == [("hover", 10, LEFT)]
    # The middle button has no clicks.
    acts(mouse, 10, "press", MIDDLE)
    assert acts(mouse, 10, "release", MIDDLE) == []


def test_a_button_that_is_forgotten_drags_no_more() -> None:
    mouse = Mouse()
    acts(mouse, 10, "press")
    acts(mouse, 30, "move")
    mouse.forget()
    assert acts(mouse, 40, "move") == [("hover", 40, LEFT)]
    assert acts(mouse, 40, "release") == []


@pytest.mark.parametrize(("action", "steps"), [("wheel up", 3.0), ("wheel down", -3.0)])
def test_a_wheel_turns_by_its_steps(action: str, steps: float) -> None:
    assert Mouse().gestures(action, Gesture("hover", 10, 10, steps=3.0))[0].steps == steps


# The joystick unit in process, and behind a TCP port.


@pytest.fixture
def display() -> Ramtek9300:
    return Ramtek9300()


@pytest.fixture
def unit(display: Ramtek9300) -> Unit:
    unit = Unit(display)
    unit.show()
    assert unit.poll() == []
    return unit


def told(unit: Unit) -> list[tuple[str, int, int]]:
    return [(each.kind, each.element, each.line) for each in unit.poll()]


def test_bits_above_the_place_of_a_cursor_are_no_part_of_it(display: Ramtek9300) -> None:
    class Noisy(Ramtek9300):
        def receive(self, count: int) -> np.ndarray[tuple[int, ...], np.dtype[np.uint16]]:
            return super().receive(count) | np.uint16(0x8000)

    noisy = Noisy()
    noisy.joystick.move_to(30, 40)
    Unit(noisy).show()
    assert noisy.joystick.position == (30, 40)


def test_enter_is_read_once_however_late(unit: Unit, display: Ramtek9300) -> None:
    display.joystick.move_to(30, 40)
    display.joystick.press_enter()
    display.joystick.press_enter()
    assert told(unit) == [("hover", 30, 40), ("pick", 30, 40)]
    assert told(unit) == []
    display.joystick.press_enter()
    # What was pressed before the unit is shown is no pick.
    unit.show()
    assert told(unit) == []


def test_a_drag_lasts_as_long_as_track(unit: Unit, display: Ramtek9300) -> None:
    display.joystick.track = True
    assert told(unit) == [("grab", 0, 0)]
    display.joystick.move_to(30, 40)
    assert told(unit) == [("drag", 30, 40)]
    display.joystick.move_to(31, 40)
    display.joystick.track = False
    assert told(unit) == [("drag", 31, 40), ("drop", 31, 40)]


def test_the_pointer_and_the_mark_are_cursors_and_write_no_word(unit: Unit, display: Ramtek9300) -> None:
    written = display.frame_buffer.written
    unit.mark((100, 90))
    marked = display.cursors[MARK]
    assert (marked.element, marked.line, marked.is_visible) == (100, 90, True)
    assert display.cursors[POINTER].is_visible
    received = display.words_received
    unit.mark((100, 90))
    assert display.words_received == received
    unit.mark(None)
    assert not display.cursors[MARK].is_visible
    unit.hide()
    assert not display.cursors[POINTER].is_visible
    assert display.frame_buffer.written == written


def test_a_mark_beyond_the_screen_is_at_its_edge(unit: Unit, display: Ramtek9300) -> None:
    unit.mark((-40, 90))
    assert (display.cursors[MARK].element, display.cursors[MARK].line) == (0, 90)
    unit.mark((10**6, 10**6))
    assert display.cursors[MARK].line == 0x3FF
