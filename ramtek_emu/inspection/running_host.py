"""RunningHost: the host of a running display, which can be paused, and a replay of what it has sent.

What moves the cursors beside the instructions, such as the joystick, is kept with the states of the replay.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Final

import numpy as np

from ramtek_emu.display import Ramtek9300
from ramtek_emu.host.server import HOST_SECONDS, Record, Server
from ramtek_emu.inspection.replay import Replay
from ramtek_emu.inspection.stream import Stream
from ramtek_emu.memory.cursors import Cursors

PIECE_SECONDS: Final = 0.006
"""How long a tick prepares states, searches, or executes the words of a host."""
MOST_BYTES: Final = 1 << 28
"""Limit: the bytes of the instructions of a running display, and of the states to go back to."""


def replay_from(display: Ramtek9300) -> Replay:
    """A replay without instructions that begins with a display as it is."""
    return Replay(Stream(display.configuration), display)


def recording_into(replay: Replay, also: Record | None = None) -> Record:
    """A function that appends the bytes of whole instructions to a replay; `also` records them, too."""

    def record(data: bytes) -> None:
        if also is not None:
            also(data)
        replay.append(np.frombuffer(data, "<u2").astype(np.uint16))

    return record


class RunningHost:
    """The host of a running display, and the replay that its session records into."""

    def __init__(self, server: Server, replay: Replay, obey: Callable[[], object] = lambda: None) -> None:
        """Serve the hosts of a server; `obey` moves the joystick or presses RESET if lines ask for it."""
        self.display, self.replay = server.session.display, replay
        self._server, self._session, self._obey = server, server.session, obey
        self._cursors = cursor_states(self.display.cursors)
        """The cursors and switches after the last instruction."""
        self._has_moved = False
        """Whether the cursors have moved since the last state, which no instruction repeats."""

    @property
    def is_connected(self) -> bool:
        """Whether a host is connected, so that its words are worth waiting for."""
        return self._server.busy

    def serve(self, is_paused: bool) -> None:
        """Execute the host's words for some milliseconds; if the host is paused, only send its replies."""
        self._session.is_stopped = is_paused
        self._obey()
        # RESET also hides the cursors, which the recorded instruction does not.
        self._has_moved |= cursor_states(self.display.cursors) != self._cursors
        self._note()
        end = time.monotonic() + PIECE_SECONDS
        wait = HOST_SECONDS if not is_paused and self.is_connected else 0.0
        while self._server.step(wait) and not is_paused and time.monotonic() < end:
            self._note()
            wait = 0.0
        self._note()
        self._cursors = cursor_states(self.display.cursors)

    def _note(self) -> None:
        """Keep the state of the display if it is between instructions, within the limit of memory."""
        if self._session.is_within:
            return
        self.replay.note(self.display, self._has_moved)
        self._has_moved = False
        stream = self.replay.stream
        if stream.words.nbytes + stream.ends.nbytes + self.replay.state_bytes > MOST_BYTES:
            self.replay.forget(self.display)


def cursor_states(cursors: Cursors) -> tuple[object, ...]:
    """The places and states of all cursors, and the switches, to compare."""
    places = [(cursor.element, cursor.line, cursor.state, cursor.enter) for cursor in cursors.all]
    return *places, cursors.track, cursors.enter_is_pressed
