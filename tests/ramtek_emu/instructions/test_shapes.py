from __future__ import annotations

import pytest

from ramtek_emu import WordsError, instructions
from tests.ramtek_emu.words import hexadecimal


def test_circles_and_areas_are_encoded_in_the_words_of_the_time() -> None:
    assert hexadecimal(instructions.write_circles([(100, 50, 20)], 7)) == "6D03 0002 0007 0006 0064 0032 0014"
    assert hexadecimal(instructions.fill(100, 50)) == "3A03 8000 0064 0032 0002 0000"


def test_circles_of_another_shape_are_refused() -> None:
    with pytest.raises(WordsError, match=r"circles must be an \(n, 3\) array"):
        instructions.write_circles([[1, 2]])


@pytest.mark.parametrize("circle", [[1, 2, -3], [1, 2, 70000], [1, 70000, 3], [-40000, 1, 1]])
def test_circles_that_no_word_holds_are_refused(circle: list[int]) -> None:
    with pytest.raises(WordsError) as refusal:
        instructions.write_circles([circle, [0, 0, 0]])
    assert str(refusal.value).startswith(
        "a circle must have a center within -32768 to 65535 and a radius within 0 to 65535, not ["
    )
