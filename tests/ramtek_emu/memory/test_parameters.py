from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from ramtek_emu import instructions
from ramtek_emu.instruction_set.table import OPERANDS, Flags
from ramtek_emu.memory.parameters import Parameters, coefficients, signed
from ramtek_emu.memory.scan_orders import Point, Window
from ramtek_emu.testing import words
from tests.ramtek_emu import reference
from tests.ramtek_emu.displays import box, sent
from tests.ramtek_emu.strategies import SMALL, scan_codes, windows


def test_operands_stay_until_they_are_set_again() -> None:
    display = sent("0802 0004 0007", "0902 0040 0001 0001 0002 0002", "0900")
    assert display.words[1:3, 1:3].tolist() == [[7, 7], [7, 7]]
    assert display.frame_buffer.written == 8
    display.send(instructions.reset())
    display.send(instructions.erase())
    assert not display.words.any()


def test_addresses_count_from_index_registers_and_the_operating_point() -> None:
    display = sent("0802 0008 0005 0006", "0942 0044 0003 0000 0000 0001 0000")
    assert box(display) == (5, 6, 6, 6)
    display = sent("0802 0010 0009 0007", "0982 0044 0003 FFFF 0000 0000 0000")
    assert box(display) == (8, 7, 9, 7)
    # The text window of wtr() begins at the operating point.
    display = sent("0802 8000 0014 001E", "09C2 0044 0003 0000 0000 0006 0008")
    assert box(display) == (20, 30, 26, 38)


@given(words(16))
def test_a_word_is_a_number_in_two_s_complement(word: int) -> None:
    assert signed(word) & 0xFFFF == word
    assert -0x8000 <= signed(word) <= 0x7FFF


@given(st.lists(st.integers(-0x8000, 0x7FFF), min_size=6, max_size=6))
def test_a_conic_is_the_same_in_single_words_and_in_pairs(numbers: list[int]) -> None:
    words = [number & 0xFFFF for number in numbers]
    pairs = [half for word in words for half in (0, word)]
    assert coefficients(tuple(words)) == coefficients(tuple(pairs)) == tuple(numbers)


def test_a_pair_with_a_high_word_is_a_number_of_32_bits() -> None:
    assert coefficients((1, 2, 0xFFFF, 0xFFFE, *[0] * 8)) == (0x10002, -2, 0, 0, 0, 0)


@given(windows(), scan_codes, st.sampled_from([0, Flags.INDEX_1, Flags.INDEX_2, Flags.RELATIVE]))
def test_a_window_moves_the_operating_point_to_where_its_scan_starts(
    window: Window, code: int, addressing: int
) -> None:
    parameters = Parameters.at_reset(SMALL)
    parameters.index_1, parameters.index_2, parameters.start = Point(3, -4), Point(-7, 2), Point(5, 6)
    base = parameters.base(addressing)
    words = tuple(number & 0xFFFF for number in window)
    parameters.take({"window": words, "scan_order": (code,)}, addressing)
    assert parameters.window == window.moved(*base)
    assert parameters.start == reference.corner(parameters.window, code)
    parameters.take({"window": words, "start": (1, 2)}, 0)
    assert parameters.start == (1, 2)


@pytest.mark.parametrize("name", OPERANDS)
def test_every_operand_is_read_as_the_words_that_set_it(name: str) -> None:
    parameters = Parameters.at_reset(SMALL)
    words = tuple(range(1, 1 + OPERANDS[name].words))
    if name == "conic":
        words = tuple(half for number in range(1, 7) for half in (0, number))
    parameters.take({name: words}, 0)
    assert parameters.operand(name) == words
