from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from ramtek_emu import InstructionError, instructions
from tests.ramtek_emu.words import hexadecimal


def test_entries_are_loaded_and_read_in_the_words_of_the_time() -> None:
    assert hexadecimal(instructions.load_entries(1, [[1, 2, 3]])) == "0300 0002 0004 0203 0001"
    assert hexadecimal(instructions.load_short_entries(1, [[0x1F, 0x2F, 0x3F]])) == "0300 0001 0002 0123"
    assert hexadecimal(instructions.park_table(0x200)) == "0300 0200 0000"
    assert hexadecimal(instructions.read_entries(4, 2)) == "0400 0004 0004"


@pytest.mark.parametrize(
    ("call", "sentence"),
    [
        (lambda i: i.park_table(-1), "a table's address must be 0 to 65535, not -1; count in words"),
        (lambda i: i.park_table(1.5), "a table's address must be a whole number from 0 to 65535, not 1.5; "),
        (lambda i: i.read_entries(0, 40000), "the words to read must be 0 to 32767, not 40000; read the "),
    ],
)
def test_addresses_that_no_word_holds_are_refused_in_words(
    call: Callable[[Any], object], sentence: str
) -> None:
    with pytest.raises(InstructionError) as refusal:
        call(instructions)
    assert str(refusal.value).startswith(sentence)
