"""Glass: the pixels of a window, and the input of its user. The only module that uses pygame.

What is modeled: the field at the largest whole multiple that fits, centered, each pixel a k x k block. A
window that is smaller than the field shows it whole, blurred. What is **not**: the phosphor, the beam.

The field is that of a `FieldSource`: the `ScanOut` of a display, or a page that a program draws.

Only lines that changed are enlarged and sent to the screen; an X server gets them directly.
"""

from __future__ import annotations

import os
import sys
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any, Final, Protocol

import numpy as np

# Set before pygame is imported: its greeting would mix with data on stdout, and Windows enlarges and blurs
# the windows of a process that does not declare itself aware of the screen's resolution.
os.environ["PYGAME_HIDE_SUPPORT_PROMPT"] = "1"
os.environ["SDL_WINDOWS_DPI_AWARENESS"] = os.environ.get("SDL_WINDOWS_DPI_AWARENESS", "permonitorv2")
import pygame

from ramtek_emu.arrays import Colors, PackedColors
from ramtek_emu.errors import NoScreenError, escaped
from ramtek_emu.monitor.boxes import PageBox
from ramtek_emu.monitor.input_queue import Close, InputQueue, Key, Pointer
from ramtek_emu.video.scan_out import Run

KEY_DELAY: Final = 400
KEY_INTERVAL: Final = 33
"""Milliseconds until the first repeat of a pressed key, and between the repeats."""
FIELD_MASKS: Final = (0xFF0000, 0x00FF00, 0x0000FF, 0)
REDRAWN_ON: Final = frozenset(
    (pygame.WINDOWEXPOSED, pygame.WINDOWSIZECHANGED, pygame.WINDOWRESTORED, pygame.WINDOWSHOWN)
)
CLIPBOARD_TEXT: Final = "text/plain;charset=utf-8"
"""The only type of text that pygame's clipboard takes."""
CONTROL: Final = pygame.KMOD_CTRL | pygame.KMOD_META


def open_screen() -> None:
    """Start the video system; NoScreenError if there is no screen, or an unasked-for dummy driver."""
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
    if driver == "x11":
        # SDL reads this when the window gets its surface. Otherwise OpenGL sends the whole window for a part.
        os.environ.setdefault("SDL_FRAMEBUFFER_ACCELERATION", "0")
    if driver in ("offscreen", "dummy") and driver not in asked.split(","):
        pygame.display.quit()
        raise NoScreenError(
            f"a window must have a screen, and DISPLAY or WAYLAND_DISPLAY does not answer; {advice}"
        )


class FieldSource(Protocol):
    """Makes the fields that a window shows, (lines, elements). Fields with equal stamps are equal."""

    lines: int
    elements: int
    blink_is_on: bool
    """Whether blinking cursors are shown; the window sets it."""

    @property
    def stamp(self) -> Any:
        """A value that changes whenever a pixel may have changed."""

    def scan_out_changes_into(self, pixels: PackedColors, last: Any) -> tuple[Any, tuple[Run, ...]]:
        """Bring pixels with the stamp `last` up to date; None for any pixels.

        Returns their new stamp, and the lines that have changed as runs from the top.
        """
        ...

    def field(self) -> Colors:
        """The field of a screenshot or a film, (lines, elements, 3) uint8."""
        ...


