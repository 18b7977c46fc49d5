"""Console: keys and mouse of a window, passed as plain values to the program that uses the display.

What is modeled: the joystick unit. The mouse moves the cursors that its device drives; the left button is
ENTER, the right one is TRACK while it is down. What is **not**: how a joystick feels.

A program that draws its own pages takes F1 and F4 itself. For the others, whose picture is a host's, the
monitor shows them over the field; see `overlay`.

This module does not depend on the library that makes the window.
"""

from __future__ import annotations

import os
from abc import ABC, abstractmethod
from collections.abc import Callable
from pathlib import Path
from typing import Final

from ramtek_emu.display import Ramtek9300
from ramtek_emu.errors import OutputExistsError, RamtekError
from ramtek_emu.monitor.input_queue import Close, Input, InputQueue, Key, Pointer, Release
from ramtek_emu.monitor.overlay import PAGES, Overlay

LEFT: Final = 1
RIGHT: Final = 3
"""Numbers of the mouse's buttons."""
MODIFIERS: Final = frozenset(
    f"{side} {key}" for side in ("left", "right") for key in ("shift", "ctrl", "alt", "meta")
)


class Console(ABC):
    """The keys, the mouse, the shortcuts and the messages of one window."""

    def __init__(
        self,
        display: Ramtek9300,
        *,
        screenshots: str | os.PathLike[str] = ".",
        screenshot_name: str = "ramtek",
        on_key: Callable[[Key], object] | None = None,
        on_release: Callable[[str], object] | None = None,
        on_pointer: Callable[[Pointer], object] | None = None,
        on_drop: Callable[[Path], object] | None = None,
        on_close: Callable[[], bool] | None = None,
        on_message: Callable[[str], object] | None = None,
    ) -> None:
        self.display = display
        self.full_screen = False
        self.overlay = Overlay()
        """The page and the message over the field."""
        self.screenshots = Path(screenshots)
        self.screenshot_name = screenshot_name
        self.on_key = on_key
        self.on_release = on_release
        self.on_pointer = on_pointer
        self.on_drop = on_drop
        self.on_close = on_close
        self.on_message = on_message
        self._enter = False
        self.input = InputQueue()

    @property
    def is_at_rest(self) -> bool:
        """Whether no input waits, and no key and no button of the mouse is down."""
        return not self.input and not self.input.down - MODIFIERS

    @abstractmethod
    def close(self) -> None:
        """Close the window without asking."""

    @abstractmethod
    def toggle_full_screen(self) -> None:
        """Switch to full screen, or back to a window of the previous size."""

    @abstractmethod
    def show_message(self, message: str) -> None:
        """Show a message for which there is no `on_message`."""

    def screenshot(self) -> Path:
        """Save the field under the next free number, never over a file; OutputError or WriteError."""
        from ramtek_emu.png import save_png

        number = 1
        while True:
            path = self.screenshots / f"{self.screenshot_name}-{number:04d}.png"
            number += 1
            if path.exists():
                continue
            try:
                save_png(self.display.field(), path, overwrite=False)
            except OutputExistsError:
                continue
            return path.resolve()

    def tell(self, message: str) -> None:
        """Show a message to the user; an empty one takes the last one away."""
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
            self.handle_release(user_input)
        elif isinstance(user_input, Close):
            self.ask_to_close()
        elif self.on_drop is not None:
            self.on_drop(user_input)

    def handle_key(self, key: Key) -> None:
        """Handle a key: first the shortcuts of the window, then `on_key`, then the pages and Esc.

        Esc leaves full screen before anything else. Shortcuts do not repeat while their key is held down.
        """
        if key.name in MODIFIERS:
            return
        if key.name == "f11" or (key.name == "return" and key.alt):
            if not key.repeated:
                self.toggle_full_screen()
        elif key.name == "escape" and self.full_screen:
            self.toggle_full_screen()
        elif key.name == "f12":
            if not key.repeated:
                self._tell_of_screenshot()
        elif key.name == "q" and key.control:
            # Asked twice in a row, a program may take it for consent to lose changes.
            if not key.repeated:
                self.ask_to_close()
        elif self.on_key is not None and self.on_key(key):
            return
        elif key.name in PAGES:
            if not key.repeated:
                self.overlay.turn_to(PAGES[key.name])
        elif key.name == "escape" and not key.repeated:
            if self.overlay.page:
                self.overlay.page = ""
            else:
                self.ask_to_close()

    def handle_release(self, release: Release) -> None:
        """Call `on_release` with the name of the key, unless it is a modifier."""
        if self.on_release is not None and release.name not in MODIFIERS:
            self.on_release(release.name)

    def _tell_of_screenshot(self) -> None:
        """Take a screenshot, without a message on it, and tell the path."""
        self.tell("")
        try:
            self.tell(f"saved {self.screenshot()}")
        except RamtekError as refusal:
            self.tell(str(refusal))

    def handle_pointer(self, pointer: Pointer) -> None:
        """Move the joystick, set its switches, and call `on_pointer`."""
        joystick = self.display.joystick
        joystick.move_to(pointer.element, pointer.line)
        if pointer.button == LEFT:
            self._enter = pointer.action == "press"
            if self._enter:
                joystick.press_enter()
        elif pointer.button == RIGHT:
            joystick.track = pointer.action == "press"
        if self.on_pointer is not None:
            self.on_pointer(pointer._replace(enter=self._enter))
