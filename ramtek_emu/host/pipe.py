"""A display on two pipes: a pipe for the words of the host, and a pipe for the replies.

`PipeServer` serves the host as other servers do. `paced` reads a recorded stream at the pace of a host that
loads the table at a given rate. `stream_fields` are the fields of a recorded stream, for a film.

The session ends with the input; an unfinished instruction and an odd last byte are dropped.
"""

from __future__ import annotations

import itertools
import math
import socket
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import suppress

import numpy as np

from ramtek_emu.arrays import Colors
from ramtek_emu.configuration import Configuration
from ramtek_emu.display import Ramtek9300
from ramtek_emu.host.server import READ_BYTES, Client, HostSession, Record, Server
from ramtek_emu.instruction_set.decoder import Decoder
from ramtek_emu.instruction_set.table import FORMAT_OF_NAME

Read = Callable[[int], bytes]
"""A function that waits for bytes, and returns at most so many; none at the end."""
Write = Callable[[bytes], object]
"""A function that writes all of the bytes; ConnectionError if the pipe has no reader."""


class PipeServer(Server):
    """A display that serves a single host, which is connected by two pipes.

    `serve` waits for the host, as a command does. `step` does not, as with other servers: two threads copy
    the bytes of the pipes to a socket and from it, and the display serves the other end of the socket.
    Without `write`, replies are dropped.
    """

    def __init__(
        self, display: Ramtek9300, read: Read, write: Write = lambda _: None, record: Record | None = None
    ) -> None:
        super().__init__(display, None, "", math.inf, record)
        self._read, self._write = read, write

    def serve(self, ends: Callable[[], bool]) -> None:
        """Execute the host's words until it leaves or `ends()` is true, and write the replies at once."""
        while data := self._read(READ_BYTES):
            for reply in self.session.feed(data):
                if ends():
                    return
                with suppress(ConnectionError):
                    self._write(reply)

    def finish(self, ends: Callable[[], bool]) -> None:
        """Wait until the replies to a host that has left are written, or until `ends()` is true."""
        while not ends() and self._replying.is_alive():
            self._replying.join(0.1)

    def _accept(self, seconds: float) -> bool:
        if self.served:
            return False
        served, self._copied = socket.socketpair()
        self._client = Client(served, self.session, self.idle_seconds)
        self._replying = threading.Thread(target=self._copy_replies, daemon=True)
        self._replying.start()
        threading.Thread(target=self._copy_words, daemon=True).start()
        return True

    def _leave(self) -> None:
        """Leave the unfinished instruction and the odd byte in the session, so that they can be reported."""

    def _copy_words(self) -> None:
        with suppress(OSError):
            while data := self._read(READ_BYTES):
                self._copied.sendall(data)
            self._copied.shutdown(socket.SHUT_WR)

    def _copy_replies(self) -> None:
        with self._copied, suppress(OSError):
            while data := self._copied.recv(READ_BYTES):
                # The words of a host that cannot take its replies are still executed.
                with suppress(OSError):
                    self._write(data)


def stream_pieces(
    read: Read, configuration: Configuration, is_cut: Callable[[int], bool]
) -> Iterator[tuple[bytes, bool]]:
    """The pieces of a stream, which is cut after the instructions that `is_cut` chooses.

    Yields the bytes of each piece, and whether it ends with a chosen instruction. `is_cut` is called with the
    opcode of each instruction, in order. A row of illegal words is an instruction, as in a listing; it ends
    where the reads of the stream cut it.
    """
    decoder, odd_byte = Decoder(configuration), b""
    while data := read(READ_BYTES):
        # A word may have begun in the bytes before, and an instruction in the words before.
        whole, odd, begun = odd_byte + data, len(odd_byte), 0
        odd_byte = whole[len(whole) & ~1 :]
        for words in decoder.split(np.frombuffer(whole, "<u2", len(whole) // 2).astype(np.uint16)):
            if not decoder.is_within_row and is_cut(words.item(0) >> 8):
                end = 2 * decoder.used - odd
                yield data[begun:end], True
                begun = end
        if begun < len(data):
            yield data[begun:], False


def is_load(opcode: int) -> bool:
    """Whether an instruction loads the lookup table."""
    return opcode == FORMAT_OF_NAME["LAM"].opcode


def every(count: int) -> Callable[[int], bool]:
    """A function that returns True at every `count`-th call."""
    numbers = itertools.count(1)
    return lambda _: next(numbers) % count == 0


def paced(read: Read, loads_per_second: int, configuration: Configuration) -> Read:
    """A function that reads as `read` does, but waits before every load of the lookup table.

    Each call returns a piece of the stream. After a late load, the next load still waits its full time.

    What is modeled: only the pace of the host. A stream has no times: words that a host sent during a minute
    are executed in a moment, and an animation of table loads would be over at once. What is **not**: the
    time of any other instruction; see `timing`.

    Hardware: none: no source gives the rate of fields, or of transfers (NCAR waits for the vertical retrace
    before a load, so a field had at most one load).
    """

    def waited_for() -> Iterator[bytes]:
        due = time.monotonic()
        for data, ends_in_load in stream_pieces(read, configuration, is_load):
            if ends_in_load:
                time.sleep(max(0.0, due - time.monotonic()))
                due = max(due, time.monotonic()) + 1 / loads_per_second
            yield data

    left = waited_for()
    return lambda _: next(left, b"")


def stream_fields(
    session: HostSession, cut: Iterator[tuple[bytes, bool]], ends: Callable[[], bool] = lambda: False
) -> Iterator[Colors]:
    """The fields of a stream after each cut, (lines, elements, 3) uint8, and at its end, if it changed.

    `cut` are its `stream_pieces`. The stream is executed when fields are taken. When `ends()` is true, the
    rest of the words is not executed. Replies are dropped.
    """
    last: Colors | None = None
    for data, is_cut in cut:
        if any(ends() for _ in session.feed(data)):
            break
        if is_cut:
            last = session.display.field()
            yield last
    field = session.display.field()
    if last is None or not np.array_equal(field, last):
        yield field
