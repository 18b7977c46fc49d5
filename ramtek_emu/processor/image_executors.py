"""Executors of the instructions for images and for the lookup table.

Images are erased, written, read, filled and copied, and rasters of one bit a pixel are written. The lookup
table is loaded and read.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from ramtek_emu.drawing import areas
from ramtek_emu.instruction_set.instruction import Instruction
from ramtek_emu.instruction_set.table import Flags
from ramtek_emu.memory.frame_buffer import NORMAL_ORDER
from ramtek_emu.memory.parameters import register
from ramtek_emu.memory.scan_orders import Point, Window
from ramtek_emu.processor.processor import Executors, Pauses, Processor


def erase(processor: Processor, instruction: Instruction) -> Pauses | None:
    """Hardware: NCAR (the window alone), JPL (through the mask; foreground with the swap flag).

    Assumed: BERS fills the whole memory and ignores the windows: the B stands for bulk.
    """
    parameters = processor.parameters
    window, enable = parameters.window, parameters.enable
    if instruction.format.name == "BERS":
        window = parameters.whole_window
        enable = enable._replace(window=window)
    _, background = processor.colors(instruction)
    return areas.fill_window(processor.frame_buffer, window, background, enable)


def write_image(processor: Processor, instruction: Instruction) -> None:
    """Hardware: LIN, PIC (one word a pixel); JPL, NCAR (mode 1, two pixels a word; a run goes on).

    Assumed: if the number of bytes is odd, the last byte is dropped in mode 0 and is a pixel in mode 1. In
    mode 1 the upper planes become 0. For pairs of pixels at the edge of the window see scan_orders.
    """
    parameters = processor.parameters
    pairs = bool(parameters.image_mode & 1)
    if pairs:
        words = np.frombuffer(instruction.data_bytes(), np.uint8).astype(np.uint16)
    else:
        words = instruction.data[: (instruction.length or 0) // 2]
    end = processor.frame_buffer.write_scan(
        parameters.window, parameters.order, parameters.start, words, parameters.enable, pairs=pairs
    )
    parameters.start = register(end)


def read_image(processor: Processor, instruction: Instruction) -> None:
    """Hardware: LIN (one word a pixel), NCAR (the read mask).

    Assumed: planes that do not exist read as 0. Reading moves the operating point as writing does. The byte
    that pads the last word is 0.
    """
    parameters = processor.parameters
    length, pairs = instruction.length or 0, bool(parameters.image_mode & 1)
    count = length if pairs else length // 2
    words, end = processor.frame_buffer.read_scan(
        parameters.window, parameters.order, parameters.start, count, pairs
    )
    parameters.start = register(end)
    words &= np.uint16(parameters.read_mask)
    if pairs:
        data = words.astype(np.uint8).tobytes() + bytes(length % 2)
        reverse = instruction.low_byte & Flags.REVERSE_PACKING
        words = np.frombuffer(data, "<u2" if reverse else ">u2").astype(np.uint16)
    processor.reply(words)


def write_raster(processor: Processor, instruction: Instruction) -> None:
    """Write one bit a pixel: foreground for 1, background for 0.

    Hardware: PRG rast.c, LIN wr.c (one bit a pixel into the window in scan order, bytes as in text, highest
    bit first); PRG rread.c, rast.c (1 is the foreground: rread sets the bit of a dark pixel, and rast draws
    word 64 on word 128).
    Assumed: a line of the window need not end with a byte; with the additive flag, pixels of 0 are not
    written.
    """
    parameters = processor.parameters
    data = np.frombuffer(instruction.data_bytes(), np.uint8)
    foreground, background = processor.colors(instruction)
    bits = np.unpackbits(data)
    dots = bits.astype(np.bool_) if instruction.low_byte & Flags.ADDITIVE else None
    words = np.array((background, foreground), np.uint16)[bits]
    parameters.start = register(
        processor.frame_buffer.write_scan(
            parameters.window, parameters.order, parameters.start, words, parameters.enable, dots
        )
    )


def write_random_pixels(processor: Processor, instruction: Instruction) -> None:
    """Assumed: three numbers a pixel, element, line and word; the operating point ends at the last."""
    parameters = processor.parameters
    pixels = processor.points(instruction, 3)
    if len(pixels):
        points = processor.placed(pixels[:, :2], instruction.low_byte)
        words = (pixels[:, 2] & 0xFFFF).astype(np.uint16)
        processor.frame_buffer.write_points(points[:, 0], points[:, 1], words, parameters.enable)
        parameters.start = Point(*points[-1].tolist())


def fill(processor: Processor, instruction: Instruction) -> Pauses:
    """Fill the area around the operating point with the foreground.

    Hardware: NCAR (disabled code: mode 0 is "fill until"; a circle was drawn in the foreground before; words
    are compared through the read mask).
    Assumed: in mode 0, or without data, the area ends at pixels of the foreground; in every other mode it
    consists of pixels with the word at the operating point. Pixels are connected up, down, left and right,
    within the memory and the write window. If the operating point is outside, nothing is filled. The
    operating point does not move.
    """
    parameters = processor.parameters
    frame_buffer = processor.frame_buffer
    inside = parameters.write_window.intersection(frame_buffer.window)
    if not inside.holds(parameters.start):
        return
    mask, words = np.uint16(parameters.read_mask), frame_buffer.words
    foreground, _ = processor.colors(instruction)
    by_seed = (instruction.length or 0) >= 2 and bool(instruction.data[0])
    seed = words[parameters.start.line, parameters.start.element]
    word = (seed if by_seed else np.uint16(foreground & parameters.whole_word)) & mask
    compare = np.equal if by_seed else np.not_equal
    fenced = np.zeros((inside.height, inside.width + 2), np.bool_)
    for band in areas.bands(inside):
        part = words[band.top : band.bottom + 1, inside.left : inside.right + 1] & mask
        compare(part, word, out=fenced[band.top - inside.top : band.bottom + 1 - inside.top, 1:-1])
        yield
    yield from areas.fill_area(frame_buffer, inside, fenced, parameters.start, foreground, parameters.enable)


def copy_image(processor: Processor, instruction: Instruction) -> Pauses:
    """Copy the window to another place.

    Assumed: the data are the element and the line of the corner where the scan of the copy starts; without
    data, that corner is the operating point. All words are read, through the read mask, before the first word
    is written. Outside the memory nothing is copied. The operating point moves to that corner.
    """
    parameters = processor.parameters
    points = processor.placed(processor.points(instruction)[:1], instruction.low_byte)
    corner = Point(*points[0].tolist()) if len(points) else parameters.start
    origin = parameters.order.corner(parameters.window)
    across, down = corner.element - origin.element, corner.line - origin.line
    inside = parameters.window.intersection(processor.frame_buffer.window)
    parameters.start = corner
    if inside.is_empty:
        return
    bands = list(areas.bands(inside))
    blocks = []
    for band in bands:
        words = processor.frame_buffer.words[band.top : band.bottom + 1, band.left : band.right + 1]
        blocks.append(words & np.uint16(parameters.read_mask))
        yield
    for band, block in zip(bands, blocks, strict=True):
        place = Window(band.left + across, band.top + down, band.right + across, band.bottom + down)
        processor.frame_buffer.write_block(place, NORMAL_ORDER, block, parameters.enable)
        yield


def load_lookup_table(processor: Processor, instruction: Instruction) -> None:
    """Hardware: JPL, NCAR (the device number is the number of a table, 0 on systems of one channel).

    Assumed: words for a table that does not exist are dropped.
    """
    if instruction.low_byte == 0:
        words = instruction.data[: (instruction.length or 0) // 2]
        processor.lookup_table.load(instruction.operands["address"][0], words)


def read_lookup_table(processor: Processor, instruction: Instruction) -> None:
    """Hardware: JPL (the packing of LAM). Assumed: a table that does not exist reads as zeros."""
    count = (instruction.length or 0) // 2
    if instruction.low_byte == 0:
        processor.reply(processor.lookup_table.read(instruction.operands["address"][0], count))
    else:
        processor.reply(np.zeros(count, np.uint16))


EXECUTORS: Final[Executors] = {
    "ERS": erase,
    "BERS": erase,
    "WI": write_image,
    "RI": read_image,
    "WR": write_raster,
    "WRP": write_random_pixels,
    "FILL": fill,
    "COPY": copy_image,
    "LAM": load_lookup_table,
    "RAM": read_lookup_table,
}
