"""The layout of a screen: everything that can be pointed at, at one moment."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from operator import itemgetter
from typing import Final

from autocolor.screens.screen import Content, Handle
from autocolor.widgets.bars import Bar
from autocolor.widgets.items import Area
from autocolor.widgets.menu import MENU, STRIP, WIDE_BAR, NameList
from autocolor.widgets.widget import Choice, Gap, Widget

REACH: Final = 8
"""Assumed: elements or lines from a handle within which it is grabbed."""


@dataclass(frozen=True)
class Layout:
    """Everything that can be pointed at on a screen at one moment, computed on demand."""

    content: Content
    rows: Sequence[Widget] = ()
    """The rows of the menu with their areas; none while the menu is away."""
    strip: Sequence[Widget] = ()
    """The words of the strip; none while the menu is away."""
    over: Sequence[Widget] = ()
    """The widgets over every screen, the topmost first."""
    offer: Widget | None = None
    """The button beside the message."""
    opened: str = ""
    """The key of the row whose wide bar or list is open, if that row is on this page of the menu."""
    list_names: Callable[[Choice], NameList] | None = None
    """Gives the open list of a choice."""

    @cached_property
    def opened_row(self) -> Widget | None:
        """The row whose wide bar or list is open."""
        if not self.opened:
            return None
        return next((row for row in self.rows if row.key == self.opened and opens(row)), None)

    @cached_property
    def wide(self) -> Widget | None:
        """The wide bar of a row, if it is shown."""
        row = self.opened_row
        return row.at(WIDE_BAR) if isinstance(row, Bar) else None

    @cached_property
    def listed(self) -> NameList | None:
        """The list of a row, if it is shown."""
        row = self.opened_row
        return self.list_names(row) if isinstance(row, Choice) and self.list_names is not None else None

    @cached_property
    def widgets(self) -> Sequence[Widget]:
        """Everything that can be pointed at, the topmost first."""
        wide = () if self.wide is None else (self.wide,)
        listed = () if self.listed is None else self.listed.rows
        offer = () if self.offer is None else (self.offer,)
        return (*offer, *listed, *wide, *self.over, *self.rows, *self.content.widgets, *self.strip)

    @cached_property
    def by_key(self) -> Mapping[str, Sequence[Widget]]:
        """The widgets that have a key, the topmost first."""
        by_key: dict[str, list[Widget]] = {}
        for widget in self.widgets:
            by_key.setdefault(widget.key, []).append(widget)
        return by_key

    def is_covered(self, element: int, line: int) -> bool:
        """Whether the menu, its list or wide bar, or a panel over every screen covers a place."""
        if self.rows and (MENU.has(element, line) or STRIP.has(element, line)):
            return True
        if self.wide is not None and WIDE_BAR.has(element, line):
            return True
        if self.listed is not None and self.listed.area.has(element, line):
            return True
        return any(widget.area.has(element, line) for widget in self.over)

    def widget_at(self, element: int, line: int) -> Widget | None:
        """The topmost widget at a place; headings and gaps are left out."""
        for widget in self.widgets:
            if widget.has(element, line) and not isinstance(widget, Gap):
                return widget
        return None

    def lit(self, key: str, area: Area) -> Widget | None:
        """The row or widget that has a key, preferably at this area. A wide bar lights its row."""
        widgets = [widget for widget in self.by_key.get(key, ()) if widget is not self.wide]
        return next((widget for widget in widgets if widget.area == area), widgets[0] if widgets else None)

    def now(self, grabbed: Widget) -> Widget | None:
        """A widget of an earlier layout as it is now, in its earlier area; None if it is gone."""
        widgets = [each for each in self.by_key.get(grabbed.key, ()) if type(each) is type(grabbed)]
        if not widgets:
            return None
        return next((each for each in widgets if each.area == grabbed.area), widgets[0]).at(grabbed.area)


def opens(row: Widget) -> bool:
    """Whether a row of a menu can open a wide bar or a list."""
    return isinstance(row, Bar) or (isinstance(row, Choice) and row.has_list)


def handles_near(handles: Sequence[Handle], element: int, line: int) -> list[Handle]:
    """The handles within reach of a place, the nearest first; at equal distances, the last first.

    A handle whose sign is at the place comes before all others.
    """
    near = []
    for handle in handles:
        is_at_sign = handle.sign.has(element, line)
        distance = -1 if is_at_sign else max(abs(handle.element - element), abs(handle.line - line))
        if distance <= REACH:
            near.append((distance, handle))
    return [handle for _, handle in sorted(reversed(near), key=itemgetter(0))]
