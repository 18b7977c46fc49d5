"""Executors for cursors: writing and reading in three kinds of coordinates, shapes, tracking devices.

Hardware: LIN (screen coordinates: element; line with visible and blink; TRACK and ENTER when read); NCAR
(pixel coordinates, the same words); JPL (global coordinates: element, line, a word of the state).
Assumed: screen coordinates are places on the screen. Pixel coordinates are the pixels of the memory at these
places, by display origin, zoom and video origin. Global coordinates equal screen coordinates, as on a system
of one channel. Writing a cursor that does not exist has no effect, and reading it gives 0; both set the
illegal-instruction status.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from ramtek_emu.instruction_set.instruction import Instruction
from ramtek_emu.memory.cursors import LINE_BITS, SHAPE_SIZE
from ramtek_emu.processor.processor import Executors, Processor
from ramtek_emu.video.view import pixel_at, screen_at


def has_cursor(processor: Processor, instruction: Instruction) -> bool:
    """Whether the cursor of the instruction exists; if not, the illegal-instruction bit is set."""
    if instruction.low_byte < len(processor.cursors.all):
        return True
    processor.is_illegal = True
    return False


def element_bits(processor: Processor) -> int:
    """The bits that hold an element: ten on the 9300 (Hardware: LIN), eleven on wider displays."""
    return 0x3FF if processor.configuration.elements <= 0x400 else 0x7FF


def write_cursor(processor: Processor, instruction: Instruction) -> None:
    """Place a cursor in screen coordinates, or by WCSP in pixel coordinates."""
    if has_cursor(processor, instruction):
        (element,), (line,) = instruction.operands.values()
        place = element & element_bits(processor), line & LINE_BITS
        if instruction.format.name == "WCSP":
            place = screen_at(processor.parameters, processor.configuration, *place)
        processor.cursors.place(instruction.low_byte, *place, line & ~LINE_BITS)


def write_global_cursor(processor: Processor, instruction: Instruction) -> None:
    """Place a cursor in global coordinates; the state is a separate word."""
    if has_cursor(processor, instruction):
        (element,), (line,), (state,) = instruction.operands.values()
        processor.cursors.place(instruction.low_byte, element & 0xFFF, line & 0xFFF, state)


def read_cursor(processor: Processor, instruction: Instruction) -> None:
    """Reply the place of a cursor in screen coordinates, or by RCSP in pixel coordinates, with its state."""
    if not has_cursor(processor, instruction):
        return processor.reply(np.zeros(2, np.uint16))
    cursor = processor.cursors[instruction.low_byte]
    element, line = cursor.element & element_bits(processor), cursor.line
    if instruction.format.name == "RCSP":
        element, line = pixel_at(processor.parameters, processor.configuration, cursor.element, line)
    state = processor.cursors.read_state(instruction.low_byte)
    processor.reply(np.array((element, line & LINE_BITS | state & ~LINE_BITS), np.uint16))


def read_global_cursor(processor: Processor, instruction: Instruction) -> None:
    """Reply the place of a cursor in global coordinates; the state is a separate word."""
    if not has_cursor(processor, instruction):
        return processor.reply(np.zeros(3, np.uint16))
    cursor = processor.cursors[instruction.low_byte]
    state = processor.cursors.read_state(instruction.low_byte)
    processor.reply(np.array((cursor.element & 0xFFFF, cursor.line & 0xFFFF, state), np.uint16))


def load_cursor_shape(processor: Processor, instruction: Instruction) -> None:
    """Hardware: JPL (32 rows of two words, low byte first). Assumed: fewer rows replace the topmost ones."""
    if has_cursor(processor, instruction):
        words = instruction.data[: (instruction.length or 0) // 4 * 2]
        rows = words.astype("<u2").view(np.uint8).reshape(-1, 4)
        processor.cursors.set_shape(instruction.low_byte, rows[:SHAPE_SIZE])


def connect_device(processor: Processor, instruction: Instruction) -> None:
    """Hardware: JPL (bit c: the device drives cursor c)."""
    processor.cursors.driven[instruction.low_byte] = instruction.operands["cursors"][0]


EXECUTORS: Final[Executors] = {
    "WCSS": write_cursor,
    "WCSP": write_cursor,
    "WCSG": write_global_cursor,
    "RCSS": read_cursor,
    "RCSP": read_cursor,
    "RCSG": read_global_cursor,
    "LCF": load_cursor_shape,
    "DDCC": connect_device,
}
