from __future__ import annotations

import time
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor.arrays import Words
from autocolor.errors import UsageError
from autocolor.screens.board import (
    REACH,
    Board,
    Layout,
    handles_near,
    last_rows,
    rows_of_menu,
    with_loads,
)
from autocolor.screens.input import Gesture
from autocolor.screens.message_line import MESSAGE, MessagePart, message_items
from autocolor.screens.screen import Handle, Screen
from autocolor.screens.session import MESSAGE_SECONDS, Session
from autocolor.screens.viewer import Viewer
from autocolor.widgets.bars import Bar
from autocolor.widgets.items import (
    GRAY,
    NIGHT,
    ORANGE,
    SCREEN,
    SLATE,
    WHITE,
    WIDTH,
    YELLOW,
    Area,
    filled,
    text,
)
from autocolor.widgets.letters import PANEL as LETTER_PANEL
from autocolor.widgets.menu import MENU, WIDE_BAR, Section, laid_out, page_of_menu
from autocolor.widgets.sheet import Sheet
from autocolor.widgets.widget import Button, Choice, Place, Widget
from ramtek_emu import PRINCETON_9300, Ramtek9300
from tests.autocolor.screens.boards import Desk, desk_viewer, middle_of, point
from tests.small import car


@pytest.fixture
def viewer(tmp_path: Path) -> Viewer:
    return desk_viewer(tmp_path)


@pytest.fixture
def board(viewer: Viewer) -> Board:
    return viewer.board


def display_of(viewer: Viewer) -> Ramtek9300:
    assert isinstance(viewer.display, Ramtek9300)
    return viewer.display


def is_drawn_whole(viewer: Viewer) -> bool:
    """Whether the display has what the page alone gives."""
    fresh = Ramtek9300(display_of(viewer).configuration)
    Sheet(fresh).show(viewer.board.page())
    display = display_of(viewer)
    return np.array_equal(display.words, fresh.words) and np.array_equal(display.entries, fresh.entries)


def test_the_row_under_the_pointer_is_lit_and_few_words_are_written(viewer: Viewer, board: Board) -> None:
    place = middle_of(board, "ambient")
    written = display_of(viewer).frame_buffer.written
    point(viewer, "hover", *place)
    assert display_of(viewer).words[place[1] - 6, place[0]] == SLATE
    # A row, and the hint in the message line.
    assert display_of(viewer).frame_buffer.written - written < 3 * (136 * 16 + WIDTH * 16)
    assert board.messages[-1].text == "The light from everywhere."
    point(viewer, "hover", 100, 100)
    assert display_of(viewer).words[place[1] - 6, place[0]] != SLATE
    assert is_drawn_whole(viewer)


def test_a_gap_says_nothing_and_a_dim_row_says_why(viewer: Viewer, board: Board) -> None:
    point(viewer, "hover", *middle_of(board, "a gap"))
    assert board.messages[-1].text == "the desk"
    point(viewer, "hover", *middle_of(board, "do it"))
    assert board.messages[-1].text == "not today"
    point(viewer, "pick", *middle_of(board, "do it"))
    assert board.messages[0][:2] == ("do it: not today", ORANGE)


def test_of_two_rows_with_one_name_the_one_under_the_pointer_is_lit(
    viewer: Viewer, board: Board, monkeypatch: pytest.MonkeyPatch
) -> None:
    rows = Desk.rows
    monkeypatch.setattr(Desk, "rows", lambda desk: [*rows(desk), *rows(desk)])
    viewer.tell("")
    first, second = [each.area for each in board.widgets() if each.label == "ambient"]
    point(viewer, "hover", second.left + 9, second.top + 1)
    words = display_of(viewer).words
    assert words[second.top, second.left] == SLATE
    assert words[first.top, first.left] != SLATE


def test_a_second_pick_places_what_the_first_one_took(viewer: Viewer, board: Board) -> None:
    before = viewer.studio.scene
    element, line = board.screen.handles()[0][1:3]
    point(viewer, "pick", element + 5, line)
    assert board.mark == (element, line)
    assert viewer.message == "the eye: pick its new place"
    # The menu's own ground, and a hover, let it be held.
    point(viewer, "pick", MENU.left + 50, MENU.bottom - 3)
    point(viewer, "pick", 250, 170)
    assert viewer.studio.scene.view.eye[:2] == (5.0, -3.0)
    assert board.held is None
    viewer.on_key("z", control=True)
    assert viewer.studio.scene is before


def test_a_place_that_is_refused_is_told_and_the_handle_still_held(
    viewer: Viewer, board: Board, monkeypatch: pytest.MonkeyPatch
) -> None:
    from autocolor import UsageError

    def refuse(*_: object) -> None:
        raise UsageError("an eye must be elsewhere")

    element, line = board.screen.handles()[0][1:3]
    point(viewer, "pick", element, line)
    monkeypatch.setattr(board.screen, "place", refuse)
    point(viewer, "pick", 250, 170)
    assert board.messages[0][:2] == ("an eye must be elsewhere", ORANGE)
    assert board.held is not None
    assert viewer.on_key("escape")
    assert board.held is None


