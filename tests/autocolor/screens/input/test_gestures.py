from __future__ import annotations

from itertools import pairwise

import pytest

from autocolor.screens.input.gestures import LEFT, MIDDLE, SLOP, Gesture, Mouse, turn_between, wheel_ratio


def kinds(gestures: list[Gesture]) -> list[str]:
    return [each.kind for each in gestures]


def test_the_degrees_of_a_drag_do_not_depend_on_its_steps() -> None:
    places, total = [(100, 100), (130, 90), (90, 140), (160, 80)], [0.0, 0.0]
    for before, after in pairwise(places):
        right, up = turn_between(*before, *after)
        total = [total[0] + right, total[1] + up]
    assert total == pytest.approx(turn_between(*places[0], *places[-1]))


def test_the_wheel_moves_closer_and_back_by_its_steps() -> None:
    assert wheel_ratio(1) < 1
    assert wheel_ratio(3) == pytest.approx(wheel_ratio(1) ** 3)
    assert wheel_ratio(2) * wheel_ratio(-2) == pytest.approx(1)


def test_a_movement_without_a_button_is_a_hover() -> None:
    assert kinds(Mouse().gestures(3, 4, "move")) == ["hover"]


def test_a_click_is_a_pick_even_if_the_hand_is_not_quite_still() -> None:
    mouse = Mouse()
    assert mouse.gestures(10, 10, "press", LEFT) == []
    assert mouse.gestures(10 + SLOP, 10 - SLOP, "move") == []
    (pick,) = mouse.gestures(10 + SLOP, 10 - SLOP, "release", LEFT)
    assert (pick.kind, pick.element, pick.line) == ("pick", 10 + SLOP, 10 - SLOP)


def test_a_drag_is_grabbed_where_the_button_was_pressed_and_dropped_at_its_release() -> None:
    mouse = Mouse()
    mouse.gestures(10, 10, "press", MIDDLE, shift=True)
    grab, drag = mouse.gestures(20, 10, "move")
    assert (grab.kind, grab.element, grab.button, grab.shift) == ("grab", 10, MIDDLE, True)
    assert (drag.kind, drag.element, drag.button) == ("drag", 20, MIDDLE)
    # Back within the slop it is a drag still.
    assert kinds(mouse.gestures(10, 10, "move")) == ["drag"]
    assert mouse.gestures(10, 10, "release", LEFT) == []
    assert kinds(mouse.gestures(10, 10, "release", MIDDLE)) == ["drop"]
    assert kinds(mouse.gestures(10, 10, "move")) == ["hover"]


def test_other_buttons_have_no_clicks() -> None:
    mouse = Mouse()
    mouse.gestures(10, 10, "press", MIDDLE)
    assert mouse.gestures(10, 10, "release", MIDDLE) == []


def test_a_button_that_is_forgotten_drags_no_more() -> None:
    mouse = Mouse()
    mouse.gestures(10, 10, "press", LEFT)
    mouse.gestures(30, 10, "move")
    mouse.forget()
    assert kinds(mouse.gestures(40, 10, "move")) == ["hover"]
    assert mouse.gestures(40, 10, "release", LEFT) == []


def test_the_wheel_tells_its_steps_with_their_direction() -> None:
    assert [each.steps for each in Mouse().gestures(1, 1, "wheel up", steps=2)] == [2]
    assert [each.steps for each in Mouse().gestures(1, 1, "wheel down", steps=3)] == [-3]
