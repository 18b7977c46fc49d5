"""HostSession: passes the bytes of a host to a display and those of the replies back, for sockets and pipes.

What is modeled: words low byte first both ways (Hardware: PRG, JPL, V8K: the words of a PDP-11's or a VAX's
memory as they are); instructions cut anywhere; replies in order and as soon as they exist; whole words: an
odd byte at the end is dropped (Hardware: PRG DRIVER.c, V8K round down).

The words are passed on in pieces. A piece that may contain reading instructions is short, so that no more
than MOST_WAITING words of replies ever wait; the next piece is read when those replies were taken. A piece is
also short if the last one took long, so that a window that is served in between stays responsive.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from typing import Final

import numpy as np

from ramtek_emu import instructions
from ramtek_emu.arrays import Booleans, Words
from ramtek_emu.display import Ramtek9300
from ramtek_emu.instruction_set.instruction import NO_WORDS
from ramtek_emu.instruction_set.table import FORMATS

Record = Callable[[bytes], object]

LEAST: Final = 4
PIECE: Final = 1 << 15
"""The smallest and the largest number of words passed to the display at once."""
LONG: Final = 0.004
SHORT: Final = 0.001
"""Seconds: a piece that took longer than LONG makes the next one shorter, one below SHORT makes it longer."""
READING_PIECE: Final = 64
"""The size of a piece that may contain reading instructions: at most 32, each with at most 32,767 words."""
REPLY_PIECE: Final = 1 << 15
"""The largest number of words of replies returned at once."""


def replying() -> Booleans:
    """Whether each of the 256 opcodes makes the display reply."""
    opcodes = np.zeros(256, np.bool_)
    opcodes[[format.opcode for format in FORMATS if format.replies]] = True
    return opcodes


class HostSession:
    """One host at a display. When it leaves, its unfinished words are dropped and the memories are kept."""

    def __init__(self, display: Ramtek9300, record: Record | None = None) -> None:
        """Begin a session; `record` is called with the bytes of whole instructions, in order."""
        self.display = display
        self._record = record
        self._unrecorded = NO_WORDS
        self.words = 0
        """How many words the host has sent; it never decreases."""
        self.odd_byte = b""
        """The first byte of a word whose second byte has not arrived."""
        self._replies = replying()
        self._size = READING_PIECE
        self.leave()

    @property
    def held_words(self) -> int:
        """How many words of an incomplete instruction are held."""
        return self.display.decoder.held_words

    @property
    def unfinished(self) -> bool:
        """Whether a word or an instruction is incomplete."""
        return bool(self.odd_byte) or self.held_words > 0

    def feed(self, data: bytes) -> Iterator[bytes]:
        """Pass bytes of the host to the display, piece by piece, and yield the replies to each piece.

        The work is done while the iterator is consumed: the next piece waits until all replies were taken.
        """
        data = self.odd_byte + data
        self.odd_byte = data[len(data) & ~1 :]
        words = np.frombuffer(data, "<u2", len(data) // 2).astype(np.uint16, copy=False)
        most = READING_PIECE if self._replies[words >> 8].any() else PIECE
        place = 0
        while place < len(words):
            piece = words[place : place + min(self._size, most)]
            place += len(piece)
            begin = time.perf_counter()
            self.display.send(piece)
            took = time.perf_counter() - begin
            if took > LONG:
                self._size = max(LEAST, self._size // 8)
            elif took < SHORT:
                self._size = min(PIECE, 2 * self._size)
            self.words += len(piece)
            self._keep(piece)
            yield b""
            while waiting := self.display.processor.waiting:
                yield self.display.receive(min(waiting, REPLY_PIECE)).astype("<u2", copy=False).tobytes()

    def _keep(self, piece: Words) -> None:
        """Record the words of the instructions that are complete now."""
        if self._record is not None:
            words = np.concatenate((self._unrecorded, piece))
            whole = len(words) - self.held_words
            self._record(words[:whole].astype("<u2", copy=False).tobytes())
            self._unrecorded = words[whole:]

    def reset(self) -> None:
        """Reset the display; what is recorded resets it at the same place.

        The incomplete instruction and the replies that were not taken are dropped; the odd byte stays, since
        the stream of bytes goes on.
        """
        self._unrecorded = NO_WORDS
        self.display.reset()
        if self._record is not None:
            self._record(instructions.reset().astype("<u2", copy=False).tobytes())

    def leave(self) -> None:
        """Drop the incomplete instruction, the odd byte and the replies that were not taken."""
        self.odd_byte = b""
        self._unrecorded = NO_WORDS
        self.display.decoder.clear()
        self.display.receive(self.display.processor.waiting)
