from __future__ import annotations

import os
from itertools import combinations
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor.errors import UsageError
from autocolor.mapping.ranges import BACKGROUND, SCREENS, LevelRange
from autocolor.screens.cached import Cached
from autocolor.screens.entries_screen import CELL_HEIGHT, CELL_WIDTH, SIDE, cell_words, named_cells
from autocolor.screens.help_screen import LIMITS
from autocolor.screens.keys import rows_of_help
from autocolor.screens.message_line import MESSAGE, MessagePart, lines_of_message, message_items
from autocolor.screens.pages import LEFT, MIDDLE, ROWS_A_PAGE, STEP, TOP
from autocolor.screens.screen import Content
from autocolor.screens.session import LastEdit
from autocolor.screens.tutorial import Tutorial
from autocolor.screens.viewer import Viewer
from autocolor.widgets.bars import Bar
from autocolor.widgets.items import BLACK, CHARACTER, ORANGE, SCREEN, WHITE, WIDTH, YELLOW, Area, filled, text
from autocolor.widgets.menu import MENU, MESSAGE_CHARACTERS, WIDE_BAR, laid_out
from ramtek_emu import Ramtek9300, instructions
from tests.autocolor.screens.boards import desk_hand
from tests.autocolor.screens.hand import Hand
from tests.autocolor.widgets.drawing import checksum
from tests.small import boxes, wall_scene

ROWS = rows_of_help()


