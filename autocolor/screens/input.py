"""The gestures of the pointer, which the mouse and the joystick unit both make.

A hover is a movement; a pick is a click or ENTER. A drag begins with a grab, and ends with a drop. The unit
has a place, ENTER and TRACK alone; TRACK stays on during a drag. The mouse also has other buttons, a wheel
and modifiers.
"""

from __future__ import annotations

from typing import Final, NamedTuple

from ramtek_emu import HostPort, instructions

LEFT: Final = 1
MIDDLE: Final = 2
RIGHT: Final = 3
"""The buttons of the mouse; the right button is TRACK."""

SLOP: Final = 2
"""Assumed: elements or lines that the mouse may move while its button is down for a click."""

DEGREES: Final = 0.4
"""Assumed: degrees for each element or line of a drag; across the whole picture is most of a turn."""

STEP_CLOSER: Final = 0.92
"""Assumed: the ratio of distances for each step of the wheel."""


class Gesture(NamedTuple):
    """A movement, click or turn of the wheel at an element and a line.

    `kind` is "hover", "pick", "grab", "drag", "drop" or "wheel"; `steps` is for the wheel, up positive.
    """

    kind: str
    element: int
    line: int
    button: int = LEFT
    steps: float = 0.0
    shift: bool = False
    control: bool = False


class Mouse:
    """The mouse. A click becomes a pick, and a movement with a button down becomes a drag."""

    def __init__(self) -> None:
        self._pressed: Gesture | None = None
        """The press of the button that is down; None if all are up."""
        self._drags = False

    def forget(self) -> None:
        """Forget the button that is down."""
        self._pressed, self._drags = None, False

    def gestures(self, action: str, place: Gesture) -> list[Gesture]:
        """The gestures of an action at a place: "move", "press", "release", "wheel up" or "wheel down".

        `place` is a hover with the button and the modifiers, and with the steps of a wheel as they come.
        """
        pressed = self._pressed
        if action.startswith("wheel"):
            return [place._replace(kind="wheel", steps=place.steps if action == "wheel up" else -place.steps)]
        if action == "press":
            if pressed is None:
                self._pressed, self._drags = place, False
            return []
        if action == "release":
            if pressed is None or place.button != pressed.button:
                return []
            drags = self._drags
            self.forget()
            kind = "drop" if drags else "pick"
            # The other buttons have no clicks.
            return [place._replace(kind=kind)] if drags or place.button == LEFT else []
        if pressed is None:
            return [place]
        moved = place._replace(kind="drag", button=pressed.button)
        if self._drags:
            return [moved]
        if max(abs(place.element - pressed.element), abs(place.line - pressed.line)) <= SLOP:
            return []
        self._drags = True
        return [pressed._replace(kind="grab"), moved]


def turn_between(element: int, line: int, other_element: int, other_line: int) -> tuple[float, float]:
    """How far to turn to the right and up, in degrees, so that the object follows a drag to another place.

    >>> turn_between(100, 100, 110, 95)
    (-4.0, -2.0)
    """
    return DEGREES * (element - other_element), DEGREES * (other_line - line)


def wheel_ratio(steps: float) -> float:
    """The ratio of distances for some steps of the wheel; steps up move closer."""
    return float(STEP_CLOSER**steps)


# The joystick unit of the display, as a host uses it: the host reads the cursor and turns it into gestures.
#
# Hardware: the cursor's words have its place, TRACK while the switch is on, and ENTER once for each press;
# there is no other input. So ENTER is a pick, and a drag lasts as long as TRACK. The cursor is the pointer; a
# second cursor marks what the pointer can grab.

POINTER: Final = 0
MARK: Final = 1
"""The numbers of the cursors."""

POLL_SECONDS: Final = 1 / 100
"""Assumed: the time between two reads of the cursor; a read takes 0.1 ms over TCP."""

ELEMENT_BITS: Final = 0x7FF
LINE_BITS: Final = 0x3FF
TRACK: Final = 1 << 12
ENTER: Final = 1 << 13
"""Hardware: LIN, the bits of an element, of a line, and of the switches in the second word."""


class Unit:
    """The joystick unit of a display."""

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
        """Put the mark at an element and a line, within the reach of a cursor; None hides it."""
        if place != self._mark:
            element, line = place or (0, 0)
            element, line = min(max(element, 0), ELEMENT_BITS), min(max(line, 0), LINE_BITS)
            self._display.send(instructions.write_cursor(MARK, element, line, visible=place is not None))
            self._mark = place

    def poll(self) -> list[Gesture]:
        """The gestures since the last poll. Raises PortError if the display cannot be reached."""
        element, line, state = self._read()
        place, before = (element, line), self._place
        tracks, tracked = bool(state & TRACK), self._tracks
        self._place, self._tracks = place, tracks
        gestures = []
        if tracks and not tracked:
            gestures.append(Gesture("grab", *(before if before is not None else place)))
        if before is not None and place != before:
            gestures.append(Gesture("drag" if tracks or tracked else "hover", *place))
        if tracked and not tracks:
            gestures.append(Gesture("drop", *place))
        if state & ENTER:
            gestures.append(Gesture("pick", *place))
        return gestures

    def _read(self) -> tuple[int, int, int]:
        """The element and line of the pointer, and the word with its switches."""
        self._display.send(instructions.read_cursor(POINTER))
        element, line = self._display.receive(2).tolist()
        return element & ELEMENT_BITS, line & LINE_BITS, line
