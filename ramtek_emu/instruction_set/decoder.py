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
from typing import Final, NamedTuple

import numpy as np

from ramtek_emu.arrays import Booleans, Words
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
MOST_WORDS: Final = MOST_HEAD + 0x8000
"""An upper bound on the words of an instruction, but a row of illegal words."""
FEW: Final = 24
"""So many illegal words are looked at one by one, and further words at once."""
CONIC: Final = OPERAND_BITS["conic"]


class Continuation(NamedTuple):
    """How an instruction with a certain first word continues."""

    head: int
    """The number of words before the operands that flag words name."""
    first: int
    """The index of the first operand flag word; 0 if there is none, or if no operands follow."""
    second: int
    has_length: bool
    has_data: bool
    may_be_short: bool
    """Whether conic coefficients are twelve words, or six where twelve make no sense."""


class Decoder:
    """Takes words as they arrive and returns whole instructions; words of an incomplete instruction wait."""

    def __init__(self, configuration: Configuration = GMR_9300) -> None:
        self.used = 0
        """How many words of the last call belong to the instructions that it has yielded."""
        self.is_within_row = False
        """Whether the illegal words that were yielded last continue those of the call before."""
        self._extended = configuration.extended
        self._last_is_illegal = False
        self.clear()

    def __repr__(self) -> str:
        return f"Decoder(words pending: {self.pending_words})"

    @property
    def pending_words(self) -> int:
        """How many words of an incomplete instruction have arrived."""
        return len(self.pending) // 2

    def clear(self) -> None:
        """Drop the words of an incomplete instruction."""
        self.pending = bytearray()
        """The words of an incomplete instruction, as bytes in the machine's order."""
        self._missing = 1

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
            self.clear()
        begin = 0
        ends, missing = lengths(words, self._extended)
        layouts, numbers = layouts_of_words(self._extended), words.data
        for end in ends:
            is_illegal = layouts[numbers[begin]] is None
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
    layouts, numbers, count = layouts_of_words(extended), words.data, len(words)
    ends = array("q")
    place = 0
    while place < count:
        layout = layouts[numbers[place]]
        if layout is None:
            end = end_of_row(words, place, words_that_begin(extended))
        else:
            head, first, second, has_length, has_data, may_be_short = layout
            end = place + head
            if first or second:
                if end > count:
                    return ends, end - count
                if first:
                    end += SIZES_1[numbers[place + first]]
                if second:
                    end += SIZES_2[numbers[place + second] & 0x3F]
                if may_be_short:
                    missing = missing_coefficients(numbers, place, end, layout)
                    if missing is None:
                        return ends, end + 1 - count
                    end += missing
            if has_length:
                end += 1
                if has_data:
                    if end > count:
                        return ends, end - count
                    end += numbers[end - 1] + 1 >> 1
            if end > count:
                return ends, end - count
        ends.append(end)
        place = end
    return ends, 0


def missing_coefficients(numbers: memoryview[int], place: int, end: int, layout: Continuation) -> int | None:
    """The words of a WC's coefficients beyond six: 6, or 0 if it has six; None if that is not known yet.

    The WC begins at `place`, and `end` is the end of its operands if it has six.
    """
    flag_word = numbers[place + layout.first] if layout.first else 0
    if not flag_word & CONIC:
        return 0
    # With twelve coefficients, every second word is the upper half of one.
    after_conic = end - place - layout.head - SIZES_1[flag_word & 2 * CONIC - 1]
    if not layout.has_length or after_conic not in (0, 2, 4):
        return 6
    if end >= len(numbers):
        return None
    return 0 if numbers[end] == 4 else 6


def end_of_row(words: Words, place: int, legal: Booleans) -> int:
    """The end of the row of illegal words that begins at `place`."""
    end, numbers = place + 1, words.data
    while end < len(words) and end - place < FEW:
        if legal.item(numbers[end]):
            return end
        end += 1
    step = FEW
    while end < len(words):
        found = legal[words[end : end + step]]
        if found.any():
            return end + int(found.argmax())
        end += len(found)
        step = min(2 * step, 1 << 20)
    return end


