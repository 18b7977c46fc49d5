"""Monitor: the window that shows the field of a display, with the mouse as its joystick.

What is modeled: the joystick unit. The mouse moves the cursors that its device drives; the left button is
ENTER, the right one is TRACK while it is down. What is **not**: how a joystick feels.

The window shows fields: programs draw words in the frame buffer, and cursors. Keys, the mouse, dropped files
and ticks are passed as plain values to the program that uses the display. After an input that changed the
field, the field is shown before the next input is handled, so that input never outruns the picture.

A program that draws its own pages handles F1, F4 and F12 itself. If the picture belongs to a host, the
monitor shows pages over the field; see `overlay`. A window may also show a page of a program, such as an
inspector with the field in it; then the program decides which places of the mouse are the joystick's.

F3 records the fields that are shown, with their times, as a film; see `ramtek_emu.films.TimedFilm`. Meanwhile
a red mark, which the film does not have, stands at the lower right. Closing the window saves the film, too.
"""

from __future__ import annotations

import os
import tempfile
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Final

from ramtek_emu.command_line import report
from ramtek_emu.display import Ramtek9300
from ramtek_emu.errors import RamtekError
from ramtek_emu.monitor.glass import FieldSource as FieldSource
from ramtek_emu.monitor.glass import Glass
from ramtek_emu.monitor.glass import open_screen as open_screen
from ramtek_emu.monitor.input_queue import Close, Input, InputQueue, Release
from ramtek_emu.monitor.input_queue import Key as Key
from ramtek_emu.monitor.input_queue import Pointer as Pointer
from ramtek_emu.monitor.overlay import PAGES, Overlay
from ramtek_emu.video.scan_out import turned
from ramtek_emu.writing import PNG, write_numbered

if TYPE_CHECKING:
    from ramtek_emu.films import TimedFilm

TICK_MILLISECONDS: Final = 15
BLINK_SECONDS: Final = 0.5
"""How long a blinking cursor is shown, and how long it is hidden. Assumed: as in `Timing`."""
LEFT: Final = 1
RIGHT: Final = 3
"""Numbers of the mouse's buttons."""
MODIFIERS: Final = frozenset(
    f"{side} {key}" for side in ("left", "right") for key in ("shift", "ctrl", "alt", "meta")
)


