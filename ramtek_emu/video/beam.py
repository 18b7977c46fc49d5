"""Beam: the clock of a display, and the position of its monitor's beam.

What is modeled: a clock that only instructions advance, and a beam that moves line by line from the top of a
field to its bottom and is then blanked for some lines. So the same stream always gives the same field. What
is **not**: interlace, real time, pauses of the host.
"""

from __future__ import annotations

from typing import Any

from ramtek_emu.timing import Timing


class Beam:
    """The clock and the beam of one display."""

    def __init__(self, timing: Timing, lines: int) -> None:
        self.timing = timing
        self.lines = lines
        self.nanoseconds = 0
        """The time since power-on; it never decreases."""

    def state(self) -> dict[str, Any]:
        """The time since power-on."""
        return {"nanoseconds": self.nanoseconds}

    def restore(self, state: dict[str, Any]) -> None:
        """Set the time of a state."""
        self.nanoseconds = state["nanoseconds"]

    @property
    def lines_done(self) -> int:
        """The number of lines begun since power-on, with the blanked lines."""
        return self.nanoseconds // self.timing.line

    @property
    def lines_per_field(self) -> int:
        """The number of lines of a field, with the blanked lines."""
        return self.lines + self.timing.blanked_lines

    @property
    def line(self) -> int:
        """The current line of the beam; lines from `lines` on are blanked."""
        return self.lines_done % self.lines_per_field

    @property
    def blink_is_on(self) -> bool:
        """Whether blinking cursors are shown in this field."""
        return self.lines_done // self.lines_per_field // self.timing.blink_fields % 2 == 0

    def charge(self, words: int, pixels: int, instructions: int = 1) -> None:
        """Advance the clock by the time of instructions, with all their words and pixels."""
        timing = self.timing
        self.nanoseconds += instructions * timing.instruction + words * timing.word + pixels * timing.pixel

    def wait_for_line(self, line: int) -> None:
        """Advance the clock to the beginning of a line; if the beam is on that line, no time passes."""
        ahead = (line - self.line) % self.lines_per_field
        if ahead:
            self.nanoseconds = (self.lines_done + ahead) * self.timing.line
