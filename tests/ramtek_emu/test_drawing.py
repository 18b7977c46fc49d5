import itertools

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from ramtek_emu import InstructionError, Ramtek9300, instructions
from ramtek_emu.scan_orders import SCAN_ORDERS
from tests.ramtek_emu import reference
from tests.ramtek_emu.strategies import SMALL, quick, scan_codes, thorough

far = st.integers(-40, 60)


@thorough
@given(st.lists(st.tuples(far, far), min_size=2, max_size=6))
def test_vectors_are_the_nearest_pixels_with_both_ends(vertices: list[tuple[int, int]]) -> None:
    display = Ramtek9300(SMALL)
    display.send(instructions.write_vectors(vertices, 9))
    twin = np.zeros((9, 13), int)
    for start, end in itertools.pairwise(vertices):
        for element, line in reference.line_places(start, end):
            if 0 <= element < 13 and 0 <= line < 9:
                twin[line, element] = 9
    assert (display.words == twin).all()
    assert display.processor.parameters.start == vertices[-1]


def test_a_vector_to_the_operating_point_is_a_point() -> None:
    display = Ramtek9300(SMALL)
    display.send(instructions.write_vectors([(4, 5)], 3))
    assert np.argwhere(display.words).tolist() == [[5, 4]]


def test_relative_vertices_count_from_the_one_before() -> None:
    display = Ramtek9300(SMALL)
    display.send(np.array([0x0EC3, 0x8002, 1, 2, 2, 8, 3, 0, 0xFFFF, 2], np.uint16))
    assert np.argwhere(display.words).tolist() == [[2, 2], [2, 3], [2, 4], [2, 5], [3, 4], [4, 4]]
    assert display.processor.parameters.start == (4, 4)


def test_many_vectors_across_the_whole_range_take_little_time_and_memory() -> None:
    display = Ramtek9300()
    ends = np.tile([[-0x8000, -0x8000], [0x7FFF, 0x7FFF]], (4000, 1))
    display.send(instructions.write_vectors(ends, 5))
    assert (np.diagonal(display.words) == 5).all()


@quick
@given(scan_codes, st.text(st.characters(min_codepoint=32, max_codepoint=126), min_size=1, max_size=5))
def test_the_scan_order_turns_text(code: int, text: str) -> None:
    display = Ramtek9300()
    display.send(
        instructions.set_parameters(foreground=5, background=2, scan_order=code, window=(200, 200, 299, 299))
    )
    data = text.encode()
    packed = np.frombuffer(data + bytes(len(data) % 2), ">u2").astype(np.uint16)
    display.send(np.concatenate(([0x0C01, len(data)], packed)).astype(np.uint16))
    cells = np.concatenate([display.processor.characters[letter] for letter in data], axis=1)
    window = SCAN_ORDERS[code].oriented(display.words[200:300, 200:300])
    assert (window[:9, : cells.shape[1]] == np.where(cells, 5, 2)).all()
    assert not window[9:].any()


@pytest.mark.parametrize("size", [1, 3, (2, 5)])
def test_size_repeats_the_dots(size: int | tuple[int, int]) -> None:
    across, down = (size, size) if isinstance(size, int) else size
    display = Ramtek9300()
    display.send(instructions.write_text("Rg", 10, 20, 7, 1, size))
    dots = np.concatenate([display.processor.characters[ord(letter)] for letter in "Rg"], axis=1)
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
    shapes = display.processor.characters
    assert (display.words[19:28, 10:17] == np.where(shapes[ord("C")], 5, 0)).all()
    assert display.processor.parameters.start == (17, 19)


def test_text_may_run_off_the_screen() -> None:
    display = Ramtek9300()
    display.send(instructions.write_text("edge", 630, 475, 7))
    display.send(instructions.write_text("edge", -10, -4, 7))
    assert display.words[:5, :18].any()
    assert display.words[475:, 630:].any()


def test_text_with_the_widest_spacing_takes_little_time_and_memory() -> None:
    display = Ramtek9300()
    window = [0x8000, 0x8000, 0x7FFF, 0x7FFF]
    head = [0x0C03, 0x0740, *window, 16, 16, 0xFFFF, 0xFFFF, 0x0F0F, 0xFFFE]
    display.send(np.array(head + [0x4142] * 0x7FFF, np.uint16))
    assert display.decoder.held_words == 0


def test_spacing_leaves_the_pixels_between_the_cells() -> None:
    display = Ramtek9300()
    display.send(instructions.erase(word=4))
    display.send(np.array([0x0C03, 0x0246, 7, 2, 10, 20, 99, 60, 3, 2, 2, 0x4142], np.uint16))
    shapes = display.processor.characters
    for element, letter in ((10, "A"), (20, "B")):
        cell = display.words[20:29, element : element + 7]
        assert (cell == np.where(shapes[ord(letter)], 7, 2)).all()
    assert (display.words[20:29, 17:20] == 4).all()
    assert display.processor.parameters.start == (30, 20)


def test_text_of_a_size_that_the_display_does_not_have_is_refused() -> None:
    with pytest.raises(InstructionError) as refusal:
        instructions.write_text("A", 0, 0, size=17)
    assert str(refusal.value) == "the size of text must be 1 to 16, not 17; write it smaller"
