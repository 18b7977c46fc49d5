from __future__ import annotations

from pathlib import Path

import pytest

from autocolor.screens.help_screen import LEFT, MIDDLE, ROWS_A_PAGE, STEP, TITLE, TOP, help_items
from autocolor.screens.message_line import MESSAGE
from autocolor.screens.viewer import Viewer, rows_of_help
from autocolor.widgets.items import ORANGE, SCREEN, WHITE, text
from ramtek_emu import Ramtek9300
from tests.autocolor.screens.hand import Hand
from tests.small import wall_scene

ROWS = rows_of_help()


@pytest.mark.parametrize("count", [0, 1, ROWS_A_PAGE, ROWS_A_PAGE + 1, len(ROWS), 100])
def test_every_row_is_on_a_page_and_nothing_overlaps(count: int) -> None:
    rows = [ROWS[number % len(ROWS)] for number in range(count)]
    for page in range(max(1, -(-count // ROWS_A_PAGE))):
        items = help_items(TITLE, rows, page)
        for number, item in enumerate(items):
            assert SCREEN.covers(item.area)
            assert not MESSAGE.overlaps(item.area)
            assert not any(item.area.overlaps(other.area) for other in items[:number])
        for number, (keys, does) in enumerate(rows[page * ROWS_A_PAGE :][:ROWS_A_PAGE]):
            top = TOP + STEP * number
            assert text(keys, LEFT, top, ORANGE) in items
            assert text(does, MIDDLE, top, WHITE) in items


def test_the_rows_are_plain_text() -> None:
    assert all(keys.isascii() and does.isascii() for keys, does in ROWS)


def test_pages_are_turned_by_the_unit_the_wheel_and_keys(tmp_path: Path) -> None:
    viewer = Viewer(wall_scene(), Ramtek9300(), tmp_path)
    hand = Hand(viewer)
    viewer.session.keys = ROWS * 3
    pages = -(-len(viewer.session.keys) // ROWS_A_PAGE)
    viewer.on_key("f1")
    shown = []
    for turn in (
        lambda: hand.click(300, 200),
        lambda: viewer.on_pointer(300, 200, "wheel down"),
        lambda: viewer.on_key("space", typed=" "),
    ):
        shown.append(viewer.board.screen.items())
        turn()
    assert len({str(items) for items in shown}) == 3
    for _ in range(pages - 3):
        hand.click(300, 200)
    assert viewer.board.screen.items() == shown[0]
