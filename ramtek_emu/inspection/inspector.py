"""Inspector: the window in which a stream, or a running display, is inspected.

The keys and buttons are in the table at the foot of this module. The mouse selects on the field, scrubs on
the bar, and goes to instructions of the listing and the history. While a running display is followed, the
mouse over its field is its joystick.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Final, NamedTuple

from ramtek_emu.inspection.page import InspectorPage
from ramtek_emu.inspection.panels import PAUSE
from ramtek_emu.inspection.replay import Replay
from ramtek_emu.inspection.running_host import RunningHost
from ramtek_emu.inspection.session import EntryRange, InspectionSession
from ramtek_emu.memory.scan_orders import Point
from ramtek_emu.monitor.overlay import KEYS
from ramtek_emu.monitor.window import LEFT, RIGHT, TICK_MILLISECONDS, Key, Monitor, Pointer

WHEEL_ROWS: Final = 3


def inspect(replay: Replay, caption: str = "RAMTEK 9300") -> None:
    """Open a window in which the instructions of a replay are inspected, until it is closed.

    NoScreenError if there is no screen.
    """
    Inspector(InspectionSession(replay), caption).run()


def inspect_host(host: RunningHost, caption: str, ends: Callable[[], bool]) -> None:
    """Follow a running display in a window, until it is closed or `ends()` is true; NoScreenError."""
    Inspector(InspectionSession(host.replay, host), caption).run(ends)


class Inspector:
    """The window of a session: the page, the keys and the mouse."""

    def __init__(self, session: InspectionSession, caption: str = "RAMTEK 9300") -> None:
        self.session = session
        self.bindings = tuple(binding for binding in BINDINGS if session.host or not binding.is_live)
        self.buttons = tuple(binding for binding in self.bindings if binding.button)
        self.page = InspectorPage(
            session,
            [binding.button for binding in self.buttons],
            help_rows(session.host is not None),
            caption,
        )
        self._anchor: tuple[str, Point, int] | None = None
        """Where the mouse went down: the part of the page, the place, and the entry there."""
        self.monitor = Monitor(
            session.display,
            caption,
            source=self.page,
            on_key=self.press,
            on_pointer=self.point,
            on_tick=session.tick,
            on_message=session.tell,
        )

    def run(self, ends: Callable[[], bool] = lambda: False) -> None:
        """Keep the window open until it is closed, or until `ends()` is true."""
        monitor = self.monitor
        monitor.open()
        try:
            while monitor.is_open and not ends():
                monitor.step(0 if self.session.is_busy else TICK_MILLISECONDS)
        finally:
            monitor.close()

    def press(self, key: Key) -> bool:
        """Handle a key; returns whether it means something here."""
        session = self.session
        if key.name in ("f3", "f12"):
            return False
        is_plain = not key.control and not key.alt
        if session.state.prompt and key.name in ("return", "enter"):
            session.enter()
            return True
        if session.state.prompt and key.name == "backspace":
            session.erase_typed()
            return True
        if is_plain and session.takes(key.text):
            session.type(key.text)
            return True
        if is_plain and key.text.isascii() and key.text.isdigit():
            session.ask("instruction", key.text)
            return True
        name = f"{'shift ' if key.shift else ''}{'ctrl ' if key.control else ''}{key.name}"
        for binding in self.bindings:
            # On some keyboards a bracket is typed with other keys.
            if (name in binding.keys or key.text in binding.keys) and not (key.repeated and binding.is_once):
                binding.action(session)
                break
        return True

    def point(self, pointer: Pointer) -> None:
        """Handle an action of the mouse."""
        session, page = self.session, self.page
        place = Point(pointer.element, pointer.line)
        part, row = page.panel_at(place)
        if pointer.action.startswith("wheel"):
            self._turn_wheel(part, pointer.steps if pointer.action == "wheel down" else -pointer.steps)
        elif session.state.is_following and not session.state.page and self._steers(part, pointer):
            on_field = page.field_place(place)
            self.monitor.steer(pointer._replace(element=on_field.element, line=on_field.line))
            session.point_at(on_field)
        elif pointer.action == "press" and pointer.button == LEFT:
            self._press_at(part, row, place)
        elif pointer.action == "press" and pointer.button == RIGHT and part == "stage":
            session.select(None)
        elif pointer.action == "move":
            self._move_to(part, place)
        elif pointer.action == "release" and pointer.button == LEFT:
            self._release_at(place)

    def _steers(self, part: str, pointer: Pointer) -> bool:
        """Whether the mouse is the joystick: over the field, or where a button goes up."""
        return self._anchor is None and (part == "stage" or pointer.action == "release")

    def _turn_wheel(self, part: str, steps: int) -> None:
        session = self.session
        if part == "listing":
            session.scroll_listing(WHEEL_ROWS * steps)
        elif part == "history":
            session.scroll_history(WHEEL_ROWS * steps)
        elif part == "bar":
            session.step(steps)

    def _press_at(self, part: str, row: int, place: Point) -> None:
        session, page = self.session, self.page
        if part == "button":
            self.buttons[row].action(session)
        elif part == "listing" and row >= 0:
            session.click_listing(row)
        elif part == "history" and row >= 0:
            session.click_history(row)
        elif part == "bar":
            self._anchor = part, place, 0
            session.go(page.number_at(place.element))
        elif part == "stage" and session.state.page != "help":
            self._anchor = part, place, self._entry_at(place)

    def _entry_at(self, place: Point) -> int:
        """The entry at a place of the page of entries, -1 where there is none."""
        entry = self.page.entry_at(place) if self.session.state.page == "entries" else None
        return -1 if entry is None else entry

    def _move_to(self, part: str, place: Point) -> None:
        session, page = self.session, self.page
        if self._anchor is not None and self._anchor[0] == "bar":
            session.go(page.number_at(place.element))
            return
        if part != "stage" or session.state.page == "help":
            session.point_at()
        elif session.state.page == "entries":
            session.point_at(entry=page.entry_at(place))
        else:
            session.point_at(page.field_place(place))
        if self._anchor is not None and place != self._anchor[1]:
            self._select_to(place, is_final=False)

    def _release_at(self, place: Point) -> None:
        if self._anchor is not None and self._anchor[0] == "stage":
            self._select_to(place, is_final=True)
        self._anchor = None

    def _select_to(self, place: Point, is_final: bool) -> None:
        """Select from where the mouse went down to a place; a final selection asks for its history."""
        if self._anchor is None:
            return
        session, page = self.session, self.page
        _, begin, entry = self._anchor
        if session.state.page == "entries":
            if entry >= 0 and (last := self._entry_at(place)) >= 0:
                session.select(EntryRange(min(entry, last), max(entry, last) + 1), is_final)
        else:
            session.select(session.memory_window(page.field_place(begin), page.field_place(place)), is_final)


class KeyBinding(NamedTuple):
    """Keys and a button for an action."""

    keys_text: str
    help: str
    keys: tuple[str, ...]
    """The names of keys, with "shift " or "ctrl " before a name."""
    action: Callable[[InspectionSession], object]
    button: str = ""
    """The text of the button; "" for no button."""
    is_once: bool = False
    """Whether the action is not repeated while its key stays down."""
    is_live: bool = False
    """Whether the action is for running displays only."""


def pause_or_go_on(session: InspectionSession) -> None:
    """Pause a running display, or let it go on."""
    if session.state.is_following:
        session.pause()
    else:
        session.go_on()


BINDINGS: Final = (
    KeyBinding("Space", "pause the host, or let it go on", ("space",), pause_or_go_on, PAUSE, True, True),
    KeyBinding(
        "Home", "the start, before the first instruction", ("home",), lambda session: session.go(0), "|<"
    ),
    KeyBinding("Page Up", "ten back", ("page up",), lambda session: session.step(-10), "-10"),
    KeyBinding("Left, Up", "step back", ("left", "up", ","), lambda session: session.step(-1), "<"),
    KeyBinding(
        "Right, Down",
        "step; a paused host sends its next instruction",
        ("right", "down", "."),
        lambda session: session.step(1),
        ">",
    ),
    KeyBinding("Page Down", "ten on", ("page down",), lambda session: session.step(10), "+10"),
    KeyBinding(
        "End", "the end of the stream", ("end",), lambda session: session.go(session.state.length), ">|"
    ),
    KeyBinding(
        "0 to 9, G",
        "type an instruction's number, then Enter",
        ("g",),
        lambda session: session.ask("instruction"),
        "go to",
    ),
    KeyBinding(
        "O",
        "type an opcode, then Enter: its next instruction",
        ("o",),
        lambda session: session.ask("opcode"),
        "opcode",
    ),
    KeyBinding("N", "the next of the same opcode", ("n",), lambda session: session.next_opcode(), "next"),
    KeyBinding(
        "Shift+N",
        "the one before of the same opcode",
        ("shift n",),
        lambda session: session.next_opcode(back=True),
    ),
    KeyBinding(
        "C",
        "the next change of what is selected",
        ("c",),
        lambda session: session.next_change(),
        "change",
    ),
    KeyBinding(
        "[", "the write before, in the history", ("[",), lambda session: session.next_write(back=True)
    ),
    KeyBinding(
        "]", "the write after, in the history", ("]",), lambda session: session.next_write(back=False)
    ),
    KeyBinding(
        "F4",
        "the entries of the lookup table, and back",
        ("f4",),
        lambda session: session.turn_to("entries"),
        "entries",
        True,
    ),
    KeyBinding("Esc", "stop, close the page, or clear the selection", ("escape",), InspectionSession.escape),
    KeyBinding("F1", "this help, and back", ("f1",), lambda session: session.turn_to("help"), "help", True),
)
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
