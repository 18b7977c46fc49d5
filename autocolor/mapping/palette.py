"""Thumbnails: small pictures of a display image, and their colors reduced to few, by median cut.

P. Heckbert, 1982, "Color image quantization for frame buffer display": the box of all colors is cut in two at
the median of its longest side, then the largest of the boxes, until there are enough of them.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from autocolor.arrays import Bytes, Indices, Words, halves_up
from autocolor.mapping.display_image import DisplayImage

LINES: Final = 48
ELEMENTS: Final = 64
"""The size of a thumbnail."""


def in_palette(colors: Bytes, most: int) -> tuple[Words, Bytes]:
    """The place of each pixel's color in a palette, (lines, elements), and the palette, (at most `most`, 3).

    `colors` are (lines, elements, 3). A picture with no more than `most` colors keeps them exactly.
    """
    red, green, blue = np.moveaxis(colors.astype(np.uint32), -1, 0)
    packed, place_of_pixel, counts = np.unique(
        (red << 16 | green << 8 | blue).ravel(), return_inverse=True, return_counts=True
    )
    distinct = np.stack([packed >> 16, packed >> 8 & 255, packed & 255], axis=1).astype(np.int64)
    boxes = [np.arange(len(distinct))]
    sizes = [_size(distinct[box]) for box in boxes]
    while len(boxes) < most and max(sizes) > 0:
        largest = sizes.index(max(sizes))
        halves = _halves(distinct, counts, boxes[largest])
        boxes[largest : largest + 1] = halves
        sizes[largest : largest + 1] = [_size(distinct[half]) for half in halves]
    palette = np.empty((len(boxes), 3), np.uint8)
    place = np.empty(len(distinct), np.uint16)
    for number, box in enumerate(boxes):
        mean = counts[box] @ distinct[box] / counts[box].sum()
        palette[number] = halves_up(mean.astype(np.float32))
        place[box] = number
    return place[place_of_pixel.reshape(-1)].reshape(colors.shape[:2]), palette


def _size(colors: Indices) -> int:
    """The gain of cutting the box of some colors: its longest side, times the number of colors."""
    return int((colors.max(axis=0) - colors.min(axis=0)).max()) * len(colors)


def _halves(distinct: Indices, counts: Indices, box: Indices) -> list[Indices]:
    """A box cut in two at the median of its longest side; neither is empty."""
    inside = distinct[box]
    axis = int((inside.max(axis=0) - inside.min(axis=0)).argmax())
    order = box[np.argsort(inside[:, axis], kind="stable")]
    passed = np.cumsum(counts[order])
    middle = int(np.searchsorted(passed, passed[-1] / 2)) + 1
    middle = min(max(middle, 1), len(order) - 1)
    return [order[:middle], order[middle:]]


def thumbnail(image: DisplayImage, lines: int = LINES, elements: int = ELEMENTS) -> Bytes:
    """The colors of a display image, averaged over rectangles: (lines, elements, 3) uint8.

    A smaller image keeps its lines or elements. An image of twice the size of the thumbnail suffices: a scene
    that is not shown is rendered quickly for a thumbnail.
    """
    sums = image.colors.astype(np.int64)
    counts = np.ones((1, 1, 1), np.int64)
    for axis, most in enumerate((lines, elements)):
        size = sums.shape[axis]
        firsts = np.arange(min(most, size)) * size // min(most, size)
        sums = np.add.reduceat(sums, firsts, axis=axis)
        counts = counts * np.expand_dims(np.diff(firsts, append=size), tuple({0, 1, 2} - {axis}))
    return halves_up((sums / counts).astype(np.float32)).astype(np.uint8)
