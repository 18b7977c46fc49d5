"""A display on two pipes: a pipe for the words of the host, and a pipe for the replies.

`serve_pipe` blocks until the host sends something, as a command does. `PolledPipe` never blocks, so that a
window can be drawn in between: two threads read and write the pipes, and only the caller uses the display.
`PacedReader` reads a recorded stream at the pace of a host that loads the table at a given rate.
`stream_fields` are the fields of a recorded stream, for a film.

A host that stops reading its replies loses them, but its words are still executed (Assumed: a host that draws
and leaves wants its picture). The session ends with the input; an unfinished instruction and an odd last byte
are dropped.
"""

from __future__ import annotations

import itertools
import queue
import threading
import time
from collections.abc import Callable, Iterator

import numpy as np

from ramtek_emu.arrays import Colors
from ramtek_emu.configuration import Configuration
from ramtek_emu.host.server import READ_BYTES, HostSession
from ramtek_emu.instruction_set.decoder import Decoder
from ramtek_emu.instruction_set.table import FORMAT_OF_NAME

Read = Callable[[int], bytes]
Write = Callable[[bytes], object]


def serve_pipe(
    session: HostSession, read: Read, write: Write | None, ends: Callable[[], bool] = lambda: False
) -> None:
    """Execute the bytes that `read` returns until it returns none; pass replies to `write` at once.

    `read(most)` returns the available bytes, at most `most` of them. Without `write`, replies are dropped.
    When `ends()` is true, the rest of the words is not executed.
    """
    while data := read(READ_BYTES):
        for reply in session.feed(data):
            if ends():
                return
            if reply and write is not None:
                try:
                    write(reply)
                except ConnectionError:
                    # The host has closed its end.
                    write = None


class PolledPipe:
    """Serves pipes in slices of time; `ended` becomes true when the host has closed its end."""

    def __init__(self, session: HostSession, read: Read, write: Write | None = None) -> None:
        self.session = session
        self.ended = False
        self._data: queue.Queue[bytes] = queue.Queue(4)
        self._replies: queue.Queue[bytes] = queue.Queue(64)
        self._pending: Iterator[bytes] = iter(())
        self._reply = b""
        self._write = write
        # How many bytes were read, and how many of them were passed to the session.
        self._read_bytes = self._fed_bytes = 0
        threading.Thread(target=self._fill, args=(read,), daemon=True).start()
        if write is not None:
            threading.Thread(target=self._drain, daemon=True).start()

    @property
    def has_replied(self) -> bool:
        """Whether all replies were written, or the host no longer reads them."""
        return self._write is None or not (self._reply or self._replies.unfinished_tasks)

    @property
    def unexecuted(self) -> int:
        """The number of words that were read and are not executed."""
        return self.session.unexecuted + (self._read_bytes - self._fed_bytes) // 2

    def step(self) -> bool:
        """Execute a piece of words; returns False if none has arrived, or if the last reply must wait."""
        if self._reply:
            try:
                self._replies.put_nowait(self._reply)
            except queue.Full:
                return False
            self._reply = b""
        reply = next(self._pending, None)
        if reply is None:
            try:
                data = self._data.get_nowait()
            except queue.Empty:
                return False
            if not data:
                self.ended = True
                return False
            self._fed_bytes += len(data)
            self._pending = self.session.feed(data)
        elif self._write is not None:
            self._reply = reply
        return True

    def serve_for(self, seconds: float) -> None:
        """Serve for up to `seconds`, or until no work is left, without blocking."""
        end = time.monotonic() + seconds
        while not self.ended and self.step() and time.monotonic() < end:
            pass

    def _fill(self, read: Read) -> None:
        data = b"-"
        while data:
            try:
                data = read(READ_BYTES)
            except (OSError, ValueError):
                data = b""
            self._read_bytes += len(data)
            self._data.put(data)

    def _drain(self) -> None:
        write = self._write
        while True:
            reply = self._replies.get()
            if write is not None:
                try:
                    write(reply)
                except (OSError, ValueError):
                    write = None
            self._replies.task_done()


class CutReader:
    """The pieces of a stream, which is cut after the instructions that `is_cut` chooses.

    `is_cut` is called with the opcode of each instruction, in order. A row of illegal words is an
    instruction, as in a listing; it ends where the reads of the stream cut it.
    """

    def __init__(self, read: Read, configuration: Configuration, is_cut: Callable[[int], bool]) -> None:
        self.waiting = 0
        """The number of bytes that were read and not yielded."""
        self._read = read
        self._is_cut = is_cut
        self._decoder = Decoder(configuration)

    def __iter__(self) -> Iterator[tuple[bytes, bool]]:
        """Yields the bytes of each piece, and whether it ends with a chosen instruction."""
        odd_byte = b""
        while data := self._read(READ_BYTES):
            # A word may have begun in the bytes before, and an instruction in the words before.
            whole, odd, begun = odd_byte + data, len(odd_byte), 0
            odd_byte = whole[len(whole) & ~1 :]
            for words in self._decoder.split(np.frombuffer(whole, "<u2", len(whole) // 2).astype(np.uint16)):
                if not self._decoder.is_within_row and self._is_cut(words.item(0) >> 8):
                    end = 2 * self._decoder.used - odd
                    self.waiting = len(data) - end
                    yield data[begun:end], True
                    begun = end
            if begun < len(data):
                self.waiting = 0
                yield data[begun:], False


def is_load(opcode: int) -> bool:
    """Whether an instruction loads the lookup table."""
    return opcode == FORMAT_OF_NAME["LAM"].opcode


def every(count: int) -> Callable[[int], bool]:
    """A function that returns True at every `count`-th call."""
    numbers = itertools.count(1)
    return lambda _: next(numbers) % count == 0


class PacedReader:
    """Reads a stream as the given `read` does, but waits before every load of the lookup table.

    What is modeled: only the pace of the host. A stream has no times: words that a host sent during a minute
    are executed in a moment, and an animation of table loads would be over at once. What is **not**: the
    time of any other instruction; see `timing`.

    Hardware: none: no source gives the rate of fields, or of transfers (NCAR waits for the vertical retrace
    before a load, so a field had at most one load).

    Call it from a thread that may block, such as `PolledPipe`'s.
    """

    def __init__(
        self,
        read: Read,
        loads_per_second: int,
        configuration: Configuration,
        clock: Callable[[], float] = time.monotonic,
        sleep: Callable[[float], object] = time.sleep,
    ) -> None:
        self._pieces = iter(CutReader(read, configuration, is_load))
        self._seconds = 1 / loads_per_second
        self._clock = clock
        self._sleep = sleep
        self._due = clock()

    def __call__(self, _: int) -> bytes:
        """The next bytes of the stream, none at its end. Waits until a load is due.

        After a late load, the next load still waits its full time.
        """
        data, ends_in_load = next(self._pieces, (b"", False))
        if ends_in_load:
            now = self._clock()
            if now < self._due:
                self._sleep(self._due - now)
            self._due = max(self._due, now) + self._seconds
        return data


def stream_fields(
    session: HostSession, read: CutReader, ends: Callable[[], bool] = lambda: False
) -> Iterator[Colors]:
    """The fields of a stream after each cut, (lines, elements, 3) uint8, and at its end, if it changed.

    The stream is executed when fields are taken. When `ends()` is true, the rest of the words is not
    executed. Replies are dropped.
    """
    last: Colors | None = None
    for data, is_cut in read:
        if any(ends() for _ in session.feed(data)):
            break
        if is_cut:
            last = session.display.field()
            yield last
    field = session.display.field()
    if last is None or not np.array_equal(field, last):
        yield field
