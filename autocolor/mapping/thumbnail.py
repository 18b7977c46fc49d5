"""Thumbnails: small pictures of a display image, such as for a strip of kept variants."""

from __future__ import annotations

from typing import Final

import numpy as np

from autocolor.arrays import Bytes
from autocolor.mapping.display_image import DisplayImage
from autocolor.mapping.rounding import halves_up

LINES: Final = 48
ELEMENTS: Final = 64


def thumbnail(image: DisplayImage, lines: int = LINES, elements: int = ELEMENTS) -> Bytes:
    """The colors of a display image, averaged over rectangles: (lines, elements, 3) uint8.

    An image that has fewer lines or elements keeps those it has. An image of twice the size of the
    thumbnail is enough, so that a scene that is not shown is soon rendered for one.
    """
    sums = image.colors.astype(np.int64)
    counts = np.ones((1, 1, 1), np.int64)
    for axis, most in enumerate((lines, elements)):
        size = sums.shape[axis]
        firsts = np.arange(min(most, size)) * size // min(most, size)
        sums = np.add.reduceat(sums, firsts, axis=axis)
        counts = counts * np.expand_dims(np.diff(firsts, append=size), tuple({0, 1, 2} - {axis}))
    return halves_up((sums / counts).astype(np.float32)).astype(np.uint8)
