"""HostPort: the two methods by which a host uses a display; and the port to a file.

Files hold streams in the byte order of the PDP-11 and the VAX, low byte first (Hardware: PRG, JPL, whose
programs hand the words of their memory to the interface as they are).
"""

from __future__ import annotations

import os
import re
import select
import selectors
import socket
import struct
import time
from abc import ABC, abstractmethod
from collections import deque
from contextlib import suppress
from enum import Enum
from types import TracebackType
from typing import BinaryIO, Final, NoReturn, Protocol, TypeVar

import numpy as np

from ramtek_emu.arrays import Words
from ramtek_emu.checks import checked_stream, is_whole
from ramtek_emu.errors import PortError, ReplyError, reason_of


class HostPort(Protocol):
    """Takes the words of a host, and returns the replies; `Ramtek9300` is a host port."""

    def send(self, words: Words) -> None:
        """Send 16-bit words; an instruction may be spread over several calls."""

    def receive(self, count: int) -> Words:
        """The next `count` words of the replies, uint16; ReplyError if there are fewer."""
        ...


class Recorder:
    """A host port that writes all words to a file, and passes them on to another port if one is given."""

    def __init__(self, file: BinaryIO, port: HostPort | None = None) -> None:
        self._file = file
        self._port = port

    def __repr__(self) -> str:
        file = getattr(self._file, "name", type(self._file).__name__)
        return f"Recorder({file}{'' if self._port is None else f', {self._port!r}'})"

    def send(self, words: Words) -> None:
        """Write the words to the file, low byte first, and pass them on."""
        stream = checked_stream(words)
        self._file.write(stream.astype("<u2", copy=False).tobytes())
        if self._port is not None:
            self._port.send(stream)

    def receive(self, count: int) -> Words:
        """The words that the other port returns; ReplyError if there is no other port."""
        if self._port is None:
            raise ReplyError(
                f"a recording must have a display behind it to give words, not none ({count} asked); "
                "give Recorder a port"
            )
        return self._port.receive(count)


# -------------------- marks
# Marks: signs between the words of a connection, by which a host asks for a hard reset and is answered.
#
# On TCP a mark is a byte of urgent data, which is no part of the words; on a Unix socket it is an empty
# packet. A host sends one to ask for a hard reset, and the display sends one back when it is done: replies
# that arrive before it are those of before.
#
# Hardware: PRG DRIVER.c (the RESET bit of the interface's command register, a hard reset). Assumed: a mark
# stands for that bit, since a wire has no register beside the words; it takes effect after the words that
# were sent before it.

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


# -------------------- connection
# Connections of a host, as the display sees them: a stream of bytes (TCP), or packets (Unix).
#
# What is modeled: a write of odd length is rounded down to whole words (Hardware: PRG DRIVER.c, V8K).
# Packets have the boundaries of the host's writes, so each is rounded down alone. A stream has none: there,
# only the odd byte at the end of the session is dropped.
#
# No call waits: BlockingIOError tells that nothing can be done now, any other OSError that the host is
# lost.

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


# -------------------- socket_port
# SocketPort: what a host's ports over TCP and over a Unix socket have in common.
#
# While `send` is sending, it also takes what the display replies; otherwise both sides could wait for each
# other forever.

HURRIED: Final = 1.0
"""Seconds that closing waits for the display's end while an error is under way."""
MOST_SECONDS: Final = 1_000_000
"""The longest timeout; what the system waits for at once is not much more."""

Self = TypeVar("Self", bound="SocketPort")


