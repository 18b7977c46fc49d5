"""RunningHost: the host of a running display, which can be paused, and a replay of what it has sent.

What moves the cursors beside the instructions, such as the joystick, is kept with the states of the replay.
"""

from __future__ import annotations

import pickle
import time
from collections.abc import Callable
from typing import Final

import numpy as np

from ramtek_emu.host.server import HOST_SECONDS, Server
from ramtek_emu.inspection.replay import Replay
from ramtek_emu.inspection.stream import Stream

PIECE_SECONDS: Final = 0.006
"""How long a tick prepares states, searches, or executes the words of a host."""
MOST_BYTES: Final = 1 << 28
"""Limit: the bytes of the instructions of a running display, and of the states to go back to."""


class RunningHost:
    """The host of a running display, and the replay that its session records into.

    The replay begins with the display as it is, without instructions. When it takes MOST_BYTES, another one
    takes its place.
    """

    def __init__(self, server: Server, obey: Callable[[], object] = lambda: None) -> None:
        """Serve the hosts of a server; `obey` moves the joystick or presses RESET if lines ask for it."""
        self.server, self._session, self._obey = server, server.session, obey
        self.display = server.session.display
        self.replay = Replay(Stream(self.display.configuration), self.display)
        self._also, server.session.record = server.session.record, self._record
        self._cursors = pickle.dumps(self.display.cursors.state())
        """The cursors and switches after the last instruction."""
        self._has_moved = False
        """Whether the cursors have moved since the last state, which no instruction repeats."""

    def _record(self, data: bytes) -> None:
        """Append the bytes of whole instructions to the replay, and to the recording of the session."""
        if self._also is not None:
            self._also(data)
        self.replay.append(np.frombuffer(data, "<u2").astype(np.uint16))

    def serve(self, is_paused: bool) -> None:
        """Execute the host's words for some milliseconds; if the host is paused, only send its replies."""
        self._session.is_stopped = is_paused
        self._obey()
        # RESET also hides the cursors, which the recorded instruction does not.
        self._has_moved |= pickle.dumps(self.display.cursors.state()) != self._cursors
        self._note()
        end = time.monotonic() + PIECE_SECONDS
        wait = HOST_SECONDS if not is_paused and self.server.busy else 0.0
        while self.server.step(wait) and not is_paused and time.monotonic() < end:
            self._note()
            wait = 0.0
        self._note()
        self._cursors = pickle.dumps(self.display.cursors.state())

    def _note(self) -> None:
        """Keep the state of the display if it is between instructions, within the limit of memory."""
        if self._session.is_within:
            return
        self.replay.note(self.display, self._has_moved)
        self._has_moved = False
        stream = self.replay.stream
        if stream.words.nbytes + stream.ends.nbytes + self.replay.state_bytes > MOST_BYTES:
            self.replay = Replay(Stream(self.display.configuration), self.display)
