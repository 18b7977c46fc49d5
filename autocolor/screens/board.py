"""The board: the screen that is shown with its menu and the message line, and what is pointed at on it.

It hands each gesture to the widget, the handle or the screen at its place, and makes the page that the sheet
shows. It knows screens by their interface alone.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial
from typing import Final

import numpy as np

from autocolor.arrays import Bytes
from autocolor.screens.gestures import Gesture
from autocolor.screens.screen import Handle, Screen
from autocolor.screens.session import PICTURE, Session
from autocolor.screens.typing_line import TypingLine
from autocolor.widgets.areas import Area
from autocolor.widgets.bars import Bar
from autocolor.widgets.colors import BLACK, HEIGHT, ORANGE, WHITE, WIDTH, YELLOW
from autocolor.widgets.items import CHARACTER, Item, filled, fitted, text
from autocolor.widgets.menu import (
    MENU,
    MESSAGE_LINES,
    WIDE_BAR,
    laid_out,
    menu_items,
    pages_of,
)
from autocolor.widgets.sheet import Page
from autocolor.widgets.widget import Button, Gap, Heading, Place, Steps, Widget

MESSAGE: Final = Area(0, HEIGHT - MESSAGE_LINES, WIDTH - 1, HEIGHT - 1)
MOST_CHARACTERS: Final = (WIDTH - 16) // CHARACTER

EDGE: Final = 4
"""Assumed: elements at the right edge of the screen that bring the menu."""

REACH: Final = 7
"""Assumed: elements or lines from a handle within which it is grabbed."""


class Board:
    """What is on the display, and what is pointed at. `screens` are those that can be shown, by name."""

    def __init__(self, session: Session, screens: Mapping[str, Screen]) -> None:
        self.session = session
        self.screens = screens
        self.typing = TypingLine(session)
        self.is_pinned = False
        """Whether the menu was asked for; else it goes when the pointer leaves it."""
        self.has_focus = False
        """Whether keys go to the menu."""
        self.held: Handle | None = None
        """The handle that was picked, and goes where the next pick is."""
        self._shown = session.screen
        self._is_open = False
        self._lit = ""
        self._wide = ""
        """The key of the number whose wide bar is shown."""
        self._menu_page = 0
        self._grabbed: Widget | Handle | Screen | None = None
        self._start = self._last = Gesture("hover", -1, -1)
        self._pointer = Place(-1, -1)

    # The screen and its widgets.

    @property
    def screen(self) -> Screen:
        """The screen that is shown."""
        return self.screens[self.session.screen]

    @property
    def has_menu(self) -> bool:
        """Whether the menu is shown."""
        return self.screen.has_menu or self._is_open or self.is_pinned

    @property
    def is_dragging(self) -> bool:
        """Whether something is grabbed."""
        return self._grabbed is not None

    def turn(self) -> bool:
        """Leave and enter screens if the session asked for another one; returns whether it did."""
        wanted = self.session.screen
        if wanted == self._shown:
            return False
        self.release()
        self.screens[self._shown].leave()
        self._shown, self._wide, self._menu_page, self._lit = wanted, "", 0, ""
        self.close()
        self.screens[wanted].enter()
        return True

    def menu_rows(self) -> list[Widget]:
        """The rows of the menu, laid out."""
        if not self.has_menu:
            return []
        pages = pages_of(self._all_rows())
        self._menu_page %= len(pages)
        rows = pages[self._menu_page]
        if len(pages) > 1:
            more = f"{self._menu_page + 1} of {len(pages)}"
            rows = [*rows, Button("more", "The other rows of this menu.", run=self._turn_menu, value=more)]
        return laid_out(rows)

    def _turn_menu(self) -> None:
        self._menu_page += 1

    def _all_rows(self) -> list[Widget]:
        session, screen = self.session, self.screen
        undo = Steps(
            " ",
            "Undo the last step, or redo it.",
            step=lambda amount: session.undo() if amount < 0 else session.redo(),
            signs=("undo", "redo"),
        )
        if screen.name == PICTURE:
            ways: list[Widget] = [
                Button(each.title, each.help, run=partial(session.turn_to, each.name))
                for each in self.screens.values()
                if each.is_in_menu and each is not screen
            ]
            return [Heading("AUTOCOLOR"), *ways, Gap("ways"), *screen.rows(), undo]
        back = Button("< picture", "Back to the picture.", run=partial(session.turn_to, PICTURE))
        return [Heading(screen.title.upper()), back, Gap("ways"), *screen.rows(), Gap("undo gap"), undo]

    def widgets(self) -> list[Widget]:
        """Everything that can be pointed at, the topmost first."""
        rows = self.menu_rows()
        wide = [row.at(WIDE_BAR) for row in rows if isinstance(row, Bar) and row.key == self._wide]
        return [*wide, *rows, *self.screen.widgets()]

    def widget_at(self, element: int, line: int) -> Widget | None:
        """The widget at a place."""
        return next((each for each in self.widgets() if each.area.has(element, line)), None)

    def handle_at(self, element: int, line: int) -> Handle | None:
        """The nearest handle within reach of a place, the last of several at the same distance."""
        best, least = None, REACH + 1
        for handle in self.screen.handles():
            distance = max(abs(handle.element - element), abs(handle.line - line))
            if distance < least or (distance == least and best is not None):
                best, least = handle, distance
        return best

    # Gestures.

    def take(self, gesture: Gesture) -> None:
        """Do what a gesture asks for."""
        self._pointer = Place(gesture.element, gesture.line)
        getattr(self, f"_{gesture.kind}")(gesture)
        self._last = gesture

    def release(self) -> None:
        """Let go of what is grabbed or held."""
        self._grabbed = self.held = None
        self.screens[self._shown].release()

    def _hover(self, gesture: Gesture) -> None:
        element, line = self._pointer
        if not self.screen.has_menu:
            if element >= WIDTH - EDGE and line <= MENU.bottom:
                self._is_open = True
            elif element < MENU.left:
                self._is_open = False
        widget = self.widget_at(element, line)
        self._lit = widget.key if widget is not None else ""
        if widget is None:
            self.has_focus = False

    def _pick(self, gesture: Gesture) -> None:
        self._hover(gesture)
        element, line = self._pointer
        widget = self.widget_at(element, line)
        held, self.held = self.held, None
        if widget is not None:
            self.pick_widget(widget)
        elif self.has_menu and MENU.has(element, line):
            return
        elif held is not None:
            self.screen.place(held, element, line)
            self.screen.release()
        else:
            handle = self.handle_at(element, line)
            if handle is None:
                self.screen.pick(gesture)
                return
            self.held = handle
            self.screen.hold(handle)
            self.session.tell(f"{handle.label}: pick its new place")

    def pick_widget(self, widget: Widget) -> None:
        """Pick a widget, as at its middle if the pointer is elsewhere."""
        if widget.why_not:
            self.session.tell(f"{widget.label}: {widget.why_not}", is_warning=True)
            return
        place = self._pointer
        if not widget.area.has(*place):
            place = Place((widget.area.left + widget.area.right) // 2, widget.area.top)
        if isinstance(widget, Bar) and MENU.covers(widget.area) and not widget.is_switched_at(place):
            self._wide = "" if self._wide == widget.key else widget.key
        elif widget.typed is not None and not isinstance(widget, Bar):
            self.typing.begin(widget)
        else:
            widget.pick(place)

    def _grab(self, gesture: Gesture) -> None:
        self.held = None
        element, line = self._pointer
        self._start = gesture
        widget = self.widget_at(element, line)
        if widget is not None:
            self._grabbed = None if widget.why_not else widget
            self._lit = widget.key
            return
        handle = self.handle_at(element, line)
        self._grabbed = self.screen if handle is None else handle
        if handle is not None:
            self.screen.hold(handle)

    def _drag(self, gesture: Gesture) -> None:
        grabbed = self._grabbed
        if isinstance(grabbed, Widget):
            start, last = (Place(each.element, each.line) for each in (self._start, self._last))
            grabbed.drag(start, last, self._pointer)
        elif isinstance(grabbed, Handle):
            self.screen.place(grabbed, *self._pointer)
        elif grabbed is not None:
            grabbed.drag(self._start, self._last, gesture)

    def _drop(self, gesture: Gesture) -> None:
        self.release()

    def _wheel(self, gesture: Gesture) -> None:
        widget = self.widget_at(*self._pointer)
        if widget is None:
            self.screen.wheel(gesture)
        elif not widget.why_not:
            widget.nudge(gesture.steps)

    def close(self) -> None:
        """Take the menu away where it comes on demand."""
        self.is_pinned = self._is_open = self.has_focus = False

    # Keys.

    def toggle_menu(self) -> None:
        """Bring the menu and give it the keys, or take it away."""
        if self.has_focus or (self.is_pinned and not self.screen.has_menu):
            self.close()
            return
        self.is_pinned = self.has_focus = True
        if not self._lit_row():
            self._move_light(1)

    def escape(self) -> bool:
        """Let go of what is held, or close what is open; returns False if there is nothing."""
        if self.held is not None:
            self.held = None
        elif self._wide:
            self._wide = ""
        elif self.has_focus or self.is_pinned:
            self.close()
        else:
            return False
        return True

    def key(self, name: str, typed: str) -> bool:
        """Take a key that is typed into the widget under the pointer, or moves in the menu."""
        row = self._lit_row()
        if row is not None and row.typed is not None and self.typing.would_begin(row, typed):
            self.typing.begin(row, typed)
            return True
        if not self.has_focus:
            return False
        if name in ("up", "down"):
            self._move_light(1 if name == "down" else -1)
        elif row is not None and name in ("left", "right") and not row.why_not:
            row.nudge(1 if name == "right" else -1)
        elif row is not None and name in ("return", "space", "enter"):
            self._pointer = Place(-1, -1)
            self.pick_widget(row)
        else:
            return False
        return True

    def _lit_row(self) -> Widget | None:
        return next((each for each in self.widgets() if each.key == self._lit), None)

    def _move_light(self, step: int) -> None:
        rows = [each.key for each in self.menu_rows() if not isinstance(each, (Heading, Gap))]
        if rows:
            start = rows.index(self._lit) if self._lit in rows else (-1 if step > 0 else 0)
            self._lit = rows[(start + step) % len(rows)]

    # What is shown.

    @property
    def mark(self) -> tuple[int, int] | None:
        """The place of the handle that is held, or can be grabbed where the pointer is."""
        handle = self.held
        if handle is None and self._grabbed is None and self.widget_at(*self._pointer) is None:
            handle = self.handle_at(*self._pointer)
        return None if handle is None else (handle.element, handle.line)

    def page(self) -> Page:
        """The page to show now."""
        session, screen = self.session, self.screen
        screen.is_under_menu = self.has_menu and not screen.has_menu
        items = [*self._message_items(), *screen.items()]
        for widget in screen.widgets():
            items += widget.items(widget.key == self._lit and not widget.why_not)
        if self.has_menu:
            rows = self.menu_rows()
            items += menu_items(rows, self._lit)
            for widget in self.widgets()[:1]:
                if widget.area == WIDE_BAR:
                    items += widget.items(lit=False)
        return Page(screen.base(), items, with_loads(session.studio.entries, screen.loads()))

    def _message_items(self) -> list[Item]:
        line, ink = self.message
        if not line and not self.has_menu and not self.screen.has_menu:
            return []
        found = [filled(MESSAGE, BLACK)]
        if line:
            found.append(text(fitted(line, MOST_CHARACTERS), 8, MESSAGE.top + 3, ink, BLACK))
        return found

    @property
    def message(self) -> tuple[str, int]:
        """What the message line says, and the word it is written with."""
        session = self.session
        if self.typing.is_on:
            return self.typing.shown, YELLOW
        if session.has_news:
            return session.message, ORANGE if session.news.is_warning else WHITE
        return (self._hint(), WHITE) if self.has_menu else ("", WHITE)

    def _hint(self) -> str:
        row = self._lit_row()
        if row is not None:
            return row.why_not or row.help or row.label
        if self.held is not None:
            return f"{self.held.label}: pick its new place"
        element, line = self._pointer
        handle = self.handle_at(element, line)
        return handle.label if handle is not None else self.screen.hint(element, line)


def with_loads(entries: Bytes, loads: Sequence[tuple[int, Bytes]]) -> Bytes:
    """The lookup table with some runs of entries replaced; the same array if there are none."""
    if not loads:
        return entries
    table = np.array(entries)
    for first, colors in loads:
        table[first : first + len(colors)] = colors
    return table
