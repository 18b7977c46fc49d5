from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from ramtek_emu import InstructionError, WordsError, instructions
from ramtek_emu.instruction_set.decoder import Decoder
from tests.ramtek_emu.strategies import quick


def hexadecimal(words: np.ndarray[tuple[int], np.dtype[np.uint16]]) -> str:
    return " ".join(f"{word:04X}" for word in words)


def test_encoders_send_the_words_of_the_time() -> None:
    assert hexadecimal(instructions.reset()) == "0500"
    assert hexadecimal(instructions.initialize()) == "0600"
    assert hexadecimal(instructions.no_operation()) == "0700"
    assert hexadecimal(instructions.set_parameters(start=(10, 501))) == "0802 8000 000A 01F5"
    assert hexadecimal(instructions.erase((100, 331, 200, 411), 2)) == "0902 0044 0002 0064 014B 00C8 019B"
    assert hexadecimal(instructions.erase()) == "0900"
    assert hexadecimal(instructions.write_image([[1, 2], [3, 4]], 5, 6)) == (
        "0A03 0040 0005 0006 0006 0007 0008 0001 0002 0003 0004"
    )
    assert hexadecimal(instructions.read_entries(4, 2)) == "0400 0004 0004"
    assert hexadecimal(instructions.write_vectors([(0, 0), (639, 479)], 5)) == (
        "0E03 8002 0005 0000 0000 0004 027F 01DF"
    )


@pytest.mark.parametrize(
    ("operands", "sentence"),
    [
        ({"mask": 65536}, "mask must be whole numbers from -32768 to 65535, not 65536; round or clip it"),
        ({"mask": 1.5}, "mask must be whole numbers from -32768 to 65535, not 1.5; round or clip it"),
        ({"window": (1, 2)}, "window must be 4 numbers, not 2; give all of them"),
    ],
)
def test_operands_that_do_not_fit_are_refused_by_name(operands: dict[str, int], sentence: str) -> None:
    with pytest.raises(InstructionError) as refusal:
        instructions.set_parameters(**operands)
    assert str(refusal.value) == sentence


def test_an_unknown_operand_is_refused_with_those_that_exist() -> None:
    with pytest.raises(InstructionError, match=r"an operand must be one of mask, foreground, .*not 'color'"):
        instructions.set_parameters(color=3)


@pytest.mark.parametrize("vertices", [[], [[1, 2, 3]], [[0.5, 1.0]], [[40000000, 1]]])
def test_vertices_that_do_not_fit_are_refused(vertices: object) -> None:
    with pytest.raises(WordsError):
        instructions.write_vectors(vertices)


@quick
@given(st.integers(1, 20000))
def test_long_rows_of_vertices_are_sent_in_several_instructions(count: int) -> None:
    stream = instructions.write_vectors(np.arange(2 * count).reshape(-1, 2) % 600, 1)
    found = list(Decoder().feed(stream))
    assert sum(len(instruction.data) // 2 for instruction in found) == max(1, count - 1)


def test_circles_areas_zoom_and_cursors_are_encoded_in_the_words_of_the_time() -> None:
    assert hexadecimal(instructions.write_circles([(100, 50, 20)], 7)) == "6D03 0002 0007 0006 0064 0032 0014"
    assert hexadecimal(instructions.fill(100, 50)) == "3A03 8000 0064 0032 0002 0000"
    assert hexadecimal(instructions.zoom(2)) == "2600 0101"
    assert hexadecimal(instructions.zoom(16, 1)) == "2600 000F"
    assert hexadecimal(instructions.write_cursor(0, 100, 100, blinking=True)) == "1600 0064 0C64"
    assert hexadecimal(instructions.write_cursor(1, 100, 64)) == "1601 0064 0440"
    assert hexadecimal(instructions.read_cursor(1)) == "1701"


def test_zoom_cursors_and_circles_that_do_not_fit_are_refused_by_name() -> None:
    with pytest.raises(InstructionError) as refusal:
        instructions.zoom(17)
    assert str(refusal.value) == "zoom factors must be 1 to 16, not (17, 17); choose smaller ones"
    with pytest.raises(InstructionError) as refusal:
        instructions.write_cursor(0, 0, 1024)
    assert str(refusal.value) == "a cursor's line must be 0 to 1023, not 1024; keep to the screen"
    with pytest.raises(InstructionError, match=r"a cursor's number must be 0 to 255, not -1"):
        instructions.read_cursor(-1)
    with pytest.raises(WordsError, match=r"circles must be an \(n, 3\) array"):
        instructions.write_circles([[1, 2]])
