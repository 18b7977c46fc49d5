"""The board: the screen that is shown, its menu, the message line, and the pointer over them.

A `Layout` has everything that can be pointed at: it is made once for an event, drawn, and the next event
finds the widget under the pointer in it. The board hands each gesture to the widget, the handle or the screen
at its place. It knows screens by their interface alone.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property, partial
from operator import itemgetter
from textwrap import wrap
from typing import Final, NamedTuple

import numpy as np

from autocolor.arrays import Bytes
from autocolor.checks import Color
from autocolor.scene.kinds import in_digits
from autocolor.screens.input import MIDDLE, Gesture
from autocolor.screens.screen import Handle, Sample, Screen
from autocolor.screens.session import HISTORY, PICTURE, Session
from autocolor.widgets.bars import Bar
from autocolor.widgets.items import (
    BLACK,
    CHARACTER,
    GRAY,
    HEIGHT,
    NIGHT,
    ORANGE,
    SLATE,
    WHITE,
    WIDTH,
    YELLOW,
    Area,
    Item,
    filled,
    text,
)
from autocolor.widgets.letters import PANEL as LETTER_PANEL
from autocolor.widgets.letters import letter_panel
from autocolor.widgets.menu import (
    MENU,
    MESSAGE_LINES,
    WIDE_BAR,
    menu_items,
    page_of_menu,
)
from autocolor.widgets.sheet import Page
from autocolor.widgets.widget import (
    MARGIN,
    NOWHERE,
    TEXT_DOWN,
    Button,
    Entry,
    Gap,
    Heading,
    Pair,
    Place,
    Steps,
    Typed,
    Widget,
)

EDGE: Final = 4
"""Assumed: elements at the right edge of the screen that bring the menu."""

REACH: Final = 8
"""Assumed: elements or lines from a handle within which it is grabbed."""


@dataclass(frozen=True)
class Layout:
    """Everything that can be pointed at on a screen at one moment, computed on demand."""

    screen: Screen
    rows: Sequence[Widget] = ()
    """The rows of the menu with their areas; none while the menu is away."""
    over: Sequence[Widget] = ()
    """The widgets over every screen, the topmost first."""
    wide_key: str = ""
    """The key of the row whose wide bar is shown, if that row is on this page of the menu."""

    @cached_property
    def wide(self) -> Widget | None:
        """The wide bar of a row, if it is shown."""
        if not self.wide_key:
            return None
        bars = (row for row in self.rows if isinstance(row, Bar) and row.key == self.wide_key)
        return next((row.at(WIDE_BAR) for row in bars), None)

    @cached_property
    def beside(self) -> Sequence[Widget]:
        """The widgets of the screen beside the menu."""
        return self.screen.widgets()

    @cached_property
    def handles(self) -> Sequence[Handle]:
        """The handles of the screen, including covered handles."""
        return self.screen.handles()

    @cached_property
    def widgets(self) -> Sequence[Widget]:
        """Everything that can be pointed at, the topmost first."""
        wide = () if self.wide is None else (self.wide,)
        return (*wide, *self.over, *self.rows, *self.beside)

    @cached_property
    def by_key(self) -> Mapping[str, Sequence[Widget]]:
        """The widgets that have a key, the topmost first."""
        by_key: dict[str, list[Widget]] = {}
        for widget in self.widgets:
            by_key.setdefault(widget.key, []).append(widget)
        return by_key

    def is_covered(self, element: int, line: int) -> bool:
        """Whether the menu, its wide bar or a panel over every screen is at a place of the screen."""
        if self.rows and MENU.has(element, line):
            return True
        if self.wide is not None and WIDE_BAR.has(element, line):
            return True
        return any(widget.area.has(element, line) for widget in self.over)

    def widget_at(self, element: int, line: int) -> Widget | None:
        """The topmost widget at a place; headings and gaps are left out."""
        for widget in self.widgets:
            if widget.has(element, line) and not isinstance(widget, (Heading, Gap)):
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


class Board:
    """The page on the display, and the pointer on it. `screens` has every screen by its name."""

    def __init__(self, session: Session, screens: Mapping[str, Screen]) -> None:
        self.session = session
        self.screens = screens
        self.typing = TypingLine(session)
        self.over: Callable[[], Sequence[Widget]] = tuple
        """Gives the widgets over every screen, the topmost first, such as the tutorial's panel."""
        self.is_pinned = False
        """Whether the menu was asked for; else it goes when the pointer leaves it."""
        self.has_focus = False
        """Whether keys go to the menu."""
        self.held: Handle | None = None
        """The handle that was picked; the next pick places it."""
        self._shown = session.screen
        self._is_open = False
        self._lit, self._lit_area = "", NOWHERE
        """The key and the area of the widget that is lit."""
        self._wide = ""
        """The key of the number whose wide bar is shown."""
        self._menu_page = 0
        self._message: list[Item] = []
        """The message on the page; it covers the screen below it."""
        self._grabbed: Widget | Handle | Screen | None = None
        """The thing that is dragged, from the grab to the drop."""
        self._start = self._last = Gesture("grab", -1, -1)
        """The gesture that began the drag, and the last one."""
        self._from_handle = Place(0, 0)
        """From the handle that is dragged to the pointer."""
        self._pointer = Place(-1, -1)
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
        return self.screen.has_menu or self._is_open or self.is_pinned

    @property
    def is_dragging(self) -> bool:
        """Whether something is grabbed."""
        return self._grabbed is not None

    @property
    def lit(self) -> str:
        """The key of the widget that is lit; empty if there is none."""
        return self._lit

    @property
    def layout(self) -> Layout:
        """The layout that is shown, until `forget` or another state of the board."""
        session, has_menu = self.session, self.has_menu
        by_letters = self.typing.is_by_letters
        state = session.screen, session.moving, has_menu, self._menu_page, self._wide, self.over, by_letters
        if self._layout is None or self._layout[0] != state:
            rows = self._menu_rows() if has_menu else ()
            letters = letter_panel(self.typing.key) if by_letters else ()
            self._layout = state, Layout(self.screen, rows, (*letters, *self.over()), self._wide)
        return self._layout[1]

    def forget(self) -> None:
        """Make the layout anew when it is needed, because the scene or the screen may have changed."""
        self._layout = None

    def _menu_rows(self) -> list[Widget]:
        """The rows of this page of the menu, laid out."""
        rows = rows_of_menu(self.session, self.screen, self.screens.values())
        last = last_rows(self.session, self.screen)
        return page_of_menu(rows, last, self._menu_page, partial(setattr, self, "_menu_page"))

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
        if self.is_covered(element, line):
            return None
        near = self.screen.preferred(handles_near(self.layout.handles, element, line), element, line)
        return next((each for each in near if not self.is_covered(each.element, each.line)), None)

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
        # Without a menu beside it, the screen itself must say what to do, and the way back.
        screen = self.screen
        is_reached_by_menu = screen.is_in_menu and screen.name != PICTURE
        if is_reached_by_menu and not screen.has_menu and not self.session.has_news:
            self.session.tell(f"{screen.help}; the right edge: the menu")
        return True

    # Gestures.

    @property
    def sample(self) -> Sample | None:
        """The pixel of the picture under the pointer; None where something covers the picture."""
        element, line = self._pointer
        is_free = self.layout.widget_at(element, line) is None and not self.is_covered(element, line)
        return self.screen.sample(element, line) if is_free else None

    @property
    def text_to_copy(self) -> str:
        """The typed text, the text of the row under the pointer, or the color there; empty without any."""
        lit = self._lit_widget()
        if self.typing.is_on:
            return self.typing.text
        if isinstance(lit, Entry):
            return lit.value
        color = self.screen.color_at(*self._pointer)
        return "" if color is None else in_digits(color)

    def paste(self, text: str) -> None:
        """Put a text into the typed text or the row under the pointer, or let the screen take it as a color.

        Raises UsageError or InputError if it is refused.
        """
        lit = self._lit_widget()
        if self.typing.is_on:
            self.typing.insert(text)
        elif isinstance(lit, Entry) and not lit.why_not:
            lit.take(text)
        else:
            self.take_color(text)

    def take_color(self, color: Color | str) -> None:
        """Let the screen take a color, with the pointer where it is."""
        self.screen.take_color(color, *self._pointer)

    def take(self, gesture: Gesture) -> None:
        """Handle a gesture. Over another thing, a message gives way to the hint when it had its time."""
        hint = self._hint() if gesture.kind == "hover" and self.session.news_may_go else ""
        self._pointer = Place(gesture.element, gesture.line)
        getattr(self, f"_{gesture.kind}")(gesture)
        if hint and hint != self._hint():
            self.session.shorten_news()

    def point_at(self, gesture: Gesture) -> None:
        """Move the pointer to the place of a gesture, and do nothing else."""
        self._pointer = Place(gesture.element, gesture.line)
        self._hover(gesture)

    def release(self) -> None:
        """Let go of a grabbed or picked thing, and end typing."""
        self._let_go()
        self.typing.end()

    def _let_go(self) -> None:
        self.held = self._grabbed = None
        self.screens[self._shown].release()

    def _light(self, widget: Widget | None) -> None:
        self._lit, self._lit_area = ("", NOWHERE) if widget is None else (widget.key, widget.area)

    def _lit_widget(self) -> Widget | None:
        return self.layout.lit(self._lit, self._lit_area)

    def _hover(self, gesture: Gesture) -> None:
        element, line = self._pointer
        if not self.screen.has_menu:
            was_open = self._is_open
            if WIDTH - EDGE <= element < WIDTH and line <= MENU.bottom:
                self._is_open = True
            elif not MENU.left <= element < WIDTH and self.layout.wide is None:
                self._is_open = False
            if self._is_open and not was_open and self.session.news.persistent:
                # Beside the menu, hints stand in its place.
                self.session.tell("")
        widget = self.layout.widget_at(element, line)
        self._light(widget)
        if widget is None:
            self.has_focus = False

    def _pick(self, gesture: Gesture) -> None:
        self._hover(gesture)
        element, line = self._pointer
        widget = self.layout.widget_at(element, line)
        if widget is not None:
            self._let_go()
            self.pick_widget(widget, self._pointer)
        elif self.is_covered(element, line):
            return
        elif self.held is not None:
            # If the place is refused, the handle stays picked.
            self.screen.place(self.held, element, line)
            self._let_go()
        else:
            handle = self.handle_at(element, line)
            if handle is None:
                self.screen.pick(gesture)
                return
            self.held = handle
            self.screen.hold(handle)
            self.session.tell(f"{handle.label}: pick its new place")

    def pick_widget(self, widget: Widget, place: Place | None = None) -> None:
        """Pick a widget at a place; without a place, at the widget's middle."""
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
        self._start = self._last = gesture
        widget = self.layout.widget_at(*self._pointer)
        self._light(widget)
        # Modifiers and the middle button are for the screen.
        is_plain = not gesture.shift and not gesture.control and gesture.button != MIDDLE
        handle = self.handle_at(*self._pointer) if is_plain else None
        if widget is not None:
            self._grabbed = None if widget.why_not else widget
        elif handle is not None:
            self._grabbed = handle
            # A handle comes to the pointer, but a handle that was grabbed at its sign stays away from it.
            element, line = self._pointer
            at_sign = Place(element - handle.element, line - handle.line)
            self._from_handle = at_sign if handle.sign.has(element, line) else Place(0, 0)
            self.screen.hold(handle)
        elif not self.is_covered(*self._pointer):
            self._grabbed = self.screen

    def _drag(self, gesture: Gesture) -> None:
        last, self._last = self._last, gesture
        if isinstance(self._grabbed, Widget):
            # The scene has changed since the grab, and the widget may be gone.
            self._grabbed = self.layout.now(self._grabbed)
            if self._grabbed is not None:
                start = Place(self._start.element, self._start.line)
                self._grabbed.drag(start, Place(last.element, last.line), self._pointer)
        elif isinstance(self._grabbed, Handle):
            element, line = self._from_handle
            self.screen.place(self._grabbed, gesture.element - element, gesture.line - line)
        elif self._grabbed is not None:
            self._grabbed.drag(self._start, last, gesture)

    def _drop(self, gesture: Gesture) -> None:
        self._let_go()

    def _wheel(self, gesture: Gesture) -> None:
        widget = self.layout.widget_at(*self._pointer)
        if widget is not None:
            if not widget.why_not:
                widget.nudge(gesture.steps)
        elif not self.is_covered(*self._pointer):
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
        if self._lit_widget() is None:
            self._move_light(1)

    def escape(self) -> bool:
        """Let go of a picked handle, or close the wide bar or the menu; returns False if there is none."""
        comes_and_goes = not self.screen.has_menu
        if self.held is not None:
            self._let_go()
        elif self.layout.wide is not None:
            self._wide = ""
        elif self.has_focus or (comes_and_goes and (self.is_pinned or self._is_open)):
            self.close()
        else:
            return self.screen.escape()
        return True

    def key(self, name: str, typed: str) -> bool:
        """Take a key that is typed into the widget under the pointer, or moves in the menu."""
        row = self._lit_widget()
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
        lit = self._lit_widget()
        rows = [each for each in self.layout.rows if not isinstance(each, (Heading, Gap))]
        if rows:
            start = next((n for n, each in enumerate(rows) if each is lit), -1 if step > 0 else 0)
            self._light(rows[(start + step) % len(rows)])

    # The page.

    @property
    def mark(self) -> tuple[int, int] | None:
        """The place of the picked handle, or of the handle under the pointer."""
        handle = self.held
        if handle is not None:
            key = handle.key
            handle = next((each for each in self.layout.handles if each.key == key), handle)
        elif self._grabbed is None and self.layout.widget_at(*self._pointer) is None:
            handle = self.handle_at(*self._pointer)
        place = None if handle is None else Place(handle.element, handle.line)
        # Cursors invert the pixels below them: two at one place would be invisible.
        return None if place == self._pointer else place

    def page(self) -> Page:
        """The page to show now: the screen, its widgets, the message line and the menu, bottom to top."""
        screen = self.screen
        screen.is_under_menu, screen.lit = self.has_menu and not screen.has_menu, self._lit
        layout, lit = self.layout, self._lit_widget()
        items = list(screen.items())
        for widget in (*layout.beside, *reversed(layout.over)):
            items += widget.items(widget is lit and not widget.why_not)
        if layout.rows:
            items += menu_items(layout.rows, lit)
        if layout.wide is not None:
            items += layout.wide.items(lit=False)
        has_message = bool(layout.rows) or self.typing.is_on or self.session.has_news
        end = MENU.left if layout.rows else WIDTH
        self._message = message_items(self.messages, end) if has_message else []
        items += self._message
        return Page(screen.base(), items, with_loads(self.session.studio.entries, screen.loads()))

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
        return parts or [MessagePart(self._hint() if self.layout.rows else "", WHITE)]

    def _hint(self) -> str:
        lit, (element, line) = self._lit_widget(), self._pointer
        if lit is not None and self.layout.wide is not None and lit.key == self._wide:
            return f"{lit.label}: pick a value on the wide bar; a pick on the row takes the bar away"
        if lit is not None:
            return lit.why_not or lit.help or lit.label
        if self.held is not None:
            return f"{self.held.label}: pick its new place"
        if min(element, line) < 0 or self.is_covered(element, line):
            return self.screen.help
        handle = self.handle_at(element, line)
        if handle is None:
            return self.screen.hint(element, line)
        return f"{handle.label}: drag it, or click here and where it goes"