def instruction_of(words: Words, extended: bool) -> Instruction:
    """The instruction whose words, all of them, these are."""
    layout = layouts_of_words(extended)[words.item(0)]
    if layout is None:
        return Instruction(ILLEGAL, 0, {}, None, words)
    head = words[:MOST_HEAD].tolist()
    format, low_byte = formats_of_opcodes(extended)[head[0] >> 8], head[0] & 0xFF
    operands: dict[str, tuple[int, ...]] = {}
    length: int | None = None
    place = layout.head
    if format.fixed is not None:
        operands = {name: (word,) for name, word in zip(format.fixed, head[1:place], strict=False)}
    elif place > 1:
        first = head[1] if low_byte & Flags.OPERANDS_1 else 0
        second = head[place - 1] if low_byte & Flags.OPERANDS_2 else 0
        missing = 0
        if layout.may_be_short:
            end = place + SIZES_1[first] + SIZES_2[second & 0x3F]
            missing = missing_coefficients(words.data, 0, end, layout) or 0
        for operand in operands_named(first, second):
            size = 0 if format.requests_operands else operand.words
            if operand.name == "conic":
                size += missing
            operands[operand.name] = tuple(head[place : place + size])
            place += size
    if layout.has_length:
        length = head[place]
        place += 1
    return Instruction(format, low_byte, operands, length, words[place:] if place < len(words) else NO_WORDS)


@lru_cache
def formats_of_opcodes(extended: bool) -> tuple[InstructionFormat, ...]:
    """The formats of the 256 opcodes; without `extended`, opcodes of the 9400 and 9460 are ILLEGAL."""
    formats = {format.opcode: format for format in FORMATS if extended or not format.extended}
    return tuple(formats.get(opcode, ILLEGAL) for opcode in range(256))


@lru_cache
def layouts_of_words(extended: bool) -> tuple[Continuation | None, ...]:
    """How an instruction continues after each of the 65,536 words; None for illegal words."""
    return tuple(
        layout
        for format in formats_of_opcodes(extended)
        for layout in (
            [layout_of(format, low_byte, extended) for low_byte in range(8)] * 32
            if format.is_normal
            else [layout_of(format, 0, extended)] * 256
        )
    )


def layout_of(format: InstructionFormat, low_byte: int, extended: bool) -> Continuation | None:
    """How an instruction of a format continues, by its low byte."""
    if format is ILLEGAL or (format.is_normal and low_byte & Flags.OPERANDS_2 and not extended):
        return None
    if format.fixed is not None:
        has_length = "length" in format.fixed
        head = 1 + len(format.fixed) - has_length
        return Continuation(head, 0, 0, has_length, has_length and not format.replies, False)
    first, second = bool(low_byte & Flags.OPERANDS_1), bool(low_byte & Flags.OPERANDS_2)
    has_length, follow = bool(low_byte & Flags.DATA), not format.requests_operands
    return Continuation(
        head=1 + first + second,
        first=int(first and follow),
        second=(first + second) * (second and follow),
        has_length=has_length,
        has_data=has_length and not format.replies,
        may_be_short=format.name == "WC" and first,
    )


@lru_cache
def words_that_begin(extended: bool) -> Booleans:
    """Whether each of the 65,536 words begins an instruction."""
    return np.array([layout is not None for layout in layouts_of_words(extended)])


def sizes_of(operands: tuple[Operand, ...]) -> list[int]:
    """The number of words of the operands that each possible flag word names."""
    sizes = np.zeros(1, np.int64)
    for operand in operands:
        sizes = np.concatenate((sizes, sizes + operand.words))
    return sizes.tolist()


SIZES_1: Final = sizes_of(OPERANDS_1)
SIZES_2: Final = sizes_of(OPERANDS_2)
