"""Cursor marks: the cursors as they are drawn on a field.

Assumed: a cursor is white where the picture is dark and black where it is light, so that it is always
visible; how the 9300 mixed it into the video is in no source.
"""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np

from ramtek_emu.arrays import Dots, PackedColors
from ramtek_emu.memory.cursors import SHAPE_CENTER, SHAPE_SIZE, VISIBLE, Cursors
from ramtek_emu.video.dirty_lines import Run

WHITE: Final = np.uint32(0xFFFFFF)


class Mark(NamedTuple):
    """A cursor as it is drawn on a field. Equal marks look the same."""

    number: int
    element: int
    line: int
    changed: int
    """How often the shape of any cursor had been changed."""

    @property
    def lines(self) -> Run:
        """The lines that it is drawn on, also beyond the edges of the field."""
        return self.line - SHAPE_CENTER, self.line - SHAPE_CENTER + SHAPE_SIZE


def marks(cursors: Cursors, blink_is_on: bool) -> tuple[Mark, ...]:
    """The marks of the cursors that are drawn while blinking ones are shown, or while they are not."""
    return tuple([
        Mark(number, each.element, each.line, cursors.changed)
        for number, each in enumerate(cursors.all)
        if each.state & VISIBLE and (blink_is_on or not each.blinks)
    ])  # fmt: skip


def draw(pixels: PackedColors, mark: Mark, shape: Dots, first_line: int = 0) -> None:
    """Draw a cursor, clipped at the edges, on lines of a field of which the first is `first_line`."""
    top, left = mark.lines[0] - first_line, mark.element - SHAPE_CENTER
    up, across = max(0, -top), max(0, -left)
    part = pixels[max(0, top) : max(0, top + SHAPE_SIZE), max(0, left) : max(0, left + SHAPE_SIZE)]
    dots = shape[up : up + part.shape[0], across : across + part.shape[1]]
    if part.size:
        # The highest bit of green tells light from dark well enough, and is quick to test.
        light = (part >> 15 & 1).astype(np.bool_)
        part[dots] = np.where(light[dots], np.uint32(0), WHITE)
