"""The composition of the page: the screen, its widgets, the message line and the menu, one over the other."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from autocolor.arrays import Bytes
from autocolor.screens.board.layout import Layout
from autocolor.screens.board.message_line import message_items
from autocolor.screens.board.typing_line import TypingLine
from autocolor.screens.screen import Handle
from autocolor.screens.session import Session
from autocolor.widgets.colors import ORANGE, WHITE, YELLOW
from autocolor.widgets.menu import menu_items
from autocolor.widgets.sheet import Page
from autocolor.widgets.widget import Place, Widget


@dataclass(frozen=True)
class Composition:
    """What a page is made of: `lit` is the widget that is lit, `held` the handle that was picked."""

    session: Session
    layout: Layout
    lit: Widget | None
    held: Handle | None
    pointer: Place
    typing: TypingLine

    def page(self) -> Page:
        """The page."""
        layout, screen = self.layout, self.layout.screen
        items = list(screen.items())
        for widget in (*layout.others, *reversed(layout.over)):
            items += widget.items(widget is self.lit and not widget.why_not)
        if self.has_message:
            line, ink = self.message
            items += message_items(line, ink, ends=self.typing.is_on)
        if layout.has_menu:
            items += menu_items(layout.rows, self.lit)
        if layout.wide is not None:
            items += layout.wide.items(lit=False)
        return Page(screen.base(), items, with_loads(self.session.studio.entries, screen.loads()))

    @property
    def has_message(self) -> bool:
        """Whether the message line is shown: always beside a menu, else if there is something to say."""
        return self.layout.has_menu or self.typing.is_on or self.session.has_news

    @property
    def message(self) -> tuple[str, int]:
        """What the message line says, and the word it is written with."""
        session = self.session
        is_warned = session.has_news and session.news.is_warning
        if self.typing.is_on and not is_warned:
            return self.typing.shown, YELLOW
        if session.has_news:
            return session.message, ORANGE if is_warned else WHITE
        return (self._hint() if self.layout.has_menu else "", WHITE)

    def _hint(self) -> str:
        if self.lit is not None:
            return self.lit.why_not or self.lit.help or self.lit.label
        layout, (element, line) = self.layout, self.pointer
        if self.held is not None:
            return f"{self.held.label}: pick its new place"
        if min(element, line) < 0 or layout.is_covered(element, line):
            return layout.screen.help
        handle = layout.handle_at(element, line)
        return handle.label if handle is not None else layout.screen.hint(element, line)


def with_loads(entries: Bytes, loads: Sequence[tuple[int, Bytes]]) -> Bytes:
    """The lookup table with some runs of entries replaced; the same array if there are none."""
    if not loads:
        return entries
    table = np.array(entries)
    for first, colors in loads:
        table[first : first + len(colors)] = colors
    return table
