from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor.errors import InputError
from autocolor.files.meshes.number_text import NumberText
from tests.autocolor.files.refusals import refusal


def test_numbers_are_found_between_any_white_space() -> None:
    text = NumberText(b"\n 1 -2\t+3\r\n4e1\n", "a.txt")
    assert len(text) == 4
    assert text.wholes(0, 3, "a count").tolist() == [1, -2, 3]
    assert text.vectors(np.array([1]), 4).tolist() == [[-2, 3, 40]]
    assert (text.word(3), text.line(3)) == (b"4e1", 3)


@pytest.mark.parametrize("word", ["1.5", "1_0", "nan", "9" * 19, "9" * 5000, "+-1"])
def test_whole_numbers_are_strict(word: str) -> None:
    with pytest.raises(InputError, match="line 1: a count must be a whole number, not '"):
        NumberText(f"1 {word}".encode(), "a.txt").wholes(0, 2, "a count")


def test_values_may_be_missing_or_infinite() -> None:
    values = NumberText(b"nan -INF 1e2 NaN infinity", "").values(0, 5)
    assert str(values.tolist()) == "[nan, -inf, 100.0, nan, inf]"
    for wrong in ("fin", "\x01"):
        text = NumberText(f"1 {wrong} 2".encode(), "a.txt")
        assert "a value must be a decimal number, nan or inf, not '" in refusal(text.values, 0, len(text))


@given(st.lists(st.floats(-1e30, 1e30), min_size=1))
def test_numbers_read_back_equal(numbers: list[float]) -> None:
    text = NumberText(" ".join(map(repr, numbers)).encode(), "")
    assert text.values(0, len(numbers)).tolist() == numbers


def test_lines_begin_with_their_first_word() -> None:
    for data, firsts in ((b"\n 1 -2\t+3\n4e1\n", [0, 3]), (b"  1\n\n 2 3", [0, 1]), (b"", [])):
        assert NumberText(data, "").lines().tolist() == firsts


def test_vectors_begin_at_some_words_and_what_is_between_may_be_missing() -> None:
    text = NumberText(b"0 1.0D+00 2 nan\n3 4d-1 5 6", "a.txt")
    assert text.vectors(np.array([0, 4]), 7).tolist() == [[0, 1, 2], [3, 0.4, 5]]
    assert refusal(text.vectors, np.array([1, 4]), 7).startswith("a.txt, line 1: a coordinate must be")
    assert str(text.vectors(np.array([0]), 4, 4).tolist()) == "[[0.0, 1.0, 2.0, nan]]"
