"""Executors for reset, parameters, status, view, waiting and illegal words."""

from __future__ import annotations

from dataclasses import replace
from typing import Final

import numpy as np

from ramtek_emu.drawing.areas import fill_window
from ramtek_emu.instruction_set.instruction import Instruction
from ramtek_emu.instruction_set.table import FORMATS, OPERANDS
from ramtek_emu.memory.parameters import Parameters
from ramtek_emu.processor.processor import Executors, Pauses, Processor, Status

MOST_SAVED: Final = 16
"""The number of environments that PUSHE can save. Assumed: one more sets the illegal-instruction status."""


FOREIGN: Final = {
    row.opcode: row.name if row.extended else "the second operand flag word"
    for row in FORMATS
    if not (row.extended and row.unimplemented)
}
"""What a 9300 lacks if a word with this opcode is illegal. Other opcodes are as likely letters of a text."""
NOT_FOREIGN: Final = bytes(set(range(256)) - FOREIGN.keys())


def skip_illegal_words(processor: Processor, instruction: Instruction) -> None:
    """Hardware: PRG (the status bit). Assumed: only the illegal words are skipped."""
    processor.is_illegal = True
    processor.illegal_words += len(instruction.data)
    if processor.foreign is None and not processor.configuration.extended:
        opcodes = instruction.data.astype(">u2").tobytes()[::2].translate(None, NOT_FOREIGN)
        if opcodes:
            processor.foreign = FOREIGN[opcodes[0]]


def consume(processor: Processor, instruction: Instruction) -> None:
    """Assumed: an instruction of which only the name is known sets the illegal-instruction status."""
    processor.is_illegal = True
    processor.unimplemented += 1


def reset(processor: Processor, instruction: Instruction) -> Pauses | None:
    """Hardware: LIN libdoc (clears interrupts, parameters and screen); BTL (the lookup table stays).

    Assumed: an unread ENTER is such an interrupt and is cleared, so that the next program does not read it.
    """
    initialize(processor, instruction)
    processor.clear_status()
    for cursor in processor.cursors.all:
        cursor.enter = False
    parameters = processor.parameters
    return fill_window(
        processor.frame_buffer, parameters.whole_window, parameters.background, parameters.enable
    )


def initialize(processor: Processor, instruction: Instruction) -> None:
    """Assumed: only the parameters are reset, since libdoc mentions erasing for RSET only."""
    processor.parameters.restore(vars(Parameters.at_reset(processor.configuration)))
    processor.saved.clear()


def do_nothing(processor: Processor, instruction: Instruction) -> None:
    """Do nothing; the operands were set already."""


def save_environment(processor: Processor, instruction: Instruction) -> None:
    """Assumed: all parameters are saved, zoom and font included."""
    if len(processor.saved) < MOST_SAVED:
        processor.saved.append(replace(processor.parameters))
    else:
        processor.is_illegal = True


def restore_environment(processor: Processor, instruction: Instruction) -> None:
    """Assumed: restores the parameters saved last; without any, sets the illegal-instruction status."""
    if processor.saved:
        processor.parameters.restore(vars(processor.saved.pop()))
    else:
        processor.is_illegal = True


def read_parameters(processor: Processor, instruction: Instruction) -> None:
    """Reply the operands that the flag words name, in the order of the operand table.

    Assumed: all of this. Without flag words every operand is replied. CONE is its six words: the lower halves
    of coefficients that WC has sent as pairs.
    """
    names = instruction.operands or OPERANDS
    numbers = np.concatenate([np.atleast_1d(getattr(processor.parameters, name)) for name in names])
    processor.reply((numbers & 0xFFFF).astype(np.uint16))


def read_error_status(processor: Processor, instruction: Instruction) -> None:
    """Assumed: the reply is a word with the request bits of the status register; they are then cleared."""
    processor.reply(np.array([processor.status & ~Status.READY], np.uint16))
    processor.clear_status()


def zoom(processor: Processor, instruction: Instruction) -> None:
    """Hardware: JPL, NCAR (line factor less one in the high byte, element factor less one in the low byte).

    Assumed: four bits of each are used.
    """
    word = instruction.operands["zoom"][0]
    processor.parameters.zoom = 1 + (word & 0x0F), 1 + (word >> 8 & 0x0F)


def select_video_origin(processor: Processor, instruction: Instruction) -> None:
    """Hardware: NCAR (1: at the bottom). Assumed: only the lowest bit is used."""
    processor.parameters.origin_at_bottom = bool(instruction.low_byte & 1)


def wait_for_retrace(processor: Processor, instruction: Instruction) -> None:
    """Hardware: NCAR (before a table load). Assumed: the number is a channel; all retrace together."""
    if processor.beam is not None:
        processor.beam.wait_for_line(processor.beam.lines)


def wait_for_line(processor: Processor, instruction: Instruction) -> None:
    """Assumed: the word is a line of the screen, from the top. If there is no such line, no time passes."""
    line = instruction.operands["line"][0]
    if processor.beam is not None and line < processor.beam.lines:
        processor.beam.wait_for_line(line)


EXECUTORS: Final[Executors] = {
    "???": skip_illegal_words,
    "RSET": reset,
    "INIT": initialize,
    "NOP": do_nothing,
    "SET": do_nothing,
    "PUSHE": save_environment,
    "POPE": restore_environment,
    "READP": read_parameters,
    "RERR": read_error_status,
    "ZOOM": zoom,
    "SELVO": select_video_origin,
    "WAITVR": wait_for_retrace,
    "WAITL": wait_for_line,
    **{row.name: consume for row in FORMATS if row.unimplemented},
}
