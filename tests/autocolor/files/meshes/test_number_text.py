from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from autocolor.errors import InputError
from autocolor.files.meshes.number_text import IN_PLY, NumberText, Problems
from tests.autocolor.files.refusals import refusal


def test_numbers_are_found_between_any_white_space() -> None:
    text = NumberText(b"\n 1 -2\t+3\r\n4e1\n", "a.txt")
    assert len(text) == 4
    assert text.wholes(0, 3, "a count").tolist() == [1, -2, 3]
    assert text.coordinates(1, 3).tolist() == [-2, 3, 40]
    assert (text.word(3), text.line(3)) == (b"4e1", 3)


@pytest.mark.parametrize("word", ["1_0", "0x1", "\u0661", "nan", "inf", "1d", "1,5", "1e31", "e", "--1"])
def test_coordinates_are_strict_and_a_wrong_one_is_told_with_its_line(word: str) -> None:
    assert refusal(NumberText(f"1 2\n3 {word} 4".encode(), "a.txt").coordinates, 0, 5) == (
        "a.txt, line 2: a coordinate must be a decimal number of at most 1e30 in size, not"
        f" {word!r}; correct it"
    )


@pytest.mark.parametrize("word", ["1.0", "1_0", "x", "9" * 19, "9" * 5000, "+-1"])
def test_whole_numbers_are_strict(word: str) -> None:
    with pytest.raises(InputError, match="line 1: a count must be a whole number, not '"):
        NumberText(f"1 {word}".encode(), "a.txt").wholes(0, 2, "a count")


def test_values_may_be_missing_or_infinite() -> None:
    assert str(NumberText(b"nan -INF 1e2 NaN", "").values(0, 4).tolist()) == "[nan, -inf, 100.0, nan]"
    assert NumberText(b"infinity", "").values(0, 1, IN_PLY).tolist() == [np.inf]
    for word in ("fin", "infinity"):
        with pytest.raises(InputError, match=f"a value must be a decimal number, nan or inf, not '{word}'"):
            NumberText(f"1 {word}".encode(), "").values(0, 2)


def test_too_few_numbers_are_refused_before_anything_is_made_of_them() -> None:
    assert refusal(NumberText(b"1 2 3", "a.txt").require, 10**12, "nodes") == (
        "a.txt: there must be 1,000,000,000,000 numbers up to the end of the nodes, not 3; the file is cut"
        " short or its counts are wrong"
    )


@given(st.lists(st.floats(-1e30, 1e30), min_size=1))
def test_numbers_read_back_equal(numbers: list[float]) -> None:
    text = NumberText(" ".join(map(repr, numbers)).encode(), "")
    assert text.coordinates(0, len(numbers)).tolist() == numbers


def test_problems_come_in_the_order_of_tables_and_rows() -> None:
    problems = Problems("row")
    for place, row in (("nodes.csv", 9), ("polygons.csv", 1), ("nodes.csv", 2)):
        problems.note(place, row, "wrong")
    with pytest.raises(InputError) as caught:
        problems.raise_any()
    assert caught.value.problems == (
        "nodes.csv, row 2: wrong",
        "nodes.csv, row 9: wrong",
        "polygons.csv, row 1: wrong",
    )


def test_there_are_at_most_twenty_problems() -> None:
    problems = Problems("row")
    for row in range(19):
        problems.note("a.csv", row, "wrong")
    with pytest.raises(InputError) as caught:
        problems.note("a.csv", 19, "wrong")
    assert len(caught.value.problems) == 20


@pytest.mark.parametrize(
    ("data", "firsts"),
    [(b"\n 1 -2\t+3\n4e1\n", [0, 3]), (b"1 2\n\n3\n", [0, 2]), (b"  1\n 2 3", [0, 1]), (b"", [])],
)
def test_lines_begin_with_their_first_word(data: bytes, firsts: list[int]) -> None:
    assert NumberText(data, "").lines().tolist() == firsts


def test_vectors_begin_at_some_words_and_what_is_between_may_be_missing() -> None:
    text = NumberText(b"0 1.0D+00 2 nan\n3 4d-1 5 6", "a.txt")
    assert text.coordinates_at(np.array([0, 4]), 7).tolist() == [[0, 1, 2], [3, 0.4, 5]]
    assert refusal(text.coordinates_at, np.array([1, 4]), 7).startswith("a.txt, line 1: a coordinate must be")
    assert str(text.vectors_at(np.array([1]), 4).tolist()) == "[[1.0, 2.0, nan]]"
