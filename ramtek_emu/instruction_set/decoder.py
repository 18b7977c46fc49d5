"""Decoder: splits a continuous stream of words into instructions, wherever the stream is cut.

An instruction may span two sends, and one send may hold many instructions (Hardware: PRG, DRIVER.c cuts its
transfers every 512 bytes). The words of an incomplete instruction wait for the rest of it.

Assumed: a word whose opcode is in no row of the table, or that asks for a second operand flag word on a
display without one, is skipped alone and flagged as illegal; the next word is read as an instruction. The
sources know the status bit but not how the hardware finds its way again. Consecutive illegal words are a
single instruction here, however many they are.

Assumed: conic coefficients are six words, as LIN setp.c sends them, and in WC twelve, as LIN wc.c does. WC is
taken with six where twelve make no sense: if it has data, and the word that is the data length after six
coefficients would be the upper half of a coefficient with twelve, and is 4, the length of a point.
"""

from __future__ import annotations

from array import array
from collections.abc import Iterator
from functools import lru_cache
from typing import Final

import numpy as np

from ramtek_emu.arrays import Dots, Words
from ramtek_emu.configuration import GMR_9300, Configuration
from ramtek_emu.instruction_set.instruction import NO_WORDS, Instruction
from ramtek_emu.instruction_set.table import (
    FORMATS,
    ILLEGAL,
    OPERAND_BITS,
    OPERANDS_1,
    OPERANDS_2,
    Flags,
    InstructionFormat,
    Operand,
    operands_named,
)

MOST_HEAD: Final = 64
"""An upper bound on the words of an instruction before its data."""
FEW: Final = 24
"""The words after an illegal word that are looked at first; then twice as many, and so on."""
CONIC: Final = OPERAND_BITS["conic"]


class Decoder:
    """Takes words as they arrive and returns whole instructions; words of an incomplete instruction wait."""

    def __init__(self, configuration: Configuration = GMR_9300) -> None:
        self.used = 0
        """The place in the words fed last where the instruction yielded last ends."""
        self.is_within_row = False
        """Whether the instruction yielded last is the rest of a row of illegal words that was fed before."""
        self._extended = configuration.extended
        self.clear()

    @property
    def pending_words(self) -> int:
        """How many words of an incomplete instruction have arrived."""
        return len(self.pending) // 2

    def clear(self) -> None:
        """Drop the words of an incomplete instruction."""
        self.pending = bytearray()
        """The words of an incomplete instruction, as bytes in the machine's order."""
        self._missing = 1
        self._last_is_illegal = False

    def feed(self, words: Words) -> Iterator[Instruction]:
        """The instructions that these words complete, in order; their data are views where possible.

        Illegal words are the data of an instruction with the format ILLEGAL. A row that goes on in the next
        call is then another instruction; see `is_within_row`.
        """
        for whole in self.split(words):
            yield instruction_of(whole, self._extended)

    def split(self, words: Words) -> Iterator[Words]:
        """The words of each instruction that `feed` would return."""
        self.used = 0
        before = self.pending_words
        if len(words) < self._missing:
            self.pending += words.tobytes()
            self._missing -= len(words)
            return
        if before:
            words = np.frombuffer(bytes(self.pending) + words.tobytes(), np.uint16)
            self.pending, self._missing = bytearray(), 1
        begin = 0
        ends, missing = lengths(words, self._extended)
        formats = formats_of_words(self._extended)
        for end in ends:
            is_illegal = formats[words.item(begin)] is ILLEGAL
            self.is_within_row = is_illegal and self._last_is_illegal and begin == 0
            self._last_is_illegal = is_illegal
            self.used = end - before
            yield words[begin:end]
            begin = end
        if missing:
            self.pending, self._missing = bytearray(words[begin:].tobytes()), missing


def lengths(words: Words, extended: bool) -> tuple[array[int], int]:
    """Where the whole instructions of a stream end, and how many words the rest of it lacks.

    `words` are uint16. The ends count words from the beginning. The rest lacks at least that many words, and
    0 means that there is no rest. A row of illegal words is one instruction; it is whole wherever it ends.
    `extended` means the instructions of the 9400 and the 9460.
    """
    formats, numbers, count = formats_of_words(extended), words.data, len(words)
    ends = array("q")
    place = 0
    while place < count:
        word = numbers[place]
        format = formats[word]
        sends_data = format.sends_data
        if format is ILLEGAL:
            end = end_of_row(words, place, extended)
        elif format.fixed is not None:
            end = place + 1 + len(format.fixed)
        else:
            end = operands = place + FIRST_OPERAND[word & 6]
            if word & 6 and not format.requests_operands:
                if end > count:
                    return ends, end - count
                if word & Flags.OPERANDS_1:
                    end += SIZES_1[numbers[place + 1]]
                if word & Flags.OPERANDS_2:
                    end += SIZES_2[numbers[operands - 1] & 0x3F]
                if format.name == "WC":
                    missing = missing_coefficients(numbers, place, operands, end)
                    if missing is None:
                        return ends, end + 1 - count
                    end += missing
            end += word & Flags.DATA
            sends_data = sends_data and bool(word & Flags.DATA)
        if sends_data and end <= count:
            end += numbers[end - 1] + 1 >> 1
        if end > count:
            return ends, end - count
        ends.append(end)
        place = end
    return ends, 0


