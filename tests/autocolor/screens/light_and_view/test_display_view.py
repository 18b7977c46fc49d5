from __future__ import annotations

import numpy as np

from autocolor.screens.light_and_view.areas import PICTURE_AREA
from autocolor.screens.light_and_view.display_view import MESH, DisplayView, smaller
from autocolor.screens.light_and_view.object_lines import ObjectLines
from autocolor.widgets.areas import Area
from autocolor.widgets.colors import GRAY
from tests.autocolor.screens.hand import Hand
from tests.autocolor.screens.light_and_view.pointing import KEY, boxed, opened, scene_of_hand, screen_of
from tests.autocolor.screens.light_and_view.test_marks import drawn


def display_of(hand: Hand) -> DisplayView:
    return DisplayView(hand.viewer.session, ObjectLines())


def grays(display: DisplayView) -> int:
    """The gray pixels within the frame."""
    left, top, right, bottom = display.area
    words = drawn(display.items()).words[top : bottom + 1, left : right + 1]
    return int((words == GRAY).sum())


def test_a_smaller_picture_has_the_words_of_pixels_from_all_over_it() -> None:
    words = np.arange(12, dtype=np.uint16).reshape(3, 4)
    assert smaller(words, Area(0, 0, 3, 2)).tolist() == words.tolist()
    assert smaller(words, Area(5, 5, 5, 5)).tolist() == [[6]]
    assert smaller(words, Area(0, 0, 1, 2)).tolist() == [[1, 3], [5, 7], [9, 11]]


def test_the_picture_stands_in_a_frame_and_is_the_same_until_it_changes() -> None:
    hand = opened(boxed(KEY))
    display = display_of(hand)
    assert PICTURE_AREA.inset(7).covers(display.area)
    before, again = display.items(), display.items()
    assert before[-1] is again[-1]
    assert before[-1].area == display.area
    hand.viewer.session.change_light("key", intensity=0.2, position=(5.0, 0.0, 0.0))
    assert display.items()[-1] != before[-1]


def test_the_mesh_follows_the_view() -> None:
    hand = opened(boxed(KEY))
    display = display_of(hand)
    display.show(MESH)
    before = display.items()
    assert grays(display) > 100
    hand.viewer.session.edit(scene_of_hand(hand).with_view(angle=20.0))
    assert display.items() != before


def test_hidden_lines_of_the_mesh_are_left_out_when_there_is_time_and_come_back_with_another_view() -> None:
    hand = opened(boxed(KEY))
    display = display_of(hand)
    assert not display.leave_out_hidden()
    display.show(MESH)
    whole = grays(display)
    assert display.leave_out_hidden()
    assert grays(display) < 0.9 * whole
    assert not display.leave_out_hidden()
    # A light changes nothing of that.
    hand.viewer.session.change_light("key", position=(5.0, 0.0, 0.0))
    assert grays(display) < 0.9 * whole
    assert not display.leave_out_hidden()
    hand.viewer.session.edit(scene_of_hand(hand).with_view(angle=1.0))
    assert grays(display) > 0.95 * whole
    assert display.leave_out_hidden()


def test_a_click_in_the_quarter_turns_from_the_picture_to_the_mesh_and_back() -> None:
    hand = opened(boxed(KEY))
    element, line = (round(each) for each in PICTURE_AREA.middle)
    shown = []
    for _ in range(3):
        shown.append([each for each in screen_of(hand).items() if PICTURE_AREA.covers(each.area)])
        hand.click(element, line)
    assert shown[0] == shown[2] != shown[1]
