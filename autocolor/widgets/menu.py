"""The menu: a column of rows at the right edge of the screen, and what its rows open beside it.

A number opens a wide bar above the message line, a choice of many names a list, and a section its rows.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Final, NamedTuple, TypeVar

from autocolor.widgets.items import (
    CHARACTER,
    DOWN,
    HEIGHT,
    NIGHT,
    RIGHT,
    SLATE,
    WIDTH,
    YELLOW,
    Area,
    Item,
    filled,
    fitted,
    outline,
    pointer,
    text,
)
from autocolor.widgets.widget import MARGIN, ROW_LINES, TEXT_DOWN, Button, Choice, Place, Widget, page_choice

MESSAGE_LINES: Final = 16
"""The height of the message line, at the bottom of every screen."""

MESSAGE_CHARACTERS: Final = (WIDTH - 2 * MARGIN) // CHARACTER
"""The characters of the message line."""

MENU_ELEMENTS: Final = 136
STRIP: Final = Area(0, 0, WIDTH - 1, ROW_LINES - 1)
"""The words that lead to the screens, above every menu."""

MENU: Final = Area(WIDTH - MENU_ELEMENTS, STRIP.bottom + 1, WIDTH - 1, HEIGHT - MESSAGE_LINES - 1)
WORK: Final = Area(0, MENU.top, MENU.left - 1, MENU.bottom)
"""The area of a screen beside the menu, below the strip."""

WIDE_BAR: Final = Area(0, MENU.bottom - 23, WORK.right, MENU.bottom)
"""Where the wide bar of a number stands."""

MORE: Final = "more"
"""The label of the row that turns the pages of a menu, and of a list of names."""


def lines_of(rows: Sequence[Widget]) -> int:
    """The lines that rows take one below the other."""
    return sum([row.row_lines for row in rows])


def laid_out(rows: Sequence[Widget], area: Area = MENU) -> list[Widget]:
    """The rows of the menu, or of another column, with their areas, from the top."""
    placed, top = [], area.top
    for row in rows:
        end = top + row.row_lines
        placed.append(row.at(Area(area.left + 1, top, area.right, end - 1)))
        top = end
    return placed


def menu_items(rows: Sequence[Widget], lit: Widget | None) -> list[Item]:
    """The items of the menu: its ground and its rows. The row `lit` is lit."""
    items = [filled(MENU, NIGHT), filled(MENU._replace(right=MENU.left), SLATE)]
    return [*items, *(item for row in rows for item in row.items(row is lit and not row.why_not))]


def page_of_menu(
    rows: Sequence[Widget], last: Sequence[Widget], number: int, turn: Callable[[int], object]
) -> list[Widget]:
    """The rows of a page of the menu, counted from 0, laid out; the last page if there are not so many.

    Each page ends with the `last` rows. If there are several pages, the row before them turns to another.
    """
    room, used, pages = MENU.height - lines_of(last), 0, list[list[Widget]]([[]])
    if lines_of(rows) > room:
        room -= ROW_LINES
    for row in rows:
        used += row.row_lines
        if used > room:
            pages.append([])
            used = row.row_lines
        pages[-1].append(row)
    number = min(number, len(pages) - 1)
    if len(pages) > 1:
        pages[number].append(page_choice("The other rows of this menu.", number, len(pages), turn, MORE))
    return laid_out([*pages[number], *last])


Thing = TypeVar("Thing")


def paged(
    things: Sequence[Thing],
    size: int,
    page: int,
    help: str,
    turn: Callable[[int], object],
    label: str = "page",
    within: str = "",
) -> tuple[Sequence[Thing], list[Widget]]:
    """The things of a page of `size`, and the row that turns to other pages, if there are any.

    Pages are counted from 0; beyond the last page, it is the last page. See `page_choice`.
    """
    pages = max(1, -(-len(things) // size))
    page = min(page, pages - 1)
    turning: list[Widget] = [page_choice(help, page, pages, turn, label, within)] if pages > 1 else []
    return things[page * size : (page + 1) * size], turning


# The list of a choice with many names: at the left of its row, in as many columns as it needs.

LIST_ROWS: Final = MENU.height // ROW_LINES
"""The most rows of a column."""


class NameList(NamedTuple):
    """An open list: its area, and its rows with their areas."""

    area: Area
    rows: Sequence[Widget]

    @property
    def chosen(self) -> Widget:
        """The row of the present name; the first row if it is on another page."""
        return next((row for row in self.rows if isinstance(row, Button) and row.is_chosen), self.rows[0])

    def items(self, lit: Widget | None) -> list[Item]:
        """The items of the list. The row `lit` is lit."""
        cells = (item for row in self.rows for item in row.items(row is lit))
        return [filled(self.area, NIGHT), *cells, outline(self.area, SLATE)]


def list_of(
    choice: Choice, page: int | None, take: Callable[[str], object], turn: Callable[[int], object]
) -> NameList:
    """The list of a choice in a menu; `take` is called with the name that is picked.

    The present name stands beside the row, if there is room. Names that do not fit are on further pages,
    counted from 0; `turn` is called with the number of another page. None is the page of the present name.
    """
    names, present = list(choice.names), choice.present
    width = min(2 * MARGIN + CHARACTER * max(map(len, names)), WORK.width)
    most = LIST_ROWS * (WORK.width // width)
    size = len(names) if len(names) <= most else most - 1
    if page is None:
        page = names.index(present) // size if present in names else 0
    shown, turning = paged(names, size, page, "The other names.", turn, MORE, choice.key)
    cells: list[Widget] = [
        Button(
            name,
            f"{choice.label}: {name}. A click elsewhere closes the list.",
            within=choice.key,
            run=partial(take, name),
            is_chosen=name == present,
        )
        for name in shown
    ]
    beside = next((number for number, cell in enumerate(cells) if cell.label == present), 0)
    cells += turning
    columns = -(-len(cells) // LIST_ROWS)
    rows = -(-len(cells) // columns)
    top = choice.area.top - ROW_LINES * (beside % rows)
    top = max(MENU.top, min(top, MENU.bottom + 1 - ROW_LINES * rows))
    left = MENU.left - columns * width
    placed = []
    for number, cell in enumerate(cells):
        x, y = left + width * (number // rows), top + ROW_LINES * (number % rows)
        placed.append(cell.at(Area(x, y, x + width - 1, y + ROW_LINES - 1)))
    return NameList(Area(left, top, MENU.left - 1, top + ROW_LINES * rows - 1), placed)


# Sections: headings that fold and unfold the rows below them, so that a long menu fits in one page.


@dataclass(frozen=True)
class Section(Widget):
    """A heading over the rows up to the next section; a pick folds or unfolds them."""

    is_open: bool = True
    fold: Callable[[bool], object] = lambda _: None
    """Called with whether the section is to be open."""

    @property
    def key(self) -> str:
        return f"section {self.label}"

    def items(self, lit: bool) -> list[Item]:
        left, top, *_ = self.area
        ground = SLATE if lit else NIGHT
        middle = top + ROW_LINES // 2 - 1
        sign = (left + MARGIN + 4, middle + 3, DOWN) if self.is_open else (left + MARGIN + 6, middle, RIGHT)
        label = fitted(self.label, self.characters - 2)
        return [
            filled(self.area, ground),
            pointer(*sign, YELLOW, ground),
            text(label, left + MARGIN + 2 * CHARACTER, top + TEXT_DOWN, YELLOW, ground),
        ]

    def pick(self, place: Place) -> object:
        return self.fold(not self.is_open)

    def nudge(self, steps: float) -> object:
        return self.fold(steps > 0)


def folded(
    rows: Sequence[Widget], folds: Mapping[str, bool], fold: Callable[[str, bool], object], lines: int
) -> list[Widget]:
    """The rows of a menu without the rows of its folded sections, which fit in `lines` if possible.

    `folds` is for `open_sections`; `fold` is called with the label of a section and whether to open it.
    """
    sections = sections_of(rows)
    if len(sections) == 1:
        return list(rows)
    always, *others = sections
    heights = {section[0].label: lines_of(section[1:]) for section in others}
    is_open = open_sections(heights, folds, lines - lines_of(always) - ROW_LINES * len(others))
    shown = list(always)
    for section, *inside in others:
        assert isinstance(section, Section)
        label, folded_rows = section.label, ", ".join(row.label for row in inside)
        help = "A click folds these rows." if label in is_open else f"A click shows {folded_rows}."
        shown.append(replace(section, help=help, is_open=label in is_open, fold=partial(fold, label)))
        shown += inside if label in is_open else []
    return shown


def sections_of(rows: Sequence[Widget]) -> list[list[Widget]]:
    """The rows before the first section, and each section with its rows."""
    sections: list[list[Widget]] = [[]]
    for row in rows:
        if isinstance(row, Section):
            sections.append([])
        sections[-1].append(row)
    return sections


def open_sections(heights: Mapping[str, int], folds: Mapping[str, bool], room: int) -> set[str]:
    """The sections that are open, by the heights of their rows and the lines of room for all of these rows.

    `folds` has whether sections are to be open or folded, the last used section at the end. That section and
    the sections above it are as `folds` has them, so that its heading stays in its place; only if it fits
    without them, the nearest above are folded. The sections below are open while there is room, unless they
    are folded in `folds`.
    """
    names = list(heights)
    used = next((name for name in reversed(list(folds)) if name in heights), None)
    end = 0 if used is None else names.index(used) + 1
    is_open = [name for name in names[:end] if folds.get(name, False)]
    most = len(is_open) if used in is_open and heights[used] > room else 1
    while len(is_open) > most and sum(heights[name] for name in is_open) > room:
        del is_open[-2 if is_open[-1] == used else -1]
    for name in names[end:]:
        if folds.get(name, True) and sum(heights[each] for each in (*is_open, name)) <= room:
            is_open.append(name)
    return set(is_open)
