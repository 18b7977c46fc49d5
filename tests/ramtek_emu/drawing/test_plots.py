"""The plot, against a twin that draws bar by bar and pixel by pixel."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from ramtek_emu import PRINCETON_9300, Ramtek9300, instructions
from ramtek_emu.instruction_set.instruction import OperandValue, encode, normal
from ramtek_emu.memory.scan_orders import Point, Window
from ramtek_emu.processor.processor import Status
from tests.ramtek_emu import reference
from tests.ramtek_emu.displays import smallest_slices
from tests.ramtek_emu.strategies import SMALL, masks, points, scan_codes, sent_words, windows

numbers = st.integers(-6, 18) | st.sampled_from([-0x8000, 0x7FFF])


@given(
    st.lists(numbers, max_size=9),
    scan_codes,
    st.integers(0, 4) | st.just(0xFFFF),
    st.integers(0, 4) | st.sampled_from([0x7FFF, 0xFFFF]),
    numbers,
    points,
    masks,
    windows(),
    st.booleans(),
)
def test_a_plot_is_a_bar_from_the_base_line_to_each_number(
    data: list[int],
    code: int,
    width: int,
    spacing: int,
    base: int,
    start: Point,
    mask: int,
    clip: Window,
    swapped: bool,
) -> None:
    display = Ramtek9300(SMALL)
    display.send(instructions.set_parameters(background=9, mask=mask, write_window=clip))
    operands: dict[str, OperandValue] = {
        "foreground": 677,
        "scan_order": code,
        "dimensions": (width, 5),
        "spacing": (spacing, 3),
        "base_line": base,
        "start": start,
    }
    plot = encode(normal("WPB", operands, sent_words(data), flags=0x10 if swapped else 0))
    with smallest_slices():
        display.send(plot)

    twin = [[0] * 13 for _ in range(9)]
    (across, down), _ = reference.STEPS[code]
    place, end = (start[1], start[0]) if down else start
    for number in data:
        for line in range(9):
            for element in range(13):
                at, value = (line, element) if down else (element, line)
                along = 0 <= (at - place) * (across + down) < max(1, width)
                if along and min(base, number) <= value <= max(base, number):
                    reference.write_pixel(twin, (element, line), 9 if swapped else 677, mask & 1023, clip)
        place = (place + spacing * (across + down) + 0x8000) % 0x10000 - 0x8000
        end = number
    assert display.words.tolist() == twin
    assert display.processor.parameters.start == ((end, place) if down else (place, end))


@pytest.mark.parametrize("count", [620, 640])
def test_a_plot_on_a_9300_is_one_instruction_whatever_its_length(count: int) -> None:
    display = Ramtek9300(PRINCETON_9300)
    display.send(instructions.write_image(np.full((8, 8), 3)))
    display.send(sent_words([0x1003, 0xA380, 0, 1, 0, 1, 0, 500, 10, 510, 2 * count, *range(count)]))
    assert display.processor.waiting == 0
    assert display.status == Status.READY
    assert (display.words[:8, :8] == 3).all()
    assert display.words[500, 10 : 10 + count].all()
    display.send(sent_words([0x1103, 0x4000, 9, 4, 1, 2, 0x1201, 2, 0x0500]))
    assert display.status == Status.READY | Status.ILLEGAL
    assert display.words[500, 10 : 10 + count].all()


@pytest.mark.parametrize(
    ("words", "name"),
    [
        ([0xFFFF, 0x0804, 1, 0x3A00], "operand flags 2"),
        ([0x0700, 0xFFFF, 0x6DFF, 0x3A00], "CIRC"),
        ([0xFFFF, 0x1500], None),
    ],
)
def test_a_9300_names_the_first_instruction_that_only_a_9460_has(words: list[int], name: str | None) -> None:
    display = Ramtek9300(PRINCETON_9300)
    display.send(sent_words(words))
    assert display.processor.foreign == name
    display.reset()
    assert display.processor.foreign == name
