"""UnixPort: a host port to a display at a Unix socket, such as `ramtek serve --unix` makes.

Each packet is rounded down to whole words alone. This port sends whole words only; `write` sends the bytes
of one write as a program of the time made it, whatever their number.
"""

from __future__ import annotations

import os
import socket
import time
from typing import Final

from ramtek_emu.errors import PortError, reason_of
from ramtek_emu.host.connection import PACKET_BYTES
from ramtek_emu.host.marks import Sign, read_packet, send_packet_mark
from ramtek_emu.host.socket_port import SocketPort, checked_timeout

RETRY_SECONDS: Final = 0.05


class UnixPort(SocketPort):
    """A host port to the display at a path; it waits in line and for the display as TcpPort does."""

    at_once = 1 << 16

    def __init__(self, path: str | os.PathLike[str], timeout: float = 30.0) -> None:
        address, timeout = os.fspath(path), checked_timeout(timeout)
        super().__init__(address, connected_socket(address, timeout), timeout)

    @property
    def socket(self) -> socket.socket:
        """The connected socket, for a relay that waits for other things as well."""
        return self._socket

    def write(self, data: bytes) -> None:
        """Send bytes as one write of at most 65,536 bytes; the display rounds it down to whole words.

        PortError if the connection is lost, or if the write is longer than that.
        """
        if len(data) > self.at_once:
            raise PortError(
                f"a write must be at most {self.at_once} bytes, not {len(data)}; divide it at an even place"
            )
        while data:
            readable, writable = self._wait(writing=True)
            if readable:
                self._take()
            if writable:
                with self._lost_as_port_error():
                    try:
                        self._socket.send(data)
                    except BlockingIOError:
                        continue
                    return

    def _read(self) -> bytes | Sign:
        return read_packet(self._socket, PACKET_BYTES)

    def _send_mark(self) -> None:
        send_packet_mark(self._socket)


def packet_socket() -> socket.socket:
    """A Unix socket that keeps the boundaries of writes; PortError where the system has none."""
    try:
        return socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    except (AttributeError, OSError) as cause:
        reason = (getattr(cause, "strerror", None) or "no SOCK_SEQPACKET").lower()
        raise PortError(
            "a system must have Unix sockets that keep the boundaries of writes, and this one does not "
            f"({reason}); use TCP or a pipe"
        ) from cause


def connected_socket(path: str, timeout: float) -> socket.socket:
    """A socket connected to the display at a path; PortError if it is not reached within the seconds."""
    deadline = time.monotonic() + timeout
    while True:
        connected = packet_socket()
        connected.setblocking(False)
        try:
            connected.connect(path)
        except (OSError, ValueError) as cause:
            connected.close()
            # The line is full: it does not wait by itself, as that of TCP does.
            if isinstance(cause, BlockingIOError) and time.monotonic() < deadline:
                time.sleep(RETRY_SECONDS)
                continue
            raise PortError(
                f"a display must listen at {path}, and it is not reached ({reason_of(cause)}); "
                f"start `ramtek serve --unix {path}`"
            ) from cause
        return connected
