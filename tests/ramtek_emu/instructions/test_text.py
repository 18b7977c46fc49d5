from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from ramtek_emu import InstructionError, instructions
from tests.ramtek_emu.words import hexadecimal


def test_text_is_sent_with_all_that_its_cells_depend_on() -> None:
    assert hexadecimal(instructions.write_text("004", 1, 2, 5, 6, (2, 3))) == (
        "0C03 07C6 0005 0006 0001 0002 002A 001C 0000 0007 0009 0000 0000 0201 0003 3030 3400"
    )
    assert hexadecimal(instructions.write_text(b"", 0, 0, transparent=True)) == (
        "0C23 07C0 0000 0000 0006 0008 0000 0007 0009 0000 0000 0000 0000"
    )


@pytest.mark.parametrize(
    ("call", "sentence"),
    [
        (lambda i: i.write_text(5, 0, 0), "text must be a str or bytes, not int; write str() around it"),
        (
            lambda i: i.write_text("a", 0, 0, size=(1,)),
            "the size of text must be one number or two, not (1,)",
        ),
        (
            lambda i: i.write_text("a", 0, 0, size=2.0),
            "the size of text must be a whole number from 1 to 16,",
        ),
        (lambda i: i.write_text("a", 0, 0, 1.5), "foreground must be whole numbers from -32768 to 65535, "),
    ],
)
def test_text_that_cannot_be_sent_is_refused_in_words(call: Callable[[Any], object], sentence: str) -> None:
    with pytest.raises(InstructionError) as refusal:
        call(instructions)
    assert str(refusal.value).startswith(sentence)