class SocketPort(ABC):
    """A host port over a connected socket; `timeout` is how long it waits for the display, in seconds."""

    at_once: int
    """Bytes handed to the socket at once."""

    def __init__(self, address: str, connected: socket.socket, timeout: float) -> None:
        self.address = address
        self.timeout = timeout
        self._received = bytearray()
        self._mark_is_due = False
        """Whether a reset was asked for and not answered yet; what is received until then is dropped."""
        self._socket = connected
        connected.setblocking(False)

    def __reduce__(self) -> NoReturn:
        raise TypeError(
            f"a connection must stay in its process, not be copied or pickled ({self.address}); "
            f"open another {type(self).__name__} there"
        )

    def __repr__(self) -> str:
        state = "closed" if self._socket.fileno() < 0 else "open"
        return f"{type(self).__name__}({self.address}, {state})"

    def send(self, words: Words) -> None:
        """Send 16-bit words; PortError if the connection is lost."""
        data = memoryview(checked_stream(words).astype("<u2", copy=False).tobytes())
        while data:
            readable, writable = self._wait(writing=True)
            if readable:
                self._take()
            if writable:
                with self._lost_as_port_error(), suppress(BlockingIOError):
                    data = data[self._socket.send(data[: self.at_once]) :]

    def receive(self, count: int) -> Words:
        """The next `count` words, uint16; ReplyError at the timeout, PortError if the connection is lost."""
        if not is_whole(count) or count < 0:
            raise ReplyError(
                f"the words received must be a whole number from 0 on, not {count!r}; "
                "ask for as many as an instruction replies"
            )
        while self._mark_is_due or len(self._received) < 2 * count:
            readable, _ = self._wait(writing=False)
            if not readable:
                raise ReplyError(
                    f"the words received must come within {self.timeout:g} seconds, not {count} of which "
                    f"{len(self._received) // 2} came; send an instruction that reads them first, "
                    "or wait until no other host is served"
                )
            self._take()
        words = np.frombuffer(bytes(self._received[: 2 * count]), "<u2").astype(np.uint16)
        del self._received[: 2 * count]
        return words

    def reset(self) -> None:
        """Ask for a hard reset, and wait until it is done; all words sent before are executed first.

        An unfinished instruction and all replies that were not received are dropped; parameters, screen,
        cursors and status are reset; table and characters stay. PortError if it is not done in time. How it
        is asked for is told in `marks`.
        """
        asked = False
        while self._mark_is_due or not asked:
            # A reset that was given up is answered first: two marks at once would be one.
            readable, writable = self._wait(writing=not self._mark_is_due)
            if writable:
                with self._lost_as_port_error(), suppress(BlockingIOError):
                    self._send_mark()
                    asked = self._mark_is_due = True
            if readable:
                self._take()
            elif not writable:
                raise PortError(
                    f"a display must reset within {self.timeout:g} seconds, and {self.address} does not; "
                    "wait until no other host is served, or start it again"
                )

    def close(self) -> None:
        """End the session, and wait until the display has executed everything; it is then free for others.

        Replies that were not received are dropped. PortError if the display turned this host away, was lost,
        or does not get to the end within `timeout` seconds.
        """
        self._close(self.timeout)

    def __enter__(self: Self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, place: TracebackType | None
    ) -> None:
        if error is None:
            self.close()
        else:
            # The error under way tells more than the one of closing.
            with suppress(PortError):
                self._close(min(self.timeout, HURRIED))

    def _close(self, seconds: float) -> None:
        if self._socket.fileno() < 0:
            return
        try:
            self._end(time.monotonic() + seconds, seconds)
        finally:
            self._socket.close()

    def _end(self, deadline: float, seconds: float) -> None:
        """End our side, and read until the display ends its own; PortError if it ended first, or does not."""
        with suppress(BlockingIOError), self._lost_as_port_error():
            while (data := self._read()) is not Sign.END:
                if time.monotonic() >= deadline:
                    break
            if data is Sign.END:
                raise self._gone(None)
        with self._lost_as_port_error():
            self._socket.shutdown(socket.SHUT_WR)
        while (left := deadline - time.monotonic()) > 0:
            with selectors.DefaultSelector() as selector:
                selector.register(self._socket, selectors.EVENT_READ)
                selector.select(left)
            with suppress(BlockingIOError), self._lost_as_port_error():
                if self._read() is Sign.END:
                    return
        raise PortError(
            f"a display must get to the end of what it was sent within {seconds:g} seconds, and "
            f"{self.address} has not: it may be serving another host first; give a longer timeout"
        )

    def _wait(self, writing: bool) -> tuple[bool, bool]:
        """Wait until the socket is ready; returns whether it can be read, and whether it can be written."""
        if self._socket.fileno() < 0:
            raise PortError(f"a port must be open, not closed ({self.address}); open it again")
        with selectors.DefaultSelector() as selector:
            wanted = selectors.EVENT_READ | (selectors.EVENT_WRITE if writing else 0)
            selector.register(self._socket, wanted)
            ready = selector.select(self.timeout)
        if writing and not ready:
            raise PortError(
                f"a display must take words within {self.timeout:g} seconds, and {self.address} does not; "
                "read its replies, wait until no other host is served, or start it again"
            )
        events = ready[0][1] if ready else 0
        return bool(events & selectors.EVENT_READ), bool(events & selectors.EVENT_WRITE)

    def _take(self) -> None:
        """Keep the replies that have arrived; at a mark, drop those that precede it."""
        with suppress(BlockingIOError), self._lost_as_port_error():
            data = self._read()
            if data is Sign.END:
                raise self._gone(None)
            if data is Sign.MARK:
                self._received.clear()
                self._mark_is_due = False
            else:
                self._received += data

    @abstractmethod
    def _read(self) -> bytes | Sign:
        """The next replies, or a sign; BlockingIOError if there is neither."""

    @abstractmethod
    def _send_mark(self) -> None:
        """Send a mark; BlockingIOError if it cannot be sent now."""

    def _lost_as_port_error(self) -> LostAsPortError:
        return LostAsPortError(self)

    def _gone(self, cause: OSError | None) -> PortError:
        why = "it closed the connection" if cause is None else reason_of(cause)
        return PortError(f"a display must stay at {self.address}, and it left ({why}); connect again later")


