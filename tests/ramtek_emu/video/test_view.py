from __future__ import annotations

from dataclasses import replace

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from ramtek_emu import Ramtek9300, instructions
from tests.ramtek_emu.strategies import SMALL, sent_words, thorough


def twin_field(
    words: NDArray[np.uint16],
    shown: tuple[int, int],
    origin: tuple[int, int],
    zoom: tuple[int, int],
    up: bool,
) -> list[list[int]]:
    """The word shown at each pixel of the screen, found one by one."""
    lines, elements = words.shape
    field = []
    for line in range(shown[0]):
        from_origin = shown[0] - 1 - line if up else line
        row = (origin[1] + from_origin // zoom[1]) % lines
        field.append([int(words[row, (origin[0] + x // zoom[0]) % elements]) for x in range(shown[1])])
    return field


@thorough
@given(
    st.integers(1, 13), st.integers(1, 9), st.tuples(*[st.integers(-0x8000, 0x7FFF)] * 2),
    st.tuples(*[st.integers(1, 16)] * 2), st.booleans(),
)  # fmt: skip
def test_what_is_shown_follows_origin_zoom_and_video_origin(
    elements: int, lines: int, origin: tuple[int, int], zoom: tuple[int, int], up: bool
) -> None:
    display = Ramtek9300(replace(SMALL, visible_elements=elements, visible_lines=lines))
    words = np.arange(117).reshape(9, 13)
    display.send(instructions.load_entries(0, np.repeat(np.arange(117)[:, np.newaxis], 3, axis=1)))
    display.send(instructions.write_image(words))
    display.field()
    display.send(instructions.set_parameters(origin=origin))
    display.send(sent_words([0x2600, zoom[1] - 1 << 8 | zoom[0] - 1, 0x2700 | up]))
    twin = twin_field(display.words, (lines, elements), origin, zoom, up)
    assert display.field()[..., 0].tolist() == twin
    display.send(sent_words([0x0802, 0x0040, 3, 3, 9, 7, 0x0902, 4, 99]))
    twin = twin_field(display.words, (lines, elements), origin, zoom, up)
    assert display.field()[..., 0].tolist() == twin
