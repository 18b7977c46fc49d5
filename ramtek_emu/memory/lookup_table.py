"""LookupTable: the parallel video lookup table, whose entries are addressed by the words of the picture.

What is modeled: the two entry formats, the address counter, which advances with every load and wraps, and
reading back. What is **not**: the digital-to-analog converters, a change in the middle of a field.

Hardware: JPL, NCAR (24 bits: entry n at word address 2n, green << 8 | blue, then red); LIN, BTL (12 bits:
entry n at word address n); LIN, JPL (the counter keeps its last value, and its upper bits pick the part of
the table that is shown when there are fewer planes than address bits).
Assumed: the entries are black at power-on; no source says what a cold table shows.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from ramtek_emu.arrays import Colors, Dots, PackedColors, Words
from ramtek_emu.configuration import GMR_9300, Configuration, EntryFormat


class LookupTable:
    """The color memory: its entries, packed as 0x00RRGGBB for scan-out."""

    def __init__(self, configuration: Configuration = GMR_9300) -> None:
        self.entry_format = configuration.entry_format
        self.size = configuration.entries
        self.word_count = self.size if self.entry_format is EntryFormat.WORD_12 else 2 * self.size
        """The number of words that the host sends for the whole table."""
        self.address = 0
        """The address counter, in words."""
        self.written = 0
        """The number of words of entries written since power-on; it never decreases."""
        self._last_range = 0, 0, 0
        """The last range written: the count `written` before it, its first entry, and the entry after it."""
        self.touched: Dots | None = None
        """(entries,) dots that writes make true, also where colors stay the same; None for no dots."""
        self._packed: PackedColors = np.zeros(self.size, "<u4")
        # In this byte order, the two halves of a packed entry are the two words of the 24-bit format.
        self._halves: Words = self._packed.view("<u2")
        self.packed: PackedColors = self._packed.view()
        """The entries as 0x00RRGGBB, (entries,) uint32; a read-only view that stays current."""
        self.packed.flags.writeable = False

    def state(self) -> dict[str, Any]:
        """The entries as 0x00RRGGBB, (entries,) uint32, and the address counter."""
        return {"entries": self._packed.copy(), "table_address": self.address}

    def restore(self, state: dict[str, Any]) -> None:
        """Write the entries of a state, and set the address counter, which wraps."""
        self._packed[...] = state["entries"] & 0xFFFFFF
        self.address = state["table_address"] % self.word_count
        self._note(0, self.size, self.word_count)

    @property
    def addressed_entry(self) -> int:
        """The entry that the address counter points to."""
        return self.address if self.entry_format is EntryFormat.WORD_12 else self.address >> 1

    @property
    def entries(self) -> Colors:
        """The colors, (entries, 3) uint8; a read-only copy."""
        colors = self._packed.view(np.uint8).reshape(-1, 4)[:, 2::-1].copy()
        colors.flags.writeable = False
        return colors

    def entries_written_since(self, written: int) -> tuple[int, int] | None:
        """The range of entries written since the count was `written`: its first, and the entry after it.

        None if the entries are not a single range. Only the last range is remembered.
        """
        since, first, end = self._last_range
        return (first, end) if written >= since else None

    def load(self, address: int, words: Words) -> None:
        """Write words of the host from a word address on; the address counter advances and wraps."""
        count = self.word_count
        self.address = (address + len(words)) % count
        first, before_wrap = address % count, count - address % count
        while len(words) > before_wrap:
            self._store(first, words[:before_wrap])
            first, words, before_wrap = 0, words[before_wrap:], count
        self._store(first, words)

    def read(self, address: int, count: int) -> Words:
        """`count` words for the host from a word address on; the address counter advances and wraps."""
        if self.entry_format is EntryFormat.WORD_12:
            nibbles = (self._packed >> 4) & 0x0F0F0F
            table = ((nibbles >> 8) & 0xF00 | (nibbles >> 4) & 0xF0 | nibbles & 0xF).astype(np.uint16)
        else:
            table = self._halves
        self.address = (address + count) % self.word_count
        return np.resize(np.roll(table, -(address % self.word_count)), count).astype(np.uint16)

    def _store(self, first: int, words: Words) -> None:
        if self.entry_format is EntryFormat.WORD_12:
            wide = words.astype(np.uint32)
            nibbles = (wide & 0xF00) << 8 | (wide & 0xF0) << 4 | wide & 0xF
            # The full scale of four bits becomes the full scale of eight: 15 times 17 is 255.
            self._packed[first : first + len(words)] = nibbles * 17
            self._note(first, first + len(words), len(words))
            return
        # Measured with cold caches: masking the words while they are written takes 1.3 times as long.
        self._halves[first : first + len(words)] = words
        first_entry, end_entry = first >> 1, first + len(words) + 1 >> 1
        self._packed[first_entry:end_entry] &= 0xFFFFFF
        self._note(first_entry, end_entry, len(words))

    def _note(self, first: int, end: int, words: int) -> None:
        """Count the words written to a range of entries, and remember the range."""
        if words and self.touched is not None:
            self.touched[first:end] = True
        # Writing the same range repeatedly, as while a color is dragged, counts as one write.
        if words and self._last_range[1:] != (first, end):
            self._last_range = self.written, first, end
        self.written += words
