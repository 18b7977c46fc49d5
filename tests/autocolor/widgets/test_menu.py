from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor.widgets.items import Area
from autocolor.widgets.menu import (
    MENU,
    MORE,
    WORK,
    Section,
    folded,
    laid_out,
    lines_of,
    list_of,
    menu_items,
    open_sections,
    page_of_menu,
    sections_of,
)
from autocolor.widgets.widget import ROW_LINES, Button, Choice, Entry, Gap, Place, Widget

TALL = Entry("a row", value="with a long value")

rows = st.lists(st.sampled_from([Button("a button"), Gap("a gap"), TALL]), max_size=120)


@given(rows, st.lists(st.sampled_from([Gap("a gap"), Button("an end")]), max_size=4))
def test_the_pages_of_a_menu_have_all_rows_in_their_order(rows: list[Widget], last: list[Widget]) -> None:
    turned: list[int] = []
    shown: list[Widget] = []
    number = pages = 0
    while number < max(pages, 1):
        page = page_of_menu(rows, last, number, turned.append)
        assert [row.area.top for row in page] == [
            MENU.top + lines_of(page[:place]) for place in range(len(page))
        ]
        assert all(MENU.covers(row.area) for row in page)
        own = page[: len(page) - len(last)]
        if own and own[-1].label == MORE:
            more = own.pop()
            assert isinstance(more, Choice)
            pages = len(more.names)
            assert more.present == f"{number + 1} of {pages}"
            more.nudge(1)
            assert turned[-1] == (number + 1) % pages
        assert [row.label for row in page[len(page) - len(last) :]] == [row.label for row in last]
        shown += own
        number += 1
    assert [row.label for row in shown] == [row.label for row in rows]
    # If there are fewer pages than before, the last page is shown.
    assert page_of_menu(rows, last, 99, turned.append) == page
    # A page more is for a row that does not fit.
    assert (pages > 0) == (lines_of(rows) + lines_of(last) > MENU.height)


def test_the_row_that_is_lit_alone_looks_different() -> None:
    rows = laid_out([Button("one"), Button("one"), Button("two", why_not="not now")])
    dark, lit, dim = (menu_items(rows, each) for each in (None, rows[1], rows[2]))
    assert {item.area for item in set(lit) - set(dark)} == {
        item.area for item in lit if rows[1].area.covers(item.area)
    }
    assert dim == dark


# Lists.


def choice_of(names: list[str], present: str, top: int = 160) -> Choice:
    area = Area(MENU.left + 1, top, MENU.right, top + ROW_LINES - 1)
    return Choice("surface", names=names, present=present, area=area)


@given(
    st.lists(st.text("abcdefgh ", min_size=1, max_size=90), min_size=1, max_size=400, unique=True), st.data()
)
def test_the_pages_of_a_list_have_every_name_once_beside_the_menu(
    names: list[str], data: st.DataObject
) -> None:
    present = data.draw(st.sampled_from(names))
    choice = choice_of(names, present, ROW_LINES * data.draw(st.integers(1, 28)))
    taken: list[str] = []
    turned: list[int] = []
    seen: list[str] = []
    page = 0
    while True:
        shown = list_of(choice, page, taken.append, turned.append)
        assert WORK.covers(shown.area)
        assert shown.area.right == WORK.right
        areas = [row.area for row in shown.rows]
        assert all(shown.area.covers(area) for area in areas)
        assert not any(a.overlaps(b) for number, a in enumerate(areas) for b in areas[:number])
        for row in shown.rows:
            assert row.within == choice.key
            row.pick(Place(row.area.right, row.area.top))
        seen += taken
        if not turned or turned[-1] == 0:
            break
        page = turned[-1]
        taken.clear()
    assert seen == names
    first = list_of(choice, None, taken.append, turned.append)
    assert first.chosen.label == present
    has_room = len(first.rows) <= first.area.height // ROW_LINES and first.area.top > MENU.top
    if has_room and first.area.bottom < MENU.bottom:
        assert first.chosen.area.top == choice.area.top


