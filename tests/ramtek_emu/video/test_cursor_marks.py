from __future__ import annotations

import numpy as np
import pytest

from ramtek_emu.memory.cursors import BLINK, VISIBLE, Cursors, cross
from ramtek_emu.video.cursor_marks import Mark, draw, marks


def test_marks_are_those_of_the_cursors_that_are_seen_now() -> None:
    cursors = Cursors(4)
    cursors.place(0, 5, 6, 0)
    cursors.place(1, 7, 8, VISIBLE)
    cursors.place(3, 9, 10, VISIBLE | BLINK)
    assert marks(cursors, True) == (Mark(1, 7, 8, 0), Mark(3, 9, 10, 0))
    assert marks(cursors, False) == (Mark(1, 7, 8, 0),)
    cursors.shape(2, np.zeros((1, 4), np.uint8))
    assert marks(cursors, False) == (Mark(1, 7, 8, 1),)


@pytest.mark.parametrize(("element", "line"), [(20, 50), (0, 0), (39, 99), (60, 50), (20, 130)])
def test_a_mark_is_the_shape_in_black_or_white_on_its_lines(element: int, line: int) -> None:
    mark, shape = Mark(0, element, line, 0), cross()
    pixels = np.zeros((100, 40), np.uint32)
    pixels[:, ::2] = 0xFFFFFF
    before = pixels.copy()
    draw(pixels, mark, shape)
    for y, x in np.ndindex(100, 40):
        row, column = y - line + 15, x - element + 15
        is_dot = 0 <= row < 32 and 0 <= column < 32 and shape[row, column]
        assert pixels[y, x] == (before[y, x] ^ 0xFFFFFF if is_dot else before[y, x])
    changed = np.flatnonzero((pixels != before).any(axis=1)).tolist()
    assert set(changed) <= set(range(*mark.lines))


def test_a_part_of_a_field_takes_its_part_of_the_mark() -> None:
    mark = Mark(0, 20, 50, 0)
    whole, part = np.zeros((100, 40), np.uint32), np.zeros((100, 40), np.uint32)
    draw(whole, mark, cross())
    for first, end in ((0, 40), (40, 55), (55, 100)):
        draw(part[first:end], mark, cross(), first)
    assert whole.any()
    assert (whole == part).all()
