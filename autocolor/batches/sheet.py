"""The contact sheet of a batch: a labeled thumbnail of each variant, in rows and columns."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Final, NamedTuple

import numpy as np

from autocolor.arrays import Bytes, light_of
from autocolor.batches.outputs import SHEET_MARK, marked
from autocolor.batches.table import Variant
from autocolor.checks import is_whole, printable, shown
from autocolor.errors import UsageError

GROUND: Final = 32
"""The gray of the background."""

NO_PICTURE: Final = 64
"""The gray of a cell without a picture."""

INK: Final = 224
"""The gray of the labels."""

GAP: Final = 8
"""Pixels between cells, and around them."""

LABEL_LINES: Final = 16

MOST_COLUMNS: Final = 100
"""Limit: columns of a sheet that are asked for."""


class Box(NamedTuple):
    """The most elements and lines of a thumbnail."""

    elements: int
    lines: int


BOXES: Final = ((400, Box(160, 120)), (2500, Box(80, 60)), (10_000, Box(48, 36)))
"""Limit: the most variants of a sheet, for each size of its thumbnails. A sheet has at most 19 MB."""


class ContactSheet:
    """A contact sheet that is filled cell by cell."""

    def __init__(self, variants: Sequence[Variant], columns: int | None = None) -> None:
        """An empty sheet; see `columns_of`. Raises UsageError for too many variants or wrong columns."""
        most = BOXES[-1][0]
        if len(variants) > most:
            raise UsageError(
                f"a contact sheet must have at most {most:,} variants, not {len(variants):,}; make sheets of"
                " parts of the table"
            )
        self.box = next(box for count, box in BOXES if len(variants) <= count)
        self._names = [variant.name for variant in variants]
        if columns is not None and not is_whole(columns, 1, MOST_COLUMNS):
            raise UsageError(
                f"the columns of a sheet must be a whole number from 1 to {MOST_COLUMNS}, not"
                f" {shown(columns)}; choose another"
            )
        self._columns = min(columns, len(variants)) if columns else columns_of(variants)
        rows = -(-len(variants) // self._columns)
        step = self._step
        self._colors = np.full((rows * step[0] + GAP, self._columns * step[1] + GAP, 3), GROUND, np.uint8)
        for number in range(len(variants)):
            self._cell(number)[:] = NO_PICTURE

    def put(self, number: int, small: Bytes | None) -> None:
        """Put the thumbnail of a variant in the middle of its cell; the number counts from 0."""
        if small is not None:
            cell = self._cell(number)
            cell[:] = GROUND
            top, left = ((cell.shape[axis] - small.shape[axis]) // 2 for axis in (0, 1))
            cell[top : top + small.shape[0], left : left + small.shape[1]] = small

    def png(self) -> bytes:
        """The sheet as a PNG file."""
        from PIL import Image, ImageDraw, ImageFont

        image = Image.fromarray(self._colors)
        draw, font = ImageDraw.Draw(image), ImageFont.load_default()
        for number, name in enumerate(self._names):
            top, left = self._corner(number)
            label = printable(name)
            if not isinstance(font, ImageFont.FreeTypeFont):
                label = label.encode("ascii", "replace").decode()
            while len(label) > 1 and font.getlength(label) > self.box.elements:
                label = f"{label.rstrip('.')[:-1]}.."
            draw.text((left, top + self.box.lines + 2), label, fill=(INK, INK, INK), font=font)
        return marked("png", np.asarray(image), None, SHEET_MARK)

    @property
    def _step(self) -> tuple[int, int]:
        """Lines and elements from a cell to the next."""
        return self.box.lines + LABEL_LINES + GAP, self.box.elements + GAP

    def _corner(self, number: int) -> tuple[int, int]:
        row, column = divmod(number, self._columns)
        return GAP + row * self._step[0], GAP + column * self._step[1]

    def _cell(self, number: int) -> Bytes:
        top, left = self._corner(number)
        return self._colors[top : top + self.box.lines, left : left + self.box.elements]


def columns_of(variants: Sequence[Variant]) -> int:
    """The columns that make a sheet nearly square, and of a grid a multiple of the values of its last key."""
    counts: dict[str, set[str]] = {}
    for variant in variants:
        for key, value in variant.settings.items():
            counts.setdefault(key, set()).add(repr(value))
    axes = [len(values) for values in counts.values() if len(values) > 1]
    square = max(1, math.ceil(math.sqrt(len(variants))))
    if len(axes) < 2 or math.prod(axes) != len(variants) or axes[-1] > 2 * square:
        return square
    return axes[-1] * max(1, round(square / axes[-1]))


def thumbnail(colors: Bytes, box: Box) -> Bytes:
    """The colors, averaged as light over the smallest squares for which they fit in a box, uint8.

    Lines and elements that fill no square are left out at the lower right. Measured: 9 ms for 640 x 480.
    """
    side = max(1, -(-colors.shape[0] // box.lines), -(-colors.shape[1] // box.elements))
    lines, elements = max(1, colors.shape[0] // side), max(1, colors.shape[1] // side)
    if side == 1:
        return colors
    light = light_of(np.arange(256.0)).astype(np.float32)
    squares = colors[: lines * side, : elements * side]
    rows = light.take(squares).reshape(lines, -1, elements, min(side, colors.shape[1]), 3)
    between = light_of(np.linspace(0.5, 254.5, 255))
    small: Bytes = np.searchsorted(between, rows.mean((1, 3)), side="right").astype(np.uint8)
    return small


def read_thumbnail(path: str, box: Box) -> Bytes | None:
    """The thumbnail of a picture file that a batch wrote; None if it cannot be read."""
    from PIL import Image

    try:
        with Image.open(path) as image:
            return thumbnail(np.asarray(image.convert("RGB")), box)
    except (OSError, ValueError, Image.DecompressionBombError):
        return None