def with_loads(entries: Bytes, loads: Sequence[tuple[int, Bytes]]) -> Bytes:
    """The lookup table with some runs of entries replaced; the same array if there are none."""
    if not loads:
        return entries
    table = np.array(entries)
    for first, colors in loads:
        table[first : first + len(colors)] = colors
    return table


# The message line: the bottom lines of every screen, for errors, results, hints and what is typed. A message
# that does not fit takes further lines over the screen while it stands.

MESSAGE: Final = Area(0, HEIGHT - MESSAGE_LINES, WIDTH - 1, HEIGHT - 1)
MOST_CHARACTERS: Final = (WIDTH - 16) // CHARACTER
LINE_STEP: Final = 12
"""Lines from one line of a message to the next."""

MOST_LINES: Final = 2
"""Assumed: lines of a message, and of a typed text; longer texts are cut."""


class MessagePart(NamedTuple):
    """A part of a message: its text, and the word of its color."""

    text: str
    ink: int
    selected: int | None = None
    """Of a typed text, the number of the first character that is selected; None for other texts."""


def message_items(parts: Sequence[MessagePart], end: int = WIDTH) -> list[Item]:
    """The parts of a message one below the other, the last line in the message line.

    Lines above the message line end before element `end`.
    """
    is_short = len(parts) == 1 and len(parts[0].text) <= MOST_CHARACTERS
    most = MOST_CHARACTERS if is_short else (end - 16) // CHARACTER
    lines = [line for part in parts for line in lines_of_message(part, most)]
    top = MESSAGE.top - LINE_STEP * (len(lines) - 1)
    items = [filled(MESSAGE, BLACK)]
    if top < MESSAGE.top:
        items.append(filled(Area(0, top, end - 1, MESSAGE.top - 1), BLACK))
    for line, ink, selected in lines:
        left, right = line, ""
        if selected is not None:
            left, right = line[:selected], line[selected:]
        if left:
            items.append(text(left, 8, top + 3, ink, BLACK))
        if right:
            items.append(text(right, 8 + CHARACTER * len(left), top + 3, BLACK, ink))
        top += LINE_STEP
    return items


