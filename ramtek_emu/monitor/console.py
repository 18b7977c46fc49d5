"""Console: what a user does at a window, as plain values for whoever drives the display.

What is modeled: the joystick unit. The mouse moves the cursors that its device drives, the left button is
ENTER, the right one TRACK while it is down. What is **not**: the joystick's feel.

Nothing here knows how the window is made.
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
    """A key that went down: its name ("a", "f1", "return", "escape", ...), what it types, what was held."""

    name: str
    text: str = ""
    control: bool = False
    shift: bool = False
    alt: bool = False
    repeated: bool = False
    """Whether it was down already: what a key does while it is held can be one step."""


class Pointer(NamedTuple):
    """The mouse over the field, in elements and lines of the display; `enter` while its button is down."""

    element: int
    line: int
    enter: bool
    action: str
    """"move", "press", "release", "wheel up" or "wheel down"."""
    button: int = 0
    """0 none, 1 left, 2 middle, 3 right."""


class Console(ABC):
    """Keys and pointer, shortcuts and messages of one window."""

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
        """Fill the screen, or go back to a window of the size before."""

    @abstractmethod
    def show_message(self, message: str) -> None:
        """Show a sentence that nobody else takes."""

    def screenshot(self) -> Path:
        """Save the field under the next free number, never over a file; WriteError when it cannot be."""
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
        """Give a sentence to the user."""
        if self.on_message is not None:
            self.on_message(message)
        else:
            self.show_message(message)

    def ask_to_close(self) -> None:
        """Close the window if whoever drives it agrees."""
        if self.on_close is None or self.on_close():
            self.close()

    def handle_key(self, key: Key) -> None:
        """Do what a key asks for: the window's own shortcuts first, Esc last."""
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
        """Move the joystick, set its switches, and tell whoever drives the display."""
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
