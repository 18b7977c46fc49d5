"""Encoders of circles and of areas that are filled."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ramtek_emu.arrays import Words
from ramtek_emu.checks import whole_numbers
from ramtek_emu.errors import WordsError
from ramtek_emu.instruction_set.instruction import MOST_BYTES, OperandValue, encode, normal


def write_circles(circles: Sequence[Sequence[int]], word: int | None = None) -> Words:
    """CIRC: draw the outlines of (n, 3) circles: element and line of the center, and radius."""
    numbers = whole_numbers(circles, "circles", WordsError)
    if numbers.ndim != 2 or numbers.shape[1] != 3 or not 0 < len(numbers) <= MOST_BYTES // 6:
        raise WordsError(
            f"circles must be an (n, 3) array of element, line and radius with 1 to {MOST_BYTES // 6} rows, "
            f"not of shape {numbers.shape}; reshape or divide it"
        )
    least, most = numbers.min(axis=0), numbers.max(axis=0)
    if (least < (-0x8000, -0x8000, 0)).any() or (most > 0xFFFF).any():
        raise WordsError(
            "a circle must have a center within -32768 to 65535 and a radius within 0 to 65535, not "
            f"{least.tolist()} to {most.tolist()}; leave out what lies farther away"
        )
    words = (numbers.astype(np.int64) & 0xFFFF).astype(np.uint16)
    return encode(normal("CIRC", {"foreground": word}, words.reshape(-1)))


def fill(element: int, line: int, word: int | None = None) -> Words:
    """FILL: fill the area around a pixel with the foreground, up to pixels that have it already."""
    operands: dict[str, OperandValue | None] = {"foreground": word, "start": (element, line)}
    return encode(normal("FILL", operands, np.zeros(1, np.uint16)))