class Monitor:
    """A window that shows a display. `run` keeps it open; programs with a loop of their own call `step`."""

    def __init__(
        self,
        display: Ramtek9300,
        caption: str = "RAMTEK 9300",
        *,
        source: FieldSource | None = None,
        fit: bool | None = False,
        full_screen: bool = False,
        screenshots: str | os.PathLike[str] = ".",
        on_key: Callable[[Key], object] | None = None,
        on_release: Callable[[str], object] | None = None,
        on_pointer: Callable[[Pointer], object] | None = None,
        on_drop: Callable[[Path], object] | None = None,
        on_tick: Callable[[], object] | None = None,
        on_close: Callable[[], bool] | None = None,
        on_message: Callable[[str], object] | None = None,
    ) -> None:
        """Prepare a window; `open` opens it. Screenshots and films are saved in the folder `screenshots`.

        With `fit`, the field fills the window; with None, if the screen has no room for twice its size.
        `source` is shown instead of the display's field. The mouse then moves no joystick: `on_pointer` gets
        places of the source's field, and may call `steer` with places of the display's.
        `on_key` returns whether it handled the key; if it did not, F1 and F4 show a page over the field, Esc
        closes that page, and F12 saves the field. In full screen, Esc first leaves full screen. `on_release`
        gets the name of a released key after its press was handled, also when another window gets the
        keyboard; modifiers are left out. `on_close` returns whether the window may close. `on_message` gets
        messages for the user, such as the path of a screenshot; without it they are shown in the caption, or
        in full screen over the field.
        """
        self._display = display
        self._source = source
        self.full_screen = full_screen
        self.screenshots = Path(screenshots)
        self.file_name = "ramtek"
        """The beginning of the names of screenshots and films; a number follows."""
        self.on_key = on_key
        self.on_release = on_release
        self.on_pointer = on_pointer
        self.on_drop = on_drop
        self.on_tick = on_tick
        self.on_close = on_close
        self.on_message = on_message
        self.input = InputQueue()
        self.overlay = Overlay()
        """The page and the message over the field."""
        self._film: TimedFilm | None = None
        """The film that is recorded."""
        self.refreshed = 0
        """The number of times that the field was shown; it never decreases."""
        self._caption = caption
        self.glass = Glass((self.source.elements, self.source.lines), fit)
        """The window's pixels, its clipboard, and whether the field fills it."""
        self._shown: tuple[object, ...] | None = None

    @property
    def display(self) -> Ramtek9300:
        """The display that is shown.

        A display that takes its place gets the joystick's position; it must have as many lines and elements.
        """
        return self._display

    @display.setter
    def display(self, display: Ramtek9300) -> None:
        display.joystick.move_to(*self._display.joystick.position)
        display.scan_out.shown_table = self._display.scan_out.shown_table
        self._display = display
        self.glass.forget_shown()

    @property
    def source(self) -> FieldSource:
        """What makes the fields that the window shows: the display's scan-out, or a page of a program."""
        return self._display.scan_out if self._source is None else self._source

    @property
    def is_open(self) -> bool:
        """Whether the window is open."""
        return self.glass.is_open

    @property
    def is_at_rest(self) -> bool:
        """Whether no input waits, and no key and no button of the mouse is down."""
        return not self.input and not self.input.down - MODIFIERS

    @property
    def caption(self) -> str:
        """The text of the window's title bar."""
        return self._caption

    @caption.setter
    def caption(self, text: str) -> None:
        self._caption = text
        self._set_title()

    def _set_title(self, message: str = "") -> None:
        """Show the caption, whether a film is recorded, and a message in the title bar."""
        recording = "recording" if self._film is not None else ""
        self.glass.set_title(" - ".join(part for part in (self._caption, recording, message) if part))

    def open(self) -> None:
        """Open the window; NoScreenError if there is no screen."""
        self.glass.open(self.full_screen)
        self._set_title()

    def close(self) -> None:
        """Close the window without asking. A film is saved, and a message on stderr has its path."""
        self.glass.close()
        if self._film is not None:
            report(self._end_film(self._film))

    def _to_be_shown(self) -> tuple[object, ...]:
        return self.source.stamp, self.glass.stamp, self.overlay.stamp

    def show_message(self, message: str) -> None:
        """Show a message in the title bar of the window, or over the field in full screen."""
        self.overlay.message = message if self.full_screen else ""
        self._set_title(message)

    def run(self, is_busy: Callable[[], bool] = lambda: False) -> None:
        """Keep the window open until it is closed; open it first if it is not.

        While `is_busy()` is true, ticks follow each other without waiting for input.
        """
        if not self.is_open:
            self.open()
        try:
            while self.is_open:
                self.step(0 if is_busy() else TICK_MILLISECONDS)
        finally:
            self.close()

    def step(self, wait: int = 0) -> bool:
        """Handle input, waiting up to `wait` milliseconds for some, and show the field if it changed.

        After an input that changes the field, further inputs wait until the field was shown. Returns whether
        the window is still open.
        """
        self.glass.collect(self.input, 0 if self.input else wait)
        before = self._to_be_shown() if self.is_open else ()
        while self.is_open and self.input and self._to_be_shown() == before:
            self.handle(self.input.take())
        if self.is_open and self.on_tick is not None:
            self.on_tick()
        self.source.blink_is_on = int(time.monotonic() / BLINK_SECONDS) % 2 == 0
        if self.is_open and self._shown != self._to_be_shown():
            self.refresh()
        return self.is_open

    def refresh(self) -> None:
        """Show the current field."""
        self._shown = self._to_be_shown()
        self.refreshed += 1
        # Hide the mouse pointer while a cursor of the display follows the mouse.
        driven = self.display.joystick.driven if self._source is None else ()
        hides_mouse = any(cursor.is_visible for cursor in driven)
        table = self.display.scan_out.table()
        draw_over = partial(self.overlay.draw, colors=table, title=self._caption)
        self.glass.show(self.source, draw_over if any(self.overlay.stamp) else None, hides_mouse)
        if self._film is not None:
            self._film.show(self.source.field(), time.monotonic())
            if self._film.is_full:
                self.tell(f"the film is full: {self._end_film(self._film)}")

    def toggle_full_screen(self) -> None:
        """Switch to full screen, or back to a window of the previous size."""
        self.full_screen = not self.full_screen
        self.glass.set_full_screen(self.full_screen)

    def toggle_fit(self) -> None:
        """Let the field fill the window, or show it at the largest whole multiple again."""
        self.glass.fit = not self.glass.fit
        self.tell("the picture fills the window" if self.glass.fit else "the picture at a whole multiple")

    def screenshot(self) -> None:
        """Save the field under the next free number, without a message on it, and show its path."""
        from ramtek_emu.png import png_bytes

        self.tell("")
        field = png_bytes(self.source.field())
        try:
            self.tell(f"saved {write_numbered(field, self.screenshots, self.file_name, PNG)}")
        except RamtekError as refusal:
            self.tell(str(refusal))

    def toggle_recording(self) -> None:
        """Begin a film with the field that is shown; or end it, save it, and show its path."""
        if self._film is not None:
            self.tell(self._end_film(self._film))
            return
        from ramtek_emu.films import TimedFilm

        self._film = TimedFilm(self.source.field(), time.monotonic())
        self.overlay.is_recording = True
        # A program that gets messages would draw this message into the film.
        self.show_message("F3 ends it")

    def _end_film(self, film: TimedFilm) -> str:
        """End and save the film under the next free number; returns a sentence with its path.

        A film that cannot be saved in the folder of screenshots goes to the folder of temporary files.
        """
        from ramtek_emu.films import FILM

        self._film, self.overlay.is_recording = None, False
        fields, data, reason = film.fields, film.end(time.monotonic()), ""
        for folder in (self.screenshots, None):
            try:
                path = write_numbered(data, folder or Path(tempfile.gettempdir()), self.file_name, FILM)
            except OSError as refusal:
                reason = reason or f"{refusal}; "
                continue
            return f"{reason}saved {path}, {fields:,} {'field' if fields == 1 else 'fields'}"
        return f"{reason}the film is lost: no folder could take it"

    def tell(self, message: str) -> None:
        """Show a message to the user; "" removes the last message."""
        if self.on_message is not None:
            self.on_message(message)
        else:
            self.show_message(message)

    def ask_to_close(self) -> None:
        """Close the window, unless `on_close` returns False."""
        if self.on_close is None or self.on_close():
            self.close()

    def handle(self, user_input: Input) -> None:
        """Handle one input."""
        if isinstance(user_input, Key):
            self.handle_key(user_input)
        elif isinstance(user_input, Pointer):
            self.handle_pointer(user_input)
        elif isinstance(user_input, Release):
            if self.on_release is not None and user_input.name not in MODIFIERS:
                self.on_release(user_input.name)
        elif isinstance(user_input, Close):
            self.ask_to_close()
        elif self.on_drop is not None:
            self.on_drop(user_input)

    def handle_key(self, key: Key) -> None:
        """Handle a key: first the shortcuts of the window, then `on_key`, then the pages and Esc.

        Esc leaves full screen before anything else, and never closes the window. Shortcuts do not repeat
        while their key stays down.
        """
        shortcuts: dict[str, Callable[[], object]] = {
            "f3": self.toggle_recording,
            "f10": self.toggle_fit,
            "f11": self.toggle_full_screen,
        }
        # A program may take a second request to close in a row for consent to lose changes.
        shortcuts |= {"return": self.toggle_full_screen} if key.alt else {}
        shortcuts |= {"escape": self.toggle_full_screen} if self.full_screen else {}
        shortcuts |= {"q": self.ask_to_close} if key.control else {}
        pages: dict[str, Callable[[], object]] = {"f12": self.screenshot}
        pages |= {name: partial(self.overlay.turn_to, page) for name, page in PAGES.items()}
        pages |= {"f2": lambda: self.tell(turned(self.display.scan_out))} if self.on_key is None else {}
        if key.name in MODIFIERS:
            return
        if key.name not in shortcuts and self.on_key is not None and self.on_key(key):
            return
        if key.name == "escape" and not self.full_screen:
            self.overlay.page = ""
        elif not key.repeated and (run := (shortcuts | pages).get(key.name)):
            run()

    def handle_pointer(self, pointer: Pointer) -> None:
        """Move the joystick and set its switches, unless a program's page is shown; call `on_pointer`."""
        if self._source is None:
            self.steer(pointer)
        if self.on_pointer is not None:
            self.on_pointer(pointer)

    def steer(self, pointer: Pointer) -> None:
        """Move the joystick to a place of the display's field, and set its switches by the buttons."""
        joystick = self.display.joystick
        joystick.move_to(pointer.element, pointer.line)
        if pointer.button == LEFT and pointer.action == "press":
            joystick.press_enter()
        elif pointer.button == RIGHT:
            joystick.track = pointer.action == "press"
