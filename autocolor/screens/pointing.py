"""Pointing: what the mouse does on the picture.

A drag turns around the object, with the middle button it moves the picture, and the wheel moves closer.
"""

from __future__ import annotations

from typing import Final, NamedTuple

DEGREES: Final = 0.4
"""Assumed: degrees for each element or line of a drag; across the whole picture is most of a turn."""

STEP_CLOSER: Final = 0.92
"""Assumed: the ratio of distances for each step of the wheel."""


LEFT: Final = 1
MIDDLE: Final = 2
"""The buttons that drag."""


class Drag(NamedTuple):
    """A drag that has come to an element and a line; `number` tells it from other drags."""

    number: int
    element: int
    line: int
    button: int = LEFT

    def turn_to(self, element: int, line: int) -> tuple[float, float]:
        """How far to turn to the right and up, in degrees, so that the object follows the mouse.

        >>> Drag(1, 100, 100).turn_to(110, 95)
        (-4.0, -2.0)
        """
        return DEGREES * (self.element - element), DEGREES * (line - self.line)


def wheel_ratio(action: str, steps: int) -> float:
    """The ratio of distances for "wheel up", which moves closer, or "wheel down"."""
    return float(STEP_CLOSER ** (steps if action == "wheel up" else -steps))