def lines_of_message(part: MessagePart, most: int) -> list[MessagePart]:
    """A part of a message in lines of at most `most` characters.

    A long text is cut at its end; a typed text at its beginning, so that the last typed letters are seen.
    """
    line, ink, selected = part
    if selected is None:
        rows = wrap(line, most, max_lines=MOST_LINES, placeholder="..", tabsize=1) or [""]
        return [MessagePart(row, ink) for row in rows]
    cut = max(0, len(line) - MOST_LINES * most)
    if cut:
        line, selected = f"..{line[cut + 2 :]}", max(2, selected - cut)
    firsts = range(0, len(line), most)
    return [MessagePart(line[first : first + most], ink, max(0, selected - first)) for first in firsts]


NUMBERS: Final = "0123456789.-+"
"""The characters that begin a number."""


class TypingLine:
    """The text that is being typed, if any."""

    def __init__(self, session: Session) -> None:
        self._session = session
        self._label = ""
        self._text = ""
        self._typed: Typed | None = None
        self._is_fresh = False

    @property
    def is_on(self) -> bool:
        """Whether a text is being typed."""
        return self._typed is not None

    @property
    def is_by_letters(self) -> bool:
        """Whether a text is typed by the letter panel, because there is no keyboard."""
        return self.is_on and not self._session.has_keyboard

    @property
    def text(self) -> str:
        """The text that is being typed."""
        return self._text

    def insert(self, text: str) -> None:
        """Append a text, or replace the selected text by it."""
        self._text, self._is_fresh = (text if self._is_fresh else self._text + text), False

    @property
    def shown(self) -> MessagePart:
        """The text for the message line. The next character replaces the part that is selected."""
        selected = len(self._label) + 2
        if self._is_fresh and self._text:
            return MessagePart(f"{self._label}: {self._text}", YELLOW, selected)
        return MessagePart(f"{self._label}: {self._text}_", YELLOW, selected + len(self._text) + 1)

    def would_begin(self, widget: Widget, typed: str) -> bool:
        """Whether typing a character over a widget begins to type into it."""
        return isinstance(widget, Bar) and not widget.why_not and typed != "" and typed in NUMBERS

    def begin(self, widget: Widget, typed: str = "") -> None:
        """Begin with the widget's text, which the first character replaces."""
        self._typed = widget.typed
        self._label = widget.label
        self._text = typed or (self._typed.text if self._typed is not None else "")
        self._is_fresh = not typed

    def end(self) -> None:
        """End typing without taking the text."""
        self._typed = None

    def take(self) -> None:
        """Take the text if it was changed or proposed. A refused text raises an error and stays, selected."""
        typed = self._typed
        if typed is not None and (typed.is_proposed or self._text != typed.text):
            self._is_fresh = True
            typed.take(self._text)
        self.end()

    def leave(self) -> None:
        """Take the text as `take` does, but give up a text that was proposed."""
        if self._typed is not None and self._typed.is_proposed:
            self.end()
        self.take()

    def key(self, name: str, typed: str) -> None:
        """Take a key. Raises the errors of the function that takes the text."""
        if name == "escape":
            self.end()
        elif name in ("return", "enter", "tab"):
            self.take()
        elif name == "backspace":
            self._text, self._is_fresh = ("" if self._is_fresh else self._text[:-1]), False
        elif name in ("end", "right"):
            self._is_fresh = False
        elif typed and typed.isprintable():
            self.insert(typed)


