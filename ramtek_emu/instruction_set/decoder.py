"""Decoder: splits a continuous stream of words into instructions, wherever the stream is cut.

An instruction may span two sends, and one send may hold many instructions (Hardware: PRG, DRIVER.c cuts its
transfers every 512 bytes). The words of an incomplete instruction are kept until the rest of it arrives.

Assumed: a word whose opcode is in no row of the table, or that asks for a second operand flag word on a
display without one, is skipped alone and flagged as illegal; the next word is read as an instruction. The
sources know the status bit but not how the hardware finds its way again.

Assumed: conic coefficients are twelve words, as the only client sends them. The six words of the header's
comment are taken only where twelve make no sense: in a WC with data, if the word that is the data length
after six coefficients would be the upper half of a coefficient with twelve, and is 4, the length of a point.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import lru_cache
from typing import Final

import numpy as np

from ramtek_emu.arrays import Booleans, Words
from ramtek_emu.configuration import GMR_9300, Configuration
from ramtek_emu.instruction_set.instruction import NO_WORDS, Instruction
from ramtek_emu.instruction_set.table import (
    FORMATS,
    ILLEGAL,
    OPERANDS,
    Flags,
    InstructionFormat,
    operands_named,
)

MOST_HEAD: Final = 64
"""An upper bound on the words of an instruction before its data."""
CONIC: Final = 1 << list(OPERANDS).index("conic")
"""The bit of the conic coefficients in the first operand flag word."""
MOST_WORDS: Final = MOST_HEAD + 0x8000
"""An upper bound on the words of an instruction."""


class Decoder:
    """Takes words as they arrive and returns whole instructions; words of an incomplete instruction wait."""

    def __init__(self, configuration: Configuration = GMR_9300) -> None:
        self._set_up(configuration.extended)

    def _set_up(self, extended: bool) -> None:
        self._extended = extended
        self._formats = formats_of_opcodes(extended)
        self._begins = words_that_begin(extended)
        self._pending: Words = np.empty(MOST_WORDS, np.uint16)
        self._count = 0
        self._needed = 1
        self.used = 0
        """How many words of the last `feed` belong to the instructions that it has yielded."""

    def __getstate__(self) -> tuple[bool, Words, int]:
        return self._extended, self._pending[: self._count].copy(), self._needed

    def __setstate__(self, state: tuple[bool, Words, int]) -> None:
        self._set_up(state[0])
        self._count, self._needed = len(state[1]), state[2]
        self._pending[: self._count] = state[1]

    def __repr__(self) -> str:
        return f"Decoder(words pending: {self._count})"

    @property
    def pending_words(self) -> int:
        """How many words of an incomplete instruction have arrived."""
        return self._count

    def clear(self) -> None:
        """Drop the words of an incomplete instruction."""
        self._count, self._needed = 0, 1

    def feed(self, words: Words, in_rows: bool = False) -> Iterator[Instruction]:
        """The instructions that these words complete, in order; their data are views where possible.

        An illegal word becomes an instruction with the format ILLEGAL. With `in_rows=True`, consecutive
        illegal words become the data of a single instruction.
        """
        place = self.used = 0
        while self._count and place < len(words):
            taken = min(self._needed - self._count, len(words) - place)
            self._pending[self._count : self._count + taken] = words[place : place + taken]
            self._count += taken
            place += taken
            if self._count < self._needed:
                return
            head = self._pending[: min(self._count, MOST_HEAD)].tolist()
            format = self._format(head[0])
            self._needed = words_needed(format, head)
            if self._needed == self._count:
                whole = self._pending[: self._count].copy()
                self.clear()
                self.used = place
                yield instruction_of(format, head, whole)
        while place < len(words):
            head = words[place : place + MOST_HEAD].tolist()
            format = self._format(head[0])
            if in_rows and format is ILLEGAL:
                row = self._illegal_row(words, place)
                self.used = place = place + row
                yield Instruction(ILLEGAL, 0, {}, None, words[place - row : place])
                continue
            needed = words_needed(format, head)
            if needed > len(words) - place:
                # Keep the words of an incomplete instruction.
                self._needed, self._count = needed, len(words) - place
                self._pending[: self._count] = words[place:]
                return
            self.used = place = place + needed
            yield instruction_of(format, head, words[place - needed : place])

    def _illegal_row(self, words: Words, place: int) -> int:
        """How many consecutive words from `place` on are illegal."""
        count, step = 1, MOST_HEAD
        while place + count < len(words):
            begins = self._begins[words[place + count : place + count + step]]
            if begins.any():
                return count + int(begins.argmax())
            count += len(begins)
            step *= 2
        return count

    def _format(self, word: int) -> InstructionFormat:
        format = self._formats[word >> 8]
        if not self._extended and format.is_normal and word & Flags.OPERANDS_2:
            return ILLEGAL
        return format


FIRST_OPERAND: Final = {
    0: 1,
    Flags.OPERANDS_1: 2,
    Flags.OPERANDS_2: 2,
    Flags.OPERANDS_1 | Flags.OPERANDS_2: 3,
}
"""The index of the first operand by the two flags: the instruction word and the flag words precede it."""


def words_needed(format: InstructionFormat, head: list[int]) -> int:
    """The number of words that an instruction needs at least, given its first words."""
    if format.fixed is not None:
        count = 1 + len(format.fixed)
        if format.replies or "length" not in format.fixed or len(head) < count:
            return count
        return count + (head[1 + format.fixed.index("length")] + 1) // 2
    flags = head[0]
    count = FIRST_OPERAND[flags & 6]
    if len(head) < count:
        return count
    if count > 1 and not format.requests_operands:
        first, second = flag_words(head)
        count += sum(operand.words for operand in operands_named(first, second))
        if first & CONIC and flags & Flags.DATA and format.name == "WC":
            place = short_length_place(head)
            if place is not None and len(head) <= place:
                return place + 1
            count -= 6 if place is not None and head[place] == 4 else 0
    if flags & Flags.DATA:
        count += 1
        if not format.replies and len(head) >= count:
            count += (head[count - 1] + 1) // 2
    return count


def instruction_of(format: InstructionFormat, head: list[int], words: Words) -> Instruction:
    """The instruction in these words; `head` is its first words as numbers."""
    if format is ILLEGAL:
        return Instruction(format, 0, {"word": (head[0],)})
    low_byte = head[0] & 0xFF
    operands: dict[str, tuple[int, ...]] = {}
    length: int | None = None
    if format.fixed is not None:
        place = 1 + len(format.fixed)
        for name, word in zip(format.fixed, head[1:place], strict=True):
            if name == "length":
                length = word
            else:
                operands[name] = (word,)
    else:
        place = FIRST_OPERAND[low_byte & 6]
        if place > 1:
            for operand in operands_named(*flag_words(head)):
                size = 0 if format.requests_operands else operand.words
                if operand.name == "conic" and format.name == "WC" and low_byte & Flags.DATA:
                    length_place = short_length_place(head)
                    size = 6 if length_place is not None and head[length_place] == 4 else 12
                operands[operand.name] = tuple(head[place : place + size])
                place += size
        if low_byte & Flags.DATA:
            length = head[place]
            place += 1
    return Instruction(format, low_byte, operands, length, words[place:] if place < len(words) else NO_WORDS)


def flag_words(head: list[int]) -> tuple[int, int]:
    """The two operand flag words of a normal instruction; an absent flag word is 0."""
    first = head[1] if head[0] & Flags.OPERANDS_1 else 0
    second = head[2 if head[0] & Flags.OPERANDS_1 else 1] if head[0] & Flags.OPERANDS_2 else 0
    return first, second


@lru_cache
def formats_of_opcodes(extended: bool) -> tuple[InstructionFormat, ...]:
    """The formats of the 256 opcodes; without `extended`, opcodes of the 9400 and 9460 are ILLEGAL."""
    formats = {format.opcode: format for format in FORMATS if extended or not format.extended}
    return tuple(formats.get(opcode, ILLEGAL) for opcode in range(256))


@lru_cache
def words_that_begin(extended: bool) -> Booleans:
    """Whether each of the 65,536 words begins an instruction: a table to find the end of illegal words."""
    formats = formats_of_opcodes(extended)
    begins = np.repeat([format is not ILLEGAL for format in formats], 256)
    if not extended:
        words = np.arange(0x10000)
        begins &= ~(
            np.repeat([format.is_normal for format in formats], 256) & (words & Flags.OPERANDS_2 != 0)
        )
    return begins


def short_length_place(head: list[int]) -> int | None:
    """The index of the data length if there are six conic coefficients; None if that index is impossible.

    It is possible if, with twelve coefficients, the word there would be the upper half of a coefficient.
    """
    first, second = flag_words(head)
    place = FIRST_OPERAND[head[0] & 6]
    coefficients = place + sum(operand.words for operand in operands_named(first & (CONIC - 1)))
    length_place = place + sum(operand.words for operand in operands_named(first, second)) - 6
    offset = length_place - coefficients
    return length_place if offset < 12 and offset % 2 == 0 else None
