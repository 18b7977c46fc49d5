"""Timing and the beam: how long instructions take, and where the monitor's beam is meanwhile.

What is modeled: a clock that only instructions move on, and a beam that runs line by line from the top of a
field to its bottom and is then blanked for a while. So the same stream always gives the same field. What is
**not**: interlace, the time of day, the host's own pauses.

Assumed: every rate here. The sources give none for any model, only that programs waited for the vertical
retrace before they loaded the table (NCAR).
"""

from dataclasses import dataclass, fields

from ramtek_emu.errors import ConfigurationError

MOST = 1_000_000_000
"""The largest rate: a second."""


@dataclass(frozen=True, kw_only=True)
class Timing:
    """Rates, in nanoseconds; all of them Assumed, in this one place.

    Assumed: thirty fields a second, 525 lines for 480 shown ones; a processor of its time that takes
    some ten microseconds an instruction and a few memory cycles a word or pixel.
    """

    line: int = 63_492
    """One line of the field, its way back included."""
    blanked_lines: int = 45
    """Lines between the last line of a field and the first of the next."""
    instruction: int = 10_000
    word: int = 1_000
    """One word from the host."""
    pixel: int = 800
    """One word written to the frame buffer."""
    blink_fields: int = 15
    """Fields that a blinking cursor is seen, and is then not seen."""

    def __post_init__(self) -> None:
        for each in fields(self):
            value = getattr(self, each.name)
            least = 1 if each.name in ("line", "blink_fields") else 0
            if isinstance(value, bool) or not isinstance(value, int) or not least <= value <= MOST:
                raise ConfigurationError(
                    f"{each.name} must be a whole number from {least} to {MOST}, not {value!r} (timing); "
                    "give nanoseconds, lines or fields"
                )


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
