"""Which lines show an entry: the part of a field that a load of the lookup table changes."""

from __future__ import annotations

from typing import Any, Final

import numpy as np

from ramtek_emu.arrays import Words

STRIP: Final = 32
"""Lines that are searched at once."""


def lines_with(words: Words, first: int, end: int) -> tuple[int, int]:
    """The first line that has a word from `first` to before `end`, and the one after the last.

    (0, 0) when no line has one.
    """
    # Search from the top and from the bottom; what lies in between is not read. Measured: looking at every
    # line takes twice as long. To stop at whole strips would save a tenth of a scan-out once, and cost a
    # twentieth of one for each field while a color is dragged.
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
    """How far above `first` the nearest word is, of all or of each line; a word below it is very far."""
    # What is below wraps to far above.
    return (words - np.uint16(first)).min(axis=axis)
