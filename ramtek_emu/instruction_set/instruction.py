"""Instruction: an instruction as a value, and its conversion to the words that a host sends.

>>> encode(normal("SET", {"foreground": 1})).tolist() == [0x0802, 0x0002, 1]
True
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Final

import numpy as np

from ramtek_emu.arrays import Words
from ramtek_emu.checks import checked_coordinate
from ramtek_emu.errors import InstructionError
from ramtek_emu.instruction_set.table import (
    FORMAT_OF_NAME,
    ILLEGAL,
    OPERAND_BITS,
    OPERANDS,
    Flags,
    InstructionFormat,
    operands_named,
)

OperandValue = int | Sequence[int]
"""The value of an operand: a number, or a sequence with a number for each word."""
NO_WORDS: Final[Words] = np.zeros(0, np.uint16)
MOST_BYTES: Final = 0xFFFF
"""The most bytes of data: their length is sent as a 16-bit word."""


@dataclass(frozen=True, eq=False, slots=True)
class Instruction:
    """An instruction: format, low byte, operands as words, and data."""

    format: InstructionFormat
    low_byte: int = 0
    operands: Mapping[str, tuple[int, ...]] = field(default_factory=dict)
    length: int | None = None
    """The number of bytes of data; None if there is no data field."""
    data: Words = field(default_factory=lambda: NO_WORDS)

    def data_bytes(self) -> bytes:
        """The data as bytes without padding: high byte first, or low byte first with reverse packing."""
        packed = self.data.astype("<u2" if self.low_byte & Flags.REVERSE_PACKING else ">u2")
        return packed.tobytes()[: self.length]


def encode(instruction: Instruction) -> Words:
    """The words of an instruction; its low byte says which operands and data follow."""
    format = instruction.format
    if format is ILLEGAL:
        return instruction.data
    head = [format.opcode << 8 | instruction.low_byte]
    if format.is_normal:
        bits = sum(OPERAND_BITS[name] for name in instruction.operands)
        first, second = bits & 0xFFFF, bits >> 16
        for flag, word in ((Flags.OPERANDS_1, first), (Flags.OPERANDS_2, second)):
            if word:
                head[0] |= flag
                head.append(word)
        for operand in operands_named(first, second):
            head.extend(instruction.operands[operand.name])
        if instruction.length is not None:
            head[0] |= Flags.DATA
            head.append(instruction.length)
    else:
        for name in format.fixed or ():
            head.extend((instruction.length or 0,) if name == "length" else instruction.operands[name])
    words = np.array(head, np.uint16)
    return np.concatenate((words, instruction.data)) if len(instruction.data) else words


def normal(
    name: str,
    operands: Mapping[str, OperandValue | None],
    data: Words = NO_WORDS,
    length: int | None = None,
    flags: int = 0,
) -> Instruction:
    """A normal instruction with these operands; numbers from -32768 to 65535 become 16-bit words."""
    named = {key: operand_words(key, value) for key, value in operands.items() if value is not None}
    if length is None and len(data):
        length = 2 * len(data)
    if length is not None and not 0 <= length <= MOST_BYTES:
        raise InstructionError(
            f"the data of {name} must be 0 to {MOST_BYTES} bytes, not {length}; "
            "send them in several instructions"
        )
    return Instruction(FORMAT_OF_NAME[name], int(flags), named, length, data)


def operand_words(name: str, value: OperandValue) -> tuple[int, ...]:
    """The words of an operand; InstructionError if their number or range is wrong."""
    if name not in OPERANDS:
        raise InstructionError(f"an operand must be one of {', '.join(OPERANDS)}, not {name!r}; choose one")
    if isinstance(value, np.ndarray):
        value = value.tolist()
    numbers = (value,) if type(value) is int else tuple(value) if isinstance(value, Sequence) else (value,)
    if len(numbers) != OPERANDS[name].words:
        raise InstructionError(
            f"{name} must be {OPERANDS[name].words} numbers, not {len(numbers)}; give all of them"
        )
    return tuple([checked_coordinate(number, name) & 0xFFFF for number in numbers])
