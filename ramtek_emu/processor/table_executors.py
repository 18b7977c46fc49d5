"""Executors of the instructions for the lookup table: LAM and RAM."""

from __future__ import annotations

import numpy as np

from ramtek_emu.instruction_set.instruction import Instruction
from ramtek_emu.processor.processor import Processor, executes


@executes("LAM")
def load_lookup_table(processor: Processor, instruction: Instruction) -> None:
    """Hardware: JPL, NCAR (the device number is that of a table, 0 on systems of one channel).

    Assumed: words for a table that does not exist are dropped.
    """
    if instruction.low_byte == 0:
        words = instruction.data[: (instruction.length or 0) // 2]
        processor.lookup_table.load(instruction.operands["address"][0], words)


@executes("RAM")
def read_lookup_table(processor: Processor, instruction: Instruction) -> None:
    """Hardware: JPL (the packing of LAM). Assumed: a table that does not exist reads as zeros."""
    count = (instruction.length or 0) // 2
    if instruction.low_byte == 0:
        processor.reply(processor.lookup_table.read(instruction.operands["address"][0], count))
    else:
        processor.reply(np.zeros(count, np.uint16))
