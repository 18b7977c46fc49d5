from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from autocolor.widgets.menu import GAP_LINES, MENU, MOST_LINES, laid_out, menu_items, pages_of
from autocolor.widgets.widget import ROW_LINES, Button, Gap, Widget

rows = st.lists(st.sampled_from([Button, Gap]), max_size=120).map(
    lambda kinds: [kind(str(number)) for number, kind in enumerate(kinds)]
)


@given(rows)
def test_the_pages_of_a_menu_have_all_rows_in_their_order(rows: list[Widget]) -> None:
    pages = pages_of(rows)
    assert [row for page in pages for row in page] == rows
    for page in pages:
        shown = [*page, Button("more")] if len(pages) > 1 else page
        assert [row.label for row in laid_out(shown)] == [row.label for row in shown]


@given(rows)
def test_rows_stand_one_below_the_other_within_the_menu(rows: list[Widget]) -> None:
    top = MENU.top
    for row in laid_out(rows):
        assert MENU.covers(row.area)
        assert row.area.top == top
        assert row.area.height == (GAP_LINES if isinstance(row, Gap) else ROW_LINES)
        top = row.area.bottom + 1
    assert MENU.height == MOST_LINES


def test_the_row_that_is_lit_alone_looks_different() -> None:
    rows = laid_out([Button("one"), Button("one"), Button("two", why_not="not now")])
    dark, lit, dim = (menu_items(rows, each) for each in (None, rows[1], rows[2]))
    assert {item.area for item in set(lit) - set(dark)} == {
        item.area for item in lit if rows[1].area.covers(item.area)
    }
    assert dim == dark
