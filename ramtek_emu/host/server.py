"""Server: a display behind a TCP port, for one host at a time.

What is modeled: the host interface as a stream of words, low byte first, both ways. What is **not**: the
UNIBUS registers and their interrupts.

No call blocks longer than its argument allows, so that a window can be drawn in between: `step` reads what
has arrived, sends what can be sent, and returns. When a host leaves, its unfinished instruction and its
unread replies are dropped, the memories keep their state, and the next host can connect. The connection of a
second host is closed at once.

Limits: a host is disconnected if nothing is sent or received for `idle_seconds`, or if an instruction stays
incomplete for `partial_seconds`. While REPLY_BYTES of replies wait for the host, nothing more is read from
it.
"""

from __future__ import annotations

import selectors
import socket
import time
from collections.abc import Iterator
from types import TracebackType
from typing import Final

from ramtek_emu.display import Ramtek9300
from ramtek_emu.errors import PortError
from ramtek_emu.host.host_session import HostSession, Record

LOOPBACK: Final = "127.0.0.1"
IDLE_SECONDS: Final = 600.0
PARTIAL_SECONDS: Final = 60.0
READ_BYTES: Final = 1 << 16
REPLY_BYTES: Final = 1 << 18
"""When this many bytes of replies wait for the host, no more of its words are read."""


class Server:
    """A TCP server with one display. `port` is the port it listens on, even if 0 asked for any free one."""

    def __init__(
        self,
        display: Ramtek9300,
        port: int = 0,
        host: str = LOOPBACK,
        *,
        idle_seconds: float = IDLE_SECONDS,
        partial_seconds: float = PARTIAL_SECONDS,
        record: Record | None = None,
    ) -> None:
        """Start to listen; `record` is called with the bytes of whole instructions, host after host."""
        self.display = display
        self.record = record
        self.idle_seconds = idle_seconds
        self.partial_seconds = partial_seconds
        self.served = 0
        """How many hosts were served and have left; it never decreases."""
        self.refused = 0
        """How many hosts were refused because another was connected; it never decreases."""
        try:
            family = socket.AF_INET6 if ":" in host else socket.AF_INET
            self._listener = socket.create_server((host, port), family=family, backlog=4)
        except (OSError, OverflowError, UnicodeError) as cause:
            reason = (getattr(cause, "strerror", None) or str(cause)).lower()
            raise PortError(
                f"a server must have a port to itself, and {host}:{port} cannot be had ({reason}); "
                "choose another, or 0 for any"
            ) from cause
        self._listener.setblocking(False)
        self.host = host
        self.port: int = self._listener.getsockname()[1]
        self._selector = selectors.DefaultSelector()
        self._selector.register(self._listener, selectors.EVENT_READ)
        self._client: Client | None = None

    @property
    def address(self) -> str:
        """The address that a host passes to TcpPort."""
        return f"tcp://{f'[{self.host}]' if ':' in self.host else self.host}:{self.port}"

    @property
    def busy(self) -> bool:
        """Whether a host is connected."""
        return self._client is not None

    def step(self, seconds: float = 0.0) -> bool:
        """Serve what has arrived, waiting up to `seconds` for it; returns whether anything was done."""
        client = self._client
        if client is not None:
            left = max(0.0, client.deadline - time.monotonic())
            seconds = 0.0 if client.has_work else min(seconds, left)
            self._selector.modify(client.socket, client.wanted or selectors.EVENT_WRITE)
        done = False
        for key, events in self._selector.select(seconds):
            if key.fileobj is self._listener:
                self._accept()
                done = True
            elif client is not None:
                done |= client.serve(events)
        if client is not None:
            done |= client.work()
            if client.ended or time.monotonic() >= client.deadline:
                self._disconnect()
                done = True
        return done

    def serve_for(self, seconds: float) -> None:
        """Serve, without blocking, until nothing is left to do or the time is over; for a window's ticks."""
        end = time.monotonic() + seconds
        while self.step() and time.monotonic() < end:
            pass

    def close(self) -> None:
        """Disconnect the host and stop listening."""
        self._disconnect()
        self._selector.close()
        self._listener.close()

    def __enter__(self) -> Server:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, place: TracebackType | None
    ) -> None:
        self.close()

    def _accept(self) -> None:
        try:
            connection, _ = self._listener.accept()
        except OSError:
            # The caller has disconnected already.
            return
        if self._client is not None:
            self.refused += 1
            connection.close()
            return
        connection.setblocking(False)
        connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        connection.setsockopt(socket.SOL_SOCKET, socket.SO_KEEPALIVE, 1)
        session = HostSession(self.display, self.record)
        self._client = Client(connection, session, self.idle_seconds, self.partial_seconds)
        self._selector.register(connection, selectors.EVENT_READ)

    def _disconnect(self) -> None:
        if self._client is not None:
            self._selector.unregister(self._client.socket)
            self._client.leave()
            self._client = None
            self.served += 1


class Client:
    """The connected host: its connection, its words and the replies to be sent."""

    def __init__(
        self, connection: socket.socket, session: HostSession, idle_seconds: float, partial_seconds: float
    ) -> None:
        self.socket = connection
        self.session = session
        self.idle_seconds, self.partial_seconds = idle_seconds, partial_seconds
        self.gone = False
        self.sent_all = False
        self._replies = bytearray()
        self._pending: Iterator[bytes] | None = None
        self._moved = self._whole = time.monotonic()

    @property
    def has_work(self) -> bool:
        """Whether words of the host can be passed to the display now."""
        return self._pending is not None and len(self._replies) < REPLY_BYTES

    @property
    def wanted(self) -> int:
        """The events of the connection that can be handled now."""
        reading = self._pending is None and not self.sent_all and len(self._replies) < REPLY_BYTES
        return (selectors.EVENT_READ if reading else 0) | (selectors.EVENT_WRITE if self._replies else 0)

    @property
    def ended(self) -> bool:
        """Whether nothing remains to be done for this host."""
        return self.gone or (self.sent_all and self._pending is None and not self._replies)

    @property
    def deadline(self) -> float:
        """When the host is disconnected if nothing happens."""
        idle = self._moved + self.idle_seconds
        return min(idle, self._whole + self.partial_seconds) if self.session.unfinished else idle

    def serve(self, events: int) -> bool:
        """Read or write what the connection is ready for; returns whether any byte moved."""
        moved = False
        try:
            if events & selectors.EVENT_WRITE and self._replies:
                del self._replies[: self.socket.send(self._replies)]
                moved = True
            if events & selectors.EVENT_READ:
                data = self.socket.recv(READ_BYTES)
                if not self.session.unfinished:
                    self._whole = time.monotonic()
                self.sent_all = not data
                self._pending = self.session.feed(data) if data else None
                moved = True
        except BlockingIOError:
            pass
        except OSError:
            self.gone = True
        if moved:
            self._moved = time.monotonic()
        return moved

    def work(self) -> bool:
        """Pass one piece of the host's words to the display; returns whether there was one."""
        if not self.has_work or self._pending is None:
            return False
        reply = next(self._pending, None)
        if reply is None:
            self._pending = None
        else:
            self._replies += reply
        if not self.session.unfinished:
            self._whole = time.monotonic()
        return True

    def leave(self) -> None:
        """Close the connection and drop what is unfinished."""
        self._pending = None
        self.session.leave()
        self.socket.close()