@pytest.mark.parametrize("count", [0, ROWS_A_PAGE - 3, len(ROWS), 100])
def test_pages_of_text_have_every_row_and_are_turned_by_the_unit_the_wheel_and_keys(
    tmp_path: Path, count: int
) -> None:
    hand = Hand(Viewer(wall_scene(), Ramtek9300(), tmp_path))
    rows = [ROWS[number % len(ROWS)] for number in range(count)]
    hand.viewer.session.keys = rows
    hand.press("F1")
    turns = (
        lambda: hand.click(300, 200),
        lambda: hand.viewer.on_pointer(300, 200, "wheel down"),
        lambda: hand.press("space"),
        lambda: hand.press("page down"),
    )
    pages = -(-(count + 1 + len(LIMITS)) // ROWS_A_PAGE)
    shown = []
    for page in range(pages):
        items = hand.viewer.board.content.items
        shown.append(items)
        assert all(SCREEN.covers(item.area) and not MESSAGE.overlaps(item.area) for item in items)
        assert not any(one.area.overlaps(other.area) for one, other in combinations(items, 2))
        for number, (keys, does) in enumerate(rows[page * ROWS_A_PAGE :][:ROWS_A_PAGE]):
            top = TOP + STEP * number
            assert text(keys, LEFT, top, ORANGE) in items
            assert text(does, MIDDLE, top, WHITE) in items
        turns[page]()
    # After the last page comes the first, and before the first the last.
    assert hand.viewer.board.content.items == shown[0]
    hand.press("page up")
    assert hand.viewer.board.content.items == shown[-1]


RANGES = {"body": LevelRange(1, 500), "glass": LevelRange(501, 40)}


def owner(word: int) -> str:
    if word == BACKGROUND:
        return "background"
    if word >= SCREENS.first:
        return "screens"
    return next((name for name, levels in RANGES.items() if levels.first <= word <= levels.last), "nobody")


def test_every_cell_shows_its_own_word_and_a_line_runs_between_different_owners() -> None:
    page = cell_words(tuple(RANGES.values()))
    assert page.shape == (480, 640)
    for word in range(1024):
        line, element = divmod(word, SIDE)
        cell = page[line * CELL_HEIGHT :, element * CELL_WIDTH :][:CELL_HEIGHT, :CELL_WIDTH]
        assert (cell[1:-1, 1:-1] == word).all()
        edges = (
            (line > 0, -SIDE, cell[0, 1:-1]),
            (line < SIDE - 1, SIDE, cell[-1, 1:-1]),
            (element > 0, -1, cell[1:-1, 0]),
            (element < SIDE - 1, 1, cell[1:-1, -1]),
        )
        for has_neighbor, step, edge in edges:
            apart = has_neighbor and owner(word) != owner(word + step)
            assert (edge == (YELLOW if apart else word)).all()


@given(st.lists(st.tuples(st.text("abc", min_size=1, max_size=30), st.integers(2, 300)), max_size=6))
def test_a_name_stands_within_the_cells_of_its_range(rows: list[tuple[str, int]]) -> None:
    ranges: dict[str, LevelRange] = {}
    first = 1
    for owner, count in rows:
        if first + count <= SCREENS.first and owner not in ranges:
            ranges[owner] = LevelRange(first, count)
            first += count
    named = {**ranges, "screens": SCREENS}
    for (name, line, element), whole, levels in zip(named_cells(ranges), named, named.values(), strict=True):
        width = len(name) * CHARACTER + 3
        cells = range(line * SIDE + element, line * SIDE + element - (-width // CELL_WIDTH))
        assert set(cells) <= set(range(levels.first, levels.last + 1))
        assert element * CELL_WIDTH + width <= WIDTH
        assert len(name) <= len(whole)


def test_a_message_that_fits_fills_its_line_and_nothing_else() -> None:
    display = Ramtek9300()
    for item in message_items([MessagePart("x" * MESSAGE_CHARACTERS, WHITE)], MENU.left):
        assert MESSAGE.covers(item.area)
        display.send(np.frombuffer(item.stream, np.uint16))
    assert not display.words[: MESSAGE.top].any()
    assert set(np.unique(display.words[MESSAGE.top :])) == {BLACK, WHITE}
    assert message_items([MessagePart("", WHITE)]) == [filled(MESSAGE, BLACK)]


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


def test_a_screen_without_colors_refuses_to_take_a_color() -> None:
    with pytest.raises(UsageError, match=r"^this screen takes no color; turn to color mixing$"):
        Content().take_color("red", 1, 1)


def test_a_value_is_computed_once_for_the_same_sources_and_again_if_it_failed() -> None:
    cached: Cached[float] = Cached()
    source = [1]
    with pytest.raises(ZeroDivisionError):
        cached.of(lambda: 1 / 0, source, "a")
    assert [cached.of(lambda value=value: value, source, "a") for value in (2, 3)] == [2, 2]  # type: ignore[misc]
    # An equal source is another source.
    assert cached.of(lambda: 4, [1], "a") == 4
    assert cached.of(lambda: 5, [1]) == 5
    assert cached.of(lambda: 6) == 6


# What every screen draws over its base, as checksums: a golden of places, inks, labels and numerals.
# If a screen changes on purpose, look at it, and copy the new number from the failure.

PAGES = {
    "picture": 3004830101,
    "light and view": 1914575561,
    "lights": 185925428,
    "reflectance": 3909965867,
    "mixing": 3292494096,
    "blending": 1030285353,
    "mapping": 2980384995,
    "scalar": 1277672108,
    "variants": 1031639035,
    "history": 2038959727,
    "file": 3016242762,
    "explain": 1098717020,
    "split": 927769705,
    "entries": 2831939804,
    "sent": 3012791792,
    "help": 3885588141,
    "tutorial": 22660284,
}


def test_every_screen_is_drawn_as_it_was(tmp_path: Path) -> None:
    folder = tmp_path / "scenes"
    (folder / "more").mkdir(parents=True)
    (folder / "car.obj").touch()
    # A row shows the year of an old file.
    os.utime(folder / "car.obj", (1e9, 1e9))
    viewer = Viewer(boxes().with_scalar(name="z"), Ramtek9300(), folder)
    viewer.studio.keep_variant("first")
    viewer.studio.keep_variant()
    # Words of the picture would depend on the rounding of the light.
    after = viewer.studio.scene.with_paint("low", object_color="#24c")
    entries = instructions.load_entries(1, [(number, 0, 7) for number in range(60)])
    edit = LastEdit(viewer.studio.scene, after, entries, 1234)
    board = viewer.board
    board.menu.is_pinned = True
    pages = {}
    for name in viewer.screens:
        viewer.session.turn_to(name)
        viewer.tell("")
        viewer.session.last_edit = edit
        items = list(board.page().items)
        for widget in board.widgets():
            items += widget.items(lit=True)
        # The rows of all pages of the menu, and their wide bars.
        for row in board.content.rows():
            for widget in laid_out([row]):
                items += widget.items(lit=False)
            if isinstance(row, Bar):
                items += row.at(WIDE_BAR).items(lit=False)
        pages[name] = checksum(items, skips_images=True)
    viewer.session.turn_to("picture")
    tutorial = Tutorial(viewer.session)
    board.over = tutorial.widgets
    viewer.tell("")
    items = list(board.page().items)
    for widget in tutorial.widgets():
        items += widget.items(lit=True)
    pages["tutorial"] = checksum(items)
    changed = {name: number for name, number in pages.items() if PAGES.get(name) != number}
    assert not changed, changed
