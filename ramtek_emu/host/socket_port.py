"""SocketPort: what a host's ports over TCP and over a Unix socket have in common.

While `send` is sending, it also takes what the display replies; otherwise both sides could wait for each
other forever.
"""

from __future__ import annotations

import selectors
import socket
import time
from abc import ABC, abstractmethod
from contextlib import suppress
from types import TracebackType
from typing import Final, NoReturn, TypeVar

import numpy as np

from ramtek_emu.arrays import Words
from ramtek_emu.checks import checked_stream, is_whole
from ramtek_emu.errors import PortError, ReplyError, reason_of
from ramtek_emu.host.marks import Sign

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