# The main menu: the rows that stand in every menu before and after the rows of its screen.


STEPS: Final = "steps"
"""The word between undo and redo that leads to the list of steps."""


@dataclass(frozen=True)
class UndoRow(Steps):
    """Undo at the left, redo at the right, the list of steps between; a word is dim while it does nothing.

    It takes picks alone, and no drags: every pick is a step.
    """

    signs: tuple[str, str] = ("undo", "redo")
    can_undo: bool = True
    can_redo: bool = True
    show_history: Callable[[], object] = lambda: None

    def items(self, lit: bool) -> list[Item]:
        background = SLATE if lit else NIGHT
        can = self.can_undo, self.can_undo or self.can_redo, self.can_redo
        words = zip((self.signs[0], STEPS, self.signs[1]), self._places, can, strict=True)
        top = self.area.top + TEXT_DOWN
        texts = [text(word, left, top, WHITE if is_on else GRAY, background) for word, left, is_on in words]
        return [filled(self.area, background), *texts]

    @property
    def _places(self) -> tuple[int, int, int]:
        """Where the three words begin."""
        left, _, right, _ = self.area
        end = right + 1 - MARGIN - CHARACTER * len(self.signs[1])
        start = left + MARGIN
        return start, (start + CHARACTER * len(self.signs[0]) + end - CHARACTER * len(STEPS)) // 2, end

    def pick(self, place: Place) -> object:
        _, middle, end = self._places
        if middle <= place.element < end:
            return self.show_history()
        return super().pick(place)

    def drag(self, start: Place, last: Place, place: Place) -> object:
        return None


