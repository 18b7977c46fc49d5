"""Cursors and the joystick unit: marks on the screen that a host places and reads, and that a user moves.

What is modeled: positions, visible and blinking cursors, their shapes, TRACK and ENTER, the connection of
joysticks to cursors. What is **not**: the joystick's speed and spring, how a cursor was mixed into the video.

A position is an element and a line of the screen, not of the memory. Otherwise a program that moves the
display origin with the cursor would lose the cursor (Hardware: PRG, orig.c).

Hardware: LIN (words in screen coordinates, TRACK and ENTER); NCAR (in pixel coordinates); JPL (in global
coordinates; the shape of 32 x 32 around (15, 15), which device drives which cursor).
Assumed: reading a cursor clears its ENTER, so a press is read once. Every cursor reports the switches, since
the unit has one set of them. A position may be beyond the screen; the shape is then clipped. RSET and INIT
change neither the cursors nor the lookup table. The joystick drives cursor 0 until the host connects it to
other cursors.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, Final

import numpy as np

from ramtek_emu.arrays import Bytes, Dots

VISIBLE: Final = 1 << 10
BLINK: Final = 1 << 11
TRACK: Final = 1 << 12
ENTER: Final = 1 << 13
"""The bits of the state in the word of the line (Hardware: LIN)."""
LINE_BITS: Final = 0x3FF
"""The bits of the line in the same word."""
SHAPE_SIZE: Final = 32
SHAPE_CENTER: Final = 15


def cross() -> Dots:
    """The initial shape of a cursor, (32, 32).

    Assumed: an upright cross of 15 x 15 pixels, open in the middle, so that the pixel under it is visible. No
    source shows the shape of the 9300.
    """
    shape = np.zeros((SHAPE_SIZE, SHAPE_SIZE), np.bool_)
    arm = [*range(SHAPE_CENTER - 7, SHAPE_CENTER - 1), *range(SHAPE_CENTER + 2, SHAPE_CENTER + 8)]
    shape[arm, SHAPE_CENTER] = shape[SHAPE_CENTER, arm] = True
    return shape


@dataclass
class Cursor:
    """A cursor: its place on the screen and how it is shown."""

    element: int = 0
    line: int = 0
    state: int = 0
    """VISIBLE, BLINK and any other bits that the host wrote above the bits of the line."""
    enter: bool = False
    """Whether ENTER was pressed since the host last read this cursor."""
    shape: Dots = field(default_factory=cross, repr=False)

    @property
    def is_visible(self) -> bool:
        """Whether the cursor is shown."""
        return bool(self.state & VISIBLE)


class Cursors:
    """The cursors of a display, and the switches of its joystick unit."""

    def __init__(self, count: int) -> None:
        self.all = tuple(Cursor() for _ in range(count))
        self.track = False
        """The TRACK switch."""
        self.enter_is_pressed = False
        """Whether ENTER was pressed since the interface's status was last cleared."""
        self.driven = {0: 1}
        """The cursors that a tracking device drives, by the number of the device; bit n is cursor n."""
        self.shape_changes = 0
        """The number of changes of shapes; it never decreases."""

    def __getitem__(self, number: int) -> Cursor:
        return self.all[number]

    def state(self) -> dict[str, Any]:
        """The cursors, the switches, and the cursors of each tracking device as pairs (device, mask)."""
        return {
            "cursors": tuple(dict(vars(cursor)) for cursor in self.all),
            "track": self.track,
            "enter_is_pressed": self.enter_is_pressed,
            "tracking_devices": sorted(self.driven.items()),
        }

    def restore(self, state: dict[str, Any]) -> None:
        """Set the cursors and switches of a state."""
        for cursor, values in zip(self.all, state["cursors"], strict=True):
            vars(cursor).update(values)
        self.track, self.enter_is_pressed = state["track"], state["enter_is_pressed"]
        self.driven = dict(state["tracking_devices"])
        self.shape_changes += 1

    def place(self, number: int, element: int, line: int, state: int) -> None:
        """Move a cursor and set its state, as the host does."""
        cursor = self.all[number]
        cursor.element, cursor.line, cursor.state = element, line, state

    def read_state(self, number: int) -> int:
        """The state bits of a cursor, with the switches, as the host reads them; its ENTER is cleared."""
        cursor = self.all[number]
        switches = (TRACK if self.track else 0) | (ENTER if cursor.enter else 0)
        cursor.enter = False
        return cursor.state & ~(TRACK | ENTER) | switches

    def set_shape(self, number: int, rows: Bytes) -> None:
        """Replace up to 32 rows of a cursor's shape; a row is four bytes, the highest bit leftmost."""
        dots = np.unpackbits(rows, axis=1).astype(np.bool_)
        self.all[number].shape = self.all[number].shape.copy()
        self.all[number].shape[: len(dots)] = dots
        self.shape_changes += 1


class Joystick:
    """Tracking device 0, which a user moves: `display.joystick` in Python, the mouse in a window."""

    def __init__(self, cursors: Cursors, elements: int, lines: int) -> None:
        self._cursors = cursors
        self._limits = elements - 1, lines - 1

    @property
    def driven(self) -> tuple[Cursor, ...]:
        """The cursors that this device drives."""
        mask = self._cursors.driven.get(0, 0)
        return tuple(cursor for number, cursor in enumerate(self._cursors.all) if mask >> number & 1)

    @property
    def position(self) -> tuple[int, int]:
        """The element and line of the first driven cursor; (0, 0) if no cursor is driven."""
        driven = self.driven
        return (driven[0].element, driven[0].line) if driven else (0, 0)

    def move_to(self, element: int, line: int) -> None:
        """Move the driven cursors to a place; they stop at the edges of the screen."""
        place = min(max(int(element), 0), self._limits[0]), min(max(int(line), 0), self._limits[1])
        for cursor in self.driven:
            cursor.element, cursor.line = place

    def move_by(self, elements: int, lines: int) -> None:
        """Move the driven cursors by a number of elements and lines."""
        element, line = self.position
        self.move_to(element + elements, line + lines)

    @property
    def track(self) -> bool:
        """The TRACK switch: programs draw while it is on."""
        return self._cursors.track

    @track.setter
    def track(self, is_on: bool) -> None:
        self._cursors.track = bool(is_on)

    def press_enter(self) -> None:
        """Press ENTER: each cursor reports it at its next read, and the interface requests an interrupt."""
        for cursor in self._cursors.all:
            cursor.enter = True
        self._cursors.enter_is_pressed = True
