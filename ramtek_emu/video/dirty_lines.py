"""Dirty lines: the parts of a field that change when entries of the lookup table are loaded."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, Final

import numpy as np

from ramtek_emu.arrays import Words

Run = tuple[int, int]
"""Consecutive lines of a field, or entries of the table: the first, and the one after the last."""
STRIP: Final = 32
"""How many lines are searched at once."""


def lines_with(words: Words, first: int, end: int) -> Run:
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


def united(runs: Iterable[Run], lines: int) -> tuple[Run, ...]:
    """The lines of all runs that a field of so many has, as runs from the top that do not touch.

    >>> united([(40, 72), (9, 9), (-5, 32), (20, 40), (90, 105)], 100)
    ((0, 72), (90, 100))
    """
    found: list[Run] = []
    clipped = sorted((max(0, first), min(lines, end)) for first, end in runs)
    for first, end in clipped:
        if first >= end:
            continue
        if found and first <= found[-1][1]:
            found[-1] = found[-1][0], max(end, found[-1][1])
        else:
            found.append((first, end))
    return tuple(found)
