"""Monitor: shows the field of a display in a window. The only place that knows pygame.

What is modelled: a field at the largest whole multiple that fits, centered, every pixel one k x k block;
the mouse as the cursor's joystick, its button as ENTER. What is **not**: the phosphor, the beam, the
joystick's feel.

The window shows, it never draws: everything to be seen is words in the frame buffer. Keys, drops and ticks
are handed to whoever drives the display as plain values.
"""

import os
import sys
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import numpy as np

# Before pygame is loaded: its greeting would mix with data on stdout, and on Windows a process that does
# not speak up has its window enlarged by a blurring factor.
os.environ["PYGAME_HIDE_SUPPORT_PROMPT"] = "1"
os.environ["SDL_WINDOWS_DPI_AWARENESS"] = os.environ.get("SDL_WINDOWS_DPI_AWARENESS", "permonitorv2")
import pygame

from .display import Ramtek9300
from .errors import NoScreenError, OutputExistsError, RamtekError
from .png import save_png

TICK_MILLISECONDS = 15
KEY_DELAY, KEY_INTERVAL = 400, 40
MODIFIERS = frozenset(
    f"{side} {key}" for side in ("left", "right") for key in ("shift", "ctrl", "alt", "meta")
)
FIELD_MASKS = (0xFF0000, 0x00FF00, 0x0000FF, 0)
REDRAWN_ON = frozenset(
    (pygame.WINDOWEXPOSED, pygame.WINDOWSIZECHANGED, pygame.WINDOWRESTORED, pygame.WINDOWSHOWN)
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


class Placement(NamedTuple):
    """Where the field lies in the window: left, top, width and height in pixels."""

    left: int
    top: int
    width: int
    height: int


def placement(field: tuple[int, int], window: tuple[int, int], fit: bool = False) -> Placement:
    """Where a (width, height) field lies in a (width, height) window: whole multiples unless `fit`.

    A window smaller than the field shows the middle of it.

    >>> placement((640, 480), (1400, 1000))
    Placement(left=60, top=20, width=1280, height=960)
    """
    ratio = min(window[0] / field[0], window[1] / field[1])
    if fit:
        width, height = (max(1, int(size * ratio + 0.5)) for size in field)
    else:
        multiple = max(1, int(ratio))
        width, height = field[0] * multiple, field[1] * multiple
    return Placement((window[0] - width) // 2, (window[1] - height) // 2, width, height)


def open_screen() -> None:
    """Start the screen; NoScreenError when there is none, or only one that nobody sees or asked for."""
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
            f"a window must have a screen, and the one that DISPLAY or WAYLAND_DISPLAY names does not "
            f"answer; {advice}"
        )


class Monitor:
    """A window on a display. `run` holds it open; `step` does one round, for programs that work meanwhile."""

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
        """Prepare a window; nothing is opened yet.

        `on_key` returns whether it took the key: Esc, when nobody took it, leaves full screen, then asks to
        close. `on_close` returns whether the window may close. `on_message` is given sentences for the
        user, such as where a screenshot went; without it they stand in the window's caption.
        """
        self.display = display
        self.fit = fit
        self.full_screen = full_screen
        self.screenshots = Path(screenshots)
        self.screenshot_name = screenshot_name
        self.on_key = on_key
        self.on_pointer = on_pointer
        self.on_drop = on_drop
        self.on_tick = on_tick
        self.on_close = on_close
        self.on_message = on_message
        self.refreshed = 0
        """How often the field was shown; it only grows."""
        self._caption = caption
        self._size = (display.scan_out.elements, display.scan_out.lines)
        self._window_size = self._size
        self._open = False
        self._shown: tuple[object, ...] | None = None
        self._enter = False
        self._down: set[int] = set()

    @property
    def is_open(self) -> bool:
        """Whether the window is there."""
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
        """Open the window; NoScreenError when there is no screen."""
        open_screen()
        desktop = pygame.display.get_desktop_sizes()[0]
        room = int(desktop[0] * 0.95), int(desktop[1] * 0.9)
        self._window_size = placement(self._size, room)[2:]
        self._field = pygame.Surface(self._size, 0, 32, FIELD_MASKS)
        self._open = True
        pygame.display.set_caption(self._caption)
        pygame.key.set_repeat(KEY_DELAY, KEY_INTERVAL)
        self._set_mode()

    def close(self) -> None:
        """Close the window without asking."""
        if self._open:
            self._open = False
            pygame.display.quit()

    def run(self) -> None:
        """Open the window and hold it open until it is closed."""
        self.open()
        try:
            while self._open:
                self.step(TICK_MILLISECONDS)
        finally:
            self.close()

    def step(self, wait: int = 0) -> bool:
        """Handle what came in, waiting for it up to `wait` milliseconds; show the field if it changed.

        Returns whether the window is still open.
        """
        event = pygame.event.wait(wait) if wait else pygame.event.poll()
        while event.type != pygame.NOEVENT and self._open:
            self._handle(event)
            event = pygame.event.poll() if self._open else event
        if self._open and self.on_tick is not None:
            self.on_tick()
        if self._open and self._shown != (
            self.display.scan_out.stamp,
            pygame.display.get_window_size(),
            self.fit,
        ):
            self.refresh()
        return self._open

    def refresh(self) -> None:
        """Show the present field."""
        screen = pygame.display.get_surface()
        self._shown = (self.display.scan_out.stamp, pygame.display.get_window_size(), self.fit)
        self.refreshed += 1
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

    def screenshot(self) -> Path:
        """Save the field under the next free number, never over a file; WriteError when it cannot be."""
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
        elif self._open:
            pygame.display.set_caption(f"{self._caption} - {message}")

    def ask_to_close(self) -> None:
        """Close the window if whoever drives it agrees."""
        if self.on_close is None or self.on_close():
            self.close()

    def toggle_full_screen(self) -> None:
        """Fill the screen, or go back to a window of the size before."""
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
        self._shown = None

    def _scan_out(self, surface: pygame.Surface) -> None:
        # The surface stays locked as long as the array lives: it ends with this line.
        self.display.scan_out.scan_out_into(np.asarray(surface.get_view("2")).T)

    def _handle(self, event: pygame.event.Event) -> None:
        if event.type in REDRAWN_ON:
            self._shown = None
        elif event.type == pygame.QUIT:
            self.ask_to_close()
        elif event.type == pygame.KEYDOWN:
            self._handle_key(
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
            self._enter = pressed if event.button == 1 else self._enter
            self._handle_pointer(event.pos, "press" if pressed else "release", event.button)
        elif event.type == pygame.MOUSEWHEEL and event.y:
            self._handle_pointer(pygame.mouse.get_pos(), "wheel up" if event.y > 0 else "wheel down")

    def _handle_key(self, key: Key) -> None:
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

    def _handle_pointer(self, place: tuple[int, int], action: str, button: int = 0) -> None:
        if self.on_pointer is None:
            return
        left, top, width, height = placement(self._size, pygame.display.get_window_size(), self.fit)
        # Outside the field the cursor stays at its edge, as a joystick's does.
        element = int(np.clip((place[0] - left) * self._size[0] // width, 0, self._size[0] - 1))
        line = int(np.clip((place[1] - top) * self._size[1] // height, 0, self._size[1] - 1))
        self.on_pointer(Pointer(element, line, self._enter, action, button))
