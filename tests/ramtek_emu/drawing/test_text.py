from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from ramtek_emu import Ramtek9300, instructions
from ramtek_emu.drawing.text import TextStyle
from ramtek_emu.memory.character_rom import characters
from ramtek_emu.memory.scan_orders import Point, ScanOrder, Window
from ramtek_emu.snapshot import display_of, snapshot_bytes
from tests.ramtek_emu import reference
from tests.ramtek_emu.strategies import SMALL, masks, points, scan_codes, sent_words, windows
from tests.tables import refused


def test_a_cell_has_1_to_16_dots_in_each_direction() -> None:
    for size, dots in [(-1, 1), (0, 1), (1, 1), (2, 2), (15, 15), (16, 16), (17, 16)]:
        for dimensions, expected in [((size, 9), (dots, 9)), ((7, size), (7, dots))]:
            style = TextStyle(
                dimensions=dimensions,
                spacing=(0, 0),
                size=(2, 3),
                foreground=1,
                background=0,
                transparent=False,
            )
            assert style.dots_each == expected
            assert style.cell == (2 * expected[0], 3 * expected[1])


def letters(text: str) -> NDArray[np.bool_]:
    return np.concatenate([characters()[ord(letter)] for letter in text], axis=1)


def test_text_fills_the_lines_of_its_window_and_the_rest_is_dropped() -> None:
    display = Ramtek9300()
    # Two cells in a line, two lines, and a rest that is too small for a third line.
    display.send(sent_words([0x0C03, 0x0042, 5, 10, 20, 23, 45, 7, 0x4142, 0x4344, 0x4546, 0x4700]))
    assert (display.words[20:29, 10:24] == 5 * letters("AB")).all()
    assert (display.words[29:38, 10:24] == 5 * letters("CD")).all()
    assert display.processor.parameters.start == (24, 29)
    # Text without a start point continues the dropped text, and is dropped too.
    display.send(sent_words([0x0C01, 2, 0x4748]))
    assert np.count_nonzero(display.words) == np.count_nonzero(letters("ABCD"))


def test_a_cell_larger_than_its_window_is_written_whole_and_alone() -> None:
    display = Ramtek9300()
    display.send(sent_words([0x0C03, 0x0042, 5, 10, 20, 12, 22, 4, 0x4142, 0x4344]))
    assert (display.words[20:29, 10:17] == 5 * letters("A")).all()
    assert np.count_nonzero(display.words) == np.count_nonzero(letters("A"))


def test_only_lines_of_text_that_reach_into_the_memory_are_drawn(monkeypatch: pytest.MonkeyPatch) -> None:
    display = Ramtek9300()
    blocks: list[tuple[int, ...]] = []

    def write_block(start: Point, order: ScanOrder, block: NDArray[np.uint16], *rest: object) -> None:
        blocks.append(block.shape)

    monkeypatch.setattr(display.frame_buffer, "write_block", write_block)
    # 65,534 cells of one dot: a column below the memory, a column that begins in the memory, then lines.
    display.send(sent_words([0x0C03, 0x0140, 9, 480, 9, 0x7FFF, 1, 1, 65534, *[0x4142] * 32767]))
    assert blocks == []
    display.send(sent_words([0x0C03, 0x0140, 9, 0, 9, 0x7FFF, 1, 1, 65534, *[0x4142] * 32767]))
    assert blocks == [(1, 1)] * 480
    blocks.clear()
    display.send(sent_words([0x0C03, 0x0140, -5000, -1, 0x7FFF, 0x7FFF, 1, 1, 65534, *[0x4142] * 32767]))
    assert blocks == [(1, 640)]


def test_the_operating_point_after_text_has_16_bits() -> None:
    display = Ramtek9300()
    display.send(instructions.write_text("A", 32761, 0))
    display.send(instructions.set_parameters(start=(32767, 0), spacing=(20, 0)))
    display.send(np.array([0x0C01, 2, 0x4142], np.uint16))
    assert all(-0x8000 <= number < 0x8000 for number in display.processor.parameters.start)
    assert (
        display_of(snapshot_bytes(display)).processor.parameters.start == display.processor.parameters.start
    )


def test_text_with_the_widest_spacing_takes_little_time_and_memory() -> None:
    display = Ramtek9300()
    window = [0x8000, 0x8000, 0x7FFF, 0x7FFF]
    head = [0x0C03, 0x0740, *window, 16, 16, 0xFFFF, 0xFFFF, 0x0F0F, 0xFFFE]
    display.send(np.array(head + [0x4142] * 0x7FFF, np.uint16))
    assert display.decoder.pending_words == 0


Pair = tuple[int, int]
pairs_to_4, pairs_to_3, pairs_to_2 = (
    st.tuples(*[st.integers(least, most)] * 2) for least, most in ((1, 4), (0, 3), (1, 2))
)


@given(
    st.binary(min_size=1, max_size=9),
    st.tuples(windows(), scan_codes, points),
    st.tuples(pairs_to_4, pairs_to_3, pairs_to_2),
    st.tuples(*[st.booleans()] * 3),
    masks,
    windows(),
)
def test_text_in_every_scan_order_equals_the_twin(
    codes: bytes,
    scan: tuple[Window, int, Point],
    style: tuple[Pair, Pair, Pair],
    flags: tuple[bool, bool, bool],
    mask: int,
    clip: Window,
) -> None:
    (window, code, start), (dimensions, spacing, size) = scan, style
    swapped, additive, reversed_bytes = flags
    display = Ramtek9300(SMALL)
    display.send(instructions.erase(word=85))
    display.send(instructions.set_parameters(mask=mask, foreground=514, background=257, window=window))
    display.send(instructions.set_parameters(scan_order=code, dimensions=dimensions, spacing=spacing))
    scale = (size[1] - 1) << 8 | (size[0] - 1)
    display.send(instructions.set_parameters(scale=scale, start=start, write_window=clip))
    packed = np.frombuffer(codes + bytes(len(codes) % 2), "<u2" if reversed_bytes else ">u2")
    low = 0x01 | (0x10 if swapped else 0) | (0x20 if additive else 0) | (0x08 if reversed_bytes else 0)
    display.send(sent_words([0x0C00 | low, len(codes), *packed.tolist()]))

    twin = [[85] * 13 for _ in range(9)]
    words = (257, 514) if swapped else (514, 257)
    colors = words[0], None if additive else words[1]
    shapes = characters().tolist()
    after = reference.write_text(twin, shapes, codes, window, code, start, style, colors, mask & 1023, clip)
    assert display.words.tolist() == twin
    assert display.processor.parameters.start == after


test_a_size_of_text_that_the_display_does_not_have = refused(
    lambda size: instructions.write_text("A", 0, 0, size=size),
    [(size, f"the size of text must be 1 to 16, not {size}; write it smaller") for size in (0, 17)],
)
