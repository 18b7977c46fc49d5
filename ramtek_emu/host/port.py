"""HostPort: the two methods by which a host uses a display; ports to a file and to a display elsewhere.

Words have 16 bits and are sent low byte first, in files and on wires (Hardware: PRG, JPL: their programs hand
the words of their memory to the interface unchanged).

A socket connects a host to a display in another process. TCP carries a stream of bytes. A Unix socket carries
packets; a packet is a write of the host.
"""

from __future__ import annotations

import os
import re
import selectors
import socket
import struct
import sys
import time
from contextlib import suppress
from types import TracebackType
from typing import BinaryIO, Final, Protocol, Self

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
    """A host port that writes all words to a file, and passes them on to another port if there is one."""

    def __init__(self, file: BinaryIO, port: HostPort | None = None) -> None:
        self._file = file
        self._port = port

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


PACKET_BYTES: Final = 1 << 19
"""The longest packet that is read whole. Limit: more than a socket's default buffer."""


def prepared(connected: socket.socket) -> socket.socket:
    """The socket, set not to wait and, with TCP, to send small pieces at once."""
    connected.setblocking(False)
    # A Unix socket has no such option, and on some systems no lost connection has it.
    with suppress(OSError):
        connected.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    return connected


def ready(connected: socket.socket, wanted: int, seconds: float) -> int:
    """The events of those wanted for which a socket is ready, waiting up to `seconds` for some."""
    if not wanted:
        return 0
    with selectors.DefaultSelector() as selector:
        selector.register(connected, wanted)
        found = selector.select(seconds)
    return found[0][1] if found else 0


def keeps_writes(connected: socket.socket) -> bool:
    """Whether bytes arrive in packets: a packet is a write of the other side."""
    return connected.type != socket.SOCK_STREAM


def read_socket(connected: socket.socket, most: int, flags: int = 0) -> bytes | None:
    """The next packet, or at most `most` bytes of a stream; b"" at the end, None if nothing has arrived."""
    with suppress(BlockingIOError):
        return connected.recv(PACKET_BYTES if keeps_writes(connected) else most, flags)
    return None


def write_socket(connected: socket.socket, data: bytes | memoryview) -> int:
    """Send as many bytes as the socket takes now; returns their number: for a packet, all or none."""
    with suppress(BlockingIOError):
        return connected.send(data)
    return 0


def break_off(connected: socket.socket) -> None:
    """Make closing a TCP connection look like a loss to the other side. It changes no Unix socket."""
    # On some systems, a lost connection accepts no options.
    with suppress(OSError):
        connected.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))


class SocketPort:
    """A host port over a connected socket; `timeout` is the longest wait for the display, in seconds.

    While `send` is sending, it also reads the replies of the display. Otherwise both sides could wait for
    each other forever.
    """

    at_once: int
    """The most bytes that are sent or read at once."""

    def __init__(self, address: str, connected: socket.socket, timeout: float) -> None:
        self.address = address
        self.timeout = timeout
        self.socket = prepared(connected)
        self._received = bytearray()

    def send(self, words: Words) -> None:
        """Send 16-bit words; PortError if the connection is lost."""
        self._send(checked_stream(words).astype("<u2", copy=False).tobytes())

    def receive(self, count: int) -> Words:
        """The next `count` words, uint16; ReplyError at the timeout, PortError if the connection is lost."""
        if not is_whole(count) or count < 0:
            raise ReplyError(
                f"the words received must be a whole number from 0 on, not {count!r}; "
                "ask for as many as an instruction replies"
            )
        deadline = time.monotonic() + self.timeout
        while len(self._received) < 2 * count:
            self._exchange(deadline)
            if time.monotonic() >= deadline and len(self._received) < 2 * count:
                raise ReplyError(
                    f"the words received must come within {self.timeout:g} seconds, not {count} of which "
                    f"{len(self._received) // 2} came; send an instruction that reads them first, "
                    "or wait until no other host is served"
                )
        words = np.frombuffer(bytes(self._received[: 2 * count]), "<u2").astype(np.uint16)
        del self._received[: 2 * count]
        return words

    def close(self) -> None:
        """End the session, and wait until the display has executed all words; then it can serve other hosts.

        Unread replies are dropped. PortError if the display turned this host away, was lost, or does not
        execute all words within `timeout` seconds.
        """
        if self.socket.fileno() < 0:
            return
        deadline = time.monotonic() + self.timeout
        with self.socket:
            # What has arrived may end with the display's refusal of this host.
            while ready(self.socket, selectors.EVENT_READ, 0) and time.monotonic() < deadline:
                self._exchange(deadline)
            try:
                self.socket.shutdown(socket.SHUT_WR)
                while (left := deadline - time.monotonic()) > 0 and ready(
                    self.socket, selectors.EVENT_READ, left
                ):
                    if read_socket(self.socket, self.at_once) == b"":
                        return
            except OSError as cause:
                raise self._gone(cause) from cause
        raise PortError(
            f"a display must execute all words within {self.timeout:g} seconds, and "
            f"{self.address} has not: it may be serving another host first; give a longer timeout"
        )

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, place: TracebackType | None
    ) -> None:
        if error is None:
            self.close()
        else:
            # The error that is being raised says more than an error of closing.
            self.socket.close()

    def _send(self, data: bytes) -> None:
        left, deadline = memoryview(data), time.monotonic() + self.timeout
        while left:
            if sent := self._exchange(deadline, left[: self.at_once]):
                left, deadline = left[sent:], time.monotonic() + self.timeout
            elif time.monotonic() >= deadline:
                raise PortError(
                    f"a display must take words within {self.timeout:g} seconds, and {self.address} does "
                    "not; read its replies, wait until no other host is served, or start it again"
                )

    def _exchange(self, deadline: float, data: bytes | memoryview = b"") -> int:
        """Wait until the display sends replies or takes bytes of the data, and return how many it took."""
        if self.socket.fileno() < 0:
            raise PortError(f"a port must be open, not closed ({self.address}); open it again")
        wanted = selectors.EVENT_READ | (selectors.EVENT_WRITE if data else 0)
        events = ready(self.socket, wanted, max(0.0, deadline - time.monotonic()))
        try:
            if events & selectors.EVENT_READ:
                replies = read_socket(self.socket, self.at_once)
                if replies == b"":
                    raise ConnectionError("it closed the connection")
                self._received += replies or b""
            return write_socket(self.socket, data) if events & selectors.EVENT_WRITE else 0
        except OSError as cause:
            raise self._gone(cause) from cause

    def _gone(self, cause: OSError) -> PortError:
        return PortError(
            f"a display must stay at {self.address}, and it left ({reason_of(cause)}); connect again later"
        )