def rows_of_menu(session: Session, screen: Screen, screens: Iterable[Screen]) -> list[Widget]:
    """The rows of a screen's menu: on the picture the ways to other screens, elsewhere the way back."""
    if screen.name == PICTURE:
        ways: list[Widget] = [
            Button(each.title, each.help, run=partial(session.turn_to, each.name))
            for each in screens
            if each.is_in_menu and each is not screen
        ]
        return [Heading("AUTOCOLOR"), *ways, Gap("ways"), *screen.rows()]
    back = Button("< picture", "Back to the picture.", run=partial(session.turn_to, PICTURE))
    return [Heading(screen.title.upper()), back, Gap("ways"), *screen.rows()]


def last_rows(session: Session, screen: Screen) -> list[Widget]:
    """The rows at the end of every page of every menu: undo, and over the picture comparing."""
    history = session.studio.history
    can_undo, can_redo = bool(history.to_undo), bool(history.to_redo)
    undo = UndoRow(
        " ",
        "Undo the last step, or redo it; between, the list of all steps.",
        "" if can_undo or can_redo else "there is no step to undo",
        step=lambda amount: session.undo() if amount < 0 else session.redo(),
        can_undo=can_undo,
        can_redo=can_redo,
        show_history=partial(session.turn_to, PICTURE if session.screen == HISTORY else HISTORY),
    )
    return [Gap("undo gap"), undo, *([compare_row(session)] if screen.shows_picture else [])]


def compare_row(session: Session) -> Widget:
    """The row that shows the state to compare with, and the present one again, or both side by side."""
    other = session.comparing.other
    if other is None:
        return Button("compare", why_not="there is no step to undo")
    return Pair(
        "compare",
        f"Show {other.name}, and the present state again; or both, left and right of a line.",
        run=session.switch_comparing,
        other="split",
        run_other=session.switch_split,
        is_chosen=session.comparing.is_on,
    )
