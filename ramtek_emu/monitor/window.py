"""Monitor: shows the field of a display in a window. The only module that uses pygame.

What is modeled: the field at the largest whole multiple that fits, centered, each pixel a k x k block; the
mouse as the joystick of the display. What is **not**: the phosphor, the beam.

The window shows fields: what programs draw is words in the frame buffer, and cursors. Keys, the mouse,
dropped files and ticks are passed as plain values to the program that uses the display. A field is shown
after every input that changed it, before the next input is handled, so that input never outruns the picture.
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
from ramtek_emu.monitor.input_queue import Close
from ramtek_emu.monitor.input_queue import Key as Key
from ramtek_emu.monitor.input_queue import Pointer as Pointer
from ramtek_emu.monitor.placement import pixel_under
from ramtek_emu.monitor.placement import placement as placement
from ramtek_emu.video.scan_out import Stamp

TICK_MILLISECONDS: Final = 15
BLINK_SECONDS: Final = 0.5
"""How long a blinking cursor is shown, and then hidden. Assumed: as in the time model."""
KEY_DELAY: Final = 400
KEY_INTERVAL: Final = 33
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

        `on_key` returns whether it handled the key; if it did not, F1 and F4 show a page over the field, and
        Esc leaves that page or else closes the window. In full screen, Esc leaves that first. `on_close`
        returns whether the window may close. `on_message` takes messages for the user, such as the path of a
        screenshot; without it they are shown in the caption, and in full screen over the field.
        """
        super().__init__(
            display,
            screenshots=screenshots,
            screenshot_name=screenshot_name,
            on_key=on_key,
            on_pointer=on_pointer,
            on_drop=on_drop,
            on_close=on_close,
            on_message=on_message,
        )
        self.fit = fit
        self.full_screen = full_screen
        self.on_tick = on_tick
        self.refreshed = 0
        """How often the field was shown; it never decreases."""
        self._caption = caption
        self._size = (display.scan_out.elements, display.scan_out.lines)
        self._window_size = self._size
        self._open = False
        self._shown: tuple[object, ...] | None = None

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
        place = pygame.display.get_window_size(), self.fit
        return self.display.scan_out.stamp, place, self.overlay.stamp

    def show_message(self, message: str) -> None:
        """Show a message in the title bar of the window, or over the field where there is none."""
        self.overlay.message = message if self.full_screen else ""
        if self._open:
            pygame.display.set_caption(" - ".join(part for part in (self._caption, message) if part))

    def run(self) -> None:
        """Open the window and keep it open until it is closed."""
        self.open()
        try:
            while self._open:
                self.step(TICK_MILLISECONDS)
        finally:
            self.close()

    def step(self, wait: int = 0) -> bool:
        """Handle input, waiting up to `wait` milliseconds for some, and show the field if it changed.

        At most one input that changes the field is handled; the others wait until it was shown. Returns
        whether the window is still open.
        """
        if wait and not self.input:
            self._note(pygame.event.wait(wait))
        for event in pygame.event.get():
            self._note(event)
        before = self._to_be_shown() if self._open else ()
        while self._open and self.input and self._to_be_shown() == before:
            self.handle(self.input.take())
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
        # The surface is locked while the array exists, that is until the end of this method.
        pixels = np.asarray(surface.get_view("2")).T
        stamp = self.display.scan_out.scan_out_changes_into(pixels, held)
        has_overlay = any(self.overlay.stamp)
        if has_overlay:
            self.overlay.draw(pixels, self.display.scan_out.table(), self._caption)
        self._held = None if has_overlay else (surface, stamp)

    def _note(self, event: pygame.event.Event) -> None:
        """Let the input of an event wait, or note what it tells of the window."""
        if event.type in REDRAWN_ON:
            self._shown = self._held = None
        elif event.type == pygame.QUIT:
            self.input.add(Close())
        elif event.type == pygame.KEYDOWN:
            control, alt = event.mod & (pygame.KMOD_CTRL | pygame.KMOD_META), event.mod & pygame.KMOD_ALT
            name, shift = pygame.key.name(event.key), event.mod & pygame.KMOD_SHIFT
            self.input.add(Key(name, event.unicode, bool(control), bool(shift), bool(alt)))
        elif event.type == pygame.KEYUP:
            self.input.release(pygame.key.name(event.key))
        elif event.type == pygame.WINDOWFOCUSLOST:
            self.input.release_everything()
        elif event.type == pygame.DROPFILE:
            self.input.add(Path(event.file))
        elif event.type == pygame.MOUSEMOTION:
            self.input.add(Pointer(*self._pixel_under(event.pos), False, "move"))
        elif event.type in (pygame.MOUSEBUTTONDOWN, pygame.MOUSEBUTTONUP) and event.button <= 3:
            action = "press" if event.type == pygame.MOUSEBUTTONDOWN else "release"
            self.input.add(Pointer(*self._pixel_under(event.pos), False, action, event.button))
        elif event.type == pygame.MOUSEWHEEL and event.y:
            action = "wheel up" if event.y > 0 else "wheel down"
            place = self._pixel_under(pygame.mouse.get_pos())
            self.input.add(Pointer(*place, False, action, steps=abs(event.y)))

    def _pixel_under(self, place: tuple[int, int]) -> tuple[int, int]:
        return pixel_under(place, self._size, pygame.display.get_window_size(), self.fit)
