"""Watching: the finished picture is blanked, and comes in again line by line as it is computed, as in 1983.

Each line is one instruction. Nothing else changes: no scene, no step to undo, no level range, no entry.
"""

from __future__ import annotations

import time
from collections.abc import Iterator
from typing import Final

import numpy as np

from autocolor.arrays import Words
from autocolor.mapping.ranges import BACKGROUND
from autocolor.studio import Studio
from ramtek_emu import HostPort, instructions

PICTURE_SECONDS: Final = 6.0
"""Assumed: how long a whole picture takes to come in; the paper gives no times. Long enough to see the order
of the lines, and short enough to wait for. A picture whose lines take longer comes in as fast as
they are computed: the coupe's 480 take a third of a second."""

TICK_SECONDS: Final = 0.01
"""Assumed: after this time no further line is begun in a tick of the window, which has 15 ms; so a key waits
for one line at most. Measured: the slowest line takes 3 ms for the coupe, 35 for 90,000 polygons. The first
line waits for the projection, 3 and 34 ms; an edit of the view takes at least three times as long."""

MESSAGE: Final = "line by line; any key shows the whole picture"

ENDING: Final = ("w", "escape")
"""Keys that only show the whole picture at once while it comes in."""


class Watching:
    """A picture that comes in line by line on a display, if there is one."""

    def __init__(self, display: HostPort) -> None:
        self._display = display
        self._lines: Iterator[tuple[int, Words]] = iter(())
        self._words = np.empty((0, 0), np.uint16)
        """The words of the whole picture."""
        self._done = 0
        self._begun = 0.0

    @property
    def is_on(self) -> bool:
        """Whether a picture is coming in."""
        return self._done < len(self._words)

    def begin(self, studio: Studio) -> None:
        """Blank the picture of a studio to its background; `advance` lets it come in."""
        self._lines = studio.watch()
        self._words, self._done, self._begun = studio.words, 0, time.monotonic()
        lines, elements = self._words.shape
        self._display.send(instructions.erase((0, 0, elements - 1, lines - 1), BACKGROUND))

    def advance(self) -> None:
        """Send the lines that are due by now, as many as a tick has time for; if any is due, at least one."""
        tick = time.monotonic()
        due = (tick - self._begun) / PICTURE_SECONDS * len(self._words)
        while self.is_on and self._done < due and time.monotonic() - tick <= TICK_SECONDS:
            line, words = next(self._lines)
            self._display.send(instructions.write_image(words, top=line))
            self._done = line + 1

    def end(self) -> bool:
        """Show the rest of the picture at once; returns False if none was coming in."""
        was_on, done = self.is_on, self._done
        # It has ended even if the display is lost.
        self._done = len(self._words)
        if was_on:
            self._display.send(instructions.write_image(self._words[done:], top=done))
        return was_on
