"""Monitor: shows the field of a display in a window. The only module that uses pygame.

What is modeled: the field at the largest whole multiple that fits, centered, each pixel a k x k block; the
mouse as the joystick of the display. What is **not**: the phosphor, the beam.

The window shows fields and draws nothing itself: everything visible is words in the frame buffer, and
cursors. Keys, the mouse, dropped files and ticks are passed as plain values to the program that uses the
display.
"""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Final

import numpy as np

# Set before pygame is imported: its greeting would mix with data on stdout, and Windows enlarges and blurs
# the windows of a process that does not declare itself aware of the screen's resolution.
os.environ["PYGAME_HIDE_SUPPORT_PROMPT"] = "1"
os.environ["SDL_WINDOWS_DPI_AWARENESS"] = os.environ.get("SDL_WINDOWS_DPI_AWARENESS", "permonitorv2")
import pygame

from ramtek_emu.display import Ramtek9300
from ramtek_emu.errors import NoScreenError
from ramtek_emu.monitor.console import Console
from ramtek_emu.monitor.console import Key as Key
from ramtek_emu.monitor.console import Pointer as Pointer
from ramtek_emu.monitor.placement import pixel_under
from ramtek_emu.monitor.placement import placement as placement
from ramtek_emu.video.scan_out import Stamp

TICK_MILLISECONDS: Final = 15
BLINK_SECONDS: Final = 0.5
"""How long a blinking cursor is shown, and then hidden. Assumed: as in the time model."""
KEY_DELAY: Final = 400
KEY_INTERVAL: Final = 40
"""Milliseconds until a key that is held down repeats, and between its repeats."""
FIELD_MASKS: Final = (0xFF0000, 0x00FF00, 0x0000FF, 0)
REDRAWN_ON: Final = frozenset(
    (pygame.WINDOWEXPOSED, pygame.WINDOWSIZECHANGED, pygame.WINDOWRESTORED, pygame.WINDOWSHOWN)
)


