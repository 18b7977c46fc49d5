"""The board: the screen that is shown with its menu and the message line, and what is pointed at on it.

It hands each gesture to the widget, the handle or the screen at its place, and makes the page that the sheet
shows. It knows screens by their interface alone.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Final

from autocolor.screens.board.composition import Composition
from autocolor.screens.board.grip import Grip, place_of
from autocolor.screens.board.layout import Layout
from autocolor.screens.board.main_menu import last_rows, page_of_menu, rows_of_menu
from autocolor.screens.board.message_line import MESSAGE
from autocolor.screens.board.typing_line import TypingLine
from autocolor.screens.input.gestures import Gesture
from autocolor.screens.screen import Handle, Screen
from autocolor.screens.session import PICTURE, Session
from autocolor.widgets.bars import Bar
from autocolor.widgets.colors import WIDTH
from autocolor.widgets.menu import MENU
from autocolor.widgets.sheet import Page
from autocolor.widgets.widget import NOWHERE, Gap, Heading, Place, Widget

EDGE: Final = 4
"""Assumed: elements at the right edge of the screen that bring the menu."""


class Board:
    """What is on the display, and what is pointed at. `screens` are those that can be shown, by name."""

    def __init__(self, session: Session, screens: Mapping[str, Screen]) -> None:
        self.session = session
        self.screens = screens
        self.typing = TypingLine(session)
        self.over: Callable[[], Sequence[Widget]] = tuple
        """What stands over every screen, the topmost first: a panel that is there for a while."""
        self.is_pinned = False
        """Whether the menu was asked for; else it goes when the pointer leaves it."""
        self.has_focus = False
        """Whether keys go to the menu."""
        self.held: Handle | None = None
        """The handle that was picked, and goes where the next pick is."""
        self._shown = session.screen
        self._is_open = False
        self._lit, self._lit_area = "", NOWHERE
        """The key and the area of what is lit."""
        self._wide = ""
        """The key of the number whose wide bar is shown."""
        self._menu_page = 0
        self._has_message = False
        """Whether the message line covers what is below it."""
        self._grip = Grip()
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
        return self._grip.is_on

    @property
    def lit(self) -> str:
        """The key of the widget that is lit; empty if there is none."""
        return self._lit

    def turn(self) -> bool:
        """Leave and enter screens if the session asked for another one; returns whether it did."""
        wanted = self.session.screen
        if wanted == self._shown:
            return False
        self.release()
        self.screens[self._shown].leave()
        self._shown, self._wide, self._menu_page = wanted, "", 0
        self._light(None)
        self.close()
        self.screens[wanted].enter()
        self._tell_the_way()
        return True

    def _tell_the_way(self) -> None:
        """Tell what to do on a screen beside which no menu stands, and how to come back from it."""
        screen = self.screen
        is_reached_by_menu = screen.is_in_menu and screen.name != PICTURE
        if is_reached_by_menu and not screen.has_menu and not self.session.has_news:
            self.session.tell(f"{screen.help}; the right edge: the menu")

    def layout(self) -> Layout:
        """What can be pointed at now."""
        over = self.over()
        covers = ([MENU] if self.has_menu else []) + ([MESSAGE] if self._has_message else [])
        covers += [each.area for each in over]
        return Layout(self.screen, self.menu_rows(), self._wide, covers, over)

    def menu_rows(self) -> list[Widget]:
        """The rows of the menu, laid out."""
        if not self.has_menu:
            return []
        rows = rows_of_menu(self.session, self.screen, self.screens.values())
        last = last_rows(self.session, self.screen)
        return page_of_menu(rows, last, self._menu_page, partial(setattr, self, "_menu_page"))

    def widgets(self) -> list[Widget]:
        """Everything that can be pointed at, the topmost first."""
        return self.layout().widgets

    def widget_at(self, element: int, line: int) -> Widget | None:
        """The widget at a place."""
        return self.layout().widget_at(element, line)

    def handle_at(self, element: int, line: int) -> Handle | None:
        """The nearest handle within reach of a place, if nothing covers it."""
        return self.layout().handle_at(element, line)

    # Gestures.

    def take(self, gesture: Gesture) -> None:
        """Do what a gesture asks for."""
        self._pointer = place_of(gesture)
        getattr(self, f"_{gesture.kind}")(gesture)

    def point_at(self, gesture: Gesture) -> None:
        """Take note of the place of a gesture."""
        self._pointer = place_of(gesture)
        self._hover(gesture)

    def release(self) -> None:
        """Let go of what is grabbed, held or typed."""
        self._let_go()
        self.typing.end()

    def _let_go(self) -> None:
        self.held = None
        self._grip.release()
        self.screens[self._shown].release()

    def _light(self, widget: Widget | None) -> None:
        self._lit, self._lit_area = ("", NOWHERE) if widget is None else (widget.key, widget.area)

    def _hover(self, gesture: Gesture) -> Layout:
        element, line = self._pointer
        layout = self.layout()
        if not self.screen.has_menu:
            was_open = self._is_open
            if WIDTH - EDGE <= element < WIDTH and line <= MENU.bottom:
                self._is_open = True
            elif not MENU.left <= element < WIDTH and layout.wide is None:
                self._is_open = False
            if self._is_open and not was_open and self.session.news.stands:
                # Beside the menu, hints stand in its place.
                self.session.tell("")
            layout = layout if self._is_open == was_open else self.layout()
        widget = layout.widget_at(element, line)
        self._light(widget)
        if widget is None:
            self.has_focus = False
        return layout

    def _pick(self, gesture: Gesture) -> None:
        layout = self._hover(gesture)
        element, line = self._pointer
        widget = layout.widget_at(element, line)
        if widget is not None:
            self._let_go()
            self.pick_widget(widget, self._pointer)
        elif layout.is_covered(element, line):
            return
        elif self.held is not None:
            # One that is refused is still held.
            self.screen.place(self.held, element, line)
            self._let_go()
        else:
            handle = layout.handle_at(element, line)
            if handle is None:
                self.screen.pick(gesture)
                return
            self.held = handle
            self.screen.hold(handle)
            self.session.tell(f"{handle.label}: pick its new place")

    def pick_widget(self, widget: Widget, place: Place | None = None) -> None:
        """Pick a widget at a place, without one at its middle."""
        if widget.why_not:
            self.session.tell(f"{widget.label}: {widget.why_not}", is_warning=True)
            return
        if place is None:
            place = Place((widget.area.left + widget.area.right) // 2, widget.area.top)
        if isinstance(widget, Bar) and MENU.covers(widget.area) and not widget.is_switched_at(place):
            self._wide = "" if self._wide == widget.key else widget.key
        elif widget.typed is not None and not isinstance(widget, Bar):
            self.typing.begin(widget)
        else:
            widget.pick(place)

    def _grab(self, gesture: Gesture) -> None:
        self._let_go()
        layout = self.layout()
        self._light(layout.widget_at(*self._pointer))
        self._grip.grab(layout, gesture)

    def _drag(self, gesture: Gesture) -> None:
        self._grip.drag(self.layout(), gesture)

    def _drop(self, gesture: Gesture) -> None:
        self._let_go()

    def _wheel(self, gesture: Gesture) -> None:
        layout = self.layout()
        widget = layout.widget_at(*self._pointer)
        if widget is not None:
            if not widget.why_not:
                widget.nudge(gesture.steps)
        elif not layout.is_covered(*self._pointer):
            self.screen.wheel(gesture)

    # Keys.

    def close(self) -> None:
        """Take the menu away where it comes on demand."""
        self.is_pinned = self._is_open = self.has_focus = False
        if not self.screen.has_menu:
            self._wide = ""

    def toggle_menu(self) -> None:
        """Bring the menu and give it the keys, or take it away."""
        if self.has_focus or (self.is_pinned and not self.screen.has_menu):
            self.close()
            return
        self.is_pinned = self.has_focus = True
        if self.layout().lit(self._lit, self._lit_area) is None:
            self._move_light(1)

    def escape(self) -> bool:
        """Let go of what is held, or close what is open; returns False if there is nothing."""
        comes_and_goes = not self.screen.has_menu
        if self.held is not None:
            self._let_go()
        elif self.layout().wide is not None:
            self._wide = ""
        elif self.has_focus or (comes_and_goes and (self.is_pinned or self._is_open)):
            self.close()
        else:
            return self.screen.escape()
        return True

    def key(self, name: str, typed: str) -> bool:
        """Take a key that is typed into the widget under the pointer, or moves in the menu."""
        row = self.layout().lit(self._lit, self._lit_area)
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
            self.pick_widget(row)
        else:
            return False
        return True

    def _move_light(self, step: int) -> None:
        layout = self.layout()
        lit = layout.lit(self._lit, self._lit_area)
        rows = [each for each in layout.rows if not isinstance(each, (Heading, Gap))]
        if rows:
            start = next((n for n, each in enumerate(rows) if each is lit), -1 if step > 0 else 0)
            self._light(rows[(start + step) % len(rows)])

    # What is shown.

    @property
    def mark(self) -> tuple[int, int] | None:
        """The place of the handle that is held, or can be grabbed where the pointer is."""
        layout, handle = self.layout(), self.held
        if handle is not None:
            handle = layout.handle_now(handle)
        elif not self._grip.is_on and layout.widget_at(*self._pointer) is None:
            handle = layout.handle_at(*self._pointer)
        place = None if handle is None else Place(handle.element, handle.line)
        # Cursors invert what is below them: of two at one place nothing would be seen.
        return None if place == self._pointer else place

    def page(self) -> Page:
        """The page to show now."""
        self.screen.is_under_menu = self.has_menu and not self.screen.has_menu
        composition = self._composition()
        self._has_message = composition.has_message
        return composition.page()

    @property
    def message(self) -> tuple[str, int]:
        """What the message line says, and the word it is written with."""
        return self._composition().message

    def _composition(self) -> Composition:
        layout = self.layout()
        lit = layout.lit(self._lit, self._lit_area)
        return Composition(self.session, layout, lit, self.held, self._pointer, self.typing)
