"""Inspector: the window in which a stream, or a running display, is inspected.

The keys and buttons are in the table at the foot of this module. The mouse selects on the field, scrubs on
the bar, and goes to instructions of the listing and the history. While a running display is followed, the
mouse over its field is its joystick.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path
from string import digits
from typing import Final, NamedTuple

from ramtek_emu.errors import RamtekError
from ramtek_emu.inspection import session as sessions
from ramtek_emu.inspection.histories import EntryRange
from ramtek_emu.inspection.page import InspectorPage, layout_of
from ramtek_emu.inspection.session import Inspection, display_of
from ramtek_emu.memory.scan_orders import Point
from ramtek_emu.monitor.overlay import KEYS
from ramtek_emu.monitor.window import LEFT, RIGHT, Key, Monitor, Pointer
from ramtek_emu.snapshot import snapshot_bytes
from ramtek_emu.video.scan_out import turned
from ramtek_emu.writing import PNG, write_numbered


class Inspector:
    """The window of an inspection: the page, the keys and the mouse."""

    def __init__(self, session: Inspection, caption: str = "RAMTEK 9300") -> None:
        is_live, display = session.host is not None, display_of(session)
        self.bindings = tuple(binding for binding in BINDINGS if is_live or not binding.is_live)
        self.buttons = tuple(binding for binding in self.bindings if binding.button)
        labels = [binding.button for binding in self.buttons]
        sizes = display.configuration
        layout = layout_of(sizes.shown_elements, sizes.shown_lines, sizes.cursors, labels)
        rows = layout.boxes["listing"].rows - 1, layout.boxes["history"].rows - 1
        session = replace(session, listing_rows=rows[0], history_rows=rows[1])
        self.page = InspectorPage(session, layout, labels, help_rows(is_live), caption)
        self._anchor, self._anchor_place = "", Point(0, 0)
        """The part of the page where the mouse went down, or "joystick", and the place; "" while it is up."""
        self.monitor = Monitor(
            display,
            caption,
            source=self.page,
            on_key=self.press,
            on_pointer=self.point,
            on_tick=lambda: self._do(sessions.tick),
            on_message=lambda message: self._do(sessions.tell, message),
        )

    @property
    def session(self) -> Inspection:
        """The inspection that is shown."""
        return self.page.session

    def _do(self, action: Callable[..., Inspection], *values: object, **named: object) -> None:
        """Show the inspection after an action."""
        self.page.session = action(self.page.session, *values, **named)

    def is_busy(self) -> bool:
        """Whether a tick has work to do, or waits for a host itself."""
        return sessions.is_busy(self.session)

    def press(self, key: Key) -> bool:
        """Handle a key; returns whether it means something here."""
        session = self.session
        if key.name == "f12":
            return False
        if session.typed is not None and key.name == "backspace":
            self._do(sessions.ask, session.typed[:-1])
            return True
        types = key.text.isprintable() and key.text != "" and not key.control and not key.alt
        if types and (session.typed is not None or key.text in digits):
            self._do(sessions.ask, (session.typed or "") + key.text)
            return True
        name = f"{'ctrl+' if key.control else ''}{'shift+' if key.shift else ''}{key.name}"
        name = name.replace("return", "enter").replace("escape", "esc")
        for binding in self.bindings:
            if name in binding.keys and not (key.repeated and binding.is_once):
                self._do(binding.action)
                break
        return True

    def point(self, pointer: Pointer) -> None:
        """Handle an action of the mouse."""
        session, page = self.session, self.page
        place = Point(pointer.element, pointer.line)
        part, row = page.panel_at(place)
        is_left = pointer.button == LEFT
        if pointer.action.startswith("wheel"):
            steps = pointer.steps if pointer.action == "wheel down" else -pointer.steps
            self._do(sessions.step, steps)
        elif (session.is_following and part == "stage" and not session.page) or self._anchor == "joystick":
            # The mouse is the joystick over the field, and beyond it while a button is down.
            on_field = page.field_place(place)
            self.monitor.steer(pointer._replace(element=on_field.element, line=on_field.line))
            self._do(replace, pointed=on_field)
            if pointer.action != "move":
                self._anchor = "joystick" if pointer.action == "press" else ""
        elif pointer.action == "press" and is_left:
            self._press_at(part, row, place)
        elif pointer.action == "press" and pointer.button == RIGHT and part == "stage":
            self._do(sessions.select, None)
        elif pointer.action == "move":
            self._move_to(part, place)
        elif pointer.action == "release" and is_left:
            if self._anchor == "stage":
                self._select_to(place, is_final=True)
            self._anchor = ""

    def _press_at(self, part: str, row: int, place: Point) -> None:
        if part == "button":
            self._do(self.buttons[row].action)
        elif part in ("listing", "history") and row >= 0:
            self._do(sessions.click, part, row)
        elif part == "bar" or (part == "stage" and self.session.page != "help"):
            self._anchor, self._anchor_place = part, place
            if part == "bar":
                self._do(sessions.go, self.page.number_at(place.element))

    def _move_to(self, part: str, place: Point) -> None:
        page = self.page
        if self._anchor == "bar":
            self._do(sessions.go, page.number_at(place.element))
            return
        if part != "stage" or self.session.page == "help":
            self._do(replace, pointed=None)
        elif self.session.page == "entries":
            self._do(replace, pointed=page.entry_at(place))
        else:
            self._do(replace, pointed=page.field_place(place))
        if self._anchor == "stage" and place != self._anchor_place:
            self._select_to(place, is_final=False)

    def _select_to(self, end: Point, is_final: bool) -> None:
        """Select from where the mouse went down to a place; a final selection asks for its history."""
        page, begin = self.page, self._anchor_place
        if self.session.page == "entries":
            first, last = page.entry_at(begin), page.entry_at(end)
            if first is not None and last is not None:
                entries = EntryRange(min(first, last).first, max(first, last).end)
                self._do(sessions.select, entries, is_final)
        else:
            places = page.field_place(begin), page.field_place(end)
            window = sessions.memory_window(display_of(self.session), *places)
            self._do(sessions.select, window, is_final)


class KeyBinding(NamedTuple):
    """Keys and a button for an action."""

    text: str
    """The keys, with commas between them."""
    help: str
    action: Callable[[Inspection], Inspection]
    button: str = ""
    """The text of the button; "" for no button."""
    is_once: bool = False
    """Whether the action is not repeated while its key stays down."""
    is_live: bool = False
    """Whether the action is for running displays only."""

    @property
    def keys(self) -> list[str]:
        """The names of the keys, with "shift+" before a name."""
        return self.text.lower().split(", ")


def turn_table(session: Inspection) -> Inspection:
    """Show the words through the next table of grays, or again through the table of the display."""
    shown = display_of(session).scan_out
    message = turned(shown)
    for display in (session.replay.display, *([session.host.display] if session.host is not None else ())):
        display.scan_out.shown_table = shown.shown_table
    return sessions.tell(session, message)


def save_snapshot(session: Inspection) -> Inspection:
    """Save the display under the next free number, and show the path."""
    try:
        path = write_numbered(snapshot_bytes(display_of(session)), Path(), "snapshot", PNG)
    except RamtekError as refusal:
        return sessions.tell(session, str(refusal))
    return sessions.tell(session, f"saved {path}")


def pause_or_go_on(session: Inspection) -> Inspection:
    """Pause the host of a running display, or let it go on."""
    return sessions.pause(session) if session.is_following else sessions.go_on(session)


BINDINGS: Final = (
    KeyBinding("Space", "pause the host, or let it go on", pause_or_go_on, "pause, go on", True, True),
    KeyBinding("Home", "the start, before the first instruction", partial(sessions.go, number=0), "|<"),
    KeyBinding("Page Up", "ten steps back", partial(sessions.step, count=-10), "-10"),
    KeyBinding("Left, Up", "a step back", partial(sessions.step, count=-1), "<"),
    KeyBinding("Right, Down", "a step on", partial(sessions.step, count=1), ">"),
    KeyBinding("Page Down", "ten steps on", partial(sessions.step, count=10), "+10"),
    KeyBinding("End", "the end of the stream", lambda session: sessions.go(session, session.length), ">|"),
    KeyBinding(
        "0 to 9, F", "type an instruction's number, or a text such as FORE=7", sessions.ask, "go to, find"
    ),
    KeyBinding("Enter", "go to the number, or to the next instruction with the text", sessions.enter),
    KeyBinding("Shift+Enter", "the previous instruction with the text", partial(sessions.enter, back=True)),
    KeyBinding("C", "the next change of the selection", sessions.next_change, "change"),
    KeyBinding("Shift+C", "the previous change of the selection", partial(sessions.next_change, back=True)),
    KeyBinding(
        "F4", "the entries of the lookup table, and back", partial(sessions.turn_to, page="entries"),
        "entries", True,
    ),
    KeyBinding("F2", KEYS[1][1], turn_table, "table", True),
    KeyBinding("S", "save a numbered snapshot of the display", save_snapshot, "snapshot", True),
    KeyBinding("Esc", "stop a search, close the page, or clear the selection", sessions.escape),
    KeyBinding("F1", "this help, and back", partial(sessions.turn_to, page="help"), "help", True),
)  # fmt: skip
MOUSE_LIVE: Final = (("mouse, running", "over the field: the joystick, whose ENTER is the left button"),)
MOUSE: Final = (
    ("click", "select a pixel or an entry, and list its writes"),
    ("drag", "select a rectangle or entries"),
    ("right button", "clear the selection"),
    ("click a row", "go to its instruction"),
    ("drag on the bar", "go through the stream"),
    ("wheel", "step"),
)
WINDOW_KEYS: Final = tuple(row for row in KEYS if row[0] in ("F3", "F10", "F11, Alt+Enter", "F12", "Ctrl+Q"))
"""The keys of every window that an inspector has, too."""


def help_rows(is_live: bool) -> list[tuple[str, str]]:
    """The keys and the mouse of an inspector, of a running display if `is_live`, with their actions."""
    bindings = [(binding.text, binding.help) for binding in BINDINGS if is_live or not binding.is_live]
    return [*bindings, *(MOUSE_LIVE if is_live else ()), *MOUSE, *WINDOW_KEYS]
