from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor.screens.layout import REACH, handles_near
from autocolor.screens.message_line import MESSAGE
from autocolor.screens.screen import Handle
from autocolor.screens.session import MESSAGE_SECONDS
from autocolor.screens.surface.painting import change_paint
from autocolor.screens.viewer import Viewer
from autocolor.widgets.items import ORANGE, SCREEN, SLATE, WHITE, WIDTH, filled
from autocolor.widgets.letters import PANEL as LETTER_PANEL
from autocolor.widgets.menu import MENU, WIDE_BAR
from autocolor.widgets.widget import Button, Pair
from ramtek_emu import Ramtek9300
from tests.autocolor.screens.boards import EYE, Desk, desk_hand
from tests.autocolor.screens.boxes import hint_of, told, undo
from tests.autocolor.screens.hand import Hand
from tests.small import wall_scene


@pytest.fixture
def hand(tmp_path: Path) -> Hand:
    return desk_hand(tmp_path)


def eye_of(hand: Hand) -> tuple[float, ...]:
    return tuple(hand.scene.view.eye)


# Rows and hints.


def test_the_row_under_the_pointer_is_lit_and_few_words_are_written(hand: Hand) -> None:
    place = hand.middle("ambient")
    written = hand.display.frame_buffer.written
    hand.move(*place)
    assert hand.display.words[place[1] - 6, place[0]] == SLATE
    # A row, and the hint in the message line.
    assert hand.display.frame_buffer.written - written < 3 * (136 * 16 + WIDTH * 16)
    hand.move(100, 100)
    assert hand.display.words[place[1] - 6, place[0]] != SLATE
    assert hand.is_drawn_whole()


def test_the_hint_is_that_of_the_row_or_of_the_screen_and_a_dim_row_says_why(hand: Hand) -> None:
    assert hand.hint == "the desk"
    hints = {"ambient": "The light from everywhere.", "a gap": "the desk", "do it": "not today"}
    assert {label: hint_of(hand, label) for label in hints} == hints
    hand.pick("do it")
    assert told(hand) == ("do it: not today", True)
    assert (hand.display.words[MESSAGE.top :] == ORANGE).any()


def test_tab_and_arrows_and_return_do_what_a_pointer_does(hand: Hand) -> None:
    hints = ["The light from everywhere.", "not today"]
    assert [hand.hint for key in ("tab", "down") if hand.press(key)] == hints
    hand.press("up", "right")
    assert hand.scene.ambient == 0.01
    # From the first row, the light goes round to the last one.
    hand.press("up", "left")
    assert hand.scene.ambient == 0


@pytest.mark.parametrize("by_key", [True, False])
def test_the_edge_opens_the_menu_of_the_picture_and_leaving_or_escape_closes_it(
    hand: Hand, by_key: bool
) -> None:
    hand.go_to("picture")
    for element in (MENU.left + 2, WIDTH - 5):
        hand.move(element, 100)
        assert hand.labels == []
    for element in (WIDTH - 4, MENU.left):
        hand.move(element, 100)
        assert "lights" in hand.labels
    if by_key:
        assert hand.press("escape")
    else:
        hand.move(MENU.left - 1, 100)
    assert hand.labels == []
    hand.move(2, 2)
    hand.viewer.tell("")
    assert np.array_equal(hand.display.words, hand.viewer.studio.words)


