"""Encoders that set the display up: reset, parameters, zoom.

>>> " ".join(f"{word:04X}" for word in set_parameters(foreground=1))
'0802 0002 0001'
"""

from __future__ import annotations

import numpy as np

from ramtek_emu.arrays import Words
from ramtek_emu.checks import is_whole
from ramtek_emu.errors import InstructionError
from ramtek_emu.instruction_set.instruction import Instruction, OperandValue, encode, normal
from ramtek_emu.instruction_set.table import FORMAT_OF_NAME


def reset() -> Words:
    """RSET: set every parameter as at power-on and erase the screen; the lookup table is kept."""
    return encode(Instruction(FORMAT_OF_NAME["RSET"]))


def initialize() -> Words:
    """INIT: set every parameter as at power-on; screen and lookup table are kept."""
    return encode(Instruction(FORMAT_OF_NAME["INIT"]))


def no_operation() -> Words:
    """NOP: do nothing."""
    return encode(Instruction(FORMAT_OF_NAME["NOP"]))


def set_parameters(**operands: OperandValue | None) -> Words:
    """SET: set operands by name (`foreground=3`, `window=(0, 0, 639, 479)`); they stay until set again."""
    return encode(normal("SET", operands))


def zoom(across: int = 1, down: int | None = None) -> Words:
    """ZOOM: show each pixel `across` elements wide and `down` lines high, 1 to 16; `down` may be left out."""
    factors = (across, across if down is None else down)
    if not all(is_whole(each) and 1 <= each <= 16 for each in factors):
        raise InstructionError(f"zoom factors must be 1 to 16, not {factors}; choose smaller ones")
    word = int(factors[1]) - 1 << 8 | int(factors[0]) - 1
    return np.array((FORMAT_OF_NAME["ZOOM"].opcode << 8, word), np.uint16)
