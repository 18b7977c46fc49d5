"""Encoders of cursors: they are placed and read."""

from __future__ import annotations

import numpy as np

from ramtek_emu.arrays import Words
from ramtek_emu.checks import checked_cursor, checked_number
from ramtek_emu.errors import InstructionError
from ramtek_emu.instruction_set.table import FORMAT_OF_NAME


def write_cursor(
    number: int, element: int, line: int, *, visible: bool = True, blinking: bool = False
) -> Words:
    """WCSS: place a cursor on the screen, and show or hide it."""
    number = checked_cursor(number)
    element, line = (
        checked_number(each, f"a cursor's {name}", 0, most, "keep to the screen", InstructionError)
        for each, name, most in ((element, "element", 0x7FF), (line, "line", 0x3FF))
    )
    state = (0x0400 if visible else 0) | (0x0800 if blinking else 0)
    return np.array((FORMAT_OF_NAME["WCSS"].opcode << 8 | number, element, line | state), np.uint16)


def read_cursor(number: int) -> Words:
    """RCSS: ask for a cursor; then receive two words: element, and line with the state above ten bits."""
    return np.array([FORMAT_OF_NAME["RCSS"].opcode << 8 | checked_cursor(number)], np.uint16)
