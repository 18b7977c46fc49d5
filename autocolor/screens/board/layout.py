"""The layout of the board: what can be pointed at on a screen at one moment, and what covers what."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Final

from autocolor.screens.screen import Handle, Screen
from autocolor.widgets.areas import Area
from autocolor.widgets.bars import Bar
from autocolor.widgets.menu import WIDE_BAR
from autocolor.widgets.widget import Gap, Heading, Widget

REACH: Final = 7
"""Assumed: elements or lines from a handle within which it is grabbed."""


@dataclass(frozen=True)
class Layout:
    """The rows of the menu on a screen, and the areas of the menu and the message line, if they are shown.

    What the screen has is asked for once, and only if it is needed.
    """

    screen: Screen
    rows: Sequence[Widget]
    wide_key: str
    """The key of the row whose wide bar is shown, if it is on this page of the menu."""
    covers: Sequence[Area]
    over: Sequence[Widget] = ()
    """The widgets over every screen, the topmost first."""

    @property
    def has_menu(self) -> bool:
        """Whether the menu is shown."""
        return bool(self.rows)

    @cached_property
    def wide(self) -> Widget | None:
        """The wide bar of a row, if it is shown."""
        bars = (row for row in self.rows if isinstance(row, Bar) and row.key == self.wide_key)
        return next((row.at(WIDE_BAR) for row in bars), None)

    @cached_property
    def others(self) -> Sequence[Widget]:
        """The widgets of the screen beside the menu."""
        return self.screen.widgets()

    @cached_property
    def handles(self) -> Sequence[Handle]:
        """The handles that nothing covers."""
        return [each for each in self.screen.handles() if not self.is_covered(each.element, each.line)]

    @property
    def widgets(self) -> list[Widget]:
        """Everything that can be pointed at, the topmost first."""
        wide = [self.wide] if self.wide is not None else []
        return [*wide, *self.over, *self.rows, *self.others]

    def is_covered(self, element: int, line: int) -> bool:
        """Whether the menu, its wide bar or the message line is at a place."""
        covers = self.covers if self.wide is None else (*self.covers, WIDE_BAR)
        return any(area.has(element, line) for area in covers)

    def widget_at(self, element: int, line: int) -> Widget | None:
        """The widget at a place; headings and gaps are none."""
        at = (each for each in self.widgets if each.area.has(element, line))
        return next((each for each in at if not isinstance(each, (Heading, Gap))), None)

    def handle_at(self, element: int, line: int) -> Handle | None:
        """The nearest handle within reach of a place, the last of several at the same distance."""
        if self.is_covered(element, line):
            return None
        best, least = None, REACH
        for handle in self.handles:
            distance = max(abs(handle.element - element), abs(handle.line - line))
            if distance <= least:
                best, least = handle, distance
        return best

    def lit(self, key: str, area: Area) -> Widget | None:
        """The row or widget that has a key; of several, the one at an area."""
        found = [each for each in (*self.over, *self.rows, *self.others) if each.key == key]
        return next((each for each in found if each.area == area), found[0] if found else None)

    def now(self, grabbed: Widget) -> Widget | None:
        """What a widget, made before, is now, where it was then; None if there is no such one any more."""
        found = [each for each in self.widgets if each.key == grabbed.key and type(each) is type(grabbed)]
        if not found:
            return None
        return next((each for each in found if each.area == grabbed.area), found[0]).at(grabbed.area)

    def handle_now(self, handle: Handle) -> Handle:
        """A handle that was picked before, where it is now if it is seen."""
        return next((each for each in self.screen.handles() if each.key == handle.key), handle)
