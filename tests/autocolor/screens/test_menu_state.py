from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from autocolor.widgets.items import Area
from autocolor.widgets.menu import MENU
from autocolor.widgets.widget import Button
from tests.autocolor.screens.boards import NAMES, Room, desk_hand
from tests.autocolor.screens.boxes import hint_of, told
from tests.autocolor.screens.hand import Hand


@pytest.fixture
def hand(tmp_path: Path) -> Hand:
    return desk_hand(tmp_path)


# Lists, sections and hiding.


@pytest.fixture
def room(hand: Hand) -> Room:
    room = hand.viewer.screens["room"] = Room(hand.viewer.session)
    hand.go_to("room")
    return room


def test_a_row_of_many_names_opens_a_list_from_which_a_name_is_taken(hand: Hand, room: Room) -> None:
    hand.move(470, 31)
    assert hand.hint.startswith("?: drag it")
    assert hint_of(hand, "finish") == "The finish; a click lists all 5."
    assert "gloss" not in hand.labels
    hand.pick("finish")
    assert room.chosen == "chrome"
    assert hand.labels[: len(NAMES)] == list(NAMES)
    assert hand.hint == "finish: pick a name on the list; a pick on the row takes it away"
    assert hint_of(hand, "gloss") == "finish: gloss. A click elsewhere closes the list."
    assert hand.is_drawn_whole()
    # It covers a handle.
    hand.move(470, 31)
    assert "drag it" not in hand.hint
    hand.pick("gloss")
    assert room.chosen == "gloss"
    assert "gloss" not in hand.labels
    assert hand.is_drawn_whole()


def test_rows_that_turn_pages_and_drags_and_the_wheel_open_no_list(hand: Hand, room: Room) -> None:
    hand.pick("page")
    assert room.did == ["2"]
    element, line = hand.middle("finish")
    hand.viewer.on_pointer(element, line, "wheel up")
    assert room.chosen == "satin"
    hand.drag((element, line), (MENU.left, line))
    assert room.chosen == "matte"
    assert "gloss" not in hand.labels


@pytest.mark.parametrize("by", ["the row", "escape", "the screen", "a panel", "a handle"])
def test_a_list_is_closed_by_its_row_by_escape_and_by_a_pick_elsewhere_which_does_no_more(
    hand: Hand, room: Room, by: str
) -> None:
    hand.pick("finish")
    closes: dict[str, Callable[[], object]] = {
        "the row": lambda: hand.pick("finish"),
        "escape": lambda: hand.press("escape"),
        "the screen": lambda: hand.click(200, 300),
        "a panel": lambda: hand.pick("panel"),
        "a handle": lambda: hand.click(302, 200),
    }
    closes[by]()
    assert "gloss" not in hand.labels
    assert (room.chosen, room.did, hand.message) == ("chrome", [], "")
    assert hand.is_drawn_whole()


def test_a_pick_on_another_row_and_a_drag_close_a_list_and_are_done(hand: Hand, room: Room) -> None:
    hand.pick("finish")
    hand.pick("near 1")
    assert (room.did, "gloss" in hand.labels) == (["near 1"], False)
    hand.pick("finish")
    hand.drag((100, 300), (120, 300), (125, 300))
    # The screen is told where the drag began, where it was last, and where it is.
    assert room.did == ["near 1", (100, 100, 120), (100, 120, 125)]
    assert "gloss" not in hand.labels


def test_a_name_that_is_refused_leaves_the_list_open(hand: Hand, room: Room) -> None:
    hand.choose("finish", "glass")
    assert told(hand) == ("a finish must not be glass; choose another", True)
    assert room.chosen == "chrome"
    hand.pick("satin")
    assert room.chosen == "satin"