def test_a_drag_of_a_handle_is_one_step_and_escape_takes_it_back(viewer: Viewer, board: Board) -> None:
    before = viewer.studio.scene
    element, line = board.screen.handles()[0][1:3]
    for end in ("drop", "escape"):
        point(viewer, "grab", element, line)
        for step in range(1, 5):
            point(viewer, "drag", element + 3 * step, line)
        assert viewer.studio.scene is not before
        if end == "drop":
            point(viewer, "drop", element + 12, line)
            viewer.on_key("z", control=True)
        else:
            viewer.on_key("escape")
            point(viewer, "drag", element + 40, line)
        assert viewer.studio.scene is before
        assert not board.is_dragging
    assert not viewer.studio.undo()


def test_a_handle_below_the_menu_cannot_be_reached(viewer: Viewer, board: Board) -> None:
    assert board.handle_at(508, 300) is None
    assert board.handle_at(502, 300) is None
    before = viewer.studio.scene
    # Nor can the screen be dragged by the ground of the menu.
    point(viewer, "grab", 508, MENU.bottom - 3)
    assert not board.is_dragging
    point(viewer, "drag", 300, 300)
    assert viewer.studio.scene is before


def test_enter_during_a_drag_does_not_end_its_step(viewer: Viewer, board: Board) -> None:
    before = viewer.studio.scene
    element, line = board.screen.handles()[0][1:3]
    point(viewer, "grab", element, line)
    point(viewer, "drag", element + 10, line)
    point(viewer, "pick", element + 10, line)
    point(viewer, "drag", element + 20, line)
    point(viewer, "drop", element + 20, line)
    viewer.on_key("z", control=True)
    assert viewer.studio.scene is before


def test_undo_by_a_key_during_a_drag_lets_go(viewer: Viewer, board: Board) -> None:
    before = viewer.studio.scene
    place = middle_of(board, "ambient")
    point(viewer, "grab", *place)
    point(viewer, "drag", place[0] + 20, place[1])
    assert viewer.studio.scene is not before
    viewer.on_key("z", control=True)
    assert viewer.studio.scene is before
    point(viewer, "drag", place[0] + 30, place[1])
    assert viewer.studio.scene is before


def test_a_widget_that_is_gone_is_dragged_no_more(
    viewer: Viewer, board: Board, monkeypatch: pytest.MonkeyPatch
) -> None:
    place = middle_of(board, "ambient")
    point(viewer, "grab", *place)
    monkeypatch.setattr(Desk, "rows", lambda desk: [])
    before = viewer.studio.scene
    point(viewer, "drag", place[0] + 20, place[1])
    assert viewer.studio.scene is before
    assert not board.is_dragging


def test_a_bar_goes_on_where_it_was_grabbed_though_rows_move(
    viewer: Viewer, board: Board, monkeypatch: pytest.MonkeyPatch
) -> None:
    place = middle_of(board, "ambient")
    point(viewer, "grab", *place)
    rows = Desk.rows
    monkeypatch.setattr(Desk, "rows", lambda desk: list(reversed(rows(desk))))
    point(viewer, "drag", MENU.right, place[1])
    assert viewer.studio.scene.ambient == 1.0


def test_a_drag_beyond_the_screen_stays_at_its_edge(viewer: Viewer, board: Board) -> None:
    element, line = board.screen.handles()[0][1:3]
    point(viewer, "grab", element, line)
    point(viewer, "drag", -300, -5)
    point(viewer, "drop", -300, -5)
    point(viewer, "pick", 3, 3)
    assert viewer.studio.scene.view.eye[:2] == (-50.0, -20.5)
    assert is_drawn_whole(viewer)


def test_a_click_opens_the_wide_bar_and_a_second_one_closes_it(viewer: Viewer, board: Board) -> None:
    place = middle_of(board, "ambient")
    point(viewer, "pick", *place)
    assert board.layout.widget_at(300, WIDE_BAR.top + 5) is not None
    point(viewer, "pick", WIDE_BAR.left + 3, WIDE_BAR.top + 5)
    assert viewer.studio.scene.ambient == 0.0
    assert is_drawn_whole(viewer)
    point(viewer, "pick", *place)
    assert board.layout.widget_at(300, WIDE_BAR.top + 5) is None
    point(viewer, "pick", *place)
    assert viewer.on_key("escape")
    assert board.layout.widget_at(300, WIDE_BAR.top + 5) is None


def test_a_number_is_typed_over_its_bar(viewer: Viewer, board: Board) -> None:
    point(viewer, "hover", *middle_of(board, "ambient"))
    for sign in "0.25":
        viewer.on_key(sign, typed=sign)
    assert board.messages[-1].text == "ambient: 0.25_"
    viewer.on_key("return", typed="\r")
    assert viewer.studio.scene.ambient == 0.25
    viewer.on_key("z", control=True)
    assert viewer.studio.scene.ambient == 0.0


