from __future__ import annotations

import numpy as np
import pytest

from ramtek_emu.checks import checked_colors, checked_factors, checked_number, checked_stream, checked_words
from ramtek_emu.errors import ColorsError
from tests.tables import refused


def factor(value: object) -> int:
    return checked_number(value, "a factor", 1, 16, "choose another", ColorsError)


def size(value: object) -> tuple[int, int]:
    return checked_factors(value, "the size of text", "write it smaller")


def test_numbers_of_python_and_numpy_are_whole_and_limits_are_taken() -> None:
    for whole in (1, 16, np.uint8(1), np.int64(16)):
        checked = factor(whole)
        assert (type(checked), checked) == (int, int(whole))
    assert size(16) == size([16, np.int64(16)]) == (16, 16)


@pytest.mark.parametrize("kind", [np.uint16, np.int16, np.int64, np.uint64, ">u2", "u1"])
def test_arrays_of_any_whole_type_are_taken(kind: str) -> None:
    row = np.array([0, 127, 5], kind)
    for checked in (checked_stream(row), checked_words([row], 7)[0]):
        assert (checked.dtype.type, checked.tolist()) == (np.uint16, row.tolist())
    colors = checked_colors(1021, [row] * 3)
    assert (colors.dtype.type, colors[2].tolist()) == (np.uint8, row.tolist())
    assert checked_stream(checked) is checked
    assert checked_stream([]).dtype == np.uint16


test_what_is_no_factor = refused(
    factor,
    [
        *((value, f"a factor must be 1 to 16, not {value}; choose another") for value in (0, np.int64(17))),
        *(
            (value, f"a factor must be a whole number from 1 to 16, not {value!r}; choose another")
            for value in (True, 2.0, None, "2")
        ),
    ],
)
test_what_is_no_size = refused(
    size,
    [
        ((1, 2, 3), "the size of text must be one number or two, not (1, 2, 3); give both"),
        ((1, 17), "the size of text must be 1 to 16, not 17; write it smaller"),
    ],
)
MANY = "colors must be at most {}, as the table's entries, not {}; send fewer"
RUN = "the first of {} entries must be 0 to {}, not {}; choose entries of the table"
test_what_is_no_run_of_entries = refused(
    lambda given: checked_colors(given[0], [[1, 2, 3]] * given[1], *given[2:]),
    [
        ((-1, 1), RUN.format(1, 1023, -1)),
        ((1022, 3), RUN.format(3, 1021, 1022)),
        ((0, 1025), MANY.format(1024, 1025)),
    ],
)
COLOR = "a color must be 0 to 255, not {} (entry {}, {}); clip it first"
test_what_is_no_color = refused(
    lambda colors: checked_colors(7, colors),
    [
        ([[0, 1, 2], [0, 256, 0]], COLOR.format(256, 8, "green")),
        ([[0, 1, -1]], COLOR.format(-1, 7, "blue")),
        ([0, 1, 2], "colors must be an (n, 3) array of red, green, blue, not of shape (3,); reshape it"),
    ],
)
WHOLE = "a stream of words must be whole numbers, not {}; convert them first, rounding half up"
BYTES = WHOLE.partition(";")[0] + "; pass np.frombuffer(data, '<u2') if its low bytes come first"
test_what_is_no_stream = refused(
    checked_stream,
    [
        *((value, BYTES.format(type(value).__name__)) for value in (bytearray(2), memoryview(b"12"))),
        *((value, WHOLE.format("object")) for value in (None, [10**30], [[1], [2, 3]])),
        ("0700", WHOLE.format("<U4")),
        (1792, "a stream of words must be one row, not of shape (); flatten it first"),
    ],
)
