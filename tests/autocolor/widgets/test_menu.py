from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor.widgets.items import Area
from autocolor.widgets.menu import (
    MENU,
    MESSAGE_CHARACTERS,
    MOST_LINES,
    WIDE_BAR,
    WORK,
    Section,
    folded,
    laid_out,
    lines_of,
    list_of,
    menu_items,
    open_sections,
    page_of_menu,
    pages_of,
    sections_of,
)
from autocolor.widgets.widget import ROW_LINES, Button, Choice, Gap, Heading, Place, Widget

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


FIT = MOST_LINES // ROW_LINES
"""The rows of one page."""


def buttons(count: int) -> list[Widget]:
    return [Button(str(number)) for number in range(count)]


@pytest.mark.parametrize(
    ("count", "last", "sizes"),
    [
        (FIT, 0, [FIT]),
        (FIT + 1, 0, [FIT - 1, 2]),
        (2 * FIT - 2, 0, [FIT - 1, FIT - 1]),
        (2 * FIT - 1, 0, [FIT - 1, FIT - 1, 1]),
        (FIT - 2, 2, [FIT - 2]),
        (FIT - 1, 2, [FIT - 3, 2]),
    ],
)
def test_one_row_more_than_fits_makes_a_page_more(count: int, last: int, sizes: list[int]) -> None:
    rows, turned = buttons(count), list[int]()
    ends = [Button(f"end {number}") for number in range(last)]
    shown: list[str] = []
    for number, size in enumerate(sizes):
        page = page_of_menu(rows, ends, number, turned.append)
        labels = [row.label for row in page]
        assert all(MENU.covers(row.area) for row in page)
        assert labels[size:] == [*(["more"] if len(sizes) > 1 else []), *(row.label for row in ends)]
        shown += labels[:size]
        if len(sizes) > 1:
            more = page[size]
            assert isinstance(more, Button)
            assert more.value == f"{number + 1} of {len(sizes)}"
            more.pick(Place(0, 0))
            assert turned[-1] == (number + 1) % len(sizes)
    assert shown == [row.label for row in rows]
    # If there are fewer pages than before, the last one is shown.
    assert [row.label for row in page_of_menu(rows, ends, 99, turned.append)] == labels


@pytest.mark.parametrize(
    ("over", "goes_with"),
    [(Heading("over"), True), (Section("over"), False), (Section("over", is_open=False), False)],
)
def test_a_heading_is_on_the_page_of_the_row_below_it(over: Widget, goes_with: bool) -> None:
    rows = buttons(60)
    first, second, *_ = pages_of([*rows[: FIT - 2], over, *rows[FIT - 2 :]])
    assert (over in second, len(first)) == (goes_with, FIT - 2 if goes_with else FIT - 1)
    assert folded(rows, {}, lambda *_: None, MOST_LINES) == rows


