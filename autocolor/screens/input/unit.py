"""The joystick unit of the display, as a host uses it: it reads the cursor, and makes gestures of that.

Hardware: the cursor's word has its place, TRACK while that switch is on, and ENTER once for each press; there
is no other input. So ENTER is a pick, and a drag lasts as long as TRACK. The cursor is the pointer; a second
one marks what it can grab.
"""

from __future__ import annotations

from typing import Final

from autocolor.screens.input.gestures import Gesture
from ramtek_emu import HostPort, instructions

POINTER: Final = 0
MARK: Final = 1
"""The numbers of the cursors."""

POLL_SECONDS: Final = 1 / 100
"""Assumed: the time between two reads of the cursor; a read takes 0.1 ms over TCP."""

ELEMENT_BITS: Final = 0x7FF
LINE_BITS: Final = 0x3FF
TRACK: Final = 1 << 12
ENTER: Final = 1 << 13
"""Hardware: LIN, the bits of an element, and those of the second word."""


class Unit:
    """The unit of a display."""

    def __init__(self, display: HostPort) -> None:
        self._display = display
        self._place: tuple[int, int] | None = None
        self._tracks = False
        self._mark: tuple[int, int] | None = None

    def show(self) -> None:
        """Show the pointer where it is."""
        element, line, _ = self._read()
        self._display.send(instructions.write_cursor(POINTER, element, line))

    def hide(self) -> None:
        """Hide the pointer and the mark."""
        for number in (POINTER, MARK):
            self._display.send(instructions.write_cursor(number, 0, 0, visible=False))
        self._mark = None

    def mark(self, place: tuple[int, int] | None) -> None:
        """Put the mark at an element and a line, at most at an edge; or hide it."""
        if place != self._mark:
            element, line = place or (0, 0)
            element, line = min(max(element, 0), ELEMENT_BITS), min(max(line, 0), LINE_BITS)
            self._display.send(instructions.write_cursor(MARK, element, line, visible=place is not None))
            self._mark = place

    def poll(self) -> list[Gesture]:
        """What was done since the last poll. Raises PortError if the display cannot be reached."""
        element, line, state = self._read()
        place, before = (element, line), self._place
        tracks, tracked = bool(state & TRACK), self._tracks
        self._place, self._tracks = place, tracks
        found = []
        if tracks and not tracked:
            found.append(Gesture("grab", *(before if before is not None else place)))
        if before is not None and place != before:
            found.append(Gesture("drag" if tracks or tracked else "hover", *place))
        if tracked and not tracks:
            found.append(Gesture("drop", *place))
        if state & ENTER:
            found.append(Gesture("pick", *place))
        return found

    def _read(self) -> tuple[int, int, int]:
        """The element and line of the pointer, and the word of its state."""
        self._display.send(instructions.read_cursor(POINTER))
        element, line = self._display.receive(2).tolist()
        return element, line & LINE_BITS, line
