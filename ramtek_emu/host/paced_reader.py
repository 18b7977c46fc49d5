"""PacedReader: a recorded stream at the pace of a host that loads the table so many times a second.

What is modeled: no more than the pace of the host. A stream tells no time: what a host sent over a minute is
executed in a moment, and an animation of table loads would be over at once. What is **not**: how long any
other instruction takes; see `timing` for that.

Hardware: none: no source gives the rate of fields, or of transfers (NCAR waits for the vertical retrace
before each load, so that at most one came to a field).
"""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable, Iterator
from typing import Final, NamedTuple

import numpy as np

from ramtek_emu.configuration import Configuration
from ramtek_emu.instruction_set.decoder import Decoder
from ramtek_emu.instruction_set.instruction import encode

LOAD: Final = "LAM"

Read = Callable[[int], bytes]


class _Piece(NamedTuple):
    """Some bytes of a stream; the last of them may end a load of the table, and hold no other load."""

    data: bytes
    ends_a_load: bool


class PacedReader:
    """A function that reads a stream, like the one it is given, and waits before each load of the table.

    It is to be called by a thread that may wait, such as that of a `PolledPipe`.
    """

    def __init__(
        self,
        read: Read,
        loads_per_second: int,
        configuration: Configuration,
        clock: Callable[[], float] = time.monotonic,
        sleep: Callable[[float], object] = time.sleep,
    ) -> None:
        self._read = read
        self._seconds = 1 / loads_per_second
        self._decoder = Decoder(configuration)
        self._clock = clock
        self._sleep = sleep
        self._pieces: deque[_Piece] = deque()
        self._odd_byte = b""
        self._due = clock()

    def __call__(self, most: int) -> bytes:
        """At most so many bytes of the stream, none at its end; the end of a load when it is due."""
        if not self._pieces:
            data = self._read(most)
            if not data:
                return data
            self._pieces.extend(self._pieces_of(data))
        piece = self._pieces.popleft()
        if piece.ends_a_load:
            self._wait()
        return piece.data

    def _wait(self) -> None:
        """Wait until the next load is due; one that comes too late does not hurry those after it."""
        now = self._clock()
        if now < self._due:
            self._sleep(self._due - now)
        self._due = max(self._due, now) + self._seconds

    def _pieces_of(self, data: bytes) -> Iterator[_Piece]:
        """The bytes, cut after each load."""
        # A word may have begun in the bytes before, and an instruction in the words before.
        odd = len(self._odd_byte)
        whole = self._odd_byte + data
        self._odd_byte = whole[len(whole) & ~1 :]
        words = np.frombuffer(whole, "<u2", len(whole) // 2).astype(np.uint16, copy=False)
        begun, end = 0, -2 * self._decoder.held_words - odd
        for instruction in self._decoder.feed(words):
            end += 2 * len(encode(instruction))
            if instruction.format.name == LOAD:
                yield _Piece(data[begun:end], ends_a_load=True)
                begun = end
        if begun < len(data):
            yield _Piece(data[begun:], ends_a_load=False)