def test_keys_go_through_a_list_and_back_to_its_row(hand: Hand, room: Room) -> None:
    hand.press("tab")
    assert hand.hint.startswith("The finish")
    hand.press("return")
    hints = [f"finish: {name}. A click elsewhere closes the list." for name in ("satin", "glass", "matte")]
    assert [hand.hint for _ in hints if hand.press("down")] == hints
    hand.press("return")
    assert room.chosen == "matte"
    assert hand.hint.startswith("The finish")
    hand.press("return", "down", "escape")
    assert hand.hint.startswith("The finish")
    assert room.chosen == "matte"
    # The keys still go to the menu.
    hand.press("right")
    assert room.chosen == "gloss"


def test_a_list_whose_row_went_is_not_open_when_the_row_is_back(hand: Hand) -> None:
    session = hand.viewer.session
    named = session.scene
    for angle in range(4):
        named = named.with_view(angle=angle).with_saved_view()
    session.edit(named)
    hand.go_to("picture")
    hand.open_menu()
    hand.pick("camera")
    names = [view.name for view in named.views]
    # The menu of the picture stays while its list is open.
    hand.move(100, 100)
    assert names[-1] in hand.labels
    session.edit(named.replace(views=()))
    hand.viewer.tell("")
    hand.move(120, 100)
    assert hand.labels == []
    session.edit(named)
    hand.open_menu()
    assert "camera" in hand.labels
    assert names[-1] not in hand.labels


def test_sections_fold_and_unfold_and_each_screen_keeps_its_own(hand: Hand, room: Room) -> None:
    assert {"near 0", "far 14"} <= set(hand.labels)
    assert "farther 0" not in hand.labels
    assert hint_of(hand, "farther").startswith("A click shows farther 0, farther 1, ")
    assert hint_of(hand, "far") == "A click folds these rows."
    hand.pick("farther")
    assert {"near 0", "farther 14"} <= set(hand.labels)
    assert "far 0" not in hand.labels
    hand.pick("near")
    assert "near 0" not in hand.labels
    assert hand.is_drawn_whole()
    hand.go_to("desk")
    hand.go_to("room")
    assert not {"near 0", "far 0"} & set(hand.labels)
    assert "farther 14" in hand.labels
    assert "more" not in hand.labels


def test_the_section_of_a_row_that_was_used_stays_open_when_it_grows(hand: Hand, room: Room) -> None:
    # The rows at the end of the menu are in no section.
    hand.pick("compare")
    assert "farther 0" not in hand.labels
    hand.pick("far 3")
    room.rows_of["far"] = 18
    hand.viewer.tell("")
    assert "far 17" in hand.labels
    assert "near 0" not in hand.labels


@pytest.mark.parametrize("by_key", [True, False])
def test_the_menu_and_all_panels_are_hidden_and_brought_back(hand: Hand, room: Room, by_key: bool) -> None:
    def switch(label: str) -> None:
        if by_key:
            hand.press("h")
        else:
            hand.open_menu()
            hand.pick(label)

    hand.viewer.board.over = lambda: [Button("over", area=Area(100, 400, 200, 415))]
    hand.viewer.tell("")
    assert {"panel", "over"} <= set(hand.labels)
    switch("hide panels")
    assert "H shows them again" in hand.message
    hand.viewer.tell("")
    hand.move(110, 100)
    assert hand.labels == []
    assert np.array_equal(hand.display.words, hand.viewer.studio.words)
    # The picture below is free, and the menu comes on demand.
    hand.click(20, 15)
    assert room.did == ["pick"]
    hand.open_menu()
    assert "finish" in hand.labels
    assert not {"panel", "over"} & set(hand.labels)
    switch("show panels")
    assert {"panel", "over", "finish"} <= set(hand.labels)
    assert hand.is_drawn_whole()


def test_escape_and_another_screen_bring_hidden_panels_back(hand: Hand, room: Room) -> None:
    hand.press("h", "escape")
    assert "panel" in hand.labels
    assert hand.viewer.page == "room"
    hand.press("h")
    hand.go_to("desk")
    assert "ambient" in hand.labels
    assert "hide panels" not in hand.labels
