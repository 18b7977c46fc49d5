"""Pacing: how coarse a picture is while it moves, so that its fields follow each other fast enough.

A coarse picture is computed at a half or a quarter of the lines and elements; each of its pixels is shown as
a block of 2 x 2 or 4 x 4 pixels of the display.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

BLOCKS: Final = (1, 2, 4)
"""The lines and elements of a block; 1 is the whole picture."""

PICTURE_SECONDS: Final = 1 / 36
"""Assumed: the longest time that a picture may take while it moves; of a thirtieth of a second, the rest is
for the field, which a window of 1280 x 960 shows in 6 to 14 ms without a graphics processor."""

MARGIN: Final = 0.75
"""Assumed: a finer picture is tried again when it is expected to take this part of PICTURE_SECONDS, so that
the picture does not change back and forth between two blocks."""


def blocks_of(lines: int, elements: int) -> tuple[int, ...]:
    """The blocks that divide a raster.

    >>> blocks_of(480, 640), blocks_of(480, 642)
    ((1, 2, 4), (1, 2))
    """
    return tuple(block for block in BLOCKS if lines % block == 0 and elements % block == 0)


def block_for(blocks: Sequence[int], block: int, seconds: float) -> int:
    """The smallest block whose picture is expected to be fast enough, else the largest one.

    `seconds` is the time that the last picture took, and `block` its block. Assumed: the time falls with the
    lines. Measured for blocks of 1, 2 and 4: 54, 28 and 13 ms for 87,000 polygons, 197, 90 and 52 ms for a
    million.

    >>> block_for(BLOCKS, 1, 0.020), block_for(BLOCKS, 1, 0.045), block_for(BLOCKS, 4, 0.013)
    (1, 2, 4)
    """
    for each in blocks:
        limit = PICTURE_SECONDS if each >= block else MARGIN * PICTURE_SECONDS
        if seconds * block <= limit * each:
            return each
    return blocks[-1]
