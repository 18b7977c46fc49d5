"""The layout of a screen: everything that can be pointed at, at one moment."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from operator import itemgetter
from typing import Final

from autocolor.screens.screen import Content, Handle
from autocolor.widgets.bars import Bar
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
    opened_row: Widget | None = None
    """The row whose wide bar or list is open, if that row is on this page of the menu."""
    listed: NameList | None = None
    """The list of that row."""

    @cached_property
    def wide(self) -> Widget | None:
        """The wide bar of a row, if it is shown."""
        return self.opened_row.at(WIDE_BAR) if isinstance(self.opened_row, Bar) else None

    @cached_property
    def widgets(self) -> Sequence[Widget]:
        """Everything that can be pointed at, the topmost first."""
        wide = () if self.wide is None else (self.wide,)
        listed = () if self.listed is None else self.listed.rows
        offer = () if self.offer is None else (self.offer,)
        return (*offer, *listed, *wide, *self.over, *self.rows, *self.content.widgets, *self.strip)

    def is_covered(self, element: int, line: int) -> bool:
        """Whether the menu, its list or wide bar, or a panel over every screen covers a place."""
        opened = [each.area for each in (self.wide, self.listed, *self.over) if each is not None]
        return any(area.has(element, line) for area in ((MENU, STRIP, *opened) if self.rows else opened))

    def widget_at(self, element: int, line: int) -> Widget | None:
        """The topmost widget at a place; headings and gaps are left out."""
        for widget in self.widgets:
            if widget.has(element, line) and not isinstance(widget, Gap):
                return widget
        return None

    def now(self, earlier: Widget) -> Widget | None:
        """A widget of an earlier layout as it is now, preferably in its area; None if it is gone.

        The row of a wide bar stands for the bar.
        """
        key, wide = earlier.key, self.wide
        widgets = [each for each in self.widgets if each.key == key and each is not wide]
        return next((each for each in widgets if each.area == earlier.area), widgets[0] if widgets else None)


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
