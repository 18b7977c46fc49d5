from __future__ import annotations

import numpy as np
import pytest

from autocolor.errors import InputError
from autocolor.files.meshes.vtk.cursor import TYPES, VtkCursor


def text(data: bytes) -> VtkCursor:
    cursor = VtkCursor(data, "a.vtk")
    cursor.as_text()
    return cursor


def refusal(cursor: VtkCursor, kind: bytes = b"int", count: int = 2) -> str:
    with pytest.raises(InputError) as caught:
        cursor.array(count, kind, "POINTS")
    return str(caught.value)


def test_lines_and_arrays_follow_each_other_in_text() -> None:
    cursor = text(b"POINTS 2\n1 2\n\n 3 NEXT word\nmore")
    assert cursor.peek() == b"POINTS"
    assert cursor.words() == [b"POINTS", b"2"]
    assert cursor.array(3, b"int", "x").tolist() == [1, 2, 3]
    assert cursor.words() == [b"NEXT", b"word"]
    assert cursor.array(0, b"float", "x").tolist() == []
    assert cursor.words() == [b"more"]
    assert (cursor.words(), cursor.peek()) == ([], b"")


@pytest.mark.parametrize("kind", TYPES)
def test_each_type_is_read_from_binary_with_the_high_byte_first(kind: bytes) -> None:
    numbers = np.array([1, 2, 100], TYPES[kind])
    cursor = VtkCursor(b"X\r\n" + numbers.tobytes() + b"\nNEXT\n", "a.vtk")
    cursor.words()
    assert cursor.array(3, kind.upper(), "x").tolist() == [1, 2, 100]
    assert cursor.words() == [b"NEXT"]


def test_an_array_that_is_longer_than_the_file_is_refused_before_it_is_made() -> None:
    assert refusal(VtkCursor(b"abc", "a.vtk"), count=10**15) == (
        "a.vtk, byte 0: the POINTS must have 4,000,000,000,000,000 bytes, not 3; the file is cut short or its"
        " counts are wrong"
    )
    assert refusal(text(b"\n1 x"), count=3) == (
        "a.vtk, line 1: the POINTS must have 3 numbers, not 2; the file is cut short or its counts are wrong"
    )


def test_what_is_no_number_is_refused_with_its_line() -> None:
    assert refusal(text(b"\n1 x")) == (
        "a.vtk, line 2: a number of the POINTS must be a whole number, not 'x'; correct it"
    )
    assert refusal(text(b"1 2"), b"complex") == (
        "a.vtk, line 1: the type of the POINTS must be int, float, double or another of numbers, not"
        " 'complex'; write it as double"
    )


def test_coordinates_are_finite_and_whole_numbers_whole() -> None:
    cursor = VtkCursor(np.array([1, np.inf], ">f4").tobytes(), "a.vtk")
    with pytest.raises(InputError) as caught:
        cursor.coordinates(2, b"float", "POINTS")
    assert str(caught.value) == (
        "a.vtk, byte 0: a coordinate must be finite and at most 1e30 in size, not inf (number 2 of the"
        " POINTS);"
        " correct it"
    )
    with pytest.raises(InputError, match="the type of the CELLS must be one of whole numbers, not 'float'"):
        text(b"1 2").wholes(2, b"float", "CELLS")


@pytest.mark.parametrize("word", [b"-1", b"1.0", b"x", b"", b"9" * 19, "\u0661".encode()])
def test_a_count_is_a_whole_number(word: bytes) -> None:
    with pytest.raises(InputError, match="a count must be a whole number from 0 on, not "):
        text(b"").count(word, "a count")


def test_metadata_ends_with_an_empty_line() -> None:
    cursor = VtkCursor(b"INFORMATION 1\nNAME a\nDATA 2 0 1\n\nNEXT", "a.vtk")
    cursor.skip_metadata()
    assert cursor.words() == [b"NEXT"]
    with pytest.raises(InputError, match="METADATA must end with an empty line; remove it"):
        VtkCursor(b"x\n" * 20_000, "a.vtk").skip_metadata()


def test_an_endless_line_is_refused() -> None:
    with pytest.raises(InputError) as caught:
        VtkCursor(b"x" * 10_000, "a.vtk").words()
    assert str(caught.value) == (
        "a.vtk, byte 0: a line of keywords must have less than 4,096 bytes; correct it"
    )
