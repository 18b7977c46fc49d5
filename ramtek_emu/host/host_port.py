"""HostPort: the two methods by which a host uses a display; and the ports to a file and over TCP.

Files hold streams in the byte order of the PDP-11 and the VAX, low byte first (Hardware: PRG, JPL, whose
programs hand the words of their memory to the interface as they are).
"""

from __future__ import annotations

import re
import selectors
import socket
from typing import BinaryIO, Final, NoReturn, Protocol

import numpy as np

from ramtek_emu.arrays import Words
from ramtek_emu.checks import checked_stream
from ramtek_emu.errors import PortError, ReplyError

ADDRESS: Final = re.compile(r"tcp://(?P<host>\[[0-9A-Fa-f:.%\w]+\]|[^\s:/\[\]@]+):(?P<port>[0-9]{1,5})")
SENT_AT_ONCE: Final = 1 << 18
"""Bytes handed to the socket at once."""


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


class TcpPort:
    """A host port to a display behind a TCP port, such as `ramtek serve` opens: `tcp://host:port`.

    Words are transferred low byte first. `receive` waits up to `timeout` seconds. While `send` is sending, it
    also takes what the display replies; otherwise both sides could wait for each other forever.
    """

    def __init__(self, address: str, timeout: float = 30.0) -> None:
        self.address = address
        self.timeout = timeout
        self._received = bytearray()
        host, port = host_and_port(address)
        try:
            self._socket = socket.create_connection((host, port), timeout)
        except (OSError, UnicodeError) as cause:
            raise PortError(
                f"a display must listen at {address}, and it is not reached ({_reason(cause)}); "
                "start `ramtek serve` there"
            ) from cause
        self._socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self._socket.setblocking(False)

    def __reduce__(self) -> NoReturn:
        raise TypeError(
            f"a connection must stay in its process, not be copied or pickled ({self.address}); "
            "open another TcpPort there"
        )

    def __repr__(self) -> str:
        return f"TcpPort({self.address}, {'closed' if self._socket.fileno() < 0 else 'open'})"

    def send(self, words: Words) -> None:
        """Send 16-bit words; PortError if the connection is lost."""
        data = memoryview(checked_stream(words).astype("<u2", copy=False).tobytes())
        while data:
            readable, writable = self._wait(writing=True)
            if readable:
                self._take()
            if writable:
                try:
                    data = data[self._socket.send(data[:SENT_AT_ONCE]) :]
                except BlockingIOError:
                    continue
                except OSError as cause:
                    raise self._gone(cause) from cause

    def receive(self, count: int) -> Words:
        """The next `count` words, uint16; ReplyError at the timeout, PortError if the connection is lost."""
        if count < 0:
            raise ReplyError(f"the words received must be 0 or more, not {count}; ask for fewer")
        while len(self._received) < 2 * count:
            readable, _ = self._wait(writing=False)
            if not readable:
                raise ReplyError(
                    f"the words received must come within {self.timeout:g} seconds, not {count} of which "
                    f"{len(self._received) // 2} came; send an instruction that reads them first"
                )
            self._take()
        words = np.frombuffer(bytes(self._received[: 2 * count]), "<u2").astype(np.uint16)
        del self._received[: 2 * count]
        return words

    def close(self) -> None:
        """Close the connection; the display is then free for another host."""
        self._socket.close()

    def __enter__(self) -> TcpPort:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

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
                "read its replies, or start it again"
            )
        events = ready[0][1] if ready else 0
        return bool(events & selectors.EVENT_READ), bool(events & selectors.EVENT_WRITE)

    def _take(self) -> None:
        try:
            data = self._socket.recv(SENT_AT_ONCE)
        except BlockingIOError:
            return
        except OSError as cause:
            raise self._gone(cause) from cause
        if not data:
            raise self._gone(None)
        self._received += data

    def _gone(self, cause: OSError | None) -> PortError:
        why = "it closed the connection: it serves one host at a time" if cause is None else _reason(cause)
        return PortError(f"a display must stay at {self.address}, and it left ({why}); connect again later")


def host_and_port(address: str) -> tuple[str, int]:
    """The host and the port of `tcp://host:port`; PortError if the address is not of that form.

    >>> host_and_port("tcp://127.0.0.1:9300"), host_and_port("tcp://[::1]:9300")
    (('127.0.0.1', 9300), ('::1', 9300))
    """
    found = ADDRESS.fullmatch(address)
    if found is None or not 1 <= int(found["port"]) <= 0xFFFF:
        raise PortError(
            f"an address must be tcp://host:port with a port from 1 to 65535, not {address!r}; write it so"
        )
    return found["host"].strip("[]"), int(found["port"])


def _reason(cause: Exception) -> str:
    return (getattr(cause, "strerror", None) or str(cause) or type(cause).__name__).lower()