@given(rows)
def test_rows_stand_one_below_the_other_within_the_menu(rows: list[Widget]) -> None:
    top = MENU.top
    for row in laid_out(rows):
        assert MENU.covers(row.area)
        assert row.area.top == top
        assert row.area.height == (ROW_LINES // 2 if isinstance(row, Gap) else ROW_LINES)
        top = row.area.bottom + 1
    assert MENU.height == MOST_LINES == 448
    assert MENU == (504, 16, 639, 463)
    assert WORK == (0, 16, 503, 463)
    assert WIDE_BAR == (0, 440, 503, 463)


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
            row.pick(row.area)  # type: ignore[arg-type]
        seen += taken
        if not turned or turned[-1] == 0:
            break
        page = turned[-1]
        taken.clear()
    assert seen == names
    first = list_of(choice, None, taken.append, turned.append)
    assert first.chosen.label == present
    room = len(first.rows) <= first.area.height // ROW_LINES and first.area.top > MENU.top
    if room and first.area.bottom < MENU.bottom:
        assert first.chosen.area.top == choice.area.top


def test_a_list_without_the_present_name_begins_at_its_first() -> None:
    shown = list_of(choice_of(["a", "b", "c", "d"], "another"), None, lambda _: None, lambda _: None)
    assert shown.chosen.label == "a"
    assert not any(row.is_chosen for row in shown.rows if isinstance(row, Button))
    dark, lit = set(shown.items(None)), set(shown.items(shown.rows[3]))
    assert lit != dark
    assert all(shown.rows[3].area.covers(item.area) for item in lit ^ dark)


# Sections.

heights = st.lists(st.integers(0, 40), max_size=8).map(
    lambda sizes: {f"s{n}": size for n, size in enumerate(sizes)}
)
folds = st.lists(st.tuples(st.sampled_from([f"s{n}" for n in range(10)]), st.booleans()), max_size=8)


def after(uses: list[tuple[str, bool]]) -> dict[str, bool]:
    """Whether sections were opened or folded, the last used at the end."""
    folds: dict[str, bool] = {}
    for name, is_open in uses:
        folds.pop(name, None)
        folds[name] = is_open
    return folds


@given(heights, folds, st.integers(-20, 120))
def test_a_used_section_and_those_above_stay_as_they_are_if_they_fit(
    heights: dict[str, int], uses: list[tuple[str, bool]], room: int
) -> None:
    folds, names = after(uses), list(heights)
    is_open = open_sections(heights, folds, room)
    used = [name for name in folds if name in heights][-1:]
    above = names[: names.index(used[0]) + 1] if used else []
    wanted = [name for name in above if folds.get(name, False)]
    fits = not used or used[0] not in wanted or heights[used[0]] <= room
    if not used or not fits or sum(heights[name] for name in wanted) <= room:
        assert is_open & set(above) == set(wanted)
    else:
        # The nearest above are folded first, and the used section last.
        left = [name for name in above if name in is_open]
        kept = [name for name in left if name not in used]
        assert kept == wanted[: len(kept)]
        assert (used[0] in left) == (used[0] in wanted)
    below = [name for name in names if name not in above]
    total = sum(heights[name] for name in is_open)
    for name in below:
        assert (name in is_open) <= folds.get(name, True)
        assert name in is_open or not folds.get(name, True) or total + heights[name] > room
    assert total <= room or not is_open & set(below)


def test_sections_that_nobody_used_are_open_from_the_top() -> None:
    assert open_sections({"a": 10, "b": 10, "c": 10}, {}, 25) == {"a", "b"}
    assert open_sections({"a": 10, "b": 30, "c": 10}, {}, 25) == {"a", "c"}
    assert open_sections({"a": 10, "b": 10, "c": 10}, {"a": True, "b": True}, 20) == {"a", "b"}
    assert open_sections({"a": 10, "b": 10, "c": 10}, {"a": True, "b": True, "c": True}, 20) == {"a", "c"}
    assert open_sections({"a": 10, "b": 10, "c": 10}, {"b": True, "a": False}, 25) == {"b", "c"}


def menu_of(*sizes: int) -> list[Widget]:
    """Two rows, and sections with so many rows."""
    menu: list[Widget] = [Heading("menu"), Button("first")]
    for number, size in enumerate(sizes):
        menu += [Section(f"s{number}"), *(Button(f"row {number}, {row}") for row in range(size))]
    return menu


@given(st.lists(st.integers(0, 30), max_size=6), folds)
def test_folding_leaves_rows_out_and_changes_no_order(sizes: list[int], uses: list[tuple[str, bool]]) -> None:
    rows, did = menu_of(*sizes), list[tuple[str, bool]]()
    shown = folded(rows, after(uses), lambda name, is_open: did.append((name, is_open)), MOST_LINES)
    labels = [row.label for row in rows]
    places = [labels.index(row.label) for row in shown]
    assert places == sorted(places)
    assert labels[:2] == [row.label for row in shown][:2]
    whole = {section[0].label: section[1:] for section in sections_of(rows)[1:]}
    for section, *inside in sections_of(shown)[1:]:
        assert isinstance(section, Section)
        assert inside == (whole[section.label] if section.is_open else [])
        assert len(section.hint) <= MESSAGE_CHARACTERS
        section.pick(None)  # type: ignore[arg-type]
        assert did[-1] == (section.label, not section.is_open)
        section.nudge(1)
        section.nudge(-1)
        assert did[-2:] == [(section.label, True), (section.label, False)]
    assert len(whole) == len(sections_of(shown)) - 1
    used = [name for name, is_open in after(uses).items() if is_open and name in whole]
    fixed = 2 + len(sizes)
    if fixed + max([len(whole[name]) for name in used[-1:]], default=0) <= MOST_LINES // ROW_LINES:
        assert lines_of(shown) <= MOST_LINES
