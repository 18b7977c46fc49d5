"""The board: the screen that is shown, its menu, the message line, and the pointer over them.

A `Layout` has everything that can be pointed at: it is made once for an event, drawn, and the next event
finds the widget under the pointer in it. The board hands each gesture to the widget, the handle or the screen
at its place. It knows screens by their interface alone.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Final

import numpy as np

from autocolor.arrays import Bytes
from autocolor.screens.input import MIDDLE, Gesture
from autocolor.screens.layout import Layout, handles_near, opens
from autocolor.screens.main_menu import last_rows, strip_of
from autocolor.screens.menu_state import MenuState
from autocolor.screens.message_line import (
    MESSAGE,
    NUMBERS,
    MessagePart,
    TypingLine,
    message_items,
    offer_button,
)
from autocolor.screens.screen import Content, Handle, Sample, Screen, Surroundings, surface_at
from autocolor.screens.session import LEAST_SECONDS, PICTURE, Session
from autocolor.widgets.bars import Bar
from autocolor.widgets.items import BLACK, NIGHT, ORANGE, WHITE, WIDTH, Item, filled
from autocolor.widgets.letters import PANEL as LETTER_PANEL
from autocolor.widgets.letters import letter_panel
from autocolor.widgets.menu import MENU, STRIP, Section, menu_items
from autocolor.widgets.sheet import Page
from autocolor.widgets.widget import Button, Choice, Entry, Gap, Place, Widget

HIDDEN: Final = "the panels are hidden: H shows them again, or the last row of the menu at the right edge"
"""The message that says how hidden panels come back."""

EDGE: Final = 4
"""Assumed: elements at the right edge of the screen that bring the menu."""


class Board:
    """The page on the display, and the pointer on it. `screens` has every screen by its name."""

    def __init__(self, session: Session, screens: Mapping[str, Screen]) -> None:
        self.session = session
        self.screens = screens
        self.typing = TypingLine(session)
        self.over: Callable[[], Sequence[Widget]] = tuple
        """Gives the widgets over every screen, the topmost first, such as the tutorial's panel."""
        self.menu = MenuState(self._take)
        self.hides_panels = False
        """Whether the menu and all panels are hidden; the menu then comes on demand."""
        self.held: Handle | None = None
        """The handle that was picked; the next pick places it."""
        self._shown = session.screen
        self._lit: Widget | None = None
        """The widget that is lit, as it was when it was pointed at."""
        self._folded: tuple[Place, Widget] | None = None
        """Where a section was picked last, and the section, until the pointer moves."""
        self._message: list[Item] = []
        """The message on the page; it covers the screen below it."""
        self._grabbed: Widget | Handle | Screen | None = None
        """The thing that is dragged, from the grab to the drop."""
        self._start = self._last = Gesture("grab", -1, -1)
        """The gesture that began the drag, and the last one."""
        self._from_handle = Place(0, 0)
        """From the handle that is dragged to the pointer."""
        self.pointer = Place(-1, -1)
        """The place of the pointer; negative before it is moved."""
        self._layout: tuple[object, Layout] | None = None
        """The layout, and the state of the board that it was made for."""

    # The screen and its widgets.

    @property
    def screen(self) -> Screen:
        """The screen that is shown."""
        return self.screens[self.session.screen]

    @property
    def has_menu(self) -> bool:
        """Whether the menu is shown."""
        return not self._comes_and_goes or self.menu.is_open or self.menu.is_pinned

    @property
    def _comes_and_goes(self) -> bool:
        """Whether the menu comes on demand."""
        return self.hides_panels or not self.screen.has_menu

    @property
    def is_dragging(self) -> bool:
        """Whether something is grabbed."""
        return self._grabbed is not None

    @property
    def layout(self) -> Layout:
        """The layout that is shown, until `forget` or another state of the board."""
        session, has_menu = self.session, self.has_menu
        by_letters = self.typing.is_by_letters
        shown = has_menu, self.hides_panels, self.menu.stamp(session.screen), by_letters, self.over
        state = session.screen, session.moving, session.scene, shown
        if self._layout is None or self._layout[0] != state:
            letters = letter_panel(self.typing.key) if by_letters else ()
            over = (*letters, *(() if self.hides_panels else self.over()))
            above = [*((MENU, STRIP) if has_menu else ()), *(each.area for each in (*over, *self._message))]
            pointer = Place(-1, -1) if any(area.has(*self.pointer) for area in above) else self.pointer
            lit = "" if self._lit is None else self._lit.key
            content = self.screen.build(Surroundings(has_menu, not self.hides_panels, lit, pointer))
            last = [*last_rows(session, self.screen), *self._hiding_rows(content)]
            rows = self.menu.rows(session.screen, content.rows(), last) if has_menu else ()
            offer = offer_button(session.news.offer) if session.has_news and not self.typing.is_on else None
            strip = strip_of(session, self.screens.values()) if has_menu else ()
            layout = Layout(content, rows, strip, over, offer, *self.menu.opened_of(rows))
            self._layout = state, layout
        return self._layout[1]

    @property
    def content(self) -> Content:
        """The content of the screen that is shown."""
        return self.layout.content

    def forget(self) -> None:
        """Make the layout anew when it is needed, because the scene or the screen may have changed."""
        self._layout = None

    def _take(self, choice: Choice, name: str) -> None:
        """Take a name from the list; a list whose name is refused stays open."""
        if name != choice.present:
            choice.choose(name)
        elif choice.rename is not None:
            choice.rename(name)
        self._close_list()

    def _close_list(self) -> None:
        """Take the wide bar or the list away."""
        if self.menu.has_focus and self.layout.listed is not None:
            self._lit = self.layout.opened_row
        self.menu.opened = ""

    # Hiding.

    def switch_panels(self) -> None:
        """Hide the menu and all panels, or show them again. Another screen shows its panels."""
        self.hides_panels = not self.hides_panels
        self.close()
        self.session.tell(HIDDEN if self.hides_panels else "the panels are shown")

    def _hiding_rows(self, content: Content) -> list[Widget]:
        """The row that hides the panels over a picture, or shows them again."""
        if self.hides_panels:
            return [Button("show panels", "Show the menu and all panels again.", run=self.switch_panels)]
        screen = self.screen
        if not screen.shows_picture or not (screen.has_menu or content.widgets):
            return []
        help = "Show the whole picture, without menu and panels; the right edge brings this row back."
        return [Button("hide panels", help, run=self.switch_panels)]

    def widgets(self) -> Sequence[Widget]:
        """Everything that can be pointed at, the topmost first."""
        return self.layout.widgets

    def is_covered(self, element: int, line: int) -> bool:
        """Whether the menu, its wide bar, a panel or the message line covers the screen at a place."""
        has_message = any(item.area.has(element, line) for item in self._message)
        return has_message or self.layout.is_covered(element, line)

    def is_on_letters(self, element: int, line: int) -> bool:
        """Whether a place is on the letter panel."""
        return self.typing.is_by_letters and LETTER_PANEL.has(element, line)

    def handle_at(self, element: int, line: int) -> Handle | None:
        """The nearest handle within reach of a place; None if something covers the handle or the place."""
        if min(element, line) < 0 or self.is_covered(element, line):
            return None
        near = self.content.preferred(handles_near(self.content.handles, element, line), element, line)
        return next((each for each in near if not self.is_covered(each.element, each.line)), None)

    def turn(self) -> bool:
        """Leave and enter screens if the session asked for another one; returns whether it did."""
        wanted = self.session.screen
        if wanted == self._shown:
            return False
        self.release()
        self.screens[self._shown].leave()
        self._shown, self.hides_panels = wanted, False
        self._lit = None
        self.menu.begin()
        self.screens[wanted].enter()
        # Without a menu beside it, the screen itself must say what to do, and the way back.
        screen = self.screen
        is_reached_by_menu = (screen.word or screen.shows_picture) and screen.name != PICTURE
        if is_reached_by_menu and not screen.has_menu and not self.session.has_news:
            self.session.tell(f"{screen.help}; the right edge: the menu")
        return True

    # Gestures.

    @property
    def sample(self) -> Sample | None:
        """The pixel of the picture under the pointer; None where something covers the picture."""
        element, line = self.pointer
        is_free = self.layout.widget_at(element, line) is None and not self.is_covered(element, line)
        return self.content.sample(element, line) if is_free else None

    def take(self, gesture: Gesture) -> None:
        """Handle a gesture. Over another thing, a message gives way to the hint when it had its time."""
        hint = self._hint() if gesture.kind == "hover" and self.session.news_may_go else ""
        self.pointer = Place(gesture.element, gesture.line)
        getattr(self, f"_{gesture.kind}")(gesture)
        if hint and hint != self._hint():
            self.session.news = self.session.news._replace(seconds=LEAST_SECONDS)

    def release(self) -> None:
        """Let go of a grabbed or picked thing, and end typing."""
        self._let_go()
        self.typing.end()

    def _let_go(self) -> None:
        for each in (self.held, self._grabbed):
            if isinstance(each, Handle):
                each.let_go()
        self.held = self._grabbed = None

    @property
    def lit(self) -> Widget | None:
        """The widget that is lit: under the pointer, or reached by keys."""
        return None if self._lit is None else self.layout.now(self._lit)

    def _hover(self, gesture: Gesture) -> None:
        element, line = self.pointer
        if self._folded is not None and self._folded[0] != self.pointer:
            self._folded = None
        if self._comes_and_goes:
            was_open = self.menu.is_open
            if WIDTH - EDGE <= element < WIDTH and line <= MENU.bottom:
                self.menu.is_open = True
            elif not (MENU.has(element, line) or STRIP.has(element, line)) and self.layout.opened_row is None:
                # A row that has gone leaves its list to be opened again.
                self.menu.is_open, self.menu.opened = False, ""
            if self.menu.is_open and not was_open and self.session.news.persistent:
                # Beside the menu, hints stand in its place.
                self.session.tell("")
        self._lit = self.layout.widget_at(element, line)
        if self._lit is None:
            self.menu.has_focus = False

    def _pick(self, gesture: Gesture) -> None:
        self._hover(gesture)
        element, line = self.pointer
        widget = self.layout.widget_at(element, line)
        if self._leaves_list() and not MENU.has(element, line):
            # Beside the menu, this pick does no more.
            return
        if self._folded is not None:
            # The second of two clicks at one place must not fall on a row that came there.
            widget = self.layout.now(self._folded[1]) or widget
        if widget is not None:
            self._let_go()
            self._folded = (self.pointer, widget) if isinstance(widget, Section) else None
            self.pick_widget(widget, self.pointer)
        elif self.is_covered(element, line):
            return
        elif self.held is not None:
            # If the place is refused, the handle stays picked.
            self.held.place(element, line)
            self._let_go()
        else:
            # Modifiers are for the screen.
            handle = None if gesture.shift else self.handle_at(element, line)
            if handle is None:
                self.content.pick(gesture)
                return
            self.held = handle
            handle.hold()
            self.session.tell(f"{handle.label}: pick its new place")

    def _leaves_list(self) -> bool:
        """Close the list if the pointer is neither on it nor on its row; returns whether that was so."""
        listed, row = self.layout.listed, self.layout.opened_row
        if listed is None or listed.area.has(*self.pointer) or (row and row.has(*self.pointer)):
            return False
        self._close_list()
        self._hover(Gesture("hover", *self.pointer))
        return True

    def pick_widget(self, widget: Widget, place: Place | None = None) -> None:
        """Pick a widget at a place; without a place, by a key, at the widget's middle."""
        if widget.why_not:
            self.session.tell(f"{widget.label}: {widget.why_not}", is_warning=True)
            return
        by_key = place is None
        if place is None:
            place = Place((widget.area.left + widget.area.right) // 2, widget.area.top)
        self.menu.use(self.session.screen, widget)
        is_switched = isinstance(widget, Bar) and widget.is_switched_at(place)
        if opens(widget) and MENU.covers(widget.area) and not is_switched:
            self.menu.open_or_close(widget)
            if by_key and self.layout.listed is not None:
                self._lit = self.layout.listed.chosen
        elif isinstance(widget, Entry):
            self.typing.begin(widget)
        else:
            widget.pick(place)

    def _grab(self, gesture: Gesture) -> None:
        self._let_go()
        self._start = self._last = gesture
        self._leaves_list()
        self._lit = widget = self.layout.widget_at(*self.pointer)
        # Modifiers and the middle button are for the screen.
        is_plain = not gesture.shift and not gesture.control and gesture.button != MIDDLE
        handle = self.handle_at(*self.pointer) if is_plain else None
        if widget is not None:
            self._grabbed = None if widget.why_not else widget
            self.menu.use(self.session.screen, widget)
        elif handle is not None:
            self._grabbed = handle
            # A handle comes to the pointer, but a handle that was grabbed at its sign stays away from it.
            element, line = self.pointer
            at_sign = Place(element - handle.element, line - handle.line)
            self._from_handle = at_sign if handle.sign.has(element, line) else Place(0, 0)
            handle.hold()
        elif not self.is_covered(*self.pointer):
            self._grabbed = self.screen

    def _drag(self, gesture: Gesture) -> None:
        last, self._last = self._last, gesture
        if isinstance(self._grabbed, Widget):
            # The scene has changed since the grab, and the widget may be gone.
            area, now = self._grabbed.area, self.layout.now(self._grabbed)
            self._grabbed = now.at(area) if type(now) is type(self._grabbed) else None
            if self._grabbed is not None:
                start = Place(self._start.element, self._start.line)
                self._grabbed.drag(start, Place(last.element, last.line), self.pointer)
        elif isinstance(self._grabbed, Handle):
            element, line = self._from_handle
            self._grabbed.place(gesture.element - element, gesture.line - line)
        elif self._grabbed is not None:
            self.content.drag(self._start, last, gesture)

    def _drop(self, gesture: Gesture) -> None:
        self._let_go()

    def _wheel(self, gesture: Gesture) -> None:
        widget = self.layout.widget_at(*self.pointer)
        if widget is not None:
            if not widget.why_not:
                self.menu.use(self.session.screen, widget)
                widget.nudge(gesture.steps)
        elif not self.is_covered(*self.pointer):
            self.content.wheel(gesture)

    # Keys.

    def close(self) -> None:
        """Take the menu away where it comes on demand."""
        self.menu.close()
        if self._comes_and_goes:
            self.menu.opened = ""

    def toggle_menu(self) -> None:
        """Bring the menu and give it the keys, or take it away."""
        if self.menu.has_focus or (self.menu.is_pinned and self._comes_and_goes):
            self.close()
            return
        self.menu.is_pinned = self.menu.has_focus = True
        if self.lit is None:
            self._move_light(1)

    def escape(self) -> bool:
        """Let go of a picked handle, close a list or the menu, or show hidden panels.

        Returns False if there is nothing to do.
        """
        if self.held is not None:
            self._let_go()
        elif self.layout.opened_row is not None:
            self._close_list()
        elif self.menu.has_focus or (self._comes_and_goes and (self.menu.is_pinned or self.menu.is_open)):
            self.close()
        elif self.hides_panels:
            self.switch_panels()
        else:
            return self.content.escape()
        return True

    def key(self, name: str, typed: str) -> bool:
        """Take a key that is typed into the widget under the pointer, or moves in the menu."""
        row = self.lit
        if isinstance(row, Bar) and not row.why_not and typed and typed in NUMBERS:
            self.typing.begin(row.typed, typed)
            return True
        if not self.menu.has_focus:
            return False
        if name in ("up", "down"):
            self._move_light(1 if name == "down" else -1)
        elif row is not None and name in ("left", "right") and not row.why_not:
            self.menu.use(self.session.screen, row)
            row.nudge(1 if name == "right" else -1)
        elif row is not None and name in ("return", "space", "enter"):
            self.pick_widget(row)
        else:
            return False
        return True

    def _move_light(self, step: int) -> None:
        lit = self.lit
        listed = self.layout.listed
        shown = self.layout.rows if listed is None else listed.rows
        rows = [each for each in shown if not isinstance(each, Gap)]
        if rows:
            start = next((n for n, each in enumerate(rows) if each is lit), -1 if step > 0 else 0)
            self._lit = rows[(start + step) % len(rows)]

    # The page.

    @property
    def mark(self) -> tuple[int, int] | None:
        """The place of the picked handle, or of the handle under the pointer."""
        handle = self.held
        if handle is not None:
            key = handle.key
            handle = next((each for each in self.content.handles if each.key == key), handle)
        elif self._grabbed is None and self.layout.widget_at(*self.pointer) is None:
            handle = self.handle_at(*self.pointer)
        place = None if handle is None else Place(handle.element, handle.line)
        # Cursors invert the pixels below them: two at one place would be invisible.
        return None if place == self.pointer else place

    def page(self) -> Page:
        """The page to show now: the screen, its widgets, the message line and the menu, bottom to top."""
        layout, content, lit = self.layout, self.content, self.lit
        items = list(content.items)
        for widget in (*content.widgets, *reversed(layout.over)):
            items += widget.items(widget is lit and not widget.why_not)
        if layout.rows:
            items += menu_items(layout.rows, lit)
            items.append(filled(STRIP, NIGHT))
        for word in layout.strip:
            items += word.items(word is lit)
        if layout.wide is not None:
            items += layout.wide.items(lit=False)
        if layout.listed is not None:
            items += layout.listed.items(lit)
        # The last message, which may go now, must not decide whether there is a hint.
        self._message = [filled(MESSAGE, BLACK)] if layout.rows else []
        has_message = self._has_hint or self.typing.is_on or self.session.has_news
        end = MENU.left if layout.rows else WIDTH
        self._message = message_items(self.messages, end) if has_message else []
        items += self._message
        if layout.offer is not None:
            items += layout.offer.items(layout.offer is lit)
        return Page(content.base, items, with_loads(self.session.studio.entries, content.loads))

    @property
    def messages(self) -> Sequence[MessagePart]:
        """The parts of the message: a refusal stands over the typed text that is refused."""
        session = self.session
        is_warned = session.has_news and session.news.is_warning
        parts = []
        if is_warned or (session.has_news and not self.typing.is_on):
            parts.append(MessagePart(session.message, ORANGE if is_warned else WHITE))
        if self.typing.is_on:
            parts.append(self.typing.shown)
        return parts or [MessagePart(self._hint() if self._has_hint else "", WHITE)]

    @property
    def _has_hint(self) -> bool:
        """Whether a hint is in the message line: beside a menu, else at handles and surfaces of a picture."""
        if self.layout.rows:
            return True
        element, line = self.pointer
        if self.is_dragging or line >= MESSAGE.top or self.layout.widget_at(element, line) is not None:
            return False
        handle = self.held or self.handle_at(element, line)
        if handle is not None:
            # A hint would cover a handle at the foot of the picture.
            return handle.line < MESSAGE.top
        speaks = self.screen.shows_picture and self.screen.shows_scene and not self.hides_panels
        return speaks and bool(surface_at(self.session.studio, element, line))

    def _hint(self) -> str:
        lit, (element, line) = self.lit, self.pointer
        if lit is not None and lit is self.layout.opened_row:
            of, what = ("value", "the wide bar") if isinstance(lit, Bar) else ("name", "the list")
            return f"{lit.label}: pick a {of} on {what}; a pick on the row takes it away"
        if lit is not None:
            return lit.hint_at(self.pointer)
        if self.held is not None:
            return f"{self.held.label}: pick its new place"
        if min(element, line) < 0 or self.is_covered(element, line):
            return self.screen.help
        handle = self.handle_at(element, line)
        if handle is None:
            return self.content.hint(element, line) or self.screen.help
        return f"{handle.label}: drag it, or click here and where it goes"


def with_loads(entries: Bytes, loads: Sequence[tuple[int, Bytes]]) -> Bytes:
    """The lookup table with some runs of entries replaced; the same array if there are none."""
    if not loads:
        return entries
    table = np.array(entries)
    for first, colors in loads:
        table[first : first + len(colors)] = colors
    return table