def test_every_page_of_a_long_menu_is_reached_and_a_menu_that_shrinks_shows_its_last(
    hand: Hand, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(Desk, "rows_more", 70)
    hand.viewer.tell("")
    seen: list[str] = []
    for _ in range(3):
        seen += [label for label in hand.labels if label.startswith("row")]
        assert [row.label for row in hand.viewer.board.layout.rows[-3:]] == ["more", "undo gap", " "]
        hand.pick("more")
    assert seen == [f"row {number}" for number in range(70)]
    hand.pick("more")
    for count, label in ((30, "row 29"), (0, "ambient")):
        monkeypatch.setattr(Desk, "rows_more", count)
        hand.viewer.tell("")
        assert label in hand.labels


def test_undo_and_redo_are_dim_while_there_is_no_step_for_them(hand: Hand) -> None:
    def are_on() -> list[bool]:
        row = hand.widget(" ")
        assert isinstance(row, Pair)
        return [cell.is_on for cell in row.cells]

    assert are_on() == [False] * 3
    assert hint_of(hand, " ") == "there is no step to undo"
    hand.viewer.session.edit(hand.scene.replace(ambient=0.7))
    hand.viewer.tell("")
    assert are_on() == [True, True, False]
    undo(hand)
    assert are_on() == [False, True, True]
    assert hint_of(hand, " ").startswith("Undo the last step")


def test_a_click_that_slips_along_the_undo_row_undoes_nothing(hand: Hand) -> None:
    hand.viewer.session.edit(hand.scene.replace(ambient=0.7))
    scene, (element, line) = hand.scene, hand.middle(" ")
    hand.drag((element, line), (element - 5, line), (element - 60, line))
    assert hand.scene is scene


# Handles and drags.

places = st.tuples(st.integers(90, 110), st.integers(90, 110))


@given(st.lists(places, max_size=5), places)
def test_the_nearest_handle_within_reach_comes_first_the_last_of_those_as_near(
    handles: list[tuple[int, int]], place: tuple[int, int]
) -> None:
    distances = [max(abs(x - place[0]), abs(y - place[1])) for x, y in handles]
    numbers = [number for number, each in enumerate(distances) if each <= REACH]
    rows = [Handle(number, *at, "") for number, at in enumerate(handles)]
    assert [each.key for each in handles_near(rows, *place)] == sorted(
        numbers, key=lambda number: (distances[number], -number)
    )


def test_a_handle_that_can_be_grabbed_is_marked_and_named(hand: Hand) -> None:
    mark = hand.display.cursors[1]
    hand.move(EYE[0] + REACH, EYE[1])
    assert (mark.is_visible, mark.element, mark.line) == (True, *EYE)
    assert hand.hint == "the eye: drag it, or click here and where it goes"
    hand.move(EYE[0] + REACH + 1, EYE[1])
    assert (mark.is_visible, hand.hint) == (False, "the desk")
    # Two cursors at one place would be invisible.
    hand.move(*EYE)
    assert not mark.is_visible


def test_a_second_pick_places_what_the_first_one_took(hand: Hand) -> None:
    before = hand.scene
    hand.click(EYE[0] + 5, EYE[1])
    assert told(hand) == ("the eye: pick its new place", False)
    # The menu's own ground lets it be held.
    hand.click(MENU.left + 50, MENU.bottom - 3)
    hand.click(250, 170)
    assert eye_of(hand)[:2] == (5.0, -3.0)
    hand.click(300, 300)
    assert eye_of(hand)[:2] == (5.0, -3.0)
    hand.press("Alt+Left")
    assert hand.scene.equals(before)


def test_a_place_that_is_refused_is_told_and_the_handle_is_held_until_escape(hand: Hand) -> None:
    before = hand.scene
    hand.click(*EYE)
    hand.click(495, 170)
    assert told(hand) == ("an eye must be elsewhere", True)
    hand.viewer.tell("")
    hand.move(250, 170)
    assert hand.hint == "the eye: pick its new place"
    assert hand.press("escape")
    hand.click(250, 170)
    assert hand.scene is before


def test_a_drag_of_a_handle_is_one_step_and_escape_takes_it_back(hand: Hand) -> None:
    before = hand.scene
    for end in ("drop", "escape"):
        hand.grab(*EYE)
        for step in range(1, 5):
            hand.move(EYE[0] + 3 * step, EYE[1])
            # ENTER does not end the step.
            hand.joystick.press_enter()
        assert eye_of(hand)[:2] == (1.2, -4.0)
        if end == "drop":
            hand.drop()
            hand.press("Alt+Left")
        else:
            assert hand.press("escape")
            assert hand.message == "taken back"
            hand.move(EYE[0] + 40, EYE[1])
            hand.drop()
        assert hand.scene.equals(before)
    assert not hand.viewer.studio.view_back()
    # A drag that changed nothing takes nothing back.
    hand.pull("ambient", 0.2, 0.6)
    lit = hand.scene
    hand.grab(*EYE)
    hand.press("escape")
    assert hand.scene is lit


def test_a_handle_that_the_menu_or_a_wide_bar_covers_cannot_be_reached(hand: Hand) -> None:
    before = hand.scene
    for element in (502, 508):
        hand.drag((element, 300), (300, 300))
    # Nor can the screen be dragged by the ground of the menu.
    hand.drag((508, MENU.bottom - 3), (300, 300))
    hand.move(100, WIDE_BAR.bottom)
    assert hand.hint.startswith("the low handle")
    hand.pick("ambient")
    hand.drag((100, WIDE_BAR.top + 1), (60, WIDE_BAR.top + 1))
    assert hand.scene.view is before.view


@pytest.mark.parametrize(("place", "key"), [("ambient", "Ctrl+Z"), ("handle", "Alt+Left")])
def test_undo_by_a_key_during_a_drag_lets_go(hand: Hand, place: str, key: str) -> None:
    before = hand.scene
    element, line = hand.middle("ambient") if place == "ambient" else EYE
    hand.grab(element, line)
    hand.move(element + 20, line)
    assert hand.scene is not before
    hand.press(key)
    hand.move(element + 30, line)
    assert hand.scene.equals(before)


def test_a_bar_goes_on_where_it_was_grabbed_though_rows_move_until_it_is_gone(
    hand: Hand, monkeypatch: pytest.MonkeyPatch
) -> None:
    element, line = hand.middle("ambient")
    rows = Desk.rows
    hand.grab(element, line)
    monkeypatch.setattr(Desk, "rows", lambda desk: list(reversed(rows(desk))))
    hand.move(MENU.right, line)
    assert hand.scene.ambient == 1.0
    monkeypatch.setattr(Desk, "rows", lambda desk: [Button("ambient")])
    hand.viewer.tell("")
    hand.move(element - 20, line)
    monkeypatch.setattr(Desk, "rows", rows)
    hand.move(element - 30, line)
    assert hand.scene.ambient == 1.0


def test_a_drag_of_the_mouse_beyond_the_screen_goes_there(hand: Hand) -> None:
    hand.viewer.on_pointer(*EYE, "press", 1)
    for action in ("move", "release"):
        hand.viewer.on_pointer(-300, -5, action, 1)
    assert eye_of(hand)[:2] == (-50.0, -20.5)
    assert hand.is_drawn_whole()


def test_a_click_opens_the_wide_bar_and_a_second_one_or_escape_closes_it(hand: Hand) -> None:
    row = hand.middle("ambient")
    for close in (lambda: hand.click(*row), lambda: hand.press("escape")):
        hand.click(*row)
        assert hand.labels.count("ambient") == 2
        assert hand.hint == "ambient: pick a value on the wide bar; a pick on the row takes it away"
        hand.click(WIDE_BAR.right - 60, WIDE_BAR.top + 5)
        assert hand.scene.ambient > 0
        hand.click(WIDE_BAR.left + 3, WIDE_BAR.top + 5)
        assert hand.scene.ambient == 0
        assert hand.is_drawn_whole()
        close()
        assert hand.labels.count("ambient") == 1


# Typing.


def test_a_number_is_typed_over_its_bar(hand: Hand) -> None:
    hand.move(*hand.middle("ambient"))
    hand.type("0.2")
    assert hand.hint == "ambient: 0.2_"
    hand.press("return")
    assert hand.scene.ambient == 0.2
    hand.type("1e")
    # A letter that is typed is no key of the window, but one with control is.
    assert hand.hint == "ambient: 1e_"
    hand.press("Ctrl+Z")
    assert (hand.scene.ambient, hand.message) == (0.0, "undone: ambient 0 -> 0.2")
    # The turns of the wheel over it are one step as well.
    for _ in range(3):
        hand.viewer.on_pointer(*hand.middle("ambient"), "wheel up", steps=2)
    assert hand.scene.ambient == 0.06
    hand.press("Ctrl+Z")
    assert hand.scene.ambient == 0.0


def test_a_text_that_is_no_number_is_refused_and_can_be_corrected(
    hand: Hand, wait: Callable[[float], None]
) -> None:
    before = hand.scene
    hand.move(*hand.middle("ambient"))
    hand.type("0.x")
    hand.press("return")
    assert told(hand)[0].startswith("ambient must be a number, not '0.x'")
    assert hand.scene is before
    # The refused text stands below the refusal, selected.
    assert (hand.display.words[MESSAGE.top - 12 :] == ORANGE).any()
    wait(MESSAGE_SECONDS)
    hand.viewer.on_tick()
    assert not (hand.display.words[MESSAGE.top - 12 :] == ORANGE).any()
    assert hand.hint == "ambient: 0.x"
    hand.press("5", "return")
    assert hand.scene.ambient == 5.0


def test_a_click_elsewhere_takes_the_typed_text_unless_it_is_refused(hand: Hand) -> None:
    hand.move(*hand.middle("ambient"))
    hand.press("1")
    hand.click(100, 100)
    assert hand.scene.ambient == 1.0
    hand.move(*hand.middle("ambient"))
    hand.type("-3")
    hand.click(100, 100)
    assert told(hand)[1]
    assert hand.hint == "ambient: -3"
    hand.press("escape")
    assert (hand.scene.ambient, hand.hint) == (1.0, "the desk")


CORNER = LETTER_PANEL.left + 2, LETTER_PANEL.top + 2
"""A place of the letter panel beside its keys."""


def pick_letters(hand: Hand, *labels: str) -> None:
    for label in labels:
        hand.pick(label)


def test_letters_are_picked_where_there_is_no_keyboard(hand: Hand) -> None:
    hand.pick("name")
    assert hand.hint == "name: scene"
    pick_letters(hand, "end", "back", "back", "space", "2", "-", "x")
    assert hand.hint == "name: sce 2-x_"
    # Between the keys nothing is picked, and nothing taken.
    hand.click(*CORNER)
    hand.drag(CORNER, CORNER)
    assert hand.scene.name == "scene"
    hand.pick("OK")
    assert hand.scene.name == "sce 2-x"
    assert "OK" not in hand.labels
    # They are given up by cancel, and taken by a pick elsewhere.
    pick_letters(hand, "name", "a", "cancel")
    assert (hand.scene.name, hand.hint) == ("sce 2-x", "the desk")
    pick_letters(hand, "name", "b")
    hand.click(100, 100)
    assert (hand.scene.name, hand.hint) == ("b", "the desk")


def test_the_letters_go_when_a_key_is_pressed_or_a_mouse_is_used(hand: Hand) -> None:
    pick_letters(hand, "name", "a")
    hand.press("b")
    assert "OK" not in hand.labels
    hand.press("return")
    assert hand.scene.name == "ab"
    other = desk_hand(hand.viewer.folder)
    place = other.middle("name")
    for action in ("press", "release"):
        other.viewer.on_pointer(*place, action, 1)
    assert "OK" not in other.labels
    other.type("new")
    other.press("return")
    assert other.scene.name == "new"


def test_a_key_goes_to_the_typed_text_then_to_the_screen_then_to_its_binding(
    hand: Hand, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[str] = []

    def key(desk: Desk, name: str, typed: str) -> bool:
        asked.append(name)
        return name == "c"

    monkeypatch.setattr(Desk, "key", key)
    hand.viewer.tell("")
    scene = hand.scene
    assert hand.press("c")
    assert hand.scene is scene
    hand.press("e")
    assert hand.scene is not scene
    hand.move(*hand.middle("ambient"))
    hand.press("1", "e")
    assert asked == ["c", "e"]


# The page.


def test_entries_that_change_while_some_are_borrowed_are_there_afterwards(
    hand: Hand, monkeypatch: pytest.MonkeyPatch
) -> None:
    loads = [(1, np.full((64, 3), 77, np.uint8)), (60, np.full((10, 3), 9, np.uint8))]
    monkeypatch.setattr(hand.viewer.board.screen, "loads", lambda: loads)
    for _ in range(2):
        hand.viewer.tell("")
        assert hand.display.entries[:71, 0].tolist()[1:70] == [77] * 59 + [9] * 10
        assert np.array_equal(hand.display.entries[70:], hand.viewer.studio.entries[70:])
        change_paint(hand.viewer.session, object_color="red")
    hand.go_to("picture")
    assert np.array_equal(hand.display.entries, hand.viewer.studio.entries)


def test_a_message_stands_over_all_that_a_screen_draws_and_its_second_line_goes_again(
    hand: Hand, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(hand.viewer.board.screen, "items", lambda: [filled(SCREEN, 3)])
    hand.viewer.tell("")
    words = hand.display.words.copy()
    hand.viewer.tell("a long message " * 8)
    for top in (MESSAGE.top - 12, MESSAGE.top):
        assert (hand.display.words[top : top + 12, :400] == WHITE).any()
    assert hand.is_drawn_whole()
    hand.viewer.tell("")
    assert np.array_equal(hand.display.words, words)


def test_a_message_gives_way_to_the_hint_of_another_thing_when_it_had_its_time(
    hand: Hand, wait: Callable[[float], None]
) -> None:
    hand.viewer.session.edit(hand.scene.replace(ambient=0.5))
    element, line = hand.middle("name")
    hand.move(element, line)
    hand.press("Ctrl+Z")
    undone = "undone: ambient 0 -> 0.5"
    wait(1.5)
    hand.move(element + 1, line)
    assert hand.hint == undone
    hand.move(*hand.middle("ambient"))
    assert hand.hint == "The light from everywhere."
    # Where the pointer goes at once, the message is still read for a while.
    hand.press("Ctrl+Y")
    hand.move(element, line)
    assert hand.hint.startswith("redone: ")
    wait(1.5)
    hand.viewer.on_tick()
    assert not hand.hint.startswith("redone: ")
    # A warning stands its whole time.
    hand.viewer.session.warn("careful")
    wait(4)
    hand.move(*hand.middle("ambient"))
    assert hand.hint == "careful"


def test_a_pointer_that_was_not_moved_yet_reaches_no_handle(tmp_path: Path) -> None:
    viewer = Viewer(wall_scene(), Ramtek9300(), tmp_path)
    viewer.screens["desk"] = Desk(viewer.session)
    viewer.session.edit(viewer.studio.scene.with_view(eye=(-19.8, -19.8, 2)))
    viewer.session.turn_to("desk")
    viewer.tell("")
    assert viewer.board.messages[-1].text == "the desk"