def test_a_text_that_is_no_number_is_refused_and_can_be_corrected(
    viewer: Viewer, board: Board, monkeypatch: pytest.MonkeyPatch
) -> None:
    before = viewer.studio.scene
    point(viewer, "hover", *middle_of(board, "ambient"))
    for sign in "0.x":
        viewer.on_key(sign, typed=sign)
    viewer.on_key("return", typed="\r")
    assert board.messages[0][:2] == ("ambient must be a number, not '0.x'; type one, such as 1.5", ORANGE)
    assert (display_of(viewer).words[MESSAGE.top - 12 :] == ORANGE).any()
    assert viewer.studio.scene is before
    # The refused text stands below the refusal, selected.
    assert board.messages[1] == MessagePart("ambient: 0.x", YELLOW, len("ambient: "))
    _, ground, *_ = message_items(board.messages, MENU.left)
    assert ground.area.top < MESSAGE.top
    now = time.monotonic()
    monkeypatch.setattr("time.monotonic", lambda: now + MESSAGE_SECONDS + 1)
    assert [each.text for each in board.messages] == ["ambient: 0.x"]
    for name, typed in (("5", "5"), ("return", "\r")):
        viewer.on_key(name, typed=typed)
    assert viewer.studio.scene.ambient == 5.0
    assert not board.typing.is_on


def test_a_click_elsewhere_takes_the_typed_text_unless_it_is_refused(viewer: Viewer, board: Board) -> None:
    point(viewer, "hover", *middle_of(board, "ambient"))
    viewer.on_key("1", typed="1")
    point(viewer, "pick", 100, 100)
    assert viewer.studio.scene.ambient == 1.0
    point(viewer, "hover", *middle_of(board, "ambient"))
    for sign in "-3":
        viewer.on_key(sign, typed=sign)
    point(viewer, "pick", 100, 100)
    assert board.messages[0].ink == ORANGE
    assert board.typing.is_on
    viewer.on_key("escape")
    assert not board.typing.is_on
    assert viewer.studio.scene.ambient == 1.0


CORNER = LETTER_PANEL.left + 2, LETTER_PANEL.top + 2
"""A place of the letter panel beside its keys."""


def pick_letters(viewer: Viewer, board: Board, *labels: str) -> None:
    for label in labels:
        point(viewer, "pick", *middle_of(board, label))


def test_letters_are_picked_where_there_is_no_keyboard(viewer: Viewer, board: Board) -> None:
    assert not board.is_on_letters(*CORNER)
    pick_letters(viewer, board, "name")
    assert board.typing.shown == MessagePart("name: scene", YELLOW, 6)
    assert board.is_on_letters(*CORNER)
    assert board.is_covered(*CORNER)
    pick_letters(viewer, board, "end", "back", "back", "space", "2", "-", "x")
    assert board.typing.shown.text == "name: sce 2-x_"
    # Between the keys nothing is picked, and nothing taken.
    point(viewer, "pick", *CORNER)
    point(viewer, "grab", *CORNER)
    point(viewer, "drop", *CORNER)
    assert viewer.studio.scene.name == "scene"
    pick_letters(viewer, board, "OK")
    assert viewer.studio.scene.name == "sce 2-x"
    assert not board.is_on_letters(*CORNER)


def test_picked_letters_are_given_up_by_cancel_and_taken_by_a_pick_elsewhere(
    viewer: Viewer, board: Board
) -> None:
    pick_letters(viewer, board, "name", "a", "cancel")
    assert not board.typing.is_on
    assert viewer.studio.scene.name == "scene"
    pick_letters(viewer, board, "name", "b")
    point(viewer, "pick", 100, 100)
    assert viewer.studio.scene.name == "b"
    assert not board.typing.is_on


def test_the_letters_go_when_a_key_is_pressed(viewer: Viewer, board: Board) -> None:
    pick_letters(viewer, board, "name", "a")
    viewer.on_key("b", typed="b")
    assert not board.is_on_letters(*CORNER)
    assert "OK" not in [widget.label for widget in board.widgets()]
    viewer.on_key("return")
    assert viewer.studio.scene.name == "ab"


def test_an_entry_is_typed_after_a_pick_where_there_is_a_keyboard(viewer: Viewer, board: Board) -> None:
    element, line = middle_of(board, "name")
    viewer.on_pointer(element, line, "press", 1)
    viewer.on_pointer(element, line, "release", 1)
    for sign in "new":
        viewer.on_key(sign, typed=sign)
    viewer.on_key("return", typed="\r")
    assert viewer.studio.scene.name == "new"


def test_tab_and_arrows_and_return_do_what_a_pointer_does(viewer: Viewer, board: Board) -> None:
    viewer.on_key("tab", typed="\t")
    seen = [board.lit]
    for _ in range(3):
        viewer.on_key("down")
        seen.append(board.lit)
    assert seen == ["< picture", "ambient", "do it", "name"]
    viewer.on_key("up")
    viewer.on_key("up")
    viewer.on_key("right")
    assert viewer.studio.scene.ambient == 0.01
    viewer.on_key("up")
    viewer.on_key("return", typed="\r")
    assert viewer.page == "picture"


