"""Inspector: the window in which a stream, or a running display, is inspected.

The keys and buttons are in the table at the foot of this module. The mouse selects on the field, scrubs on
the bar, and goes to instructions of the listing and the history. While a running display is followed, the
mouse over its field is its joystick.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Final, NamedTuple

from ramtek_emu.errors import RamtekError
from ramtek_emu.inspection import session as sessions
from ramtek_emu.inspection.histories import EntryRange
from ramtek_emu.inspection.page import InspectorPage, layout_of
from ramtek_emu.inspection.panels import PAUSE
from ramtek_emu.inspection.replay import Replay
from ramtek_emu.inspection.running_host import RunningHost
from ramtek_emu.inspection.session import Inspection, display_of, inspection_of
from ramtek_emu.memory.scan_orders import Point
from ramtek_emu.monitor.overlay import KEYS
from ramtek_emu.monitor.window import LEFT, RIGHT, TICK_MILLISECONDS, Key, Monitor, Pointer
from ramtek_emu.snapshot import snapshot_bytes
from ramtek_emu.video.scan_out import turned
from ramtek_emu.writing import PNG, write_numbered

WHEEL_ROWS: Final = 3


Hint = Callable[[float], str]
"""A function that returns a message for people at a time of `time.monotonic`, or ""."""


def inspect(replay: Replay, caption: str = "RAMTEK 9300", hint: Hint = lambda _: "") -> None:
    """Open a window in which the instructions of a replay are inspected, until it is closed.

    NoScreenError if there is no screen.
    """
    Inspector(inspection_of(replay), caption).run(hint)


def inspect_host(host: RunningHost, caption: str, hint: Hint, ends: Callable[[], bool]) -> None:
    """Follow a running display in a window, until it is closed or `ends()` is true; NoScreenError."""
    Inspector(inspection_of(host.replay, host), caption).run(hint, ends)


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
        session = sessions.with_rows(session, *rows)
        self.page = InspectorPage(session, layout, labels, help_rows(is_live), caption)
        self._anchor: tuple[str, Point] | None = None
        """Where the mouse went down: the part of the page, and the place."""
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

    def _do(self, action: Callable[..., Inspection], *values: object) -> None:
        """Show the inspection after an action."""
        self.page.session = action(self.page.session, *values)

    def run(self, hint: Hint = lambda _: "", ends: Callable[[], bool] = lambda: False) -> None:
        """Keep the window open until it is closed, or until `ends()` is true; show the hints."""
        monitor = self.monitor
        monitor.open()
        try:
            while monitor.is_open and not ends():
                monitor.step(0 if sessions.is_busy(self.session) else TICK_MILLISECONDS)
                if message := hint(time.monotonic()):
                    self._do(sessions.tell, message)
        finally:
            monitor.close()

    def press(self, key: Key) -> bool:
        """Handle a key; returns whether it means something here."""
        session = self.session
        if key.name == "f12":
            return False
        if key.name in ("return", "enter"):
            self._do(sessions.enter, key.shift)
            return True
        if session.prompt and key.name == "backspace":
            self._do(sessions.ask, session.prompt, session.typed[:-1])
            return True
        if not key.control and not key.alt and key.text:
            if sessions.takes(session, key.text):
                self._do(sessions.ask, session.prompt, session.typed + key.text)
                return True
            if key.text.isascii() and key.text.isdigit():
                self._do(sessions.ask, "instruction", key.text)
                return True
        name = f"{'shift ' if key.shift else ''}{'ctrl ' if key.control else ''}{key.name}"
        for binding in self.bindings:
            # On some keyboards a bracket is typed with other keys.
            if (name in binding.keys or key.text in binding.keys) and not (key.repeated and binding.is_once):
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
            if part in WHEEL:
                self._do(WHEEL[part], steps)
        elif (
            session.is_following
            and not session.page
            and self._anchor is None
            and (part == "stage" or pointer.action == "release")
        ):
            # The mouse is the joystick over the field, or where a button goes up.
            on_field = page.field_place(place)
            self.monitor.steer(pointer._replace(element=on_field.element, line=on_field.line))
            self._do(point_at, on_field)
        elif pointer.action == "press" and is_left:
            self._press_at(part, row, place)
        elif pointer.action == "press" and pointer.button == RIGHT and part == "stage":
            self._do(sessions.select, None)
        elif pointer.action == "move":
            self._move_to(part, place)
        elif pointer.action == "release" and is_left:
            if self._anchor is not None and self._anchor[0] == "stage":
                self._select_to(self._anchor[1], place, is_final=True)
            self._anchor = None

    def _press_at(self, part: str, row: int, place: Point) -> None:
        if part == "button":
            self._do(self.buttons[row].action)
        elif part in ("listing", "history") and row >= 0:
            self._do(sessions.click_listing if part == "listing" else sessions.click_history, row)
        elif part == "bar" or (part == "stage" and self.session.page != "help"):
            self._anchor = part, place
            if part == "bar":
                self._do(sessions.go, self.page.number_at(place.element))

    def _move_to(self, part: str, place: Point) -> None:
        page = self.page
        if self._anchor is not None and self._anchor[0] == "bar":
            self._do(sessions.go, page.number_at(place.element))
            return
        if part != "stage" or self.session.page == "help":
            self._do(point_at)
        elif self.session.page == "entries":
            self._do(point_at, None, page.entry_at(place))
        else:
            self._do(point_at, page.field_place(place))
        if self._anchor is not None and place != self._anchor[1]:
            self._select_to(self._anchor[1], place, is_final=False)

    def _select_to(self, begin: Point, end: Point, is_final: bool) -> None:
        """Select from where the mouse went down to a place; a final selection asks for its history."""
        page = self.page
        if self.session.page == "entries":
            first, last = page.entry_at(begin), page.entry_at(end)
            if first is not None and last is not None:
                entries = EntryRange(min(first, last), max(first, last) + 1)
                self._do(sessions.select, entries, is_final)
        else:
            places = page.field_place(begin), page.field_place(end)
            window = sessions.memory_window(display_of(self.session), *places)
            self._do(sessions.select, window, is_final)


class KeyBinding(NamedTuple):
    """Keys and a button for an action."""

    keys_text: str
    help: str
    keys: tuple[str, ...]
    """The names of keys, with "shift " or "ctrl " before a name."""
    action: Callable[[Inspection], Inspection]
    button: str = ""
    """The text of the button; "" for no button."""
    is_once: bool = False
    """Whether the action is not repeated while its key stays down."""
    is_live: bool = False
    """Whether the action is for running displays only."""


def point_at(session: Inspection, place: Point | None = None, entry: int | None = None) -> Inspection:
    """Note the place of the screen, or the entry, under the pointer."""
    return replace(session, pointer=place, pointed_entry=entry)


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


BINDINGS: Final = (
    KeyBinding(
        "Space", "pause the host, or let it go on", ("space",),
        lambda session: (sessions.pause if session.is_following else sessions.go_on)(session),
        PAUSE, True, True,
    ),
    KeyBinding(
        "Home", "the start, before the first instruction", ("home",),
        lambda session: sessions.go(session, 0), "|<",
    ),
    KeyBinding("Page Up", "ten back", ("page up",), lambda session: sessions.step(session, -10), "-10"),
    KeyBinding("Left, Up", "step back", ("left", "up", ","), lambda session: sessions.step(session, -1), "<"),
    KeyBinding(
        "Right, Down", "step; a paused host sends its next instruction", ("right", "down", "."),
        lambda session: sessions.step(session, 1), ">",
    ),
    KeyBinding("Page Down", "ten on", ("page down",), lambda session: sessions.step(session, 10), "+10"),
    KeyBinding(
        "End", "the end of the stream", ("end",), lambda session: sessions.go(session, session.length), ">|"
    ),
    KeyBinding(
        "0 to 9, G", "type an instruction's number, then Enter", ("g",),
        lambda session: sessions.ask(session, "instruction"), "go to",
    ),
    KeyBinding(
        "F", "type a text of the listing, such as FORE=7 or WI WIN=", ("f",),
        lambda session: sessions.ask(session, "text"), "find",
    ),
    KeyBinding("(Shift+) Enter", "the next instruction with the text, or the last before", (), sessions.find),
    KeyBinding("C", "the next change of what is selected", ("c",), sessions.next_change, "change"),
    KeyBinding(
        "Shift+C", "the change before of what is selected", ("shift c",),
        lambda session: sessions.next_change(session, back=True),
    ),
    KeyBinding(
        "[", "the write before, in the history", ("[",),
        lambda session: sessions.next_write(session, back=True),
    ),
    KeyBinding(
        "]", "the write after, in the history", ("]",),
        lambda session: sessions.next_write(session, back=False),
    ),
    KeyBinding(
        "F4", "the entries of the lookup table, and back", ("f4",),
        lambda session: sessions.turn_to(session, "entries"), "entries", True,
    ),
    KeyBinding("F2", KEYS[1][1], ("f2",), turn_table, "table", True),
    KeyBinding("S", "save a numbered snapshot of the display", ("s",), save_snapshot, "snapshot", True),
    KeyBinding("Esc", "stop, close the page, or clear the selection", ("escape",), sessions.escape),
    KeyBinding(
        "F1", "this help, and back", ("f1",), lambda session: sessions.turn_to(session, "help"), "help", True
    ),
)  # fmt: skip
WHEEL: Final[dict[str, Callable[[Inspection, int], Inspection]]] = {
    "listing": lambda session, steps: sessions.scroll_listing(session, WHEEL_ROWS * steps),
    "history": lambda session, steps: sessions.scroll_history(session, WHEEL_ROWS * steps),
    "bar": sessions.step,
}
"""What the wheel does over a part of the page."""
MOUSE_LIVE: Final = (("mouse, running", "over the field: the joystick; a click is ENTER"),)
MOUSE: Final = (
    ("click a pixel", "its history; on the page of entries, an entry's"),
    ("drag", "select a rectangle, or entries; right button: clear"),
    ("click a row", "go to its instruction; the wheel scrolls"),
    ("drag on the bar", "scrub over the stream"),
)
WINDOW_KEYS: Final = tuple(row for row in KEYS if row[0] in ("F3", "F10", "F11, Alt+Enter", "F12", "Ctrl+Q"))
"""The keys of every window that an inspector has, too."""


def help_rows(is_live: bool) -> list[tuple[str, str]]:
    """The keys and the mouse of an inspector, of a running display if `is_live`, with their actions."""
    bindings = [(binding.keys_text, binding.help) for binding in BINDINGS if is_live or not binding.is_live]
    return [*bindings, *(MOUSE_LIVE if is_live else ()), *MOUSE, *WINDOW_KEYS]