def open_screen() -> None:
    """Start the video system; NoScreenError if there is no screen, or only a dummy that nobody asked for."""
    asked = os.environ.get("SDL_VIDEODRIVER", "")
    advice = "run it on a desktop, or ask for a picture file instead"
    served_by_x = sys.platform.startswith(("linux", "freebsd", "openbsd", "netbsd"))
    if served_by_x and not (asked or os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")):
        raise NoScreenError(
            f"a window must have a screen, and neither DISPLAY nor WAYLAND_DISPLAY names one; {advice}"
        )
    try:
        pygame.display.init()
    except pygame.error as cause:
        raise NoScreenError(
            f"a window must have a screen, and none could be opened ({cause}); {advice}"
        ) from cause
    driver = pygame.display.get_driver()
    if driver in ("offscreen", "dummy") and driver not in asked.split(","):
        pygame.display.quit()
        raise NoScreenError(
            f"a window must have a screen, and that of DISPLAY or WAYLAND_DISPLAY does not answer; {advice}"
        )


class Monitor(Console):
    """A window that shows a display. `run` keeps it open; programs with a loop of their own call `step`."""

    def __init__(
        self,
        display: Ramtek9300,
        caption: str = "RAMTEK 9300",
        *,
        fit: bool = False,
        full_screen: bool = False,
        screenshots: str | os.PathLike[str] = ".",
        screenshot_name: str = "ramtek",
        on_key: Callable[[Key], object] | None = None,
        on_pointer: Callable[[Pointer], object] | None = None,
        on_drop: Callable[[Path], object] | None = None,
        on_tick: Callable[[], object] | None = None,
        on_close: Callable[[], bool] | None = None,
        on_message: Callable[[str], object] | None = None,
    ) -> None:
        """Prepare a window; `open` opens it.

        `on_key` returns whether it handled the key; Esc, if not handled, leaves full screen or else closes
        the window. `on_close` returns whether the window may close. `on_message` takes messages for the user,
        such as the path of a screenshot; without it they are shown in the caption.
        """
        super().__init__(
            display,
            screenshots=screenshots,
            screenshot_name=screenshot_name,
            on_key=on_key,
            on_pointer=on_pointer,
            on_close=on_close,
            on_message=on_message,
        )
        self.fit = fit
        self.full_screen = full_screen
        self.on_drop = on_drop
        self.on_tick = on_tick
        self.refreshed = 0
        """How often the field was shown; it never decreases."""
        self._caption = caption
        self._size = (display.scan_out.elements, display.scan_out.lines)
        self._window_size = self._size
        self._open = False
        self._shown: tuple[object, ...] | None = None
        self._down: set[int] = set()

    @property
    def is_open(self) -> bool:
        """Whether the window is open."""
        return self._open

    @property
    def caption(self) -> str:
        """The text of the window's title bar."""
        return self._caption

    @caption.setter
    def caption(self, text: str) -> None:
        self._caption = text
        if self._open:
            pygame.display.set_caption(text)

    def open(self) -> None:
        """Open the window; NoScreenError if there is no screen."""
        open_screen()
        desktop = pygame.display.get_desktop_sizes()[0]
        room = int(desktop[0] * 0.95), int(desktop[1] * 0.9)
        self._window_size = placement(self._size, room)[2:]
        self._field = pygame.Surface(self._size, 0, 32, FIELD_MASKS)
        self._held: tuple[pygame.Surface, Stamp] | None = None
        """The surface that was scanned out to last, and the stamp of the field that it holds."""
        self._open = True
        pygame.display.set_caption(self._caption)
        pygame.key.set_repeat(KEY_DELAY, KEY_INTERVAL)
        self._set_mode()

    def close(self) -> None:
        """Close the window without asking."""
        if self._open:
            self._open = False
            pygame.display.quit()

    def _to_be_shown(self) -> tuple[object, ...]:
        return self.display.scan_out.stamp, pygame.display.get_window_size(), self.fit

    def show_message(self, message: str) -> None:
        """Show a message in the title bar of the window."""
        if self._open:
            pygame.display.set_caption(f"{self._caption} - {message}")

    def run(self) -> None:
        """Open the window and keep it open until it is closed."""
        self.open()
        try:
            while self._open:
                self.step(TICK_MILLISECONDS)
        finally:
            self.close()

    def step(self, wait: int = 0) -> bool:
        """Handle events, waiting up to `wait` milliseconds for one, and show the field if it changed.

        Returns whether the window is still open.
        """
        event = pygame.event.wait(wait) if wait else pygame.event.poll()
        while event.type != pygame.NOEVENT and self._open:
            self._handle(event)
            event = pygame.event.poll() if self._open else event
        if self._open and self.on_tick is not None:
            self.on_tick()
        self.display.scan_out.blink_is_on = int(time.monotonic() / BLINK_SECONDS) % 2 == 0
        if self._open and self._shown != self._to_be_shown():
            self.refresh()
        return self._open

    def refresh(self) -> None:
        """Show the current field."""
        screen = pygame.display.get_surface()
        self._shown = self._to_be_shown()
        self.refreshed += 1
        # Hide the mouse pointer while a cursor of the display follows the mouse.
        pygame.mouse.set_visible(not any(cursor.is_visible for cursor in self.display.joystick.driven))
        place = placement(self._size, screen.get_size(), self.fit)
        if screen.get_size() == self._size and screen.get_masks() == FIELD_MASKS:
            self._scan_out(screen)
        else:
            self._scan_out(self._field)
            screen.fill((0, 0, 0))
            if place[2:] == self._size:
                screen.blit(self._field, place[:2])
            else:
                enlarge = pygame.transform.smoothscale if self.fit else pygame.transform.scale
                screen.blit(enlarge(self._field, place[2:]), place[:2])
        pygame.display.flip()

    def toggle_full_screen(self) -> None:
        """Switch to full screen, or back to a window of the previous size."""
        if not self.full_screen:
            self._window_size = pygame.display.get_window_size()
        self.full_screen = not self.full_screen
        self._set_mode()

    def _set_mode(self) -> None:
        try:
            if self.full_screen:
                pygame.display.set_mode((0, 0), pygame.FULLSCREEN)
            else:
                pygame.display.set_mode(self._window_size, pygame.RESIZABLE)
        except pygame.error as cause:
            self.close()
            raise NoScreenError(
                f"a window must have a screen that takes it, not this one ({cause}); "
                "ask for a picture file instead"
            ) from cause
        self._shown = self._held = None

    def _scan_out(self, surface: pygame.Surface) -> None:
        held = self._held[1] if self._held is not None and self._held[0] is surface else None
        # The surface is locked while the array exists, that is until the end of this statement.
        stamp = self.display.scan_out.scan_out_changes_into(np.asarray(surface.get_view("2")).T, held)
        self._held = surface, stamp

    def _handle(self, event: pygame.event.Event) -> None:
        if event.type in REDRAWN_ON:
            self._shown = self._held = None
        elif event.type == pygame.QUIT:
            self.ask_to_close()
        elif event.type == pygame.KEYDOWN:
            self.handle_key(
                Key(
                    pygame.key.name(event.key),
                    event.unicode,
                    bool(event.mod & (pygame.KMOD_CTRL | pygame.KMOD_META)),
                    bool(event.mod & pygame.KMOD_SHIFT),
                    bool(event.mod & pygame.KMOD_ALT),
                    event.key in self._down,
                )
            )
            self._down.add(event.key)
        elif event.type == pygame.KEYUP:
            self._down.discard(event.key)
        elif event.type == pygame.DROPFILE:
            if self.on_drop is not None:
                self.on_drop(Path(event.file))
        elif event.type == pygame.MOUSEMOTION:
            self._handle_pointer(event.pos, "move")
        elif event.type in (pygame.MOUSEBUTTONDOWN, pygame.MOUSEBUTTONUP) and event.button <= 3:
            pressed = event.type == pygame.MOUSEBUTTONDOWN
            self._handle_pointer(event.pos, "press" if pressed else "release", event.button)
        elif event.type == pygame.MOUSEWHEEL and event.y:
            self._handle_pointer(pygame.mouse.get_pos(), "wheel up" if event.y > 0 else "wheel down")

    def _handle_pointer(self, place: tuple[int, int], action: str, button: int = 0) -> None:
        pixel = pixel_under(place, self._size, pygame.display.get_window_size(), self.fit)
        self.handle_pointer(*pixel, action, button)