def test_the_edge_opens_the_menu_of_the_picture_and_leaving_closes_it(viewer: Viewer, board: Board) -> None:
    viewer.session.turn_to("picture")
    viewer.tell("")
    assert not board.has_menu
    point(viewer, "hover", 638, 100)
    assert board.has_menu
    point(viewer, "hover", MENU.left + 2, 100)
    assert board.has_menu
    point(viewer, "hover", MENU.left - 1, 100)
    assert not board.has_menu
    assert np.array_equal(display_of(viewer).words, viewer.studio.words)
    point(viewer, "hover", 638, 100)
    assert viewer.on_key("escape")
    assert not board.has_menu


def test_every_page_of_a_long_menu_is_reached_and_a_menu_that_shrinks_shows_its_last(
    viewer: Viewer, board: Board, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(Desk, "rows_more", 70)
    viewer.tell("")
    seen: set[str] = set()
    for _ in range(3):
        seen |= {each.label for each in board.widgets()}
        point(viewer, "pick", *middle_of(board, "more"))
    assert {f"row {number}" for number in range(70)} <= seen
    # It is at the first page again.
    assert "ambient" in {each.label for each in board.widgets()}
    for _ in range(2):
        point(viewer, "pick", *middle_of(board, "more"))
    monkeypatch.setattr(Desk, "rows_more", 30)
    viewer.tell("")
    assert {"row 29", "more"} <= {each.label for each in board.widgets()}
    monkeypatch.setattr(Desk, "rows_more", 0)
    viewer.tell("")
    assert "ambient" in {each.label for each in board.widgets()}


def test_a_click_that_slips_along_the_undo_row_undoes_nothing(viewer: Viewer, board: Board) -> None:
    viewer.on_key("c", typed="c")
    viewer.session.turn_to("desk")
    viewer.tell("")
    scene = viewer.studio.scene
    element, line = middle_of(board, " ")
    point(viewer, "grab", element, line)
    for step in range(10):
        point(viewer, "drag", element - step, line)
    point(viewer, "drop", element, line)
    assert viewer.studio.scene is scene
    point(viewer, "pick", element, line)
    assert (viewer.page, viewer.studio.scene) == ("history", scene)
    point(viewer, "pick", *middle_of(board, " "))
    assert (viewer.page, viewer.studio.scene) == ("picture", scene)
    viewer.session.turn_to("desk")
    viewer.tell("")
    point(viewer, "pick", element - 40, line)
    assert viewer.studio.scene is not scene


def test_without_a_pointer_the_hint_is_that_of_the_screen(viewer: Viewer, board: Board) -> None:
    assert board.messages[-1].text == "the desk"


def test_the_whole_of_a_larger_display_shows_the_picture(tmp_path: Path) -> None:
    viewer = desk_viewer(tmp_path, Ramtek9300(PRINCETON_9300))
    point(viewer, "hover", *middle_of(viewer.board, "ambient"))
    assert is_drawn_whole(viewer)
    viewer.session.turn_to("picture")
    viewer.tell("")
    assert np.array_equal(display_of(viewer).words, viewer.studio.words)


def test_entries_that_change_while_some_are_borrowed_are_there_afterwards(
    viewer: Viewer, board: Board, monkeypatch: pytest.MonkeyPatch
) -> None:
    borrowed = np.full((64, 3), 77, np.uint8)
    monkeypatch.setattr(board.screen, "loads", lambda: [(1, borrowed)])
    viewer.tell("")
    assert np.array_equal(display_of(viewer).entries[1:65], borrowed)
    viewer.session.paint(object_color="red")
    viewer.tell("")
    assert np.array_equal(display_of(viewer).entries[1:65], borrowed)
    assert np.array_equal(display_of(viewer).entries[65:], viewer.studio.entries[65:])
    viewer.session.turn_to("picture")
    viewer.tell("")
    assert np.array_equal(display_of(viewer).entries, viewer.studio.entries)


def test_the_mark_goes_when_the_pointer_is_exactly_on_it(tmp_path: Path) -> None:
    viewer = Viewer(car(), Ramtek9300(), tmp_path)
    viewer.session.turn_to("light and view")
    viewer.on_tick()
    handle = viewer.board.screen.handles()[-1]
    viewer.on_pointer(handle.element + 3, handle.line + 3, "move")
    assert viewer.board.mark is not None
    viewer.on_pointer(*viewer.board.mark, "move")
    assert viewer.board.mark is None


# What a layout has is tried through the board, in test_board.py.

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


def test_the_wide_bar_covers_what_is_below_it(tmp_path: Path) -> None:
    screen = desk_viewer(tmp_path).board.screen
    rows = laid_out([Bar("ambient"), Button("go")])
    closed, opened = (Layout(screen, rows, opened=key) for key in ("", "ambient"))
    place = (100, WIDE_BAR.top + 3)
    assert not closed.is_covered(*place)
    assert opened.is_covered(*place)
    assert opened.widget_at(*place) is opened.wide
    assert Layout(screen, rows, opened="gone").wide is None


def test_a_widget_is_found_again_by_its_key_and_stays_where_it_was_grabbed(board: Board) -> None:
    before = laid_out([Bar("x", value=1.0), Button("x")])
    after = laid_out([Button("new"), Bar("x", value=2.0)])
    now = Layout(board.screen, after).now(before[0])
    assert isinstance(now, Bar)
    assert (now.value, now.area) == (2.0, before[0].area)
    assert Layout(board.screen, after).now(before[1]) is None


# What a page looks like is tried through the board, in test_board.py.


def test_entries_without_loads_are_the_same_array() -> None:
    entries = np.zeros((1024, 3), np.uint8)
    assert with_loads(entries, []) is entries


def test_loads_replace_runs_and_leave_the_entries_as_they_were() -> None:
    entries = np.zeros((1024, 3), np.uint8)
    table = with_loads(entries, [(5, np.full((3, 3), 9, np.uint8)), (7, np.full((2, 3), 4, np.uint8))])
    assert table[4:10, 0].tolist() == [0, 9, 9, 4, 4, 0]
    assert not entries.any()


def test_a_message_stands_over_all_that_a_screen_draws(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    viewer: Viewer = desk_viewer(tmp_path)
    viewer.tell("a message")
    told = [item for item in viewer.board.page().items if MESSAGE.covers(item.area)]
    monkeypatch.setattr(viewer.board.screen, "items", lambda: [filled(SCREEN, 3)])
    items = list(viewer.board.page().items)
    assert items.index(filled(SCREEN, 3)) < min(items.index(item) for item in told)


# What is dragged on a board is tried in test_board.py; here, what is asked of the screen.


class Told(Screen):
    """A screen that notes what it is asked for."""

    def __init__(self, session: Session) -> None:
        super().__init__(session)
        self.did: list[object] = []

    def handles(self) -> list[Handle]:
        return [Handle("a", 100, 100, "a")]

    def hold(self, handle: Handle) -> None:
        self.did.append(("hold", handle.key))

    def place(self, handle: Handle, element: int, line: int) -> None:
        self.did.append(("place", handle.key, element, line))

    def drag(self, start: Gesture, last: Gesture, now: Gesture) -> None:
        self.did.append(("drag", start.element, last.element, now.element))


def test_a_handle_is_held_and_placed_and_the_screen_dragged_step_by_step(viewer: Viewer) -> None:
    screen = Told(viewer.session)
    board = Board(viewer.session, {"desk": screen})
    board.take(Gesture("grab", 102, 100))
    board.take(Gesture("drag", 110, 90))
    assert board.is_dragging
    board.release()
    board.take(Gesture("drag", 120, 90))
    assert screen.did == [("hold", "a"), ("place", "a", 110, 90)]
    screen.did.clear()
    board.take(Gesture("grab", 200, 200))
    for element in (210, 225):
        board.take(Gesture("drag", element, 200))
    assert screen.did == [("drag", 200, 200, 210), ("drag", 200, 210, 225)]


def test_the_words_below_a_second_line_come_back(viewer: Viewer) -> None:
    viewer.session.turn_to("picture")
    viewer.tell("")
    words = display_of(viewer).words.copy()
    viewer.tell("a long message " * 8)
    assert (display_of(viewer).words[MESSAGE.top - 10] != words[MESSAGE.top - 10]).any()
    assert is_drawn_whole(viewer)
    viewer.tell("")
    assert np.array_equal(display_of(viewer).words, words)


def test_a_message_gives_way_to_the_hint_of_another_thing(
    viewer: Viewer, board: Board, monkeypatch: pytest.MonkeyPatch
) -> None:
    viewer.studio.edit(viewer.studio.scene.replace(ambient=0.5))
    undone = "undone: ambient 0 -> 0.5"
    element, line = middle_of(board, "name")
    point(viewer, "hover", element, line)
    now = time.monotonic()
    viewer.on_key("z", control=True)
    monkeypatch.setattr("time.monotonic", lambda: now + 1.5)
    point(viewer, "hover", element + 1, line)
    assert board.messages[0].text == undone
    point(viewer, "hover", *middle_of(board, "ambient"))
    assert board.messages[0].text == "The light from everywhere."
    # A warning stands its whole time.
    viewer.session.warn("careful")
    monkeypatch.setattr("time.monotonic", lambda: now + 4)
    point(viewer, "hover", *middle_of(board, "name"))
    assert board.messages[0].text == "careful"


def test_a_message_is_shown_a_while_even_if_the_pointer_rests_elsewhere_at_once(
    viewer: Viewer, board: Board, monkeypatch: pytest.MonkeyPatch
) -> None:
    viewer.studio.edit(viewer.studio.scene.replace(ambient=0.5))
    point(viewer, "hover", *middle_of(board, "name"))
    viewer.on_key("z", control=True)
    now = time.monotonic()
    point(viewer, "hover", *middle_of(board, "ambient"))
    assert board.messages[0].text == "undone: ambient 0 -> 0.5"
    monkeypatch.setattr("time.monotonic", lambda: now + 1.5)
    viewer.on_tick()
    assert board.messages[0].text == "The light from everywhere."
    assert is_drawn_whole(viewer)


def rows(viewer: Viewer, name: str) -> list[Widget]:
    return rows_of_menu(viewer.session, viewer.screens[name], viewer.screens.values())


def test_the_picture_leads_to_every_screen_and_every_screen_back(tmp_path: Path) -> None:
    viewer = desk_viewer(tmp_path)
    labels = [row.label for row in rows(viewer, "picture")]
    for name, screen in viewer.screens.items():
        if name == "picture":
            continue
        assert (screen.title in labels) is screen.is_in_menu
        back = next(row for row in rows(viewer, name) if row.label == "< picture")
        viewer.session.turn_to(name)
        back.pick(Place(0, 0))
        assert viewer.session.screen == "picture"


def test_each_menu_undoes_and_redoes(tmp_path: Path) -> None:
    viewer = desk_viewer(tmp_path)
    session, before = viewer.session, viewer.studio.scene
    for screen in viewer.screens.values():
        session.edit(before.replace(ambient=0.7))
        after = session.scene
        undo = next(row for row in last_rows(session, screen) if row.help.startswith("Undo"))
        undo.nudge(-1)
        assert session.scene is before
        undo.nudge(1)
        assert session.scene is after
        session.undo()


def test_the_last_row_of_a_page_turns_to_the_next_and_around() -> None:
    rows: list[Widget] = [Button(str(number)) for number in range(60)]
    seen: list[int] = []
    number = 0
    for _ in range(3):
        page = page_of_menu(rows, (), number, seen.append)
        page[-1].pick(Place(0, 0))
        number = seen[-1]
    assert seen == [1, 2, 0]
    assert [row.label for row in page_of_menu(rows, (), 9, seen.append)] == [
        row.label for row in page_of_menu(rows, (), 2, seen.append)
    ]


def test_every_page_of_a_long_menu_ends_with_undo(tmp_path: Path) -> None:
    viewer = desk_viewer(tmp_path)
    rows: list[Widget] = [Button(str(number)) for number in range(60)]
    last = last_rows(viewer.session, viewer.screens["picture"])
    labels = []
    for number in range(3):
        page = page_of_menu(rows, last, number, lambda _: None)
        assert [row.label for row in page[-3:]] == [row.label for row in last]
        assert all(MENU.covers(row.area) for row in page)
        labels += [row.label for row in page[:-4]]
    assert labels == [row.label for row in rows]


def test_undo_and_redo_are_dim_while_there_is_no_step_for_them(tmp_path: Path) -> None:
    viewer = desk_viewer(tmp_path)
    session = viewer.session

    def inks() -> list[int]:
        undo = last_rows(session, viewer.screens["desk"])[1].at(MENU)
        return [
            next(
                word
                for word in (WHITE, GRAY)
                if text(label, item.area.left, item.area.top, word, NIGHT) == item
            )
            for label, item in zip(("undo", "steps", "redo"), undo.items(lit=False)[1:], strict=True)
        ]

    undo = last_rows(session, viewer.screens["desk"])[1]
    assert (inks(), undo.why_not) == ([GRAY] * 3, "there is no step to undo")
    session.edit(session.scene.replace(ambient=0.7))
    assert inks() == [WHITE, WHITE, GRAY]
    session.undo()
    assert inks() == [GRAY, WHITE, WHITE]
    assert not last_rows(session, viewer.screens["desk"])[1].why_not


# Lists, sections and hiding.

NAMES = ("matte", "gloss", "chrome", "satin", "glass")


class Room(Screen):
    """A screen over the picture with a list, sections, and a panel."""

    name = "room"
    title = "room"
    help = "the room"
    shows_picture = True

    def __init__(self, session: Session) -> None:
        super().__init__(session)
        self.chosen = "chrome"
        self.rows_of: dict[str, int] = {"near": 3, "far": 15, "farther": 15}
        self.did: list[str] = []

    def base(self) -> Words:
        return self.session.studio.words

    def rows(self) -> list[Widget]:
        def choose(name: str) -> None:
            if name == "glass":
                raise UsageError("a finish must not be glass; choose another")
            self.chosen = name

        rows: list[Widget] = [
            Choice("finish", "The finish.", names=NAMES, present=self.chosen, choose=choose),
            Choice("page", names=("1", "2", "3", "4"), present="1", choose=self.did.append, turns_pages=True),
        ]
        for title, count in self.rows_of.items():
            rows += [Section(title), *(self._button(f"{title} {number}") for number in range(count))]
        return rows

    def widgets(self) -> list[Widget]:
        return [self._button("panel").at(Area(8, 8, 99, 23))]

    def handles(self) -> list[Handle]:
        return [Handle("covered", 470, 30, "?"), Handle("free", 300, 200, "a handle")]

    def pick(self, gesture: Gesture) -> None:
        self.did.append("pick")

    def drag(self, start: Gesture, last: Gesture, now: Gesture) -> None:
        self.did.append("drag")

    def _button(self, label: str) -> Button:
        return Button(label, run=lambda: self.did.append(label))


@pytest.fixture
def room(viewer: Viewer) -> Room:
    room = viewer.screens["room"] = Room(viewer.session)
    viewer.session.turn_to("room")
    viewer.tell("")
    return room


def labels(board: Board) -> list[str]:
    return [widget.label for widget in board.widgets()]


def pick(viewer: Viewer, label: str) -> None:
    point(viewer, "pick", *middle_of(viewer.board, label))


def hint_at(viewer: Viewer, label: str) -> str:
    point(viewer, "hover", *middle_of(viewer.board, label))
    return viewer.board.messages[-1].text


def test_a_row_of_many_names_opens_a_list_from_which_a_name_is_taken(viewer: Viewer, room: Room) -> None:
    board = viewer.board
    assert hint_at(viewer, "finish") == "The finish; a click lists all 5."
    assert "gloss" not in labels(board)
    pick(viewer, "finish")
    assert room.chosen == "chrome"
    assert labels(board)[: len(NAMES)] == list(NAMES)
    assert board.messages[-1].text == "finish: pick a name on the list; a pick on the row takes it away"
    assert hint_at(viewer, "gloss") == "finish: gloss. A click elsewhere closes the list."
    assert is_drawn_whole(viewer)
    pick(viewer, "gloss")
    assert room.chosen == "gloss"
    assert "gloss" not in labels(board)
    assert is_drawn_whole(viewer)


def test_rows_that_turn_pages_and_drags_and_the_wheel_open_no_list(viewer: Viewer, room: Room) -> None:
    pick(viewer, "page")
    assert room.did == ["2"]
    element, line = middle_of(viewer.board, "finish")
    viewer.point(Gesture("wheel", element, line, steps=1))
    assert room.chosen == "satin"
    for kind, place in (("grab", element), ("drag", MENU.left), ("drop", MENU.left)):
        point(viewer, kind, place, line)
    assert room.chosen == "matte"
    assert "gloss" not in labels(viewer.board)


def test_the_row_and_escape_and_a_pick_elsewhere_close_a_list(viewer: Viewer, room: Room) -> None:
    board = viewer.board
    for close in (
        lambda: pick(viewer, "finish"),
        lambda: viewer.on_key("escape"),
        # Beside the menu, this pick does nothing else: neither the screen, nor its panel or handle has it.
        lambda: point(viewer, "pick", 200, 300),
        lambda: pick(viewer, "panel"),
        lambda: point(viewer, "pick", 302, 200),
    ):
        pick(viewer, "finish")
        assert "gloss" in labels(board)
        close()
        assert "gloss" not in labels(board)
        assert (room.chosen, room.did, board.held) == ("chrome", [], None)
        assert is_drawn_whole(viewer)
    pick(viewer, "finish")
    pick(viewer, "near 1")
    assert room.did == ["near 1"]
    assert "gloss" not in labels(board)
    pick(viewer, "finish")
    for kind, element in (("grab", 100), ("drag", 120), ("drop", 120)):
        point(viewer, kind, element, 300)
    assert room.did == ["near 1", "drag"]
    assert "gloss" not in labels(board)


def test_a_list_over_a_picture_covers_what_is_below_it(viewer: Viewer, room: Room) -> None:
    assert viewer.board.handle_at(470, 30) is not None
    pick(viewer, "finish")
    (area,) = {viewer.board.layout.listed.area} if viewer.board.layout.listed else {SCREEN}
    assert area.has(470, 30)
    assert viewer.board.handle_at(470, 30) is None


def test_a_name_that_is_refused_leaves_the_list_open(viewer: Viewer, room: Room) -> None:
    pick(viewer, "finish")
    pick(viewer, "glass")
    assert viewer.message == "a finish must not be glass; choose another"
    assert room.chosen == "chrome"
    pick(viewer, "satin")
    assert room.chosen == "satin"


def test_keys_go_through_a_list_and_back_to_its_row(viewer: Viewer, room: Room) -> None:
    board = viewer.board
    viewer.on_key("tab")
    while board.lit != "finish":
        viewer.on_key("down")
    viewer.on_key("return")
    assert board.lit == "finish.chrome"
    viewer.on_key("down")
    assert board.lit == "finish.satin"
    viewer.on_key("down")
    viewer.on_key("down")
    assert board.lit == "finish.matte"
    viewer.on_key("return")
    assert room.chosen == "matte"
    assert board.lit == "finish"
    viewer.on_key("return")
    assert board.lit == "finish.matte"
    viewer.on_key("escape")
    assert (board.lit, room.chosen) == ("finish", "matte")
    assert board.has_focus


def test_the_menu_of_the_picture_stays_while_its_list_is_open(viewer: Viewer) -> None:
    board = viewer.board
    viewer.session.turn_to("picture")
    viewer.tell("")
    point(viewer, "hover", 638, 100)
    pick(viewer, "view")
    assert board.layout.listed is not None
    point(viewer, "hover", 100, 100)
    assert board.has_menu
    point(viewer, "pick", 100, 100)
    assert not board.has_menu


def test_a_list_whose_row_went_is_not_open_when_the_row_is_back(viewer: Viewer) -> None:
    board, session = viewer.board, viewer.session
    named = session.scene
    for angle in range(4):
        named = named.with_view(angle=angle).with_saved_view()
    session.edit(named)
    session.turn_to("picture")
    viewer.tell("")
    point(viewer, "hover", 638, 100)
    pick(viewer, "other actions")
    pick(viewer, "camera")
    assert board.layout.listed is not None
    session.edit(named.replace(views=()))
    viewer.tell("")
    point(viewer, "hover", 100, 100)
    assert not board.has_menu
    session.edit(named)
    point(viewer, "hover", 638, 100)
    assert board.has_menu
    assert board.layout.listed is None


def test_sections_fold_and_unfold_and_each_screen_keeps_its_own(viewer: Viewer, room: Room) -> None:
    board = viewer.board
    assert {"near 0", "far 14"} <= set(labels(board))
    assert "farther 0" not in labels(board)
    assert hint_at(viewer, "farther").startswith("A click shows farther 0, farther 1, ")
    assert hint_at(viewer, "far") == "A click folds these rows."
    pick(viewer, "farther")
    assert {"near 0", "farther 14"} <= set(labels(board))
    assert "far 0" not in labels(board)
    pick(viewer, "near")
    assert "near 0" not in labels(board)
    assert is_drawn_whole(viewer)
    viewer.session.turn_to("desk")
    viewer.tell("")
    viewer.session.turn_to("room")
    viewer.tell("")
    assert not {"near 0", "far 0"} & set(labels(board))
    assert "farther 14" in labels(board)
    assert "more" not in labels(board)


def test_the_section_of_a_row_that_was_used_stays_open_when_it_grows(viewer: Viewer, room: Room) -> None:
    pick(viewer, "far 3")
    room.rows_of["far"] = 18
    viewer.tell("")
    assert "far 17" in labels(viewer.board)
    assert "near 0" not in labels(viewer.board)


def test_the_rows_at_the_end_of_the_menu_are_in_no_section(viewer: Viewer, room: Room) -> None:
    pick(viewer, "compare")
    assert "farther 0" not in labels(viewer.board)
    assert "far 0" in labels(viewer.board)


def test_a_section_that_is_too_long_alone_comes_in_pages(viewer: Viewer, room: Room) -> None:
    room.rows_of["farther"] = 40
    viewer.tell("")
    pick(viewer, "farther")
    seen: set[str] = set()
    for _ in range(3):
        seen |= set(labels(viewer.board))
        pick(viewer, "more")
    assert {f"farther {number}" for number in range(40)} <= seen


def test_one_key_hides_the_menu_and_all_panels_and_brings_them_back(viewer: Viewer, room: Room) -> None:
    board = viewer.board
    assert "panel" in labels(board)
    viewer.on_key("h", typed="h")
    assert labels(board) == []
    assert not board.has_menu
    assert "H shows them again" in viewer.message
    viewer.tell("")
    assert np.array_equal(display_of(viewer).words, viewer.studio.words)
    # The picture below is free, and the menu comes on demand.
    point(viewer, "pick", 20, 15)
    assert room.did == ["pick"]
    point(viewer, "hover", 638, 100)
    assert board.has_menu
    assert "panel" not in labels(board)
    viewer.on_key("h", typed="h")
    assert "panel" in labels(board)
    assert board.has_menu
    assert is_drawn_whole(viewer)


def test_a_row_hides_the_panels_and_a_row_at_the_right_edge_brings_them_back(
    viewer: Viewer, room: Room
) -> None:
    board = viewer.board
    pick(viewer, "hide panels")
    assert labels(board) == []
    point(viewer, "hover", 100, 100)
    point(viewer, "hover", 638, 100)
    pick(viewer, "show panels")
    assert "panel" in labels(board)


def test_escape_and_another_screen_bring_hidden_panels_back(viewer: Viewer, room: Room) -> None:
    viewer.on_key("h", typed="h")
    viewer.on_key("escape")
    assert "panel" in labels(viewer.board)
    assert viewer.page == "room"
    viewer.on_key("h", typed="h")
    viewer.session.turn_to("desk")
    viewer.tell("")
    assert "ambient" in labels(viewer.board)
    assert "hide panels" not in labels(viewer.board)


def test_hidden_widgets_over_every_screen_come_back_too(viewer: Viewer, room: Room) -> None:
    viewer.board.over = lambda: [Button("over", area=Area(100, 400, 200, 415))]
    viewer.tell("")
    assert "over" in labels(viewer.board)
    viewer.on_key("h", typed="h")
    assert "over" not in labels(viewer.board)
    viewer.on_key("h", typed="h")
    assert "over" in labels(viewer.board)
