"""Screens of text in pages: a title, and rows below it; a click, the wheel and keys turn the pages."""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar, Final, NamedTuple

from autocolor.screens.screen import Content, Screen, Surroundings
from autocolor.screens.session import Session
from autocolor.widgets.items import CHARACTER, HEIGHT, LIGHT_GRAY, WHITE, WIDTH, YELLOW, text
from autocolor.widgets.menu import MESSAGE_LINES

LEFT: Final = 8
MIDDLE: Final = 204
"""Where the two texts of a row begin."""

TITLE_TOP: Final = 22
TOP: Final = 50
STEP: Final = 13
"""The lines of the title and of the first row, and from row to row."""

ROWS_A_PAGE: Final = (HEIGHT - MESSAGE_LINES - TOP) // STEP
CHARACTERS: Final = (WIDTH - 2 * LEFT) // CHARACTER


class PageRow(NamedTuple):
    """A row: its text, the word of its letters, and a white text from the middle on."""

    text: str = ""
    ink: int = WHITE
    beside: str = ""


class Pages(Screen):
    """A screen of text: a click, the wheel, Space, Page Up and Page Down turn to another page."""

    heading: ClassVar[str]
    has_menu = False
    shows_scene = False

    def __init__(self, session: Session) -> None:
        super().__init__(session)
        self._page = 0
        """The number of the page, which grows and falls without end: after the last page comes the first."""

    def enter(self) -> None:
        self._page = 0

    def rows(self) -> Sequence[PageRow]:
        """The rows of all pages."""
        raise NotImplementedError

    def build(self, around: Surroundings) -> Content:
        rows = self.rows()
        count = max(1, -(-len(rows) // ROWS_A_PAGE))
        page = self._page % count
        items = [text(self.heading, LEFT, TITLE_TOP, YELLOW, size=2)]
        if count > 1:
            turn = f"page {page + 1} of {count}; a click, the wheel or Space: the next page"
            items.append(text(turn, MIDDLE, TITLE_TOP + 6, LIGHT_GRAY))
        for number, row in enumerate(rows[page * ROWS_A_PAGE :][:ROWS_A_PAGE]):
            top = TOP + STEP * number
            items += [text(row.text, LEFT, top, row.ink), text(row.beside, MIDDLE, top)]
        return Content(
            items=[item for item in items if item.stream],
            pick=lambda gesture: self._turn(1),
            wheel=lambda gesture: self._turn(1 if gesture.steps < 0 else -1),
            key=lambda name, typed: self._turn({"space": 1, "page down": 1, "page up": -1}.get(name, 0)),
        )

    def _turn(self, pages: int) -> bool:
        self._page += pages
        return pages != 0
