from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from ramtek_emu import InstructionError, Ramtek9300, instructions
from ramtek_emu.drawing.text import TextStyle
from ramtek_emu.memory.character_rom import characters
from ramtek_emu.memory.scan_orders import SCAN_ORDERS, Point, ScanOrder, Window
from ramtek_emu.snapshot import display_of, snapshot_bytes
from tests.ramtek_emu import reference
from tests.ramtek_emu.strategies import SMALL, masks, points, scan_codes, sent_words, windows


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


@given(scan_codes, st.text(st.characters(min_codepoint=32, max_codepoint=126), min_size=1, max_size=5))
def test_the_scan_order_turns_text(code: int, text: str) -> None:
    display = Ramtek9300()
    display.send(
        instructions.set_parameters(foreground=5, background=2, scan_order=code, window=(200, 200, 299, 299))
    )
    data = text.encode()
    packed = np.frombuffer(data + bytes(len(data) % 2), ">u2").astype(np.uint16)
    display.send(np.concatenate(([0x0C01, len(data)], packed)).astype(np.uint16))
    cells = np.concatenate([characters()[letter] for letter in data], axis=1)
    window = SCAN_ORDERS[code].oriented(display.words[200:300, 200:300])
    assert (window[:9, : cells.shape[1]] == np.where(cells, 5, 2)).all()
    assert not window[9:].any()


@pytest.mark.parametrize("size", [1, 3, (2, 5)])
def test_size_repeats_the_dots(size: int | tuple[int, int]) -> None:
    across, down = (size, size) if isinstance(size, int) else size
    display = Ramtek9300()
    display.send(instructions.write_text("Rg", 10, 20, 7, 1, size))
    dots = np.concatenate([characters()[ord(letter)] for letter in "Rg"], axis=1)
    large = np.repeat(np.repeat(dots, down, axis=0), across, axis=1)
    lines, elements = large.shape
    assert (display.words[20 : 20 + lines, 10 : 10 + elements] == np.where(large, 7, 1)).all()
    assert np.count_nonzero(display.words) == lines * elements


def test_transparent_text_leaves_the_pixels_between_the_dots() -> None:
    display = Ramtek9300()
    display.send(instructions.erase(word=4))
    display.send(instructions.write_text("A", 0, 0, 7, 1, transparent=True))
    assert set(np.unique(display.words)) == {4, 7}


def test_text_that_reaches_the_window_s_edge_goes_on_below() -> None:
    display = Ramtek9300()
    # A window of two cells' width, three characters.
    display.send(np.array([0x0C03, 0x0042, 5, 10, 10, 23, 40, 3, 0x4142, 0x4300], np.uint16))
    shapes = characters()
    assert (display.words[19:28, 10:17] == np.where(shapes[ord("C")], 5, 0)).all()
    assert display.processor.parameters.start == (17, 19)


def letters(display: Ramtek9300, text: str) -> NDArray[np.bool_]:
    return np.concatenate([characters()[ord(letter)] for letter in text], axis=1)


def test_text_longer_than_its_window_keeps_its_beginning() -> None:
    display = Ramtek9300()
    # Six characters in a window of two.
    display.send(sent_words([0x0C03, 0x0040, 0, 0, 14, 9, 6, 0x4142, 0x4344, 0x4546]))
    assert (display.words[:9, :14] == 1023 * letters(display, "AB")).all()
    assert np.count_nonzero(display.words) == np.count_nonzero(letters(display, "AB"))
    assert display.processor.parameters.start == (14, 0)
    # Text without a start point continues the dropped text, and is dropped too.
    display.send(sent_words([0x0C01, 2, 0x4748]))
    assert np.count_nonzero(display.words) == np.count_nonzero(letters(display, "AB"))


def test_text_fills_the_lines_of_its_window_and_then_ends() -> None:
    display = Ramtek9300()
    # Two cells in a line, two lines, and a rest that is too small for a third line.
    display.send(sent_words([0x0C03, 0x0042, 5, 10, 20, 23, 45, 7, 0x4142, 0x4344, 0x4546, 0x4700]))
    assert (display.words[20:29, 10:24] == 5 * letters(display, "AB")).all()
    assert (display.words[29:38, 10:24] == 5 * letters(display, "CD")).all()
    assert not display.words[38:].any()
    assert display.processor.parameters.start == (24, 29)


def test_text_that_starts_across_the_last_line_of_its_window_is_written_there() -> None:
    display = Ramtek9300()
    display.send(sent_words([0x0802, 0x8002, 5, 100, 475, 0x0C01, 2, 0x4142]))
    assert (display.words[475:, 100:114] == 5 * letters(display, "AB")[:5]).all()
    assert not display.words[:475].any()


