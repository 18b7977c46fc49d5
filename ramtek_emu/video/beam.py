"""Beam: the clock of a display, and the line that the beam of its monitor is on.

What is modeled: a clock that only instructions move on, and a beam that runs line by line from the top of a
field to its bottom and is then blanked for a while. So the same stream always gives the same field. What is
**not**: interlace, the time of day, the host's own pauses.
"""

from __future__ import annotations

from ramtek_emu.timing import Timing


class Beam:
    """The clock and the beam of one display."""

    def __init__(self, timing: Timing, lines: int) -> None:
        self.timing = timing
        self.lines = lines
        self.nanoseconds = 0
        """Time since power-on; it only grows."""

    @property
    def lines_done(self) -> int:
        """Lines begun since power-on, blanked ones included."""
        return self.nanoseconds // self.timing.line

    @property
    def lines_per_field(self) -> int:
        """Shown and blanked lines."""
        return self.lines + self.timing.blanked_lines

    @property
    def field_number(self) -> int:
        """Whole fields since power-on."""
        return self.lines_done // self.lines_per_field

    @property
    def line(self) -> int:
        """The line that the beam is on; from `lines` on it is blanked."""
        return self.lines_done % self.lines_per_field

    @property
    def blink_is_on(self) -> bool:
        """Whether blinking cursors are seen in this field."""
        return self.field_number // self.timing.blink_fields % 2 == 0

    def charge(self, words: int, pixels: int) -> None:
        """Let the time of an instruction pass."""
        timing = self.timing
        self.nanoseconds += timing.instruction + words * timing.word + pixels * timing.pixel

    def wait_for_line(self, line: int) -> None:
        """Let time pass until the beam begins a line; at once if it is on it."""
        ahead = (line - self.line) % self.lines_per_field
        if ahead:
            self.nanoseconds = (self.lines_done + ahead) * self.timing.line
