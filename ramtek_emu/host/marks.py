"""Marks: signs between the words of a connection, by which a host asks for a hard reset and is answered.

On TCP a mark is a byte of urgent data, which is no part of the words; on a Unix socket it is an empty packet.
A host sends one to ask for a hard reset, and the display sends one back when it is done: replies that arrive
before it are those of before.

Hardware: PRG DRIVER.c (the RESET bit of the interface's command register, a hard reset).
Assumed: a mark stands for that bit, since a wire has no register beside the words; it takes effect after the
words that were sent before it.
"""

from __future__ import annotations

import select
import socket
import struct
from enum import Enum
from typing import Final

MARK_BYTE: Final = b"\0"
NUMBER: Final = struct.Struct("i")
SIOCATMARK: Final = 0x8905
"""The request that tells whether the next byte is urgent (Linux: asm-generic/sockios.h)."""


class Sign(Enum):
    """What a connection holds besides words."""

    END = "the other side has sent everything"
    MARK = "a mark"


def expect_marks(connected: socket.socket) -> None:
    """Keep the urgent bytes of a TCP connection at their places among the others."""
    connected.setsockopt(socket.SOL_SOCKET, socket.SO_OOBINLINE, 1)


def marks_are_known() -> bool:
    """Whether this system tells where the urgent byte of a connection is."""
    return hasattr(select, "epoll")


def read_stream(connected: socket.socket, most: int) -> bytes | Sign:
    """The next bytes of a TCP connection, at most `most`, or a sign; OSError if there are none or it is lost.

    Reading stops before an urgent byte, so that what follows it is never mixed with what precedes it.
    """
    if _number(connected, SIOCATMARK):
        connected.recv(1)
        return Sign.MARK
    return connected.recv(most) or Sign.END


def send_stream_mark(connected: socket.socket) -> None:
    """Send a mark on a TCP connection; BlockingIOError if it cannot be sent now."""
    connected.send(MARK_BYTE, socket.MSG_OOB)


def read_packet(connected: socket.socket, most: int) -> bytes | Sign:
    """The next packet of a Unix connection, cut after `most` bytes, or a sign; OSError as `read_stream`."""
    packet = connected.recv(most)
    if packet or not marks_are_known():
        return packet or Sign.END
    from termios import FIONREAD

    # An empty packet and the end read alike; at the end the other side has hung up and nothing waits.
    asked = select.poll()
    asked.register(connected, select.POLLRDHUP)
    return Sign.END if asked.poll(0) and not _number(connected, FIONREAD) else Sign.MARK


def send_packet_mark(connected: socket.socket) -> None:
    """Send a mark on a Unix connection; BlockingIOError if it cannot be sent now."""
    connected.send(b"")


def _number(connected: socket.socket, request: int) -> int:
    """What the system answers to a request about a connection; 0 where there are no such requests."""
    if not marks_are_known():
        return 0
    from fcntl import ioctl

    number: int
    (number,) = NUMBER.unpack(ioctl(connected, request, NUMBER.pack(0)))
    return number
