"""RunningHost: the host of a running display, which can be stopped, and the instructions it has sent.

What moves the cursors beside the instructions, such as the joystick, is kept with the states of the replay.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Final

import numpy as np

from ramtek_emu.arrays import Words
from ramtek_emu.display import Ramtek9300
from ramtek_emu.host.server import HOST_SECONDS, HostSession, Record
from ramtek_emu.inspection.replay import Replay
from ramtek_emu.inspection.stream import Stream
from ramtek_emu.instruction_set.instruction import NO_WORDS
from ramtek_emu.memory.cursors import Cursors

PIECE_SECONDS: Final = 0.006
"""How long a tick prepares states, searches, or executes the words of a host."""
MOST_BYTES: Final = 1 << 28
"""Limit: the bytes of the instructions of a running display, and of the states to go back to."""


class RunningHost:
    """The host of a running display, which a session may stop."""

    def __init__(self, display: Ramtek9300, also: Record | None = None) -> None:
        """Follow the host of a display; `also` records its instructions, too."""
        self.display = display
        self.session = HostSession(display, self.record)
        """The session of the hosts; a server's own session takes its place."""
        self._also = also
        self.step: Callable[[float], bool] = lambda _: False
        """Executes a piece of a host's words, as far as the session allows.

        It waits up to so many seconds for words, and returns whether it has done anything.
        """
        self.obey: Callable[[], object] = lambda: None
        """Moves the joystick or presses RESET, if lines of text ask for it."""
        self.is_connected: Callable[[], bool] = lambda: False
        """Whether a host is connected, so that its words are worth waiting for."""
        self.replay = Replay(Stream(display.configuration), display)
        """The instructions that the display has executed.

        When they and their states take MOST_BYTES, another replay begins with the display as it is.
        """
        self._cursors, self._resets = cursor_states(display.cursors), display.resets
        """The cursors and switches after the last instruction, and the number of resets."""
        self._has_moved = False
        """Whether the joystick has moved cursors since the last state, which no instruction repeats."""

    def record(self, data: bytes) -> None:
        """Note the bytes of whole instructions that the display has executed."""
        if self._also is not None:
            self._also(data)
        words = np.frombuffer(data, "<u2").astype(np.uint16)
        if self.session.is_within:
            # The display has begun another instruction, so that its state cannot be kept.
            self.replay.stream.append(words)
            return
        self._note(words)
        stream = self.replay.stream
        if stream.words.nbytes + stream.ends.nbytes + self.replay.state_bytes > MOST_BYTES:
            self.replay = Replay(Stream(self.display.configuration), self.display)

    def _note(self, words: Words) -> None:
        """Note instructions, and the state of the display after them if no instruction leads to it."""
        # RESET also hides the cursors, which the recorded instruction does not.
        has_moved = self._has_moved or self.display.resets != self._resets
        self.replay.note(words, self.display, has_moved)
        self._has_moved, self._resets = False, self.display.resets

    def serve(self, instructions: int | None) -> None:
        """Execute the host's words for some milliseconds: at most so many instructions; None for all.

        With 0 only replies are sent.
        """
        self.obey()
        self._has_moved |= cursor_states(self.display.cursors) != self._cursors
        if self._has_moved and not self.session.is_within:
            self._note(NO_WORDS)
        self.session.allowed = instructions
        end = time.monotonic() + PIECE_SECONDS
        is_done = not self.step(HOST_SECONDS if instructions != 0 and self.is_connected() else 0.0)
        while not is_done and self.session.allowed != 0 and time.monotonic() < end:
            is_done = not self.step(0.0)
        self._cursors = cursor_states(self.display.cursors)


def cursor_states(cursors: Cursors) -> tuple[object, ...]:
    """The places and states of all cursors, and the switches, to compare."""
    places = [(cursor.element, cursor.line, cursor.state, cursor.enter) for cursor in cursors.all]
    return *places, cursors.track, cursors.enter_is_pressed
