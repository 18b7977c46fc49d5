"""Dirty lines: the part of a field that changes when entries of the lookup table are loaded."""

from __future__ import annotations

from typing import Any, Final

import numpy as np

from ramtek_emu.arrays import Words

STRIP: Final = 32
"""How many lines are searched at once."""


def lines_with(words: Words, first: int, end: int) -> tuple[int, int]:
    """The first line that contains a word from `first` to `end` - 1, and the line after the last such line.

    (0, 0) if no line contains one.
    """
    # Search from the top and from the bottom, and skip what lies between. Measured: searching every line
    # takes twice as long. Returning whole strips would save a tenth of a scan-out once, and cost a twentieth
    # of one for each field while a color is dragged.
    top, bottom = 0, len(words)
    while top < bottom and least_above(words[top : top + STRIP], first) >= end - first:
        top += STRIP
    if top >= bottom:
        return (0, 0)
    while least_above(words[max(0, bottom - STRIP) : bottom], first) >= end - first:
        bottom -= STRIP
    begin = max(0, bottom - STRIP)
    in_first = least_above(words[top : top + STRIP], first, axis=1) < end - first
    in_last = least_above(words[begin:bottom], first, axis=1) < end - first
    return top + int(np.argmax(in_first)), bottom - int(np.argmax(in_last[::-1]))


def least_above(words: Words, first: int, axis: int | None = None) -> Any:
    """The smallest difference between a word and `first`, of all words or of each line, in 16 bits."""
    # A word below `first` wraps to a difference that is larger than that of any word in the range.
    return (words - np.uint16(first)).min(axis=axis)
