"""Encoders of images: windows that are filled, written and read."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import lru_cache

import numpy as np

from ramtek_emu.arrays import Words
from ramtek_emu.checks import checked_coordinate, checked_number, checked_words
from ramtek_emu.errors import InstructionError, WordsError
from ramtek_emu.instruction_set.instruction import MOST_BYTES, encode, normal
from ramtek_emu.instruction_set.table import FORMAT_OF_NAME, Flags


def erase(window: Sequence[int] | None = None, word: int | None = None) -> Words:
    """ERS: fill a window with a word. Both stay set, the word as the background."""
    return encode(normal("ERS", {"window": window, "background": word}))


def write_image(words: object, left: int = 0, top: int = 0, planes: int = 10) -> Words:
    """WI: write a (lines, elements) array of words with its top-left corner at (left, top).

    The first instruction sets the window. An image that is too long for one instruction goes on in further
    ones. WordsError names the first word that has more bits than there are planes.
    """
    planes = checked_number(planes, "the number of planes", 1, 16, "choose that of the display", WordsError)
    left, top = (checked_coordinate(each, "the words' corner") for each in (left, top))
    image = checked_words(words, planes)
    lines, elements = image.shape
    flat = np.ascontiguousarray(image).reshape(-1)
    most = MOST_BYTES // 2
    if elements <= most:
        most -= most % elements
    starts = range(0, flat.size, most)
    head = image_head(left, top, left + elements - 1, top + lines - 1, 2 * min(most, flat.size))
    stream = np.empty(flat.size + len(head) + 2 * (len(starts) - 1), np.uint16)
    place = 0
    for start in starts:
        part = flat[start : start + most]
        first = head if start == 0 else (FORMAT_OF_NAME["WI"].opcode << 8 | Flags.DATA, 2 * part.size)
        stream[place : place + len(first)] = first
        place += len(first)
        stream[place : place + part.size] = part
        place += part.size
    return stream


@lru_cache(maxsize=64, typed=True)
def image_head(left: int, top: int, right: int, bottom: int, length: int) -> Words:
    """The words of a WI with a window, up to its data."""
    head = encode(normal("WI", {"window": (left, top, right, bottom)}, length=length))
    head.flags.writeable = False
    return head


def read_image(left: int, top: int, elements: int, lines: int) -> Iterator[tuple[Words, int]]:
    """RI: read a window, in as many instructions as needed, each with the number of words to receive."""
    left, top = (checked_coordinate(each, "the corner of the words to read") for each in (left, top))
    elements, lines = (
        checked_number(each, f"the {name} to read", 1, 0x10000, "read one at least", InstructionError)
        for each, name in ((elements, "elements"), (lines, "lines"))
    )
    most = MOST_BYTES // 2
    if elements <= most:
        most -= most % elements
    window: tuple[int, ...] | None = (left, top, left + elements - 1, top + lines - 1)
    for start in range(0, elements * lines, most):
        count = min(most, elements * lines - start)
        yield encode(normal("RI", {"window": window}, length=2 * count)), count
        window = None
