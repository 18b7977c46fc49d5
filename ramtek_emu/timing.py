"""Timing: the times that instructions and lines take. The clock that uses these rates is in video.beam.

Assumed: every rate here. The sources give none for any model, only that programs waited for the vertical
retrace before they loaded the table (NCAR).
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import Final

from ramtek_emu.errors import ConfigurationError

MOST: Final = 1_000_000_000
"""The largest value of any rate. Limit: one second, if it is a time."""


@dataclass(frozen=True, kw_only=True)
class Timing:
    """Rates, in nanoseconds; all of them Assumed, in this one place.

    Assumed: thirty fields a second, 525 lines for 480 shown ones; a processor of its time that takes
    some ten microseconds an instruction and a few memory cycles a word or pixel.
    """

    line: int = 63_492
    """One line of the field, horizontal retrace included."""
    blanked_lines: int = 45
    """Lines between the last line of a field and the first of the next."""
    instruction: int = 10_000
    word: int = 1_000
    """One word from the host."""
    pixel: int = 800
    """One word written to the frame buffer."""
    blink_fields: int = 15
    """The number of fields that a blinking cursor is shown, and the number that it is hidden."""

    def __post_init__(self) -> None:
        for rate in fields(self):
            value = getattr(self, rate.name)
            least = 1 if rate.name in ("line", "blink_fields") else 0
            if isinstance(value, bool) or not isinstance(value, int) or not least <= value <= MOST:
                raise ConfigurationError(
                    f"{rate.name} must be a whole number from {least} to {MOST}, not {value!r} (timing); "
                    "give nanoseconds, lines or fields"
                )