class Glass:
    """The window of a display, closed at first; `size` is the size of the field, (elements, lines).

    With `fit` None, the field fills the window if the screen has no room for twice its size.
    """

    def __init__(self, size: tuple[int, int], fit: bool | None = False) -> None:
        self.fit = bool(fit)
        """Whether the field fills the window, blurred, instead of being a whole multiple."""
        self.is_open = False
        self._fits_by_room = fit is None
        self._size = size
        self._window_size = size
        self._redrawn = 0
        """The number of times that the window lost the field."""
        self._shown: tuple[pygame.Surface, PageBox, Any] | None = None
        """The surface of the last field, its place in the window, and the stamp of that field."""

    @property
    def stamp(self) -> object:
        """A value that changes whenever the window must show the field again, even an unchanged field."""
        return pygame.display.get_window_size(), self.fit, self._redrawn

    def open(self, full_screen: bool) -> None:
        """Open the window; NoScreenError if there is no screen."""
        open_screen()
        desktop = pygame.display.get_desktop_sizes()[0]
        room = int(desktop[0] * 0.95), int(desktop[1] * 0.9)
        if self._fits_by_room:
            self.fit = viewport(self._size, room)[2] == self._size[0]
        self._window_size = viewport(self._size, room, self.fit)[2:]
        self._field = pygame.Surface(self._size, 0, 32, FIELD_MASKS)
        self.is_open = True
        pygame.key.set_repeat(KEY_DELAY, KEY_INTERVAL)
        self._set_mode(full_screen)

    def close(self) -> None:
        """Close the window if it is open."""
        if self.is_open:
            self.is_open = False
            # The clipboard of pygame opens the display once more.
            while pygame.display.get_init():
                pygame.display.quit()

    def set_title(self, title: str) -> None:
        """Change the text of the window's title bar; letters that cannot be printed are escaped."""
        if self.is_open:
            # Names of files may contain bytes that are not text; pygame refuses them.
            pygame.display.set_caption(escaped(title))

    def copy(self, text: str) -> bool:
        """Put a text into the clipboard; returns False if the screen has none, or the window is closed."""
        if not self.is_open:
            return False
        try:
            if hasattr(pygame.scrap, "put_text"):
                # pygame-ce has functions of its own, and warns of the others.
                pygame.scrap.put_text(text)
            else:
                pygame.scrap.init()
                pygame.scrap.put(CLIPBOARD_TEXT, text.encode())
        except (pygame.error, UnicodeError):
            # Names of files may contain bytes that are not text.
            return False
        return True

    def paste(self) -> str:
        """The text in the clipboard; empty if there is none, or the window is closed."""
        if not self.is_open:
            return ""
        try:
            if hasattr(pygame.scrap, "get_text"):
                return str(pygame.scrap.get_text())
            pygame.scrap.init()
            return (pygame.scrap.get(CLIPBOARD_TEXT) or b"").decode(errors="replace")
        except pygame.error:
            return ""

    def set_full_screen(self, full_screen: bool) -> None:
        """Fill the screen, or go back to a window of the previous size; NoScreenError if that fails."""
        if full_screen:
            self._window_size = pygame.display.get_window_size()
        else:
            # Without a window manager the first call only leaves full screen; the second sets the size.
            self._set_mode(full_screen)
        self._set_mode(full_screen)

    def _set_mode(self, full_screen: bool) -> None:
        try:
            if full_screen:
                pygame.display.set_mode((0, 0), pygame.FULLSCREEN)
            else:
                with warnings.catch_warnings():
                    # pygame-ce warns where the screen, or its window manager, chooses the size.
                    warnings.simplefilter("ignore", RuntimeWarning)
                    pygame.display.set_mode(self._window_size, pygame.RESIZABLE)
        except pygame.error as cause:
            self.close()
            raise NoScreenError(
                f"a window must have a screen, and this screen refuses it ({cause}); "
                "ask for a picture file instead"
            ) from cause
        self.forget_shown()

    def forget_shown(self) -> None:
        """Note that the window has lost the field, or has another field to show."""
        self._redrawn += 1
        self._shown = None

    def show(
        self, source: FieldSource, draw_over: Callable[[PackedColors], None] | None, hides_mouse: bool
    ) -> None:
        """Show the current field, with something drawn over it, and show or hide the pointer of the mouse."""
        pygame.mouse.set_visible(not hides_mouse)
        screen = pygame.display.get_surface()
        place = viewport(self._size, screen.get_size(), self.fit)
        is_direct = screen.get_size() == self._size and screen.get_masks() == FIELD_MASKS
        surface = screen if is_direct else self._field
        last = self._shown[2] if self._shown is not None and self._shown[:2] == (surface, place) else None
        # The surface is locked while the array exists.
        pixels = np.asarray(surface.get_view("2")).T
        stamp, changed = source.scan_out_changes_into(pixels, last)
        if draw_over is not None:
            draw_over(pixels)
        del pixels
        self._shown = (surface, place, stamp) if draw_over is None else None
        is_blurred = self._is_blurred(place)
        if last is None or draw_over is not None or is_blurred:
            if not is_direct:
                screen.fill((0, 0, 0))
                self._enlarge(screen, place, (0, self._size[1]))
            pygame.display.flip()
        elif changed:
            if not is_direct:
                for run in changed:
                    self._enlarge(screen, place, run)
            pygame.display.update(
                [enlarged(run, place, self._size).clip(screen.get_rect()) for run in changed]
            )

    def _is_blurred(self, place: PageBox) -> bool:
        """Whether the field is not shown at a whole multiple."""
        return (self.fit and place[2:] != self._size) or place.width < self._size[0]

    def _enlarge(self, screen: pygame.Surface, place: PageBox, run: Run) -> None:
        """Copy a run of lines of the field, enlarged, to their place in the window."""
        lines = self._field.subsurface((0, run[0], self._size[0], run[1] - run[0]))
        target = enlarged(run, place, self._size)
        if target.size == lines.get_size():
            screen.blit(lines, target)
        else:
            enlarge = pygame.transform.smoothscale if self._is_blurred(place) else pygame.transform.scale
            if screen.get_masks() == FIELD_MASKS and screen.get_rect().contains(target):
                # Measured: this takes two thirds of the time of enlarging into a copy.
                enlarge(lines, target.size, screen.subsurface(target))
            else:
                screen.blit(enlarge(lines, target.size), target)

    def collect(self, queue: InputQueue, wait: int = 0) -> None:
        """Put the input of the user into a queue, waiting up to `wait` milliseconds for the first."""
        if wait:
            self._note(pygame.event.wait(wait), queue)
        for event in pygame.event.get():
            self._note(event, queue)

    def _note(self, event: pygame.event.Event, queue: InputQueue) -> None:
        """Put the input of an event into the queue, or note that the window has lost the field."""
        if event.type in REDRAWN_ON:
            self.forget_shown()
        elif event.type == pygame.QUIT:
            queue.add(Close())
        elif event.type == pygame.KEYDOWN:
            control, alt = event.mod & CONTROL, event.mod & pygame.KMOD_ALT
            name, shift = pygame.key.name(event.key), event.mod & pygame.KMOD_SHIFT
            queue.add(Key(name, event.unicode, bool(control), bool(shift), bool(alt)))
        elif event.type == pygame.KEYUP:
            queue.release(pygame.key.name(event.key))
        elif event.type == pygame.WINDOWFOCUSLOST:
            queue.release_everything()
        elif event.type == pygame.DROPFILE:
            queue.add(Path(event.file))
        elif event.type == pygame.MOUSEMOTION:
            queue.add(self._pointer(event.pos, "move"))
        elif event.type in (pygame.MOUSEBUTTONDOWN, pygame.MOUSEBUTTONUP) and event.button <= 3:
            action = "press" if event.type == pygame.MOUSEBUTTONDOWN else "release"
            queue.add(self._pointer(event.pos, action, event.button))
        elif event.type == pygame.MOUSEWHEEL and event.y:
            action = "wheel up" if event.y > 0 else "wheel down"
            queue.add(self._pointer(pygame.mouse.get_pos(), action, steps=abs(event.y)))

    def _pointer(self, place: tuple[int, int], action: str, button: int = 0, steps: int = 1) -> Pointer:
        """The input of the mouse at a place of the window, with the current modifiers."""
        element, line = pixel_under(place, self._size, pygame.display.get_window_size(), self.fit)
        down = pygame.key.get_mods()
        shift, control = bool(down & pygame.KMOD_SHIFT), bool(down & CONTROL)
        return Pointer(element, line, action, button, steps, shift, control)


