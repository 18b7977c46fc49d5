"""Encoders: functions that return the words of instructions, for a host to send.

They set up the display, write and read images, draw circles, areas, lines and text, place cursors, and load
and read the lookup table. An operand that is left out keeps the value that an earlier instruction set.

    >>> " ".join(f"{word:04X}" for word in set_parameters(foreground=1))
    '0802 0002 0001'
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise
from struct import Struct
from typing import Final

import numpy as np

from ramtek_emu.arrays import Words
from ramtek_emu.checks import (
    checked_colors,
    checked_coordinate,
    checked_factors,
    checked_number,
    checked_stream,
    checked_words,
    whole_numbers,
)
from ramtek_emu.drawing.vectors import points
from ramtek_emu.errors import InstructionError, WordsError
from ramtek_emu.instruction_set.instruction import (
    MOST_BYTES,
    NO_WORDS,
    Instruction,
    OperandValue,
    encode,
    normal,
)
from ramtek_emu.instruction_set.table import FORMAT_OF_NAME, Flags
from ramtek_emu.memory.scan_orders import Window


def concatenate(*parts: Words) -> Words:
    """Several streams joined into one stream."""
    return np.concatenate([checked_stream(part) for part in parts]) if parts else NO_WORDS


def reset() -> Words:
    """RSET: set every parameter as at power-on and erase the screen; the lookup table is kept."""
    return encode(Instruction(FORMAT_OF_NAME["RSET"]))


def set_parameters(**operands: OperandValue | None) -> Words:
    """SET: set operands by name (`foreground=3`, `window=(0, 0, 639, 479)`); they stay until set again."""
    return encode(normal("SET", operands))


def zoom(across: int = 1, down: int | None = None) -> Words:
    """ZOOM: show each pixel `across` elements wide and `down` lines high (1 to 16; None is `across`).

    Only the 9400 and the 9460 have it.
    """
    factors = across if down is None else (across, down)
    across, down = checked_factors(factors, "a zoom factor", "choose another")
    return np.array((FORMAT_OF_NAME["ZOOM"].opcode << 8, (down - 1) << 8 | (across - 1)), np.uint16)


def erase(window: Sequence[int] | None = None, word: int | None = None) -> Words:
    """ERS: fill a window with a word. The window stays set, and the word stays set as the background."""
    return encode(normal("ERS", {"window": window, "background": word}))


def write_image(words: object, left: int = 0, top: int = 0, planes: int = 10) -> Words:
    """WI: write a (lines, elements) array of words with its top-left corner at (left, top).

    The first instruction sets the window. An image that is too long for one instruction continues in further
    instructions. WordsError names the first word with more bits than `planes`.
    """
    planes = checked_number(planes, "the number of planes", 1, 16, "choose that of the display", WordsError)
    left, top = (checked_coordinate(place, "the words' corner") for place in (left, top))
    image = checked_words(words, planes)
    lines, elements = image.shape
    window = (left, top, left + elements - 1, top + lines - 1)
    return in_instructions("WI", {"window": window}, image.reshape(-1), elements)


def read_image(left: int, top: int, elements: int, lines: int) -> Iterator[tuple[Words, int]]:
    """RI: read a window. Yields the instructions, with the number of words to receive after each of them."""
    left, top = (checked_coordinate(place, "the corner of the words to read") for place in (left, top))
    elements, lines = (
        checked_number(count, f"the {name} to read", 1, 0x10000, "read one at least", InstructionError)
        for count, name in ((elements, "elements"), (lines, "lines"))
    )
    most = MOST_BYTES // 2
    window: tuple[int, ...] | None = (left, top, left + elements - 1, top + lines - 1)
    for start in range(0, elements * lines, most):
        count = min(most, elements * lines - start)
        yield encode(normal("RI", {"window": window}, length=2 * count)), count
        window = None


def write_circles(circles: object, word: int | None = None) -> Words:
    """CIRC: draw the outlines of (n, 3) circles (element and line of the center, radius).

    Circles that do not fit in one instruction continue in the next. Only the 9400 and the 9460 have it.
    WordsError if the circles are not such an array.
    """
    words = checked_places(circles, "circles", "circle", ("element", "line", "radius"))
    return in_instructions("CIRC", {"foreground": word}, words.reshape(-1), 3)


def fill(element: int, line: int, word: int | None = None) -> Words:
    """FILL: fill the area around a pixel with the foreground, up to pixels that have it already.

    Only the 9400 and the 9460 have it.
    """
    operands: dict[str, OperandValue | None] = {"foreground": word, "start": (element, line)}
    return encode(normal("FILL", operands, np.zeros(1, np.uint16)))


def write_vectors(vertices: object, word: int | None = None, start: Sequence[int] | None = None) -> Words:
    """WVL: draw the lines that link (n, 2) vertices (element, line), from `start` or the first vertex on.

    Vertices that do not fit in one instruction continue in the next. The word stays set as the foreground.
    Lines are clipped at the memory, never at the window of images and text. The 9400 and the 9460 draw with
    the texture, and clip at the write window: if other programs drew before, set both with `set_parameters`.
    The mask is never set. WordsError if the vertices are not such an array.
    """
    words = checked_places(vertices, "vertices", "vertex", ("element", "line"))
    if start is None:
        start = words[0].tolist()
        words = words[1:] if len(words) > 1 else words
    return in_instructions("WVL", {"foreground": word, "start": start}, words.reshape(-1), 2)


def in_instructions(name: str, operands: dict[str, OperandValue | None], data: Words, columns: int) -> Words:
    """The instructions for data in rows of so many words; the first instruction sets the operands.

    An instruction ends with a row, if one has room for a row.
    """
    most = MOST_BYTES // 2
    most -= most % columns if columns < most else 0
    first = encode(normal(name, operands, data[:most]))
    rest = (encode(normal(name, {}, data[start : start + most])) for start in range(most, len(data), most))
    return concatenate(first, *rest) if len(data) > most else first


FEW_RUNS: Final = 8
"""Up to this number of runs of linked lines, an instruction for each is faster than a raster."""


def write_segments(segments: object, word: int | None = None) -> Words:
    """WVL or WR: draw lines from (n, 4) segments (element, line of the start; element, line of the end).

    A 9300 has an instruction for linked lines alone. So a few runs of linked segments are sent by WVL each.
    Thousands of instructions would take long: instead, the pixels of solid lines are sent as a raster of one
    bit a pixel, in the box around them, without elements and lines above 4095. So a texture may change a few
    lines, and never many. The word stays set, and with a raster the window and the scan order. WordsError if
    the segments are not such an array.
    """
    words = checked_places(segments, "segments", "segment", ("element", "line", "element", "line"))
    breaks = np.flatnonzero((words[1:, :2] != words[:-1, 2:]).any(axis=1)) + 1
    if len(breaks) < FEW_RUNS:
        runs = [words[a:b] for a, b in pairwise((0, *breaks, len(words)))]
        return concatenate(*(write_vectors(run[:, 2:], word, run[0, :2].tolist()) for run in runs))
    ends = words.view(np.int16).astype(np.int64).reshape(-1, 2)
    box = Window(*ends.min(axis=0).tolist(), *ends.max(axis=0).tolist())
    box = box.intersection(Window(0, 0, 4095, 4095))
    if box.is_empty:
        return NO_WORDS
    dots = np.zeros((box.height, box.width), np.bool_)
    for elements, lines, _, _ in points(ends[::2], ends[1::2], box):
        dots[lines - box.top, elements - box.left] = True
    operands: dict[str, OperandValue | None] = {"foreground": word, "scan_order": 0}
    most = MOST_BYTES * 8 // box.width
    parts = []
    for first in range(0, len(dots), most):
        strip = dots[first : first + most]
        top = box.top + first
        operands["window"] = (box.left, top, box.right, top + len(strip) - 1)
        data = np.packbits(strip).tobytes()
        parts.append(encode(normal("WR", operands, packed(data), len(data), Flags.ADDITIVE)))
    return concatenate(*parts)


def packed(data: bytes) -> Words:
    """Bytes as words, the first byte high; a byte of 0 pads the last word."""
    return np.frombuffer(data + bytes(len(data) % 2), ">u2").astype(np.uint16)


def checked_places(values: object, things: str, thing: str, columns: tuple[str, ...]) -> Words:
    """The values as rows of 16-bit words; WordsError unless they are rows of whole numbers, at least one."""
    numbers = whole_numbers(values, things, WordsError)
    if numbers.ndim != 2 or numbers.shape[1] != len(columns) or not len(numbers):
        raise WordsError(
            f"{things} must be an (n, {len(columns)}) array of {', '.join(columns[:-1])} and {columns[-1]} "
            f"with at least one row, not of shape {numbers.shape}; reshape it"
        )
    least = np.array([0 if column == "radius" else -0x8000 for column in columns])
    if (numbers < least).any() or numbers.max() > 0xFFFF:
        raise WordsError(
            f"a {thing} must be within {least.tolist()} to 65535, not {numbers.min(axis=0).tolist()} to "
            f"{numbers.max()}; clip it first"
        )
    return (numbers.astype(np.int64) & 0xFFFF).astype(np.uint16)


def write_text(
    text: str | bytes,
    left: int,
    top: int,
    word: int | None = None,
    background: int | None = None,
    size: int | tuple[int, int] = 1,
    transparent: bool = False,
) -> Words:
    """WT: write text in cells of 7 x 9 dots, the top-left corner of the first cell at (left, top).

    Each dot is repeated `size` times, or (across, down) times. With `transparent=True` the pixels between the
    dots stay unchanged. The window, the words and the size stay set. Characters that are not ASCII become
    question marks.
    """
    if not isinstance(text, str | bytes | bytearray):
        raise InstructionError(
            f"text must be a str or bytes, not {type(text).__name__}; write str() around it"
        )
    data = text.encode("ascii", "replace") if isinstance(text, str) else bytes(text)
    across, down = checked_factors(size, "the size of text", "write it smaller")
    left, top = (checked_coordinate(place, "the corner of text") for place in (left, top))
    window = (left, top, left + 7 * across * max(1, len(data)) - 1, top + 9 * down - 1)
    operands: dict[str, OperandValue | None] = {
        "foreground": word,
        "background": background,
        "window": window,
        "scan_order": 0,
        "dimensions": (7, 9),
        "spacing": (0, 0),
        "scale": (down - 1) << 8 | (across - 1),
    }
    return encode(normal("WT", operands, packed(data), len(data), Flags.ADDITIVE if transparent else 0))


CURSOR: Final = ("a cursor's number", 0, 255, "choose one there is", InstructionError)
TABLE_ADDRESS: Final = ("a table's address", 0, 0xFFFF, "count in words", InstructionError)
"""The arguments of `checked_number`."""


def write_cursor(
    number: int, element: int, line: int, *, visible: bool = True, blinking: bool = False
) -> Words:
    """WCSS: place a cursor on the screen, and show or hide it."""
    number = checked_number(number, *CURSOR)
    element, line = (
        checked_number(place, f"a cursor's {name}", 0, most, "keep to the screen", InstructionError)
        for place, name, most in ((element, "element", 0x7FF), (line, "line", 0x3FF))
    )
    state = (0x0400 if visible else 0) | (0x0800 if blinking else 0)
    return np.array((FORMAT_OF_NAME["WCSS"].opcode << 8 | number, element, line | state), np.uint16)


def read_cursor(number: int) -> Words:
    """RCSS: ask for a cursor; then receive two words: element, and line with the state above ten bits."""
    return np.array([FORMAT_OF_NAME["RCSS"].opcode << 8 | checked_number(number, *CURSOR)], np.uint16)


THREE_WORDS: Final = Struct("<3H")
LOAD: Final = FORMAT_OF_NAME["LAM"].opcode << 8
"""The instruction word of LAM for table 0."""


def load_entries(first: int, colors: object, entries: int = 1024, short: bool = False) -> Words:
    """LAM: load (n, 3) colors, 0 to 255, into the entries from `first` on, in the 24-bit format.

    With `short=True` it is the 12-bit format, which has the upper four bits of each component. `entries` is
    the size of the table, at most 4096; ColorsError if the colors do not fit.
    """
    checked = checked_colors(first, colors, entries)
    if short:
        red, green, blue = checked.astype(np.uint16).T >> 4
        head = np.array((LOAD, int(first), 2 * len(checked)), np.uint16)
        return np.concatenate((head, red << 8 | green << 4 | blue))
    # In the memory of a VAX the two words of an entry are the bytes blue, green, red, 0. Measured: bytes take
    # a third to half of the time of arrays, and each step of a dragged color is a load.
    data = checked.tobytes()
    memory = bytearray(6 + 4 * len(checked))
    memory[6::4], memory[7::4], memory[8::4] = data[2::3], data[1::3], data[0::3]
    memory[:6] = THREE_WORDS.pack(LOAD, 2 * int(first), 4 * len(checked))
    return np.frombuffer(memory, "<u2")


def park_table(address: int = 0) -> Words:
    """LAM without data: set the address counter of the table, whose upper bits select the section shown.

    Hardware: LIN, JPL, NCAR send it after a load; it matters with fewer planes than address bits.
    """
    return np.array((LOAD, checked_number(address, *TABLE_ADDRESS), 0), np.uint16)


def read_entries(address: int = 0, words: int = 2048) -> Words:
    """RAM: ask for `words` words of the lookup table from a word address on; then receive them."""
    words = checked_number(
        words, "the words to read", 0, MOST_BYTES // 2, "read the rest with another", InstructionError
    )
    return np.array(
        (FORMAT_OF_NAME["RAM"].opcode << 8, checked_number(address, *TABLE_ADDRESS), 2 * words), np.uint16
    )
