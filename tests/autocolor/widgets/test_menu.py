from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from autocolor.widgets.menu import MENU, MOST_LINES, WIDE_BAR, WORK, laid_out, menu_items, pages_of
from autocolor.widgets.widget import ROW_LINES, Button, Gap, Heading, Widget

rows = st.lists(st.sampled_from([Button, Gap, Heading]), max_size=120).map(
    lambda kinds: [kind(str(number)) for number, kind in enumerate(kinds)]
)


@given(rows)
def test_the_pages_of_a_menu_have_all_rows_in_their_order(rows: list[Widget]) -> None:
    pages = pages_of(rows)
    assert [row for page in pages for row in page] == rows
    for page in pages:
        shown = [*page, Button("more")] if len(pages) > 1 else page
        assert [row.label for row in laid_out(shown)] == [row.label for row in shown]


def test_a_heading_is_on_the_page_of_what_is_below_it() -> None:
    rows = [Button(str(number)) for number in range(60)]
    rows_a_page = len(pages_of(rows)[0])
    headed = [*rows[: rows_a_page - 1], Heading("more of it"), *rows[rows_a_page - 1 :]]
    first, second, *_ = pages_of(headed)
    assert len(first) == rows_a_page - 1
    assert second[0].label == "more of it"


@given(rows)
def test_rows_stand_one_below_the_other_within_the_menu(rows: list[Widget]) -> None:
    top = MENU.top
    for row in laid_out(rows):
        assert MENU.covers(row.area)
        assert row.area.top == top
        assert row.area.height == (ROW_LINES // 2 if isinstance(row, Gap) else ROW_LINES)
        top = row.area.bottom + 1
    assert MENU.height == MOST_LINES == 464
    assert MENU == (504, 0, 639, 463)
    assert WORK == (0, 0, 503, 463)
    assert WIDE_BAR == (0, 440, 503, 463)


def test_the_row_that_is_lit_alone_looks_different() -> None:
    rows = laid_out([Button("one"), Button("one"), Button("two", why_not="not now")])
    dark, lit, dim = (menu_items(rows, each) for each in (None, rows[1], rows[2]))
    assert {item.area for item in set(lit) - set(dark)} == {
        item.area for item in lit if rows[1].area.covers(item.area)
    }
    assert dim == dark
