"""Console: keys and mouse of a window, passed as plain values to the program that uses the display.

What is modeled: the joystick unit. The mouse moves the cursors that its device drives; the left button is
ENTER, the right one is TRACK while it is down. What is **not**: how a joystick feels.

This module does not depend on the library that makes the window.
"""

from __future__ import annotations

import os
from abc import ABC, abstractmethod
from collections.abc import Callable
from pathlib import Path
from typing import Final, NamedTuple

from ramtek_emu.display import Ramtek9300
from ramtek_emu.errors import OutputExistsError, RamtekError

LEFT: Final = 1
RIGHT: Final = 3
"""Numbers of the mouse's buttons."""
MODIFIERS: Final = frozenset(
    f"{side} {key}" for side in ("left", "right") for key in ("shift", "ctrl", "alt", "meta")
)


class Key(NamedTuple):
    """A key that was pressed: its name ("a", "f1", "return", "escape", ...), its text, the modifiers held."""

    name: str
    text: str = ""
    control: bool = False
    shift: bool = False
    alt: bool = False
    repeated: bool = False
    """Whether the key was down already and the event is a repeat."""


class Pointer(NamedTuple):
    """The mouse over the field, in elements and lines of the display; `enter`: the left button is down."""

    element: int
    line: int
    enter: bool
    action: str
    """"move", "press", "release", "wheel up" or "wheel down"."""
    button: int = 0
    """0: none, 1: left, 2: middle, 3: right."""


class Console(ABC):
    """The keys, the mouse, the shortcuts and the messages of one window."""

    def __init__(
        self,
        display: Ramtek9300,
        *,
        screenshots: str | os.PathLike[str] = ".",
        screenshot_name: str = "ramtek",
        on_key: Callable[[Key], object] | None = None,
        on_pointer: Callable[[Pointer], object] | None = None,
        on_close: Callable[[], bool] | None = None,
        on_message: Callable[[str], object] | None = None,
    ) -> None:
        self.display = display
        self.full_screen = False
        self.screenshots = Path(screenshots)
        self.screenshot_name = screenshot_name
        self.on_key = on_key
        self.on_pointer = on_pointer
        self.on_close = on_close
        self.on_message = on_message
        self._enter = False

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
        """Show a message to the user."""
        if self.on_message is not None:
            self.on_message(message)
        else:
            self.show_message(message)

    def ask_to_close(self) -> None:
        """Close the window, unless `on_close` returns False."""
        if self.on_close is None or self.on_close():
            self.close()

    def handle_key(self, key: Key) -> None:
        """Handle a key: first the shortcuts of the window, then `on_key`, then Esc."""
        if key.name in MODIFIERS:
            return
        if key.name == "f11" or (key.name == "return" and key.alt):
            self.toggle_full_screen()
        elif key.name == "f12":
            try:
                self.tell(f"saved {self.screenshot()}")
            except RamtekError as refusal:
                self.tell(str(refusal))
        elif key.name == "q" and key.control:
            self.ask_to_close()
        elif self.on_key is not None and self.on_key(key):
            return
        elif key.name == "escape":
            if self.full_screen:
                self.toggle_full_screen()
            else:
                self.ask_to_close()

    def handle_pointer(self, element: int, line: int, action: str, button: int = 0) -> None:
        """Move the joystick, set its switches, and call `on_pointer`."""
        joystick = self.display.joystick
        joystick.move_to(element, line)
        if button == LEFT:
            self._enter = action == "press"
            if self._enter:
                joystick.press_enter()
        elif button == RIGHT:
            joystick.track = action == "press"
        if self.on_pointer is not None:
            self.on_pointer(Pointer(element, line, self._enter, action, button))