def viewport(field: tuple[int, int], window: tuple[int, int], fit: bool = False) -> PageBox:
    """The place of a (width, height) field in a (width, height) window; a whole multiple unless `fit`.

    A window that is smaller than the field shows the whole field, as with `fit`.

    >>> viewport((640, 480), (1400, 1000))
    PageBox(left=60, top=20, width=1280, height=960)
    """
    ratio = min(window[0] / field[0], window[1] / field[1])
    if fit or ratio < 1:
        width, height = (max(1, int(size * ratio + 0.5)) for size in field)
    else:
        width, height = field[0] * int(ratio), field[1] * int(ratio)
    return PageBox((window[0] - width) // 2, (window[1] - height) // 2, width, height)


def pixel_under(
    place: tuple[int, int], field: tuple[int, int], window: tuple[int, int], fit: bool = False
) -> tuple[int, int]:
    """The element and line of the field at a place of the window; outside the field, the nearest pixel.

    >>> pixel_under((0, 999), (640, 480), (1400, 1000))
    (0, 479)
    """
    left, top, width, height = viewport(field, window, fit)
    element = (place[0] - left) * field[0] // width
    line = (place[1] - top) * field[1] // height
    return min(max(element, 0), field[0] - 1), min(max(line, 0), field[1] - 1)


def enlarged(run: Run, place: PageBox, size: tuple[int, int]) -> pygame.Rect:
    """The rectangle of the window that shows a run of lines; `size` is the field's (elements, lines)."""
    top, end = (place.top + line * place.height // size[1] for line in run)
    return pygame.Rect(place.left, top, place.width, end - top)
