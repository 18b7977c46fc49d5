"""Connections of a host, as the display sees them: a stream of bytes (TCP), or packets (Unix).

What is modeled: a write of odd length is rounded down to whole words (Hardware: PRG DRIVER.c, V8K). Packets
have the boundaries of the host's writes, so each is rounded down alone. A stream has none: there, only the
odd byte at the end of the session is dropped.

No call waits: BlockingIOError tells that nothing can be done now, any other OSError that the host is lost.
"""

from __future__ import annotations

import socket
import struct
from collections import deque
from contextlib import suppress
from typing import Final

from ramtek_emu.host.marks import (
    Sign,
    expect_marks,
    read_packet,
    read_stream,
    send_packet_mark,
    send_stream_mark,
)

READ_BYTES: Final = 1 << 16
PACKET_BYTES: Final = 1 << 19
"""The largest packet that is taken whole; more than the system lets a socket hold unless it is told to."""

AT_ONCE: Final = struct.pack("ii", 1, 0)
"""The value of SO_LINGER with which closing resets a connection."""


class StreamConnection:
    """A TCP connection. `waiting` is how many bytes of replies are still to be sent."""

    def __init__(self, connected: socket.socket) -> None:
        self.socket = connected
        self.waiting = 0
        self._replies: deque[bytes] = deque()
        self._mark_is_due = False
        connected.setblocking(False)
        self._prepare()

    def _prepare(self) -> None:
        self.socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_KEEPALIVE, 1)
        expect_marks(self.socket)

    @property
    def has_to_send(self) -> bool:
        """Whether something is still to be sent."""
        return self._mark_is_due or self.waiting > 0

    def read(self) -> bytes | Sign:
        """The next words of the host, low byte first, or a sign."""
        return read_stream(self.socket, READ_BYTES)

    def reply(self, data: bytes) -> None:
        """Keep a reply until it can be sent."""
        if data:
            self._replies.append(data)
            self.waiting += len(data)

    def answer_mark(self) -> None:
        """Drop the replies that wait, and keep a mark until it can be sent."""
        self.drop()
        self._mark_is_due = True

    def drop(self) -> None:
        """Drop all that is still to be sent."""
        self._replies.clear()
        self.waiting = 0
        self._mark_is_due = False

    def break_off(self) -> None:
        """Let the end of the connection look like a loss, since not all of the host's words were executed."""
        # On some systems, a connection that is lost already takes no options.
        with suppress(OSError):
            self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, AT_ONCE)

    def send(self) -> None:
        """Send one piece of what waits."""
        if self._mark_is_due:
            self._send_mark()
            self._mark_is_due = False
        elif self._replies:
            sent = self.socket.send(self._replies[0])
            self.waiting -= sent
            left = self._replies.popleft()[sent:]
            if left:
                self._replies.appendleft(left)

    def _send_mark(self) -> None:
        send_stream_mark(self.socket)


class PacketConnection(StreamConnection):
    """A Unix connection of packets. The replies to different writes are in different packets."""

    def _prepare(self) -> None:
        """Do nothing: the options are those of TCP."""

    def read(self) -> bytes | Sign:
        """The words of the next packet, low byte first, without its odd byte; or a sign."""
        packet = read_packet(self.socket, PACKET_BYTES)
        return packet if isinstance(packet, Sign) else packet[: len(packet) & ~1]

    def break_off(self) -> None:
        """Do nothing: a Unix socket has only one kind of end, unless the host's words were not even read."""

    def _send_mark(self) -> None:
        send_packet_mark(self.socket)
