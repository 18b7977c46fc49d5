from __future__ import annotations

from typing import Any

import pytest

from ramtek_emu import InstructionError, instructions
from tests.ramtek_emu.words import hexadecimal


def test_reset_and_parameters_are_the_words_of_the_time() -> None:
    assert hexadecimal(instructions.reset()) == "0500"
    assert hexadecimal(instructions.initialize()) == "0600"
    assert hexadecimal(instructions.no_operation()) == "0700"
    assert hexadecimal(instructions.set_parameters(start=(10, 501))) == "0802 8000 000A 01F5"


def test_zoom_is_one_word_of_factors_less_one() -> None:
    assert hexadecimal(instructions.zoom(2)) == "2600 0101"
    assert hexadecimal(instructions.zoom(16, 1)) == "2600 000F"


@pytest.mark.parametrize("factor", [17, True])
def test_a_zoom_that_the_display_does_not_have_is_refused(factor: Any) -> None:
    with pytest.raises(InstructionError) as refusal:
        instructions.zoom(factor)
    assert str(refusal.value) == (
        f"zoom factors must be 1 to 16, not ({factor}, {factor}); choose smaller ones"
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


def test_an_operand_that_is_misspelled_is_told_the_nearest() -> None:
    with pytest.raises(InstructionError, match=r"not 'foregroud'; did you mean foreground\?$"):
        instructions.set_parameters(foregroud=3)