class TcpPort(SocketPort):
    """A host port to the display at an `address`, `tcp://host:port`, such as `ramtek serve --port` opens.

    While the display serves another host, this host waits in line: its words are stored and executed when its
    turn comes. `receive` waits up to `timeout` seconds for replies, and `close` until the display has
    executed all words. A `with` block calls `close` at its end.
    """

    at_once = 1 << 18

    def __init__(self, address: str, timeout: float = 30.0) -> None:
        host, port = host_and_port(address)
        try:
            connected = socket.create_connection((host, port), timeout)
        except (OSError, ValueError, OverflowError) as cause:
            raise PortError(
                f"a display must listen at {address}, and it is not reached ({reason_of(cause)}); "
                "start `ramtek serve` there"
            ) from cause
        super().__init__(address, connected, timeout)


ADDRESS: Final = re.compile(r"(?i:tcp)://(?P<host>\[[0-9A-Fa-f:.%\w]+\]|[^\s:/\[\]@]+):(?P<port>[0-9]{1,5})")


def host_and_port(address: str) -> tuple[str, int]:
    """The host and the port of `tcp://host:port`; PortError if the address is not of that form.

    >>> host_and_port("tcp://127.0.0.1:9300"), host_and_port("TCP://[::1]:9300")
    (('127.0.0.1', 9300), ('::1', 9300))
    """
    parts = ADDRESS.fullmatch(address) if isinstance(address, str) else None
    if parts is None or not 1 <= int(parts["port"]) <= 0xFFFF:
        raise PortError(
            f"an address must be tcp://host:port with a port from 1 to 65535, not {address!r}; write it so"
        )
    return parts["host"].strip("[]"), int(parts["port"])


class UnixPort(SocketPort):
    """A host port to the display at a path, such as `ramtek serve --unix` makes.

    It waits in line, and up to `timeout` seconds for the display, as TcpPort does. The display rounds each
    packet down to whole words.
    """

    at_once = 1 << 16

    def __init__(self, path: str | os.PathLike[str], timeout: float = 30.0) -> None:
        address = os.fspath(path)
        super().__init__(address, connected_socket(address, timeout), timeout)

    def write(self, data: bytes) -> None:
        """Send bytes as one write of a program of the time: a last odd byte is dropped.

        More than 65,536 bytes are sent in several packets. PortError if the connection is lost.
        """
        self._send(data)


def packet_socket() -> socket.socket:
    """A Unix socket that keeps the boundaries of writes; PortError where the system has none."""
    try:
        if sys.platform != "win32":
            return socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        raise OSError("there are none")
    except (AttributeError, OSError) as cause:
        raise PortError(
            "a system must have Unix sockets that keep the boundaries of writes (SOCK_SEQPACKET), and this "
            "one does not; use TCP or a pipe"
        ) from cause


LISTEN_SECONDS: Final = 1.0
"""Limit: how long a host waits for a server that was just started and does not listen yet."""


def connected_socket(path: str, timeout: float) -> socket.socket:
    """A socket connected to the display at a path; PortError if it is not reached within the seconds."""
    begin = time.monotonic()
    while True:
        connected = packet_socket()
        connected.setblocking(False)
        try:
            connected.connect(path)
        except (OSError, ValueError) as cause:
            connected.close()
            # The line may be full: unlike TCP, a Unix socket does not wait for a place.
            waited = timeout if isinstance(cause, BlockingIOError) else min(timeout, LISTEN_SECONDS)
            may_listen = isinstance(cause, BlockingIOError | FileNotFoundError | ConnectionRefusedError)
            if may_listen and time.monotonic() < begin + waited:
                time.sleep(0.05)
                continue
            raise PortError(
                f"a display must listen at {path}, and it is not reached ({reason_of(cause)}); "
                f"start `ramtek serve --unix {path}`"
            ) from cause
        return connected