def checked_timeout(seconds: object) -> float:
    """How long a port waits, as a float; PortError if it is no time in seconds."""
    if not isinstance(seconds, int | float) or isinstance(seconds, bool) or not 0 < seconds <= MOST_SECONDS:
        raise PortError(
            f"a timeout must be a number of seconds from 0 to {MOST_SECONDS:,}, not {seconds!r}; "
            "choose another"
        )
    return float(seconds)


class LostAsPortError:
    """A `with` block in which a lost connection is raised as PortError."""

    def __init__(self, port: SocketPort) -> None:
        self._port = port

    def __enter__(self) -> None:
        pass

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, place: TracebackType | None
    ) -> None:
        if isinstance(error, OSError) and not isinstance(error, (BlockingIOError, PortError)):
            raise self._port._gone(error) from error


# -------------------- tcp_port
# TcpPort: a host port to a display behind a TCP port, such as `ramtek serve --port` opens.

ADDRESS: Final = re.compile(r"(?i:tcp)://(?P<host>\[[0-9A-Fa-f:.%\w]+\]|[^\s:/\[\]@]+):(?P<port>[0-9]{1,5})")


class TcpPort(SocketPort):
    """A host port to the display at `tcp://host:port`.

    Words are transferred low byte first. If the display serves another host, this one waits in line: what it
    sends is kept and executed when its turn comes. `receive` waits up to `timeout` seconds, and so does
    `close`, which a `with` block calls at its end: until the display has executed everything.
    """

    at_once = 1 << 18

    def __init__(self, address: str, timeout: float = 30.0) -> None:
        host, port = host_and_port(address)
        timeout = checked_timeout(timeout)
        try:
            connected = socket.create_connection((host, port), timeout)
        except (OSError, UnicodeError) as cause:
            raise PortError(
                f"a display must listen at {address}, and it is not reached ({reason_of(cause)}); "
                "start `ramtek serve` there"
            ) from cause
        connected.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        expect_marks(connected)
        super().__init__(address, connected, timeout)

    def _read(self) -> bytes | Sign:
        return read_stream(self._socket, self.at_once)

    def _send_mark(self) -> None:
        if not marks_are_known():
            raise PortError(
                "a hard reset over TCP must be asked for on Linux, and this is another system; "
                "use the joystick unit of `ramtek serve --joystick`"
            )
        send_stream_mark(self._socket)


def host_and_port(address: str) -> tuple[str, int]:
    """The host and the port of `tcp://host:port`; PortError if the address is not of that form.

    >>> host_and_port("tcp://127.0.0.1:9300"), host_and_port("TCP://[::1]:9300")
    (('127.0.0.1', 9300), ('::1', 9300))
    """
    found = ADDRESS.fullmatch(address) if isinstance(address, str) else None
    if found is None or not 1 <= int(found["port"]) <= 0xFFFF:
        raise PortError(
            f"an address must be tcp://host:port with a port from 1 to 65535, not {address!r}; write it so"
        )
    return found["host"].strip("[]"), int(found["port"])


# -------------------- unix_port
# UnixPort: a host port to a display at a Unix socket, such as `ramtek serve --unix` makes.
#
# Each packet is rounded down to whole words alone. This port sends whole words only; `write` sends the
# bytes of one write as a program of the time made it, whatever their number.

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
