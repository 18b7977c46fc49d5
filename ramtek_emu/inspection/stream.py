"""Stream: words as numbered instructions, counted as `ramtek list --json` counts them.

Instruction 1 is the first; 0 stands for power-on. A row of illegal words is one instruction.
"""

from __future__ import annotations

from typing import TypeVar

import numpy as np

from ramtek_emu.arrays import AnyArray, Indices, Words
from ramtek_emu.configuration import GMR_9300, Configuration
from ramtek_emu.instruction_set.decoder import lengths, words_that_begin
from ramtek_emu.instruction_set.disassembler import ListingItem, item_of
from ramtek_emu.instruction_set.instruction import NO_WORDS

Array = TypeVar("Array", bound=AnyArray)


class Stream:
    """Words for a display, with the place of each instruction; more words can be appended."""

    def __init__(self, configuration: Configuration = GMR_9300, words: Words = NO_WORDS) -> None:
        self.configuration = configuration
        self._words: Words = NO_WORDS
        self._word_count = 0
        self._ends: Indices = np.zeros(1, np.int64)
        self._count = 0
        self.append(words)

    def __len__(self) -> int:
        """The number of whole instructions."""
        return self._count

    @property
    def words(self) -> Words:
        """All words, uint16, with the words of an incomplete instruction at the end."""
        return self._words[: self._word_count]

    @property
    def ends(self) -> Indices:
        """The words up to the end of each instruction, (instructions + 1,) int64; `ends[0]` is 0."""
        return self._ends[: self._count + 1]

    def append(self, words: Words) -> None:
        """Append words; an instruction may be cut anywhere.

        Illegal words that follow illegal words at once belong to the same instruction, whose end moves on.
        """
        begin, extended = int(self._ends[self._count]), self.configuration.extended
        self._words = _with_room(self._words, self._word_count, len(words))
        self._words[self._word_count : self._word_count + len(words)] = words
        self._word_count += len(words)
        ends = np.array(lengths(self.words[begin:], extended)[0], np.int64) + begin
        if self._count and len(ends):
            legal = words_that_begin(extended)
            if not legal[self._words[[self._ends[self._count - 1], begin]]].any():
                self._count -= 1
        self._ends = _with_room(self._ends, self._count + 1, len(ends))
        self._ends[self._count + 1 : self._count + 1 + len(ends)] = ends
        self._count += len(ends)

    def words_between(self, number: int, end: int) -> Words:
        """The words of the instructions after `number` up to `end`, included."""
        return self._words[self._ends[number] : self._ends[end]]

    def item(self, number: int) -> ListingItem:
        """An instruction as `ramtek list` shows it."""
        words = self.words_between(number - 1, number)
        return item_of(int(self._ends[number - 1]), words, self.configuration.extended)


def _with_room(items: Array, used: int, more: int) -> Array:
    """The items, or a longer array that begins with the items in use, with room for more."""
    if used + more <= len(items):
        return items
    longer = np.zeros(max(2 * len(items), used + more), items.dtype)
    longer[:used] = items[:used]
    return longer  # type: ignore[return-value]
