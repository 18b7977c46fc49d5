from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from ramtek_emu import InstructionError, instructions
from tests.ramtek_emu.words import hexadecimal


def test_windows_are_filled_and_written_in_the_words_of_the_time() -> None:
    assert hexadecimal(instructions.erase((100, 331, 200, 411), 2)) == "0902 0044 0002 0064 014B 00C8 019B"
    assert hexadecimal(instructions.erase()) == "0900"
    assert hexadecimal(instructions.write_image([[1, 2], [3, 4]], 5, 6)) == (
        "0A03 0040 0005 0006 0006 0007 0008 0001 0002 0003 0004"
    )


def test_a_window_too_long_for_one_instruction_is_read_in_several() -> None:
    parts = list(instructions.read_image(0, 0, 640, 100))
    assert [count for _, count in parts] == [32640, 31360]
    assert hexadecimal(parts[0][0]) == "0B03 0040 0000 0000 027F 0063 FF00"
    assert hexadecimal(parts[1][0]) == "0B01 F500"


@pytest.mark.parametrize(
    ("call", "sentence"),
    [
        (lambda i: next(i.read_image(0, 0, 0, 2)), "the elements to read must be 1 to 65536, not 0; read "),
        (lambda i: next(i.read_image(0, 0, 2, 2.0)), "the lines to read must be a whole number from 1 to "),
        (lambda i: i.write_image([[1]], None), "the words' corner must be a whole number from -32768 to "),
    ],
)
def test_windows_that_cannot_be_sent_are_refused_in_words(
    call: Callable[[Any], object], sentence: str
) -> None:
    with pytest.raises(InstructionError) as refusal:
        call(instructions)
    assert str(refusal.value).startswith(sentence)
