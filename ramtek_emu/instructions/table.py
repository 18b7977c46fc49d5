"""Encoders of the lookup table: its entries are loaded and read."""

from __future__ import annotations

from struct import Struct
from typing import Final

import numpy as np

from ramtek_emu.arrays import Words
from ramtek_emu.checks import checked_colors, checked_number, checked_table_address
from ramtek_emu.errors import InstructionError
from ramtek_emu.instruction_set.instruction import MOST_BYTES
from ramtek_emu.instruction_set.table import FORMAT_OF_NAME

LOW_BYTE_FIRST: Final = np.dtype("<u2")
THREE_WORDS: Final = Struct("<3H")
LOAD: Final = FORMAT_OF_NAME["LAM"].opcode << 8
"""The instruction word of LAM for table 0."""


def load_entries(first: int, colors: object, entries: int = 1024) -> Words:
    """LAM: load (n, 3) colors, 0 to 255, into the entries from `first` on, in the 24-bit format."""
    checked = checked_colors(first, colors, entries)
    data = checked.tobytes()
    # In the memory of a VAX the two words of an entry are the bytes blue, green, red, 0.
    memory = bytearray(6 + 4 * len(checked))
    memory[6::4], memory[7::4], memory[8::4] = data[2::3], data[1::3], data[0::3]
    memory[:6] = THREE_WORDS.pack(LOAD, 2 * int(first), 4 * len(checked))
    return np.frombuffer(memory, LOW_BYTE_FIRST)


def load_short_entries(first: int, colors: object, entries: int = 1024) -> Words:
    """LAM: load (n, 3) colors, 0 to 255, into the entries from `first` on, in the 12-bit format.

    Only the upper four bits of each component are sent.
    """
    checked = checked_colors(first, colors, entries)
    red, green, blue = checked.astype(np.uint16).T >> 4
    head = np.array((LOAD, int(first), 2 * len(checked)), np.uint16)
    return np.concatenate((head, red << 8 | green << 4 | blue))


def park_table(address: int = 0) -> Words:
    """LAM without data: set the address counter of the table, whose upper bits select the section shown.

    Hardware: LIN, JPL, NCAR send it after a load; it matters with fewer planes than address bits.
    """
    return np.array((LOAD, checked_table_address(address), 0), np.uint16)


def read_entries(address: int = 0, words: int = 2048) -> Words:
    """RAM: ask for words of the lookup table from a word address on; then receive that many words."""
    words = checked_number(
        words, "the words to read", 0, MOST_BYTES // 2, "read the rest with another", InstructionError
    )
    return np.array((FORMAT_OF_NAME["RAM"].opcode << 8, checked_table_address(address), 2 * words), np.uint16)