def test_a_list_without_the_present_name_begins_at_its_first() -> None:
    shown = list_of(choice_of(["a", "b", "c", "d"], "another"), None, lambda _: None, lambda _: None)
    assert shown.chosen.label == "a"
    assert not any(row.is_chosen for row in shown.rows if isinstance(row, Button))
    dark, lit = set(shown.items(None)), set(shown.items(shown.rows[3]))
    assert lit != dark
    assert all(shown.rows[3].area.covers(item.area) for item in lit ^ dark)


# Sections.

folds = st.lists(st.tuples(st.sampled_from([f"s{n}" for n in range(10)]), st.booleans()), max_size=8)


def after(uses: list[tuple[str, bool]]) -> dict[str, bool]:
    """Whether sections were opened or folded, the last used at the end."""
    folds: dict[str, bool] = {}
    for name, is_open in uses:
        folds.pop(name, None)
        folds[name] = is_open
    return folds


@pytest.mark.parametrize(
    ("heights", "folds", "room", "is_open"),
    [
        # Sections that nobody used are open from the top, if they fit.
        ((10, 10, 10), {}, 25, "ab"),
        ((10, 30, 10), {}, 25, "ac"),
        ((10, 10, 10), {"x": True}, 25, "ab"),
        # The section that was used last, and those above it, stay as they are.
        ((10, 10, 10), {"c": True}, 20, "c"),
        ((10, 10, 10), {"b": True, "a": False}, 25, "bc"),
        ((10, 10, 10), {"c": True, "b": False}, 25, "c"),
        ((10, 10, 10), {"a": True, "b": True}, 20, "ab"),
        # To make room, the nearest above are folded, if that is enough.
        ((10, 10, 10), {"a": True, "b": True, "c": True}, 20, "ac"),
        ((10, 10, 10, 10), {"a": True, "b": True, "c": True, "d": True}, 20, "ad"),
        ((10, 10, 10), {"a": True, "b": True, "c": False}, 10, "a"),
        ((10, 10, 50), {"a": True, "b": True, "c": True}, 30, "abc"),
    ],
)
def test_sections_are_open_where_the_user_is(
    heights: tuple[int, ...], folds: dict[str, bool], room: int, is_open: str
) -> None:
    assert open_sections(dict(zip("abcd", heights, strict=False)), folds, room) == set(is_open)


def menu_of(*sizes: int) -> list[Widget]:
    """Two rows, and sections with so many rows."""
    menu: list[Widget] = [Gap("menu"), Button("first")]
    for number, size in enumerate(sizes):
        menu += [Section(f"s{number}"), *(Button(f"row {number}, {row}") for row in range(size))]
    return menu


@given(st.lists(st.integers(0, 30), max_size=6), folds)
def test_folding_leaves_rows_out_and_changes_no_order(sizes: list[int], uses: list[tuple[str, bool]]) -> None:
    rows, did = menu_of(*sizes), list[tuple[str, bool]]()
    shown = folded(rows, after(uses), lambda name, is_open: did.append((name, is_open)), MENU.height)
    labels = [row.label for row in rows]
    places = [labels.index(row.label) for row in shown]
    assert places == sorted(places)
    assert labels[:2] == [row.label for row in shown][:2]
    whole = {section[0].label: section[1:] for section in sections_of(rows)[1:]}
    for section, *inside in sections_of(shown)[1:]:
        assert isinstance(section, Section)
        assert inside == (whole[section.label] if section.is_open else [])
        section.pick(Place(0, 0))
        assert did[-1] == (section.label, not section.is_open)
        section.nudge(1)
        section.nudge(-1)
        assert did[-2:] == [(section.label, True), (section.label, False)]
    assert len(whole) == len(sections_of(shown)) - 1
    used = [name for name, is_open in after(uses).items() if is_open and name in whole]
    fixed = len(sizes) + 1.5
    if fixed + max([len(whole[name]) for name in used[-1:]], default=0) <= MENU.height / ROW_LINES:
        assert lines_of(shown) <= MENU.height
