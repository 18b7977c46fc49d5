from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from ramtek_emu.checks import (
    checked_colors,
    checked_number,
    checked_stream,
    checked_words,
    is_whole,
    whole_numbers,
)
from ramtek_emu.errors import ColorsError, WordsError

KINDS = st.sampled_from([np.uint16, np.int16, np.int64, np.uint64, ">u2"])


@given(st.lists(st.integers(-5, 1030), min_size=1, max_size=12), st.integers(1, 10))
def test_words_that_fit_the_planes_are_accepted(row: list[int], planes: int) -> None:
    if all(0 <= word < 1 << planes for word in row):
        checked = checked_words([row], planes)
        assert checked.dtype == np.uint16
        assert checked.tolist() == [row]
        return
    first = next(place for place, word in enumerate(row) if not 0 <= word < 1 << planes)
    with pytest.raises(WordsError) as refusal:
        checked_words([row], planes)
    assert str(refusal.value) == (
        f"a word must be 0 to {(1 << planes) - 1}, not {row[first]} "
        f"(line 0, element {first}); use fewer levels"
    )


@pytest.mark.parametrize("shape", [(3,), (0, 3), (3, 0), (1, 2, 3)])
def test_words_that_are_no_raster_are_refused_with_their_shape(shape: tuple[int, ...]) -> None:
    with pytest.raises(WordsError) as refusal:
        checked_words(np.zeros(shape, np.uint16))
    assert str(refusal.value) == (
        f"words must be a (lines, elements) array with at least one word, not of shape {shape}; "
        "pass words[np.newaxis] for one line"
    )


@given(st.lists(st.integers(0, 0x7FFF), max_size=20), KINDS)
def test_a_stream_of_any_whole_type_arrives_as_16_bit_words(row: list[int], kind: type[np.integer]) -> None:
    checked = checked_stream(np.array(row, kind))
    assert checked.dtype == np.uint16
    assert checked.tolist() == row


def test_a_stream_of_16_bit_words_is_taken_as_it_is() -> None:
    words = np.arange(5, dtype=np.uint16)
    assert checked_stream(words) is words


@given(st.integers(0, 1023), st.lists(st.tuples(*[st.integers(0, 255)] * 3), max_size=9), KINDS)
def test_colors_are_taken_when_the_table_holds_them_all(
    first: int, colors: list[tuple[int, int, int]], kind: type[np.integer]
) -> None:
    array = np.array(colors, kind).reshape(-1, 3)
    if first + len(colors) <= 1024:
        checked = checked_colors(first, array)
        assert checked.dtype == np.uint8
        assert checked.tolist() == [list(color) for color in colors]
    else:
        with pytest.raises(ColorsError, match="a run of entries must end at 1023"):
            checked_colors(first, array)


def test_an_argument_that_is_no_array_of_whole_numbers_is_refused() -> None:
    for error in (WordsError, ColorsError):
        with pytest.raises(error) as refusal:
            whole_numbers([[1], [2, 3]], "things", error)
        assert str(refusal.value) == (
            "things must be an array of whole numbers, not list; pass a numpy array"
        )
        with pytest.raises(error, match="things must be whole numbers, not bool; convert them first"):
            whole_numbers([True], "things", error)
    assert whole_numbers([], "things", WordsError).size == 0


def test_numbers_of_python_and_numpy_are_whole_and_truth_values_are_not() -> None:
    for whole in (3, np.uint8(3), np.int64(3)):
        assert is_whole(whole)
        checked = checked_number(whole, "a factor", 1, 16, "choose another", WordsError)
        assert (type(checked), checked) == (int, 3)
    for other in (True, np.bool_(True), 3.0, np.float64(3), "3", None, np.array([3])):
        assert not is_whole(other)


@pytest.mark.parametrize(
    ("value", "rule"),
    [
        (0, "1 to 16, not 0"),
        (np.int64(17), "1 to 16, not 17"),
        (True, "a whole number from 1 to 16, not True"),
        (np.float32(2), "a whole number from 1 to 16, not 2.0"),
        ("2", "a whole number from 1 to 16, not '2'"),
        (None, "a whole number from 1 to 16, not None"),
    ],
)
def test_a_number_that_does_not_fit_is_refused_as_it_was_given(value: object, rule: str) -> None:
    with pytest.raises(ColorsError) as refusal:
        checked_number(value, "a factor", 1, 16, "choose another", ColorsError)
    assert str(refusal.value) == f"a factor must be {rule}; choose another"


@pytest.mark.parametrize("data", [b"\x00\x07", bytearray(b"\x00\x07"), memoryview(b"\x00\x07")])
def test_bytes_are_no_stream_since_nobody_can_tell_their_order(data: object) -> None:
    with pytest.raises(WordsError) as refusal:
        checked_stream(data)
    assert str(refusal.value) == (
        f"a stream of words must be whole numbers, not {type(data).__name__}; "
        "pass np.frombuffer(data, '<u2') if its low bytes come first"
    )


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        ("0700", "whole numbers, not text; pass a list or an array of them"),
        (None, "whole numbers, not NoneType; pass a list or an array of them"),
        ({1792}, "whole numbers, not set; pass a list or an array of them"),
        (iter([1792]), "whole numbers, not list_iterator; pass a list or an array of them"),
        ([10**30], "whole numbers, not objects; pass a list or an array of them"),
        ([1792.5], "whole numbers, not float64; convert them first, rounding half up"),
        (1792, "one row, not the number 1792; put it in a list"),
        ([[1792]], "one row, not of shape (1, 1); flatten it first"),
    ],
)
def test_a_stream_must_be_a_row_of_whole_numbers(words: object, sentence: str) -> None:
    with pytest.raises(WordsError) as refusal:
        checked_stream(words)
    assert str(refusal.value) == f"a stream of words must be {sentence}"


def test_no_colors_may_be_an_empty_list() -> None:
    assert checked_colors(5, []).shape == (0, 3)
