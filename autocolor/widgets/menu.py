"""The menu: a column of rows at the right edge of the screen, and the wide bar above the message line."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from typing import Final

from autocolor.widgets.items import HEIGHT, NIGHT, SLATE, WIDTH, Area, Item, filled
from autocolor.widgets.widget import ROW_LINES, Button, Heading, Widget

MESSAGE_LINES: Final = 16
"""The height of the message line, at the bottom of every screen."""

MENU_ELEMENTS: Final = 136
MENU: Final = Area(WIDTH - MENU_ELEMENTS, 0, WIDTH - 1, HEIGHT - MESSAGE_LINES - 1)
WORK: Final = Area(0, 0, MENU.left - 1, MENU.bottom)
"""The area of a screen beside the menu."""

WIDE_BAR: Final = Area(0, MENU.bottom - 23, WORK.right, MENU.bottom)
"""Where the wide bar of a number stands."""

MOST_LINES: Final = MENU.height


def lines_of(rows: Sequence[Widget]) -> int:
    """The lines that rows take one below the other."""
    return sum([row.row_lines for row in rows])


def laid_out(rows: Sequence[Widget], area: Area = MENU) -> list[Widget]:
    """The rows with their areas, from the top; rows that do not fit are left out."""
    placed: list[Widget] = []
    top = area.top
    for row in rows:
        if top + row.row_lines - 1 > area.bottom:
            break
        placed.append(row.at(Area(area.left + 1, top, area.right, top + row.row_lines - 1)))
        top += row.row_lines
    return placed


def menu_items(rows: Sequence[Widget], lit: Widget | None, area: Area = MENU) -> list[Item]:
    """The items of a menu: its ground and its rows. The row `lit` is lit."""
    items = [filled(area, NIGHT), filled(area._replace(right=area.left), SLATE)]
    for row in rows:
        items += row.items(row is lit and not row.why_not)
    return items


def pages_of(rows: Sequence[Widget], lines: int = MOST_LINES) -> list[list[Widget]]:
    """The rows in pages that fit, each with room for one more row, which turns to the next page."""
    if lines_of(rows) <= lines:
        return [list(rows)]
    pages: list[list[Widget]] = [[]]
    used = 0
    for row in rows:
        if used + row.row_lines > lines - ROW_LINES:
            # A heading goes with the row below it.
            headings = [pages[-1].pop()] if len(pages[-1]) > 1 and isinstance(pages[-1][-1], Heading) else []
            pages.append(headings)
            used = lines_of(headings)
        pages[-1].append(row)
        used += row.row_lines
    return pages


def page_of_menu(
    rows: Sequence[Widget], last: Sequence[Widget], number: int, turn: Callable[[int], object]
) -> list[Widget]:
    """The rows of a page of the menu, counted from 0, laid out; the last page if there are not so many.

    Each page ends with the `last` rows. If there are several, the row before them calls `turn` with the
    number of the next page.
    """
    pages = pages_of(rows, MOST_LINES - lines_of(last))
    number = min(number, len(pages) - 1)
    if len(pages) == 1:
        return laid_out([*pages[0], *last])
    more = Button(
        "more",
        "The other rows of this menu.",
        run=partial(turn, (number + 1) % len(pages)),
        value=f"{number + 1} of {len(pages)}",
    )
    return laid_out([*pages[number], more, *last])
