from __future__ import annotations

from functools import partial

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from ramtek_emu.checks import checked_colors, checked_number, checked_size, checked_stream, checked_words
from ramtek_emu.errors import ColorsError, InstructionError, WordsError
from tests.tables import call, refused

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


@given(st.lists(st.integers(0, 0x7FFF), max_size=20), KINDS)
def test_a_stream_of_any_whole_type_arrives_as_16_bit_words(row: list[int], kind: type[np.integer]) -> None:
    checked = checked_stream(np.array(row, kind))
    assert checked.dtype == np.uint16
    assert checked.tolist() == row
    assert checked_stream(checked) is checked


@given(st.integers(0, 1023), st.lists(st.tuples(*[st.integers(0, 255)] * 3), max_size=9), KINDS)
def test_colors_are_taken_when_the_table_holds_them_all(
    first: int, colors: list[tuple[int, int, int]], kind: type[np.integer]
) -> None:
    array = np.array(colors, kind).reshape(-1, 3)
    first = min(first, 1024 - len(colors))
    checked = checked_colors(first, array)
    assert checked.dtype == np.uint8
    assert checked.tolist() == [list(color) for color in colors]


def test_numbers_of_python_and_numpy_are_whole_and_limits_are_taken() -> None:
    for whole in (1, 16, np.uint8(1), np.int64(16)):
        checked = checked_number(whole, "a factor", 1, 16, "choose another", WordsError)
        assert (type(checked), checked) == (int, int(whole))
    assert checked_size(16) == checked_size([16, np.int64(16)]) == (16, 16)
    assert checked_stream([0xFFFF, 0]).tolist() == [0xFFFF, 0]
    assert checked_colors(5, []).shape == (0, 3)
    assert checked_colors(1021, [[255, 0, 0]] * 3).shape == checked_colors(0, [[0, 0, 0]] * 3).shape


def factor(value: object) -> int:
    return checked_number(value, "a factor", 1, 16, "choose another", ColorsError)


LISTED = "a stream of words must be whole numbers, not {}; pass a list or an array of them"
ROW = "a stream of words must be one row, not {}"
BYTES = (
    "a stream of words must be whole numbers, not {}; "
    "pass np.frombuffer(data, '<u2') if its low bytes come first"
)
test_what_is_refused = refused(
    call,
    [
        (lambda: factor(0), "a factor must be 1 to 16, not 0; choose another"),
        (lambda: factor(np.int64(17)), "a factor must be 1 to 16, not 17; choose another"),
        (lambda: factor("2"), "a factor must be a whole number from 1 to 16, not '2'; choose another"),
        *(
            (
                partial(factor, value),
                f"a factor must be a whole number from 1 to 16, not {value!s}; choose another",
            )
            for value in (True, 2.0, None)
        ),
        *(
            (
                partial(checked_words, np.zeros(shape, np.uint16)),
                f"words must be a (lines, elements) array with at least one word, not of shape {shape}; "
                "pass words[np.newaxis] for one line",
            )
            for shape in ((3,), (3, 0))
        ),
        (
            lambda: checked_words([[1], [2, 3]]),
            "words must be an array of whole numbers, not list; pass a numpy array",
        ),
        (
            lambda: checked_colors(0, [[True] * 3]),
            "colors must be whole numbers, not bool; convert them first, rounding half up",
        ),
        (
            lambda: checked_colors(0, [[1, 2]]),
            "colors must be an (n, 3) array of red, green, blue, not of shape (1, 2); reshape it",
        ),
        *(
            (
                partial(checked_colors, first, []),
                f"the first entry must be 0 to 1023, not {first}; choose an entry of the table",
            )
            for first in (1024, -1)
        ),
        (
            lambda: checked_colors(1022, [[1, 2, 3]] * 3),
            "a run of entries must end at 1023, not 1024 (3 from 1022 on); send fewer",
        ),
        (
            lambda: checked_colors(7, [[1, 2, 3], [4, 256, 6]]),
            "a color must be 0 to 255, not 256 (entry 8, green); clip it first",
        ),
        (
            lambda: checked_colors(7, [[1, 2, -1]]),
            "a color must be 0 to 255, not -1 (entry 7, blue); clip it first",
        ),
        (
            lambda: checked_size((1, 2, 3)),
            "the size of text must be one number or two, not (1, 2, 3); give both",
        ),
        (lambda: checked_size((1, 17)), "the size of text must be 1 to 16, not 17; write it smaller"),
        (lambda: checked_stream(bytearray(2)), BYTES.format("bytearray")),
        (lambda: checked_stream(memoryview(b"12")), BYTES.format("memoryview")),
        (lambda: checked_stream("0700"), LISTED.format("text")),
        (lambda: checked_stream(None), LISTED.format("NoneType")),
        (lambda: checked_stream(iter([1792])), LISTED.format("list_iterator")),
        (lambda: checked_stream([10**30]), LISTED.format("objects")),
        (
            lambda: checked_stream([1792.5]),
            "a stream of words must be whole numbers, not float64; convert them first, rounding half up",
        ),
        (lambda: checked_stream(1792), ROW.format("the number 1792; put it in a list")),
        (lambda: checked_stream([[1792]]), ROW.format("of shape (1, 1); flatten it first")),
        (
            lambda: checked_stream([0, 0x10000]),
            "a word of a stream must be 0 to 65535, not 65536 (word 1); mask it to 16 bits",
        ),
        (
            lambda: checked_stream([-1]),
            "a word of a stream must be 0 to 65535, not -1 (word 0); mask it to 16 bits",
        ),
    ],
    (WordsError, ColorsError, InstructionError),
)
