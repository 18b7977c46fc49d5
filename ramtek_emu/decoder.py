"""Decoder: a continuous stream of words, cut anywhere, becomes instructions.

An instruction may span two sends and one send may hold many (Hardware: PRG, DRIVER.c cuts its transfers
every 512 bytes). The words of an instruction that is not complete are held; they are never more than one
instruction's.

Assumed: a word whose opcode is in no row of the table, or that asks for a second operand flag word on a
display without one, is skipped alone and flagged as illegal; the next word is read as an instruction. The
sources know the status bit but not how the hardware finds its way again. Coordinates and lengths up to
02FFh are no instructions either, so a stream with an unknown instruction soon falls into step.
"""

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from .configuration import GMR_9300, Configuration
from .instruction import NO_WORDS, Instruction
from .instruction_set import FORMS, ILLEGAL, Flags, Form, operands_named

Words = NDArray[np.uint16]
MOST_HEAD = 64
"""More words than any instruction has before its data."""
MOST_WORDS = MOST_HEAD + 0x8000
"""More words than any instruction has."""


class Decoder:
    """Takes words as they come and gives whole instructions; what is left waits for the next words."""

    def __init__(self, configuration: Configuration = GMR_9300) -> None:
        self._forms = {form.opcode: form for form in FORMS if configuration.extended or not form.extended}
        self._extended = configuration.extended
        self._held: Words = np.empty(MOST_WORDS, np.uint16)
        self._count = 0
        self._needed = 1

    @property
    def held_words(self) -> int:
        """Words of an instruction that is not complete yet."""
        return self._count

    def clear(self) -> None:
        """Forget the words of an instruction that is not complete."""
        self._count, self._needed = 0, 1

    def feed(self, words: Words) -> Iterator[Instruction]:
        """The instructions that these words complete, in order; their data are views where possible."""
        place = 0
        while self._count and place < len(words):
            taken = min(self._needed - self._count, len(words) - place)
            self._held[self._count : self._count + taken] = words[place : place + taken]
            self._count += taken
            place += taken
            if self._count < self._needed:
                return
            head = self._held[: min(self._count, MOST_HEAD)].tolist()
            self._needed = self._words_needed(head)
            if self._needed == self._count:
                whole = self._held[: self._count].copy()
                self.clear()
                yield self._instruction(head, whole)
        while place < len(words):
            head = words[place : place + MOST_HEAD].tolist()
            needed = self._words_needed(head)
            if needed > len(words) - place:
                # Hold the beginning of an instruction.
                self._needed, self._count = needed, len(words) - place
                self._held[: self._count] = words[place:]
                return
            place += needed
            yield self._instruction(head, words[place - needed : place])

    def _form(self, word: int) -> Form:
        form = self._forms.get(word >> 8, ILLEGAL)
        if not self._extended and form.is_normal and word & Flags.OPERANDS_2:
            return ILLEGAL
        return form

    def _words_needed(self, head: list[int]) -> int:
        """How many words the instruction that begins here is, as far as these first words tell."""
        form = self._form(head[0])
        if form.fixed is not None:
            count = 1 + len(form.fixed)
            if form.replies or "length" not in form.fixed or len(head) < count:
                return count
            return count + (head[1 + form.fixed.index("length")] + 1) // 2
        flags = head[0]
        count = FLAG_WORDS[flags & 6]
        if len(head) < count:
            return count
        if count > 1:
            count += sum(operand.words for operand in operands_named(*flag_words(head)))
        if flags & Flags.DATA:
            count += 1
            if not form.replies and len(head) >= count:
                count += (head[count - 1] + 1) // 2
        return count

    def _instruction(self, head: list[int], words: Words) -> Instruction:
        form = self._form(head[0])
        if form is ILLEGAL:
            return Instruction(form, 0, {"word": (head[0],)})
        low_byte = head[0] & 0xFF
        operands: dict[str, tuple[int, ...]] = {}
        length: int | None = None
        if form.fixed is not None:
            place = 1 + len(form.fixed)
            for name, word in zip(form.fixed, head[1:place], strict=True):
                if name == "length":
                    length = word
                else:
                    operands[name] = (word,)
        else:
            place = FLAG_WORDS[low_byte & 6]
            if place > 1:
                for operand in operands_named(*flag_words(head)):
                    operands[operand.name] = tuple(head[place : place + operand.words])
                    place += operand.words
            if low_byte & Flags.DATA:
                length = head[place]
                place += 1
        return Instruction(
            form, low_byte, operands, length, words[place:] if place < len(words) else NO_WORDS
        )


FLAG_WORDS = {0: 1, Flags.OPERANDS_1: 2, Flags.OPERANDS_2: 2, Flags.OPERANDS_1 | Flags.OPERANDS_2: 3}
"""The instruction word and the flag words that its flags announce."""


def flag_words(head: list[int]) -> tuple[int, int]:
    """The two operand flag words of a normal instruction, 0 where there is none."""
    first = head[1] if head[0] & Flags.OPERANDS_1 else 0
    second = head[2 if head[0] & Flags.OPERANDS_1 else 1] if head[0] & Flags.OPERANDS_2 else 0
    return first, second
