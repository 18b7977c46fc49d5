"""The menu: a column of rows at the right edge of the screen, and the wide bar above the message line."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from autocolor.widgets.items import HEIGHT, NIGHT, SLATE, WIDTH, Area, Item, filled
from autocolor.widgets.widget import ROW_LINES, Heading, Widget

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
    """The rows with their areas, from the top; those that do not fit are left out."""
    found: list[Widget] = []
    top = area.top
    for row in rows:
        if top + row.row_lines - 1 > area.bottom:
            break
        found.append(row.at(Area(area.left + 1, top, area.right, top + row.row_lines - 1)))
        top += row.row_lines
    return found


def menu_items(rows: Sequence[Widget], lit: Widget | None, area: Area = MENU) -> list[Item]:
    """How a menu looks: its ground, and its rows, of which `lit` is lit."""
    found = [filled(area, NIGHT), filled(area._replace(right=area.left), SLATE)]
    for row in rows:
        found += row.items(row is lit and not row.why_not)
    return found


def pages_of(rows: Sequence[Widget], lines: int = MOST_LINES) -> list[list[Widget]]:
    """The rows in pages that fit, each with room for one more row, by which the next is reached."""
    if lines_of(rows) <= lines:
        return [list(rows)]
    pages: list[list[Widget]] = [[]]
    used = 0
    for row in rows:
        if used + row.row_lines > lines - ROW_LINES:
            # A heading goes with what is below it.
            headings = [pages[-1].pop()] if len(pages[-1]) > 1 and isinstance(pages[-1][-1], Heading) else []
            pages.append(headings)
            used = lines_of(headings)
        pages[-1].append(row)
        used += row.row_lines
    return pages
