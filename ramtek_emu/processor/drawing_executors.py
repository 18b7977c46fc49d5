"""Executors of the instructions that draw: vectors, points, conics, circles, plots and text.

Assumed: with the additive flag, the pixels between the dots of characters, rasters and textures stay
unchanged, as its name suggests; without it the background word is written there.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

import numpy as np

from ramtek_emu.arrays import Numbers
from ramtek_emu.drawing import curves, plots, text, vectors
from ramtek_emu.instruction_set.instruction import Instruction
from ramtek_emu.instruction_set.table import Flags
from ramtek_emu.memory.character_rom import characters
from ramtek_emu.memory.parameters import STANDARD_FONT, Parameters, register
from ramtek_emu.memory.scan_orders import Point
from ramtek_emu.processor.processor import Executors, Pauses, Processor


def follow(parameters: Parameters, points: Numbers, slices: Iterator[int]) -> Pauses:
    """Pause after each slice, with the operating point at the last of the (n, 2) points that are drawn."""
    for drawn in slices:
        parameters.start = Point(*points[drawn - 1].tolist())
        yield
    parameters.start = Point(*points[-1].tolist())


def write_linked_vectors(processor: Processor, instruction: Instruction) -> Pauses | None:
    """Draw from the operating point through all vertices; the operating point moves to the last.

    Hardware: LIN, BTL, JPL (from the operating point through every vertex; it ends at the last); BTL (a
    vector to the operating point is a point); NCAR (texture, write window).
    """
    ends = processor.placed(processor.points(instruction), instruction.low_byte)
    starts = np.concatenate(([processor.parameters.start], ends[:-1]))
    return write_lines(processor, instruction, starts, ends, linked=True)


def write_unlinked_vectors(processor: Processor, instruction: Instruction) -> Pauses | None:
    """Assumed: four numbers for each vector, start and end; the operating point moves to the last end."""
    points = processor.points(instruction, 4).reshape(-1, 2)
    points = processor.placed(points, instruction.low_byte)
    return write_lines(processor, instruction, points[0::2], points[1::2], linked=False)


def write_lines(
    processor: Processor, instruction: Instruction, starts: Numbers, ends: Numbers, linked: bool
) -> Pauses | None:
    """Draw lines with the instruction's words and texture."""
    if not len(ends):
        return None
    parameters = processor.parameters
    transparent = bool(instruction.low_byte & Flags.ADDITIVE)
    ink = vectors.Ink(*processor.colors(instruction), parameters.texture, transparent)
    slices = vectors.write_lines(processor.frame_buffer, starts, ends, ink, parameters.enable, linked)
    return follow(parameters, ends, slices)


def write_points(processor: Processor, instruction: Instruction) -> None:
    """Hardware: NCAR (disabled code: two numbers a point). Assumed: the operating point moves to the last."""
    parameters = processor.parameters
    points = processor.placed(processor.points(instruction), instruction.low_byte)
    if len(points):
        word, _ = processor.colors(instruction)
        processor.frame_buffer.write_points(points[:, 0], points[:, 1], word, parameters.enable)
        parameters.start = Point(*points[-1].tolist())


def write_circles(processor: Processor, instruction: Instruction) -> Pauses | None:
    """Hardware: JPL rtekinc.h, NCAR (center, radius); NCAR (the operating point becomes the center).

    Assumed: three numbers for each of several circles; radii are 16-bit numbers without a sign; with relative
    addressing each center is counted from the one before.
    """
    parameters = processor.parameters
    circles = processor.points(instruction, 3)
    if not len(circles):
        return None
    word, _ = processor.colors(instruction)
    centers = processor.placed(circles[:, :2], instruction.low_byte)
    radii = circles[:, 2] & 0xFFFF
    slices = curves.write_circles(processor.frame_buffer, centers, radii, word, parameters.enable)
    return follow(parameters, centers, slices)


def write_conic(processor: Processor, instruction: Instruction) -> Pauses:
    """Hardware: LIN (from the operating point to the data point, or for a number of pixels).

    Assumed: the operating point moves to the last pixel; of several data points the first is used; without a
    data point and without a number of pixels, a closed curve is drawn once.
    """
    parameters = processor.parameters
    points = processor.placed(processor.points(instruction)[:1], instruction.low_byte)
    stop = Point(*points[0].tolist()) if len(points) else None
    elements, lines = yield from curves.conic_pixels(parameters.conic, parameters.start, stop)
    word, _ = processor.colors(instruction)
    processor.frame_buffer.write_points(elements, lines, word, parameters.enable)
    parameters.start = Point(int(elements[-1]), int(lines[-1]))


def write_plot(processor: Processor, instruction: Instruction) -> Pauses:
    """Draw a bar for each number of the data, from the base line to the number.

    Hardware: LIN libdoc (a starting point, a scanning mode, the dimension and the spacing in the direction of
    scanning, a base line); LIN fplot.c (data are lines of the screen; DIM 1 and SPACE 1 put n numbers on n
    elements, so that spacing is the distance of two bars and dimension the width of a bar).
    Assumed: the opcode, by NCAR's name and by its place among the opcodes of the 9300; that all operands come
    by flag words as in other instructions; that a plot has bars in the foreground, which include the base
    line and the number. The second words of DIM and SPACE have no effect; a DIM of 0 is 1, as for characters.
    The scan order gives the direction of the steps; data and base line are the coordinates across it,
    absolute in each addressing mode, with a sign. Only the memory and the write window clip. The operating
    point is then where the next bar begins, at the last number, as fplot.c starts at the first number.
    """
    word, _ = processor.colors(instruction)
    values = processor.points(instruction, 1)[:, 0]
    end = yield from plots.write_bars(processor.frame_buffer, processor.parameters, values, word)
    processor.parameters.start = end


def write_text(processor: Processor, instruction: Instruction) -> Pauses:
    """Hardware: BTL, LIN, JPL (cells of 7 x 9); LIN (the swap flag); JPL (size factors)."""
    foreground, background = processor.colors(instruction)
    is_standard = processor.parameters.font == STANDARD_FONT
    next_cell = yield from text.write_text(
        processor.frame_buffer,
        processor.parameters,
        characters() if is_standard else processor.loaded_characters,
        instruction.data_bytes(),
        foreground=foreground,
        background=background,
        transparent=bool(instruction.low_byte & Flags.ADDITIVE),
    )
    processor.parameters.start = register(next_cell)


def load_character(processor: Processor, instruction: Instruction) -> None:
    """Hardware: LIN (twelve rows, a byte each, the first in the high byte).

    Assumed: in LPFRP the first row is in the low byte, from its name. The highest bit is the leftmost dot, as
    in rasters. The character of that code is replaced until the display is switched off, since RSET keeps the
    lookup table too.
    """
    words = [word for (word,) in instruction.operands.values()]
    rows = np.array(words, "<u2" if instruction.format.name == "LPFRP" else ">u2").view(np.uint8)
    shape = np.unpackbits(rows[:, np.newaxis], axis=1).astype(np.bool_)
    processor.loaded_characters[instruction.low_byte] = shape


def attach_font(processor: Processor, instruction: Instruction) -> None:
    """Hardware: NCAR (FFh: the standard font). Assumed: any other number: the loaded characters."""
    processor.parameters.font = instruction.low_byte


EXECUTORS: Final[Executors] = {
    "WVL": write_linked_vectors,
    "WVU": write_unlinked_vectors,
    "WPT": write_points,
    "CIRC": write_circles,
    "WC": write_conic,
    "WPB": write_plot,
    "WT": write_text,
    "LPF": load_character,
    "LPFRP": load_character,
    "ATTPF": attach_font,
}
