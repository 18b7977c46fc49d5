from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable
from typing import Any

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


def test_encoders_take_numbers_and_rows_of_python_and_of_numpy_alike() -> None:
    encoders: Any = instructions
    one, two, three = np.int64(1), np.uint8(2), np.int16(3)
    window = np.array([1, 2, 3, 9])
    pairs = [
        (encoders.set_parameters(foreground=np.array(3)), encoders.set_parameters(foreground=3)),
        (encoders.erase(window, three), encoders.erase((1, 2, 3, 9), 3)),
        (encoders.erase(window.tolist()), encoders.erase(window)),
        (encoders.write_image([[1, 2]], one, two, three), encoders.write_image([[1, 2]], 1, 2, 3)),
        (encoders.write_text("ab", one, two, size=three), encoders.write_text("ab", 1, 2, size=3)),
        (
            encoders.write_text(bytearray(b"ab"), 1, 2, size=[two, three]),
            encoders.write_text(b"ab", 1, 2, size=(2, 3)),
        ),
        (encoders.write_vectors([(1, 2)], start=window[:2]), encoders.write_vectors([(1, 2)])),
        (encoders.write_circles(((1, 2, 3),)), encoders.write_circles(np.array([[1, 2, 3]]))),
        (encoders.zoom(three, two), encoders.zoom(3, 2)),
        (encoders.write_cursor(one, two, three), encoders.write_cursor(1, 2, 3)),
        (encoders.read_entries(one, two), encoders.read_entries(1, 2)),
        (encoders.load_entries(one, [[1, 2, 3]]), encoders.load_entries(1, np.array([[1, 2, 3]]))),
        (encoders.concatenate([0x0500], range(2)), np.array([0x0500, 0, 1], np.uint16)),
    ]
    for found, expected in pairs:
        assert found.dtype == np.uint16
        assert found.tolist() == expected.tolist()
    for (found, count), (expected, again) in zip(
        encoders.read_image(one, one, two, three), encoders.read_image(1, 1, 2, 3), strict=True
    ):
        assert (found.tolist(), count) == (expected.tolist(), again)


@pytest.mark.parametrize(
    ("call", "sentence"),
    [
        (lambda i: i.park_table(-1), "a table's address must be 0 to 65535, not -1; count in words"),
        (lambda i: i.park_table(1.5), "a table's address must be a whole number from 0 to 65535, not 1.5; "),
        (lambda i: i.read_entries(0, 40000), "the words to read must be 0 to 32767, not 40000; read the "),
        (lambda i: next(i.read_image(0, 0, 0, 2)), "the elements to read must be 1 to 65536, not 0; read "),
        (lambda i: next(i.read_image(0, 0, 2, 2.0)), "the lines to read must be a whole number from 1 to "),
        (lambda i: i.write_image([[1]], None), "the words' corner must be a whole number from -32768 to "),
        (lambda i: i.write_text(5, 0, 0), "text must be a str or bytes, not int; write str() around it"),
        (
            lambda i: i.write_text("a", 0, 0, size=(1,)),
            "the size of text must be one number or two, not (1,)",
        ),
        (
            lambda i: i.write_text("a", 0, 0, size=2.0),
            "the size of text must be a whole number from 1 to 16,",
        ),
        (
            lambda i: i.write_cursor(0, 1.5, 2),
            "a cursor's element must be a whole number from 0 to 2047, not ",
        ),
        (lambda i: i.read_cursor("a"), "a cursor's number must be a whole number from 0 to 255, not 'a'; "),
        (lambda i: i.zoom(True), "zoom factors must be 1 to 16, not (True, True); choose smaller ones"),
        (lambda i: i.set_parameters(foregroud=3), "an operand must be one of mask, foreground, "),
    ],
)
def test_numbers_that_an_encoder_cannot_send_are_refused_in_words(
    call: Callable[[Any], object], sentence: str
) -> None:
    with pytest.raises(InstructionError) as refusal:
        call(instructions)
    assert str(refusal.value).startswith(sentence)


def test_an_operand_that_is_misspelled_is_told_the_nearest() -> None:
    with pytest.raises(InstructionError, match=r"not 'foregroud'; did you mean foreground\?$"):
        instructions.set_parameters(foregroud=3)


@pytest.mark.parametrize("circle", [[1, 2, -3], [1, 2, 70000], [1, 70000, 3], [-40000, 1, 1]])
def test_circles_that_no_word_holds_are_refused(circle: list[int]) -> None:
    with pytest.raises(WordsError) as refusal:
        instructions.write_circles([circle, [0, 0, 0]])
    assert str(refusal.value).startswith(
        "a circle must have a center within -32768 to 65535 and a radius within 0 to 65535, not ["
    )


def test_the_encoders_are_there_without_an_import_of_their_own() -> None:
    program = "import ramtek_emu; print(*ramtek_emu.instructions.reset())"
    ran = subprocess.run([sys.executable, "-c", program], check=True, capture_output=True, text=True)
    assert ran.stdout == "1280\n"
