from __future__ import annotations

from autocolor.screens.board import MESSAGE
from autocolor.screens.help_screen import LIMITS, MIDDLE, STEP, TITLE, TOP, help_items
from autocolor.screens.viewer import rows_of_help
from autocolor.widgets.items import ORANGE, SCREEN, WHITE, text

ROWS = rows_of_help()


def test_every_row_of_the_help_fits_on_the_screen_above_the_message_line() -> None:
    items = help_items(TITLE, ROWS)
    assert len(items) == 1 + 2 * len(ROWS) + len(LIMITS)
    for number, item in enumerate(items):
        assert SCREEN.covers(item.area)
        assert not MESSAGE.overlaps(item.area)
        assert not any(item.area.overlaps(other.area) for other in items[:number])


def test_the_limits_of_the_method_stand_apart_from_the_rows() -> None:
    *rows, first, _ = help_items(TITLE, ROWS)
    assert first.area.top - rows[-1].area.bottom > STEP


def test_each_row_has_its_keys_and_what_they_do() -> None:
    items = help_items(TITLE, ROWS)
    for number, (keys, does) in enumerate(ROWS):
        assert keys.isascii()
        assert does.isascii()
        top = TOP + STEP * number
        assert text(does, MIDDLE, top, WHITE) in items
        assert [item for item in items if item.area.top == top and item.area.right < MIDDLE]
    assert text(ROWS[0][0], items[1].area.left, TOP, ORANGE) == items[1]