def test_a_cell_larger_than_its_window_is_written_whole_and_alone() -> None:
    display = Ramtek9300()
    display.send(sent_words([0x0C03, 0x0042, 5, 10, 20, 12, 22, 4, 0x4142, 0x4344]))
    assert (display.words[20:29, 10:17] == 5 * letters(display, "A")).all()
    assert np.count_nonzero(display.words) == np.count_nonzero(letters(display, "A"))


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


def test_text_may_run_off_the_screen() -> None:
    display = Ramtek9300()
    display.send(instructions.write_text("edge", 630, 475, 7))
    display.send(instructions.write_text("edge", -10, -4, 7))
    assert display.words[:5, :18].any()
    assert display.words[475:, 630:].any()


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


def test_spacing_leaves_the_pixels_between_the_cells() -> None:
    display = Ramtek9300()
    display.send(instructions.erase(word=4))
    display.send(np.array([0x0C03, 0x0246, 7, 2, 10, 20, 99, 60, 3, 2, 2, 0x4142], np.uint16))
    shapes = characters()
    for element, letter in ((10, "A"), (20, "B")):
        cell = display.words[20:29, element : element + 7]
        assert (cell == np.where(shapes[ord(letter)], 7, 2)).all()
    assert (display.words[20:29, 17:20] == 4).all()
    assert display.processor.parameters.start == (30, 20)


def test_text_of_a_size_that_the_display_does_not_have_is_refused() -> None:
    with pytest.raises(InstructionError) as refusal:
        instructions.write_text("A", 0, 0, size=17)
    assert str(refusal.value) == "the size of text must be 1 to 16, not 17; write it smaller"


small = st.integers(1, 4)


@given(
    st.binary(min_size=1, max_size=9),
    windows(),
    scan_codes,
    points,
    st.tuples(small, small),
    st.tuples(st.integers(0, 3), st.integers(0, 3)),
    st.tuples(st.integers(1, 2), st.integers(1, 2)),
    st.tuples(st.booleans(), st.booleans(), st.booleans()),
    masks,
    windows(),
)
def test_text_in_every_scan_order_equals_the_twin(
    codes: bytes,
    window: Window,
    code: int,
    start: Point,
    dimensions: tuple[int, int],
    spacing: tuple[int, int],
    size: tuple[int, int],
    flags: tuple[bool, bool, bool],
    mask: int,
    clip: Window,
) -> None:
    swapped, additive, reversed_bytes = flags
    display = Ramtek9300(SMALL)
    display.send(instructions.erase(word=85))
    display.send(
        instructions.set_parameters(
            mask=mask,
            foreground=514,
            background=257,
            window=window,
            scan_order=code,
            dimensions=dimensions,
            spacing=spacing,
            scale=(size[1] - 1) << 8 | (size[0] - 1),
            start=start,
            write_window=clip,
        )
    )
    packed = np.frombuffer(codes + bytes(len(codes) % 2), "<u2" if reversed_bytes else ">u2")
    low = 0x01 | (0x10 if swapped else 0) | (0x20 if additive else 0) | (0x08 if reversed_bytes else 0)
    display.send(sent_words([0x0C00 | low, len(codes), *packed.tolist()]))

    twin = [[85] * 13 for _ in range(9)]
    words = (257, 514) if swapped else (514, 257)
    after = reference.write_text(
        twin,
        characters().tolist(),
        codes,
        window,
        code,
        start,
        (dimensions, spacing, size),
        (words[0], None if additive else words[1]),
        mask & 1023,
        clip,
    )
    assert display.words.tolist() == twin
    assert display.processor.parameters.start == after


def test_a_loaded_character_takes_the_place_of_its_code() -> None:
    display = Ramtek9300()
    rows = [0x80, 0x40, 0x20, 0x10, 0x08, 0x04, 0x02, 0x01, 0xFF, 0x00, 0xAA, 0x55]
    display.send(sent_words([0x1541] + [rows[row] << 8 | rows[row + 1] for row in range(0, 12, 2)]))
    # Cells of 8 x 12, at (20, 30).
    display.send(sent_words([0x0C03, 0x0142, 5, 20, 30, 99, 99, 8, 12, 1, 0x4100]))
    dots = np.unpackbits(np.array(rows, np.uint8)[:, np.newaxis], axis=1)
    assert (display.words[30:42, 20:28] == 5 * dots).all()
    # The standard font is the ROM; the loaded font can be attached again, and survives RSET.
    display.send(sent_words([0x4EFF, 0x0C03, 0x0140, 20, 30, 99, 99, 7, 9, 1, 0x4100]))
    assert (display.words[30:39, 20:27] == 5 * characters()[0x41]).all()
    display.send(sent_words([0x0500, 0x0C03, 0x0142, 5, 20, 30, 99, 99, 8, 12, 1, 0x4100]))
    assert (display.words[30:42, 20:28] == 5 * dots).all()
    display.send(sent_words([0x2142] + [rows[row + 1] << 8 | rows[row] for row in range(0, 12, 2)]))
    assert (display.processor.loaded_characters[0x42] == dots).all()
