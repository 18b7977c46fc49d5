"""Gestures: what a user does with the pointer, told in the same way by the mouse and by the joystick unit.

A hover is a movement, a pick a click or ENTER. A drag begins with a grab, and ends with a drop. The unit has
a place, ENTER and TRACK alone; TRACK is held for a drag. The mouse also has other buttons, a wheel and
modifiers.
"""

from __future__ import annotations

from typing import Final, NamedTuple

LEFT: Final = 1
MIDDLE: Final = 2
RIGHT: Final = 3
"""The buttons of the mouse; the right one is TRACK."""

SLOP: Final = 2
"""Assumed: elements or lines that the mouse may move while its button is down for a click."""

DEGREES: Final = 0.4
"""Assumed: degrees for each element or line of a drag; across the whole picture is most of a turn."""

STEP_CLOSER: Final = 0.92
"""Assumed: the ratio of distances for each step of the wheel."""


class Gesture(NamedTuple):
    """One thing that the pointer did at an element and a line.

    `kind` is "hover", "pick", "grab", "drag", "drop" or "wheel"; `steps` are those of the wheel, up positive.
    """

    kind: str
    element: int
    line: int
    button: int = LEFT
    steps: float = 0.0
    shift: bool = False
    control: bool = False


class Mouse:
    """Makes gestures of what the mouse does: a click is a pick, a movement with a button down is a drag."""

    def __init__(self) -> None:
        self._pressed: Gesture | None = None
        """The press of the button that is down."""
        self._drags = False

    def forget(self) -> None:
        """Take the button for released."""
        self._pressed, self._drags = None, False

    def gestures(
        self,
        element: int,
        line: int,
        action: str,
        button: int = 0,
        steps: int = 1,
        shift: bool = False,
        control: bool = False,
    ) -> list[Gesture]:
        """The gestures of an action: "move", "press", "release", "wheel up" or "wheel down"."""
        place = Gesture("hover", element, line, button, 0.0, shift, control)
        pressed = self._pressed
        if action.startswith("wheel"):
            return [place._replace(kind="wheel", steps=float(steps if action == "wheel up" else -steps))]
        if action == "press":
            if pressed is None:
                self._pressed, self._drags = place, False
            return []
        if action == "release":
            if pressed is None or button != pressed.button:
                return []
            drags = self._drags
            self.forget()
            kind = "drop" if drags else "pick"
            # The other buttons have no clicks.
            return [place._replace(kind=kind)] if drags or button == LEFT else []
        if pressed is None:
            return [place]
        moved = place._replace(kind="drag", button=pressed.button)
        if self._drags:
            return [moved]
        if max(abs(element - pressed.element), abs(line - pressed.line)) <= SLOP:
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
    """The ratio of distances for some steps of the wheel; those up move closer."""
    return float(STEP_CLOSER**steps)
