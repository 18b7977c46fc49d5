"""Server: a display behind a listening socket, for one host after the other.

What is modeled: the host interface as a stream of words, low byte first, both ways. What is **not**: the
UNIBUS registers and their interrupts.

No call blocks longer than its argument allows, so that a window can be drawn in between: `step` reads what
has arrived, sends what can be sent, and returns. When a host leaves, all its words are executed first; then
its unfinished instruction and its unread replies are dropped, the memories keep their state, and the next
host is served. Hosts that connect meanwhile wait in line: the system keeps the connections of 128 of them
with what they have sent, and others try again until they find a place.

Limits: a host is disconnected if nothing is sent or received for `idle_seconds`, or if an instruction stays
incomplete for `partial_seconds`. The clock of a host starts when its turn comes, so that one that waits loses
nothing, and one that is silent holds up the line for `idle_seconds` at most. While REPLY_BYTES of replies
wait for the host, nothing more is read from it.
"""

from __future__ import annotations

import selectors
import socket
import time
from collections.abc import Callable
from types import TracebackType
from typing import Final, TypeVar

from ramtek_emu.display import Ramtek9300
from ramtek_emu.host.client import Client
from ramtek_emu.host.connection import StreamConnection
from ramtek_emu.host.host_session import HostSession, Record

IDLE_SECONDS: Final = 600.0
PARTIAL_SECONDS: Final = 60.0
LINE: Final = 128
"""How many hosts can wait in line."""

Self = TypeVar("Self", bound="Server")


class Server:
    """A display that serves the hosts of a listening socket."""

    def __init__(
        self,
        display: Ramtek9300,
        listener: socket.socket,
        connection: Callable[[socket.socket], StreamConnection],
        *,
        idle_seconds: float = IDLE_SECONDS,
        partial_seconds: float = PARTIAL_SECONDS,
        record: Record | None = None,
    ) -> None:
        """Start to serve; `record` is called with the bytes of whole instructions, host after host."""
        self.display = display
        self.record = record
        self.idle_seconds = idle_seconds
        self.partial_seconds = partial_seconds
        self.served = 0
        """How many hosts were served and have left; it never decreases."""
        self._connection = connection
        self._listener = listener
        self._listener.setblocking(False)
        self._selector = selectors.DefaultSelector()
        self._selector.register(self._listener, selectors.EVENT_READ)
        self._client: Client | None = None

    @property
    def busy(self) -> bool:
        """Whether a host is being served."""
        return self._client is not None

    def step(self, seconds: float = 0.0) -> bool:
        """Serve what has arrived, waiting up to `seconds` for it; returns whether anything was done."""
        client = self._client
        if client is None:
            return bool(self._selector.select(seconds)) and self._accept()
        left = max(0.0, client.deadline - time.monotonic())
        seconds = 0.0 if client.has_work else min(seconds, left)
        self._selector.modify(client.socket, client.wanted or selectors.EVENT_WRITE)
        done = False
        for _, events in self._selector.select(seconds):
            done |= client.serve(events)
        done |= client.work()
        if client.ended or time.monotonic() >= client.deadline:
            self._disconnect()
            done = True
        return done

    def serve_for(self, seconds: float, wait: float = 0.0) -> None:
        """Serve until nothing is left to do or the time is over; for a window's ticks.

        It blocks only while a host is connected, and up to `wait` seconds, for the first words.
        """
        end = time.monotonic() + seconds
        done = self.step(wait if self.busy else 0.0)
        while done and time.monotonic() < end:
            done = self.step()

    def reset(self) -> None:
        """Press RESET on the control unit: an unfinished instruction is dropped, the host stays connected."""
        client = self._client
        (HostSession(self.display, self.record) if client is None else client.session).reset()

    def close(self) -> None:
        """Disconnect the host and stop listening; hosts that wait in line are turned away."""
        self._disconnect()
        self._selector.close()
        self._listener.close()

    def __enter__(self: Self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, place: TracebackType | None
    ) -> None:
        self.close()

    def _accept(self) -> bool:
        try:
            connected, _ = self._listener.accept()
        except OSError:
            # The caller has disconnected already.
            return False
        try:
            connection = self._connection(connected)
        except OSError:
            connected.close()
            return True
        session = HostSession(self.display, self.record)
        self._client = Client(connection, session, self.idle_seconds, self.partial_seconds)
        # While this host is served, the others wait in the listener's line.
        self._selector.unregister(self._listener)
        self._selector.register(connected, selectors.EVENT_READ)
        return True

    def _disconnect(self) -> None:
        if self._client is not None:
            self._selector.unregister(self._client.socket)
            self._client.leave()
            self._client = None
            self._selector.register(self._listener, selectors.EVENT_READ)
            self.served += 1
