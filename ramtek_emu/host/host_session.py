"""HostSession: bytes of a host into a display, bytes of its replies back; the same for a socket and a pipe.

What is modeled: words low byte first both ways (Hardware: PRG, JPL, V8K: the words of a PDP-11's or a VAX's
memory as they are); an instruction cut anywhere; replies as soon as they exist and in order; whole words: of
an odd number of bytes the last is dropped at the end (Hardware: PRG DRIVER.c, V8K round down).

Words are handed to the display in pieces. A piece that may ask for replies is short, so that no more than
MOST_WAITING words ever wait: what a host sends next is not read before its replies are taken. A piece after
one that took long is short too, so that whoever serves in between other work, a window, gets back to it.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from typing import Final

import numpy as np

from ramtek_emu.arrays import Booleans, Words
from ramtek_emu.display import Ramtek9300
from ramtek_emu.instruction_set.instruction import NO_WORDS
from ramtek_emu.instruction_set.table import FORMATS

Record = Callable[[bytes], object]

LEAST: Final = 4
PIECE: Final = 1 << 15
"""Words handed to the display at once, at least and at most."""
LONG: Final = 0.004
SHORT: Final = 0.001
"""Seconds from which a piece was long, and up to which it was short."""
ASKING_PIECE: Final = 64
"""Words at once where some may be instructions that reply: at most 32, each with at most 32,767 words."""
REPLY_PIECE: Final = 1 << 15
"""Words of a reply handed on at once."""


def asking() -> Booleans:
    """For each of the 256 opcodes, whether it makes the display reply."""
    opcodes = np.zeros(256, np.bool_)
    opcodes[[format.opcode for format in FORMATS if format.replies]] = True
    return opcodes


class HostSession:
    """One host at a display; when it leaves, what it left unfinished is forgotten, and memory stays."""

    def __init__(self, display: Ramtek9300, record: Record | None = None) -> None:
        """Begin; `record` is given the bytes of whole instructions, in order."""
        self.display = display
        self._record = record
        self._unrecorded = NO_WORDS
        self.words = 0
        """Words taken from the host; it only grows."""
        self.odd_byte = b""
        """The first half of a word whose other half has not come."""
        self._asking = asking()
        self._size = ASKING_PIECE
        self.leave()

    @property
    def held_words(self) -> int:
        """Words of an instruction that is not complete."""
        return self.display.decoder.held_words

    @property
    def unfinished(self) -> bool:
        """Whether a word or an instruction waits for its rest."""
        return bool(self.odd_byte) or self.held_words > 0

    def feed(self, data: bytes) -> Iterator[bytes]:
        """Hand bytes of the host to the display, piece by piece; after each, the replies that it made.

        Nothing happens until the iterator is asked; whoever does not take a reply stops the host's words.
        """
        data = self.odd_byte + data
        self.odd_byte = data[len(data) & ~1 :]
        words = np.frombuffer(data, "<u2", len(data) // 2).astype(np.uint16, copy=False)
        most = ASKING_PIECE if self._asking[words >> 8].any() else PIECE
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
        """Record the words of the instructions that are whole now."""
        if self._record is not None:
            words = np.concatenate((self._unrecorded, piece))
            whole = len(words) - self.held_words
            self._record(words[:whole].astype("<u2", copy=False).tobytes())
            self._unrecorded = words[whole:]

    def leave(self) -> None:
        """Forget the unfinished instruction, the odd byte and the replies that nobody took."""
        self.odd_byte = b""
        self._unrecorded = NO_WORDS
        self.display.decoder.clear()
        self.display.receive(self.display.processor.waiting)