def missing_coefficients(numbers: memoryview[int], place: int, operands: int, end: int) -> int | None:
    """The words of a WC's coefficients beyond six: 6, or 0 if it has six; None if that is not known yet.

    The WC begins at `place`, and its operands would begin and end there if it had six.
    """
    flag_word = numbers[place + 1] if numbers[place] & Flags.OPERANDS_1 else 0
    if not flag_word & CONIC:
        return 0
    # With twelve coefficients, every second word is the upper half of one.
    after_conic = end - operands - SIZES_1[flag_word & 2 * CONIC - 1]
    if not numbers[place] & Flags.DATA or after_conic not in (0, 2, 4):
        return 6
    if end >= len(numbers):
        return None
    return 0 if numbers[end] == 4 else 6


def end_of_row(words: Words, place: int, extended: bool) -> int:
    """The end of the row of illegal words that begins at `place`."""
    legal = words_that_begin(extended)
    end, step = place + 1, FEW
    while end < len(words):
        found = legal[words[end : end + step]]
        if found.any():
            return end + int(found.argmax())
        end += len(found)
        step = min(2 * step, 1 << 20)
    return end


def instruction_of(words: Words, extended: bool) -> Instruction:
    """The instruction that these words, which must be whole, encode."""
    format = formats_of_words(extended)[words.item(0)]
    if format is ILLEGAL:
        return Instruction(ILLEGAL, 0, {}, None, words)
    head = words[:MOST_HEAD].tolist()
    low_byte, length = head[0] & 0xFF, None
    operands: dict[str, tuple[int, ...]] = {}
    if format.fixed is not None:
        place = 1 + len(format.fixed)
        operands = {name: (word,) for name, word in zip(format.fixed, head[1:place], strict=True)}
        if "length" in operands:
            (length,) = operands.pop("length")
    else:
        place = FIRST_OPERAND[low_byte & 6]
        first = head[1] if low_byte & Flags.OPERANDS_1 else 0
        second = head[place - 1] if low_byte & Flags.OPERANDS_2 else 0
        if format.requests_operands:
            operands = {operand.name: () for operand in operands_named(first, second)}
        elif place > 1:
            for operand in operands_named(first, second):
                size = operand.words
                if operand.name == "conic" and format.name == "WC":
                    end = FIRST_OPERAND[low_byte & 6] + SIZES_1[first] + SIZES_2[second & 0x3F]
                    size += missing_coefficients(words.data, 0, FIRST_OPERAND[low_byte & 6], end) or 0
                operands[operand.name] = tuple(head[place : place + size])
                place += size
        if low_byte & Flags.DATA:
            length = head[place]
            place += 1
    return Instruction(format, low_byte, operands, length, words[place:] if place < len(words) else NO_WORDS)


@lru_cache
def formats_of_words(extended: bool) -> tuple[InstructionFormat, ...]:
    """The format of the instruction that each of the 65,536 words begins, or ILLEGAL."""
    formats = {format.opcode: format for format in FORMATS if extended or not format.extended}
    rows = [formats.get(word >> 8, ILLEGAL) for word in range(0x10000)]
    if not extended:
        rows = [
            ILLEGAL if format.is_normal and word & Flags.OPERANDS_2 else format
            for word, format in enumerate(rows)
        ]
    return tuple(rows)


@lru_cache
def words_that_begin(extended: bool) -> Dots:
    """Whether each of the 65,536 words begins an instruction."""
    return np.array([format is not ILLEGAL for format in formats_of_words(extended)])


def sizes_of(operands: tuple[Operand, ...]) -> list[int]:
    """The number of words of the operands that each possible flag word names."""
    sizes = np.zeros(1, np.int64)
    for operand in operands:
        sizes = np.concatenate((sizes, sizes + operand.words))
    return sizes.tolist()


SIZES_1: Final = sizes_of(OPERANDS_1)
SIZES_2: Final = sizes_of(OPERANDS_2)
FIRST_OPERAND: Final = (1, 1, 2, 2, 2, 2, 3)
"""The index of the first operand by the two flags for flag words, which precede it."""
