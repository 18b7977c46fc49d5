from __future__ import annotations

import pytest

from ramtek_emu import InstructionError, instructions
from tests.ramtek_emu.words import hexadecimal


def test_cursors_are_placed_and_read_in_the_words_of_the_time() -> None:
    assert hexadecimal(instructions.write_cursor(0, 100, 100, blinking=True)) == "1600 0064 0C64"
    assert hexadecimal(instructions.write_cursor(1, 100, 64)) == "1601 0064 0440"
    assert hexadecimal(instructions.read_cursor(1)) == "1701"


def test_places_and_numbers_that_no_cursor_has_are_refused_by_name() -> None:
    with pytest.raises(InstructionError) as refusal:
        instructions.write_cursor(0, 0, 1024)
    assert str(refusal.value) == "a cursor's line must be 0 to 1023, not 1024; keep to the screen"
    with pytest.raises(InstructionError, match=r"a cursor's element must be a whole number from 0 to 2047, "):
        instructions.write_cursor(0, 1.5, 2)  # type: ignore[arg-type]
    with pytest.raises(InstructionError, match=r"a cursor's number must be 0 to 255, not -1"):
        instructions.read_cursor(-1)
    with pytest.raises(InstructionError, match=r"a cursor's number must be a whole number .*, not 'a'; "):
        instructions.read_cursor("a")  # type: ignore[arg-type]
