"""Client: the host that a server serves now, with its words, its replies and its time limits.

A host that no longer takes its replies loses them, but its words are still executed, as on a pipe.
"""

from __future__ import annotations

import selectors
import time
from collections.abc import Iterator
from typing import Final

from ramtek_emu.host.connection import StreamConnection
from ramtek_emu.host.host_session import HostSession
from ramtek_emu.host.marks import Sign

REPLY_BYTES: Final = 1 << 18
"""When this many bytes of replies wait for the host, no more of its words are read."""


class Client:
    """The connected host: its connection, its words and the replies to be sent."""

    def __init__(
        self,
        connection: StreamConnection,
        session: HostSession,
        idle_seconds: float,
        partial_seconds: float,
    ) -> None:
        self.connection = connection
        self.socket = connection.socket
        self.session = session
        self.idle_seconds, self.partial_seconds = idle_seconds, partial_seconds
        self.gone = False
        self.sent_all = False
        self._takes_replies = True
        self._pending: Iterator[bytes] | None = None
        self._moved = self._whole = time.monotonic()

    @property
    def has_work(self) -> bool:
        """Whether words of the host can be passed to the display now."""
        return self._pending is not None and self.connection.waiting < REPLY_BYTES

    @property
    def wanted(self) -> int:
        """The events of the connection that can be handled now."""
        reading = self._pending is None and not self.sent_all and self.connection.waiting < REPLY_BYTES
        writing = self.connection.has_to_send
        return (selectors.EVENT_READ if reading else 0) | (selectors.EVENT_WRITE if writing else 0)

    @property
    def ended(self) -> bool:
        """Whether nothing remains to be done for this host."""
        return self.gone or (self.sent_all and self._pending is None and not self.connection.has_to_send)

    @property
    def deadline(self) -> float:
        """When the host is disconnected if nothing happens."""
        idle = self._moved + self.idle_seconds
        return min(idle, self._whole + self.partial_seconds) if self.session.unfinished else idle

    def serve(self, events: int) -> bool:
        """Read or write what the connection is ready for; returns whether anything moved."""
        moved = False
        if events & selectors.EVENT_WRITE and self.connection.has_to_send:
            moved = self._send()
        if events & selectors.EVENT_READ:
            moved |= self._read()
        if moved:
            self._moved = time.monotonic()
        return moved

    def _send(self) -> bool:
        try:
            self.connection.send()
        except BlockingIOError:
            return False
        except OSError:
            self._takes_replies = False
            self.connection.drop()
        return True

    def _read(self) -> bool:
        try:
            data = self.connection.read()
        except BlockingIOError:
            return False
        except OSError:
            self.gone = True
            return False
        if not self.session.unfinished:
            self._whole = time.monotonic()
        if data is Sign.END:
            self.sent_all = True
        elif data is Sign.MARK:
            self.session.leave()
            self.session.reset()
            self.connection.answer_mark()
        else:
            self._pending = self.session.feed(data)
        return True

    def work(self) -> bool:
        """Pass one piece of the host's words to the display; returns whether there was one."""
        if not self.has_work or self._pending is None:
            return False
        begin = time.monotonic()
        reply = next(self._pending, None)
        # The clocks of the host stand still while it is the display that takes its time.
        took = time.monotonic() - begin
        self._moved, self._whole = self._moved + took, self._whole + took
        if reply is None:
            self._pending = None
        elif self._takes_replies:
            self.connection.reply(reply)
        if not self.session.unfinished:
            self._whole = time.monotonic()
        return True

    def leave(self) -> None:
        """Close the connection and drop what is unfinished."""
        if self._pending is not None:
            self.connection.break_off()
        self._pending = None
        self.session.leave()
        self.socket.close()
