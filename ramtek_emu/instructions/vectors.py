"""Encoders of straight lines, linked and unlinked.

Lines are clipped at the write window, never at the window of images and text, and are drawn with the texture.
Both stay as earlier instructions set them. Where other programs drew before, give the window: it is sent with
a texture without gaps. Both are operands that only the 9400 and the 9460 have.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from ramtek_emu.arrays import Words
from ramtek_emu.checks import whole_numbers
from ramtek_emu.errors import WordsError
from ramtek_emu.instruction_set.instruction import MOST_BYTES, OperandValue, encode, normal
from ramtek_emu.instructions.streams import concatenate

SOLID: Final = (0xFFFF, 0)
"""The texture without gaps."""


def write_vectors(
    vertices: object,
    word: int | None = None,
    start: Sequence[int] | None = None,
    window: Sequence[int] | None = None,
) -> Words:
    """WVL: draw the lines that link (n, 2) vertices (element, line), from `start` or the first vertex on.

    Vertices that do not fit in one instruction go on in the next. The word stays set as the foreground.
    `window` (left, top, right, bottom) sets the write window, which stays and clips images and text too, and
    a texture without gaps; the mask is never set. WordsError if the vertices are not such an array.
    """
    words = checked_places(vertices, "vertices", "vertex", ("element", "line"))
    if start is None:
        start = words[0].tolist()
        words = words[1:] if len(words) > 1 else words
    return in_instructions("WVL", words, {**surroundings(word, window), "start": start})


def write_segments(segments: object, word: int | None = None, window: Sequence[int] | None = None) -> Words:
    """WVU: draw a line for each of (n, 4) segments (element, line, element, line), from end to end.

    Segments that do not fit in one instruction go on in the next. The word and the window stay set, as after
    `write_vectors`. WordsError if the segments are not such an array.
    """
    words = checked_places(segments, "segments", "segment", ("element", "line", "element", "line"))
    return in_instructions("WVU", words, surroundings(word, window))


def surroundings(word: int | None, window: Sequence[int] | None) -> dict[str, OperandValue | None]:
    """The operands that lines depend on."""
    return {"foreground": word, "write_window": window, "texture": None if window is None else SOLID}


def in_instructions(name: str, rows: Words, operands: dict[str, OperandValue | None]) -> Words:
    """The instructions for rows of coordinates; the first sets the operands."""
    most = MOST_BYTES // (2 * rows.shape[1])
    parts = []
    for first in range(0, len(rows), most):
        parts.append(encode(normal(name, operands, rows[first : first + most].reshape(-1))))
        operands = {}
    return concatenate(*parts)


def checked_places(values: object, things: str, thing: str, columns: tuple[str, ...]) -> Words:
    """The values as rows of 16-bit words; WordsError unless they are at least one row of whole numbers."""
    numbers = whole_numbers(values, things, WordsError)
    if numbers.ndim != 2 or numbers.shape[1] != len(columns) or not len(numbers):
        raise WordsError(
            f"{things} must be an (n, {len(columns)}) array of {', '.join(columns[:-1])} and {columns[-1]} "
            f"with at least one row, not of shape {numbers.shape}; reshape it"
        )
    if numbers.min() < -0x8000 or numbers.max() > 0xFFFF:
        raise WordsError(
            f"a {thing} must be within -32768 to 65535, not {numbers.min()} to {numbers.max()}; "
            "clip the lines first"
        )
    return (numbers.astype(np.int64) & 0xFFFF).astype(np.uint16)
